// SPDX-License-Identifier: GPL-3.0-or-later
#include "shader/point_inputs.h"

namespace opal {
namespace {

Vec3 load(const std::vector<float> &values, size_t first) { return {values[first], values[first + 1], values[first + 2]}; }

// a (1-u-v) + b u + c v.
Vec3 interpolate(const ShadingPoint &sp, const Vec3 &a, const Vec3 &b, const Vec3 &c) {
  return a * (1 - sp.u - sp.v) + b * sp.u + c * sp.v;
}

const int32_t *corners(const ShadingPoint &sp) { return &sp.mesh->triangles[size_t(sp.triangle) * 3]; }

struct Edges {
  Vec3 a, b;  // from the first corner to the second and the third, object space
};
Edges edges(const ShadingPoint &sp) {
  const int32_t *c = corners(sp);
  const Vec3 p = sp.mesh->vertex(c[0], sp.time);
  return {sp.mesh->vertex(c[1], sp.time) - p, sp.mesh->vertex(c[2], sp.time) - p};
}

// Interpolated normal in the object's space, turned as the mesh has it (not towards the viewer), any length.
Vec3 object_normal(const ShadingPoint &sp) {
  if (sp.smooth && !sp.mesh->corner_normals.empty()) {
    const size_t first = size_t(sp.triangle) * 9;
    const std::vector<float> &n = sp.mesh->corner_normals;
    return interpolate(sp, load(n, first), load(n, first + 3), load(n, first + 6));
  }
  return normal_to_object(sp, sp.backfacing ? -sp.ng : sp.ng);
}

const Attribute *find(const ShadingPoint &sp, int name) {
  if (sp.mesh)
    for (const Attribute &a : sp.mesh->attributes)
      if (a.name == name) return &a;
  return nullptr;
}

// Where the values of an attribute at the three corners of the point's triangle begin.
void value_offsets(const ShadingPoint &sp, const Attribute &a, size_t out[3]) {
  for (int i = 0; i < 3; ++i) {
    const size_t element = a.domain == OPAL_DOMAIN_CORNER   ? size_t(sp.triangle) * 3 + size_t(i)
                           : a.domain == OPAL_DOMAIN_VERTEX ? size_t(corners(sp)[i])
                                                            : size_t(sp.triangle);
    out[i] = element * size_t(a.components);
  }
}

// Tangent along U and handedness, in the object's space; false without UVs or where they do not span a plane.
bool uv_tangent(const ShadingPoint &sp, int uv, const Vec3 &normal, Vec3 &tangent, float &sign) {
  if (!sp.mesh->corner_tangents.empty()) {
    const size_t first = size_t(sp.triangle) * 12;
    const std::vector<float> &t = sp.mesh->corner_tangents;
    tangent = interpolate(sp, load(t, first), load(t, first + 4), load(t, first + 8));
    sign = t[first + 3];
    return true;
  }
  const Attribute *a = find(sp, uv);
  if (!a || a->components < 2) return false;
  size_t at[3];
  value_offsets(sp, *a, at);
  const auto coordinate = [&](int i) { return Vec2{a->values[at[i]], a->values[at[i] + 1]}; };
  const Vec2 c0 = coordinate(0), c1 = coordinate(1), c2 = coordinate(2);
  const float du1 = c1.x - c0.x, dv1 = c1.y - c0.y, du2 = c2.x - c0.x, dv2 = c2.y - c0.y;
  const float det = du1 * dv2 - du2 * dv1;
  if (det == 0) return false;
  const Edges e = edges(sp);
  const Vec3 n = safe_normalize(normal, sp.ng);
  const Vec3 t = (e.a * dv2 - e.b * dv1) * (det > 0 ? 1.0f : -1.0f);
  tangent = safe_normalize(t - n * dot(n, t), {});
  sign = det > 0 ? 1.0f : -1.0f;
  return length_squared(tangent) > 0;
}

}  // namespace

PointTransforms point_transforms(const ShadingPoint &sp) {
  if (!sp.instance) return {};
  if (!sp.instance->motion) return {sp.instance->to_world, sp.instance->to_object};
  const Transform t = sp.instance->motion->at(sp.time);
  return {t, inverse(t)};
}

Vec3 normal_to_object(const ShadingPoint &sp, const Vec3 &n) {
  return sp.instance ? safe_normalize(point_transforms(sp).to_world.transposed_vector(n), n) : n;
}
Vec3 normal_to_world(const ShadingPoint &sp, const Vec3 &n) {
  return sp.instance ? safe_normalize(point_transforms(sp).to_object.transposed_vector(n), n) : n;
}

Vec3 generated_coordinate(const ShadingPoint &sp) {
  if (!sp.mesh) return sp.p;
  const Mesh &mesh = *sp.mesh;
  if (!mesh.generated.empty()) {
    const int32_t *c = corners(sp);
    return interpolate(sp, load(mesh.generated, size_t(c[0]) * 3), load(mesh.generated, size_t(c[1]) * 3),
                       load(mesh.generated, size_t(c[2]) * 3));
  }
  const Vec3 p = point_transforms(sp).to_object.point(sp.p), size = mesh.bounds.high - mesh.bounds.low;
  Vec3 g;
  for (int i = 0; i < 3; ++i) g[i] = size[i] > 0 ? (p[i] - mesh.bounds.low[i]) / size[i] : 0.5f;
  return g;
}

Vec3 texture_coordinate(const ShadingPoint &sp, int mode) {
  switch (mode) {
    case OPAL_COORDINATE_GENERATED: return generated_coordinate(sp);
    case OPAL_COORDINATE_NORMAL: return normal_to_object(sp, sp.ns);
    case OPAL_COORDINATE_OBJECT: return point_transforms(sp).to_object.point(sp.p);
    case OPAL_COORDINATE_REFLECTION: return sp.mesh ? reflect(sp.wo, sp.ns) : sp.wo;
    default: return sp.p;
  }
}

bool find_attribute(const ShadingPoint &sp, int name, Float4 &value, int &components) {
  const Attribute *a = find(sp, name);
  if (!a) return false;
  size_t at[3];
  value_offsets(sp, *a, at);
  const float w[3] = {1 - sp.u - sp.v, sp.u, sp.v};
  float c[4] = {0, 0, 0, 1};
  components = std::min(a->components, 4);
  for (int k = 0; k < components; ++k) {
    c[k] = 0;
    for (int i = 0; i < 3; ++i) c[k] += w[i] * a->values[at[i] + size_t(k)];
  }
  if (components == 1) c[1] = c[2] = c[0];
  value = {c[0], c[1], c[2], c[3]};
  return true;
}

Float4 attribute(const ShadingPoint &sp, int name, int mode, const Float4 &fallback) {
  Float4 v;
  int components = 0;
  if (!find_attribute(sp, name, v, components)) return fallback;
  if (mode == OPAL_ATTRIBUTE_ALPHA) return number(v.w);
  if (mode == OPAL_ATTRIBUTE_FACTOR) return number(components <= 2 ? v.x : average(v.xyz()));
  return v;
}

Float4 geometry_input(const ShadingPoint &sp, int mode) {
  switch (mode) {
    case OPAL_GEOMETRY_NORMAL: return vector(sp.ns);
    case OPAL_GEOMETRY_TANGENT: return vector(tangent_input(sp, 2, -1));
    case OPAL_GEOMETRY_TRUE_NORMAL: return vector(sp.ng);
    case OPAL_GEOMETRY_INCOMING: return vector(sp.wo);
    case OPAL_GEOMETRY_PARAMETRIC: return {1 - sp.u - sp.v, sp.u, 0, 0};
    case OPAL_GEOMETRY_BACKFACING: return number(sp.backfacing ? 1.0f : 0.0f);
    default: return vector(sp.p);
  }
}

Float4 object_input(const ShadingPoint &sp, int mode) {
  if (!sp.instance) return {};
  const Instance &i = *sp.instance;
  switch (mode) {
    case OPAL_OBJECT_LOCATION: return vector(point_transforms(sp).to_world.origin());
    case OPAL_OBJECT_COLOR: return {i.color[0], i.color[1], i.color[2], i.color[3]};
    case OPAL_OBJECT_ALPHA: return number(i.color[3]);
    case OPAL_OBJECT_INDEX: return number(i.object_index);
    default: return number(i.random);
  }
}

float light_path_input(const ShadingPoint &sp, int mode) {
  const auto is = [&sp](uint32_t kinds) { return sp.ray_kind & kinds ? 1.0f : 0.0f; };
  switch (mode) {
    case OPAL_PATH_IS_CAMERA: return is(OPAL_RAY_CAMERA);
    case OPAL_PATH_IS_SHADOW: return is(OPAL_RAY_SHADOW);
    case OPAL_PATH_IS_DIFFUSE: return is(OPAL_RAY_DIFFUSE);
    case OPAL_PATH_IS_GLOSSY: return is(OPAL_RAY_GLOSSY);
    case OPAL_PATH_IS_REFLECTION: return is(OPAL_RAY_DIFFUSE | OPAL_RAY_GLOSSY);
    case OPAL_PATH_IS_TRANSMISSION: return is(OPAL_RAY_TRANSMISSION);
    case OPAL_PATH_IS_SCATTER: return is(OPAL_RAY_SCATTER);
    case OPAL_PATH_LENGTH: return sp.ray_length;
    case OPAL_PATH_DEPTH: return float(sp.depth);
    default: return 0;
  }
}

Vec3 tangent_input(const ShadingPoint &sp, int mode, int uv) {
  if (!sp.mesh) return {};
  Vec3 t;
  if (mode == 3) {
    float sign;
    if (!uv_tangent(sp, uv, object_normal(sp), t, sign)) return {};
  } else {
    const Vec3 g = generated_coordinate(sp) - Vec3{0.5f, 0.5f, 0.5f};
    t = mode == 0 ? Vec3{0, -g.z, g.y} : mode == 1 ? Vec3{-g.z, 0, g.x} : Vec3{-g.y, g.x, 0};
  }
  t = normal_to_world(sp, t);
  return cross(sp.ns, safe_normalize(cross(t, sp.ns), {}));
}

Vec3 normal_map(const ShadingPoint &sp, int space, const Vec3 &color, float strength, int uv, bool flip_green) {
  if (!sp.mesh) return sp.ns;
  Vec3 c = 2 * (color - Vec3{0.5f, 0.5f, 0.5f});
  if (flip_green) c.y = -c.y;
  Vec3 n;
  if (space == OPAL_NORMAL_TANGENT) {
    const Vec3 normal = object_normal(sp);
    Vec3 tangent;
    float sign;
    if (!uv_tangent(sp, uv, normal, tangent, sign)) return sp.ns;
    c = {c.x * strength, c.y * strength, lerp(1, c.z, saturate(strength))};
    n = safe_normalize(tangent * c.x + cross(normal, tangent) * (sign * c.y) + normal * c.z, {});
    n = normal_to_world(sp, n);
  } else {
    if (space == OPAL_NORMAL_BLENDER_OBJECT || space == OPAL_NORMAL_BLENDER_WORLD) c.y = -c.y, c.z = -c.z;
    const bool object = space == OPAL_NORMAL_OBJECT || space == OPAL_NORMAL_BLENDER_OBJECT;
    n = object ? normal_to_world(sp, c) : safe_normalize(c, {});
  }
  if (sp.backfacing) n = -n;
  if (space != OPAL_NORMAL_TANGENT && strength != 1) n = safe_normalize(sp.ns + (n - sp.ns) * std::max(strength, 0.0f), {});
  return is_finite(n) && length_squared(n) > 0 ? n : sp.ns;
}

float fresnel_dielectric(float c, float eta) {
  c = std::abs(c);
  const float g2 = eta * eta - 1 + c * c;
  if (!(g2 > 0)) return 1;
  const float g = std::sqrt(g2);
  const float a = (g - c) / (g + c), b = (c * (g + c) - 1) / (c * (g - c) + 1);
  return 0.5f * a * a * (1 + b * b);
}

float fresnel_input(const ShadingPoint &sp, float ior, const Vec3 &normal) {
  const float eta = std::max(ior, 1e-5f);
  return fresnel_dielectric(dot(sp.wo, normal), sp.backfacing ? 1 / eta : eta);
}

float layer_weight(const ShadingPoint &sp, bool facing, float blend, const Vec3 &normal) {
  if (!facing) {
    const float eta = std::max(1 - blend, 1e-5f);
    return fresnel_dielectric(dot(sp.wo, normal), sp.backfacing ? eta : 1 / eta);
  }
  float f = std::abs(dot(sp.wo, normal));
  if (blend != 0.5f) {
    const float b = clamp(blend, 0, 1 - 1e-5f);
    f = std::pow(f, b < 0.5f ? 2 * b : 0.5f / (1 - b));
  }
  return 1 - f;
}

ShadingPoint displaced(const ShadingPoint &sp, const Vec3 &offset) {
  ShadingPoint q = sp;
  q.p += offset;
  if (!sp.mesh) return q;
  const Edges e = edges(sp);
  const Vec3 d = point_transforms(sp).to_object.vector(offset);
  const Vec3 n = cross(e.a, e.b);
  const float l2 = length_squared(n);
  if (l2 > 0) {
    q.u += dot(cross(d, e.b), n) / l2;
    q.v += dot(cross(e.a, d), n) / l2;
  }
  return q;
}

float bump_step(const ShadingPoint &sp, float filter_width) {
  if (!sp.mesh) return 1e-3f;
  const Edges e = edges(sp);
  const Transform t = point_transforms(sp).to_world;
  const float edge = std::sqrt(std::max(length_squared(t.vector(e.a)), length_squared(t.vector(e.b))));
  return std::max({2e-3f * std::max(filter_width, 0.01f) * sp.ray_length, 1e-5f * edge, 100 * max_component(sp.error), 1e-12f});
}

}  // namespace opal
