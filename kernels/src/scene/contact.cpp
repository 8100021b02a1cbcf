// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/contact.h"

namespace opal {
namespace {

constexpr float kLeastCosine = 1e-3f;

// Length along `direction` that holds everything which coincides with the face at sp.
float contact_length(const ShadingPoint &sp, const Vec3 &direction) {
  const float off = length(offset_origin(sp, direction) - sp.p);
  return 4 * off / std::max(std::abs(dot(direction, sp.ng)), kLeastCosine);
}

enum class Rank { Entered, Left, Surface };

Rank rank_of(const Scene &scene, const Hit &hit, const ShadingPoint &sp) {
  if (!scene.material_at(hit).is_gem) return Rank::Surface;
  return sp.backfacing ? Rank::Left : Rank::Entered;
}

}  // namespace

Hit next_hit(const Scene &scene, const Ray &ray, uint32_t visibility) {
  Hit best = scene.intersect(ray, visibility);
  if (!scene.any_touching || !best.valid() || !scene.instances[best.instance].touching) return best;
  ShadingPoint sp = scene.shading_point(ray, best);
  Rank rank = rank_of(scene, best, sp);
  // What lies in the same place and comes first: the search leaves out what was found before.
  Ray search = ray;
  search.t_min = std::max(ray.t_min, best.t - contact_length(sp, ray.direction));
  search.t_max = best.t + contact_length(sp, ray.direction);
  Contact &found = search.contact;
  found = {};
  found.until = kInfinity;
  found.crossed[found.count++] = best.instance;
  while (rank != Rank::Entered) {
    const Hit other = scene.intersect(search, visibility);
    if (!other.valid()) break;
    if (other.t >= ray.contact.until || ray.contact.meets(other.instance)) {
      const Rank of_other = rank_of(scene, other, scene.shading_point(ray, other));
      if (of_other < rank) best = other, rank = of_other;
    }
    if (found.count == Contact::kMost) break;
    found.crossed[found.count++] = other.instance;
  }
  return best;
}

Ray leave_surface(const Scene &scene, const Ray &arrived, const ShadingPoint &sp, const Vec3 &direction) {
  const Ray plain{offset_origin(sp, direction), direction, 0, kInfinity, arrived.time};
  if (!scene.any_touching || !sp.instance->touching) return plain;
  Contact contact;
  if (sp.ray_length < arrived.contact.until) contact = arrived.contact;
  if (dot(direction, sp.ng) > 0) {
    contact.backward = !contact.backward;
  } else if (contact.backward) {
    for (int i = 0; i < contact.count; ++i)
      if (contact.crossed[i] == sp.instance_index) {
        contact.crossed[i] = contact.crossed[--contact.count];
        break;
      }
  } else if (contact.count < Contact::kMost && !contact.contains(sp.instance_index)) {
    contact.crossed[contact.count++] = sp.instance_index;
  }
  if (contact.count == 0) return plain;
  contact.until = contact_length(sp, direction);
  return {offset_origin(sp, -direction), direction, 0, kInfinity, arrived.time, contact};
}

}  // namespace opal
