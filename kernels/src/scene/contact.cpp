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

enum class Rank { Entered, Left, Surface, Medium };

Rank rank_of(const Scene &scene, const Hit &hit, const ShadingPoint &sp) {
  const Material &material = scene.material_at(hit);
  if (!material.is_gem) return material.no_surface() ? Rank::Medium : Rank::Surface;
  return sp.backfacing ? Rank::Left : Rank::Entered;
}

}  // namespace

Hit next_hit(const Scene &scene, const Ray &ray, uint32_t visibility) {
  Hit best = scene.intersect(ray, visibility);
  if (!scene.any_touching || !best.valid() || !scene.instances[best.instance].touching) return best;
  const ShadingPoint sp = scene.shading_point(ray, best);
  Rank rank = rank_of(scene, best, sp);
  // What lies in the same place and comes first: the search leaves out what was found before.
  Ray search = ray;
  search.t_min = std::max(ray.t_min, best.t - contact_length(sp, ray.direction));
  search.t_max = best.t + contact_length(sp, ray.direction);
  Contact &found = search.contact;
  found = {};
  found.until = kInfinity;
  found.crossed[found.count++] = found.face(best.instance, sp.backfacing);
  while (rank != Rank::Entered) {
    const Hit other = scene.intersect(search, visibility);
    if (!other.valid()) break;
    const ShadingPoint there = scene.shading_point(ray, other);
    if (other.t >= ray.contact.until || ray.contact.meets(other.instance, there.backfacing)) {
      const Rank of_other = rank_of(scene, other, there);
      if (of_other < rank) best = other, rank = of_other;
    }
    if (found.count == Contact::kMost) break;
    found.crossed[found.count++] = found.face(other.instance, there.backfacing);
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
  } else {
    const int known = contact.find(sp.instance_index, sp.backfacing);
    if (contact.backward) {
      if (known >= 0) contact.crossed[known] = contact.crossed[--contact.count];
    } else if (known < 0) {
      if (contact.count == Contact::kMost) return plain;  // past all that is left
      contact.crossed[contact.count++] = contact.face(sp.instance_index, sp.backfacing);
    }
  }
  if (contact.count == 0) return plain;
  contact.until = contact_length(sp, direction);
  return {offset_origin(sp, -direction), direction, 0, kInfinity, arrived.time, contact};
}

}  // namespace opal
