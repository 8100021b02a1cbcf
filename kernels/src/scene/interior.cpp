// SPDX-License-Identifier: GPL-3.0-or-later
// Where a path begins: the gems round a point, found by looking outwards for boundaries that are left without having been
// entered. Three directions have to agree, so that an open mesh, which has no inside, is not taken for one.
#include "scene/interior.h"

namespace opal {
namespace {

constexpr int kMostBoundaries = 256;
constexpr Vec3 kDirections[3] = {{0.3017f, 0.5211f, 0.7984f}, {-0.8312f, 0.2214f, -0.5101f}, {0.4409f, -0.8511f, 0.2847f}};

struct Found {
  InteriorStack::Entry entries[InteriorStack::kCapacity];  // from the innermost out
  int count = 0;

  bool contains(const InteriorStack::Entry &e) const {
    for (int i = 0; i < count; ++i)
      if (entries[i].instance == e.instance && entries[i].material == e.material) return true;
    return false;
  }
};

Found look(const Scene &scene, const Vec3 &p, const Vec3 &direction) {
  Found found;
  InteriorStack entered;  // of what lies further along the ray
  Ray ray{p, normalize(direction)};
  for (int i = 0; i < kMostBoundaries; ++i) {
    const Hit hit = scene.intersect(ray, ~0u);
    if (!hit.valid()) break;
    const ShadingPoint sp = scene.shading_point(ray, hit);
    const uint32_t material = scene.material_index(hit.instance, hit.triangle);
    if (scene.materials[material].is_gem) {
      const InteriorStack::Entry entry{sp.instance_index, material, scene.materials[material].gem.priority, sp.instance->order};
      if (!sp.backfacing) entered.enter(entry);
      else if (entered.contains(entry.instance, entry.material)) entered.leave(entry.instance, entry.material);
      else if (found.count < InteriorStack::kCapacity) found.entries[found.count++] = entry;
    }
    ray.origin = offset_origin(sp, ray.direction);
  }
  return found;
}

}  // namespace

InteriorStack interior_at(const Scene &scene, const Vec3 &p) {
  InteriorStack result;
  bool near = false;
  for (const EmissionTarget &caster : scene.casters) near |= length_squared(p - caster.centre) <= sqr(caster.radius);
  if (!near) return result;
  const Found first = look(scene, p, kDirections[0]);
  if (first.count == 0) return result;
  const Found second = look(scene, p, kDirections[1]), third = look(scene, p, kDirections[2]);
  for (int i = first.count; i-- > 0;)  // the innermost was entered last
    if (second.contains(first.entries[i]) && third.contains(first.entries[i])) result.enter(first.entries[i]);
  return result;
}

}  // namespace opal
