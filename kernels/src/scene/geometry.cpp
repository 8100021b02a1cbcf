// SPDX-License-Identifier: GPL-3.0-or-later
// From a ray to a point that can be shaded.
#include "scene/scene.h"

namespace opal {
namespace {

constexpr float kEpsilon = 0x1p-24f;  // half a unit in the last place of 1
// Embree interpolates a turn for itself. Its angle comes from an arc cosine, which loses up to five bits near 1.
constexpr float kInterpolation = 64 * kEpsilon;
constexpr float gamma(int n) { return float(n) * kEpsilon / (1 - float(n) * kEpsilon); }

Vec3 absolute(const Vec3 &v) { return {std::abs(v.x), std::abs(v.y), std::abs(v.z)}; }

Vec3 corner(const std::vector<float> &values, size_t first) { return {values[first], values[first + 1], values[first + 2]}; }

// Looks past what a ray in contact must not meet.
struct ContactQuery {
  RTCRayQueryContext context;  // first: Embree hands it back
  const Contact *contact;

  static void filter(const RTCFilterArguments *a) {
    const Contact &contact = *reinterpret_cast<const ContactQuery *>(a->context)->contact;
    if (!(a->ray->tfar < contact.until)) return;
    // Ray and normal are in the object's space, where faces are wound as in the mesh.
    const bool back = dot(Vec3{a->hit->ng_x, a->hit->ng_y, a->hit->ng_z}, {a->ray->dir_x, a->ray->dir_y, a->ray->dir_z}) > 0;
    if (!contact.meets(a->hit->instance[0], back)) *a->valid = 0;
  }
};

}  // namespace

Vec3 Mesh::vertex(int i, float time) const {
  const Vec3 a = vertex(i);
  if (!moving()) return a;
  return between(corner(positions_start, size_t(i) * 3), a, corner(positions_end, size_t(i) * 3), time);
}

// Everywhere that an instance comes. One that turns is a ball about its centre here, whose path alone is followed: of each
// corner's that would take long for a hundred thousand copies.
Bounds world_bounds(const Bounds &local, const Instance &instance) {
  Bounds b;
  if (local.empty()) return b;
  const bool turns = instance.motion && instance.motion->turns();
  const Vec3 centre = local.centre();
  float r2 = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 p{i & 1 ? local.high.x : local.low.x, i & 2 ? local.high.y : local.low.y, i & 4 ? local.high.z : local.low.z};
    for (int key = 0; turns && key < Motion::kKeys; ++key)
      r2 = std::max(r2, length_squared(instance.motion->at(Motion::time_of(key)).vector(p - centre)));
    if (turns) continue;
    if (instance.motion) b.extend(instance.motion->path(p));
    else b.extend(instance.to_world.point(p));
  }
  if (turns) {
    const float r = std::sqrt(r2);
    b = instance.motion->path(centre);
    b.low -= {r, r, r}, b.high += {r, r, r};
  }
  return b;
}

Hit Scene::intersect(const Ray &ray, uint32_t visibility) const {
  RTCRayHit r;
  r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z;
  r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
  r.tnear = ray.t_min, r.tfar = ray.t_max, r.time = ray.time;
  r.mask = visibility, r.id = 0, r.flags = 0;
  ContactQuery query{{}, &ray.contact};
  RTCIntersectArguments arguments;
  arguments.flags = kRtcInvokeArgumentFilter;
  arguments.context = &query.context;
  arguments.filter = &ContactQuery::filter;
  for (;;) {
    r.prim = r.geom = r.instance[0] = kRtcInvalid;
    embree.intersect1(top, &r, ray.contact.until > 0 ? &arguments : nullptr);
    if (r.geom == kRtcInvalid) return {};
    if (embree.ray_mask || (groups[instances[r.instance[0]].group].visibility & visibility)) break;
    r.tnear = std::nextafter(r.tfar, kInfinity), r.tfar = ray.t_max;  // a build that cannot mask: look past it
  }
  return {r.tfar, r.u, r.v, r.instance[0], r.prim};
}

bool Scene::occluded(const Ray &ray, uint32_t visibility) const {
  if (!embree.ray_mask || ray.contact.until > 0) return intersect(ray, visibility).valid();
  RTCRay r;
  r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z;
  r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
  r.tnear = ray.t_min, r.tfar = ray.t_max, r.time = ray.time;
  r.mask = visibility, r.id = 0, r.flags = 0;
  embree.occluded1(top, &r, nullptr);
  return r.tfar < 0;
}

uint32_t Scene::material_index(uint32_t instance, uint32_t triangle) const {
  const Instance &inst = instances[instance];
  const InstanceGroup &group = groups[inst.group];
  const Mesh &mesh = *meshes[inst.mesh];
  size_t slot = mesh.material_slots.empty() ? 0 : size_t(std::max(0, mesh.material_slots[triangle]));
  if (group.materials.empty()) return 0;
  slot = std::min(slot, group.materials.size() - 1);
  const int32_t material = group.materials[slot];
  return material < 0 ? 0u : uint32_t(material);
}

const Material &Scene::material_at(const Hit &hit) const { return materials[material_index(hit.instance, hit.triangle)]; }

ShadingPoint Scene::shading_point(const Ray &ray, const Hit &hit) const {
  ShadingPoint sp;
  const Instance &instance = instances[hit.instance];
  const Mesh &mesh = *meshes[instance.mesh];
  const int32_t *corners = &mesh.triangles[size_t(hit.triangle) * 3];
  const Vec3 a = mesh.vertex(corners[0], ray.time), b = mesh.vertex(corners[1], ray.time),
             c = mesh.vertex(corners[2], ray.time);
  const float w = 1 - hit.u - hit.v;

  const Transform to_world = instance.to_world_at(ray.time);
  const Transform to_object = instance.motion ? inverse(to_world) : instance.to_object;

  const Vec3 local = a * w + b * hit.u + c * hit.v;
  sp.p = to_world.point(local);
  const Vec3 local_error = gamma(7) * (absolute(a) * std::abs(w) + absolute(b) * hit.u + absolute(c) * hit.v);
  Transform magnitude = to_world;
  for (float &m : magnitude.m) m = std::abs(m);
  sp.error = magnitude.vector(local_error) * (1 + gamma(3)) + gamma(4) * magnitude.point(absolute(local));
  if (instance.motion) sp.error += kInterpolation * magnitude.vector(absolute(local)) + gamma(4) * absolute(to_world.origin());

  Vec3 ng = to_object.transposed_vector(cross(b - a, c - a));
  ng = safe_normalize(ng, -ray.direction);
  Vec3 ns = ng;
  if (!mesh.corner_normals.empty()) {
    const size_t first = size_t(hit.triangle) * 9;
    const Vec3 n = corner(mesh.corner_normals, first) * w + corner(mesh.corner_normals, first + 3) * hit.u +
                   corner(mesh.corner_normals, first + 6) * hit.v;
    ns = safe_normalize(to_object.transposed_vector(n), ng);
    sp.smooth = true;
  }
  sp.wo = -ray.direction;
  sp.backfacing = dot(ng, sp.wo) < 0;
  sp.ng = sp.backfacing ? -ng : ng;
  sp.ns = sp.backfacing ? -ns : ns;
  sp.u = hit.u, sp.v = hit.v;
  sp.triangle = hit.triangle;
  sp.instance_index = hit.instance;
  sp.mesh = &mesh;
  sp.instance = &instance;
  sp.ray_length = hit.t;
  sp.time = ray.time;
  return sp;
}

EmissiveTriangle Scene::emissive_at(uint32_t index, float time) const {
  EmissiveTriangle e = emissive[index];
  const Instance &instance = instances[e.instance];
  const Mesh &mesh = *meshes[instance.mesh];
  if (!instance.motion && !mesh.moving()) return e;
  const int32_t *corners = &mesh.triangles[size_t(e.triangle) * 3];
  const Transform to_world = instance.to_world_at(time);
  e.p0 = to_world.point(mesh.vertex(corners[0], time));
  e.p1 = to_world.point(mesh.vertex(corners[1], time));
  e.p2 = to_world.point(mesh.vertex(corners[2], time));
  e.area = 0.5f * length(cross(e.p1 - e.p0, e.p2 - e.p0));
  return e;
}

Vec3 offset_origin(const ShadingPoint &sp, const Vec3 &direction) {
  // Three times the bound: the point's own error, and that of the ray as Embree carries it into object space. Where the
  // bound is nothing (a face that lies exactly in a coordinate plane) a trace remains, so that no denormal decides.
  const Vec3 n = sp.ng;
  const float trace = 0x1p-44f * (std::abs(sp.p.x) + std::abs(sp.p.y) + std::abs(sp.p.z) + sp.ray_length);
  const float distance = 3 * (std::abs(n.x) * sp.error.x + std::abs(n.y) * sp.error.y + std::abs(n.z) * sp.error.z) + trace;
  const Vec3 offset = n * (dot(direction, n) >= 0 ? distance : -distance);
  Vec3 p = sp.p + offset;
  for (int i = 0; i < 3; ++i) {  // round away from the surface, never back onto it
    if (offset[i] > 0) p[i] = std::nextafter(p[i], kInfinity);
    if (offset[i] < 0) p[i] = std::nextafter(p[i], -kInfinity);
  }
  return p;
}

}  // namespace opal
