// SPDX-License-Identifier: GPL-3.0-or-later
// Every source of light behind four questions: sample one as seen from a point, how likely was that, what does a ray
// that meets one see, and emit a photon.
//
// Lamps are in Blender's units (PHYSICS 6b): same watts, same pixel as Cycles.
#pragma once

#include "core/sampler.h"
#include "core/spectrum.h"
#include "core/vec.h"
#include "opal.h"

#include <cstdint>
#include <vector>

namespace opal {

struct Scene;
struct ShadingPoint;

// Which kind of source: an index into the scene's lamps, into its emissive triangles, or the world.
enum class SourceKind : uint8_t { Lamp, Triangle, World, None };
struct SourceId {
  SourceKind kind = SourceKind::None;
  uint32_t index = 0;
};

struct LightSample {
  Vec3 wi;             // towards the light
  float distance = 0;  // infinite for sun and world
  Spectrum radiance;   // arriving, before visibility; for Dirac lights: irradiance perpendicular to wi per unit pdf
  float pdf = 0;       // solid angle, with the probability of choosing this source; Dirac: that probability alone
  bool dirac = false;  // no ray can hit it by chance
  bool cast_shadow = true;
  uint32_t visibility = ~0u;  // OPAL_RAY_* bits: a lobe whose kind of ray may not see the lamp is not lit by it
  SourceId source;
};

// Chooses a source in proportion to what it may bring to p (light tree: Conty Estevez & Kulla 2018) and a point on it.
// `normal` (zero for media) and `transmissive` bound what can be received.
bool sample_light(const Scene &scene, const Vec3 &p, const Vec3 &normal, bool transmissive, int32_t light_group, float pick,
                  Vec2 u, const Wavelengths &w, float time, LightSample &out);
// The pdf with which sample_light would have produced the hit below, seen from p.
float light_pdf(const Scene &scene, const SourceId &source, const Vec3 &p, const Vec3 &normal, bool transmissive,
                int32_t light_group, const Vec3 &wi, float distance, const Vec3 &light_normal, const Vec3 &light_point,
                float time);
// Whether a source lights what belongs to a receiver set (light linking).
bool lights_receiver(const Scene &scene, const SourceId &source, int32_t light_group);

// Analytic lamps (with a size) along a ray, nearest first beyond `t_after`: hit before t_max? They do not block rays.
struct LampHit {
  float t = 0;
  uint32_t lamp = 0;
  Vec3 normal;
  Spectrum radiance;
};
bool intersect_lamps(const Scene &scene, const Ray &ray, float t_after, float t_max, uint32_t ray_kind, const Wavelengths &w,
                     LampHit &out);
// Sun discs and the world in direction d, for a ray of this kind that leaves the scene; calls back once per source.
struct EscapedRadiance {
  SourceId source;
  Spectrum radiance;
};
int escaped_radiance(const Scene &scene, const Vec3 &direction, uint32_t ray_kind, const Wavelengths &w, EscapedRadiance *out,
                     int capacity);

// ---- Emission, for photons ----

// A target: a sphere round something that can make caustics.
struct EmissionTarget {
  Vec3 centre;
  float radius = 0;
};
struct EmissionSample {
  Ray ray;
  Spectrum flux;  // emitted power / pdf: what one photon of M carries is flux / M
  Vec3 normal;    // of the source; zero where it has none
  SourceId source;
  Vec3 centre;  // with soft_radius: of the lamp
  float soft_radius = 0;
  float reach = kInfinity;     // how far the light goes before something turns it; finite within a sphere that shines inwards
  bool from_infinity = false;  // of a sun or the world: the ray begins where the scene does, not where its light comes from
};
// Whether the photon counts at the first thing that it meets. A lamp with soft falloff is a disc that faces whatever it
// lights, which is less than the sphere that photons leave: those that p's disc could not have sent are dropped, so
// that photons and next-event estimation bring the same light. Always true for other sources.
bool emission_reaches(const EmissionSample &sample, const Vec3 &p);
// The distance along the emitted ray from which on emission_reaches() holds; infinite: nowhere.
float emission_reaches_from(const EmissionSample &sample);
// Emits one photon. With targets, only directions that can meet one of them are sampled (probability counted exactly,
// overlaps included); without, the whole emission into the scene, and of lamps in the world's medium all. A photon for which
// false is returned carries nothing; it counts among the M all the same. Fastest with Scene::casters itself or an empty vector.
bool sample_emission(const Scene &scene, const std::vector<EmissionTarget> &targets, Vec2 pick, Vec2 position, Vec2 direction,
                     float time, const Wavelengths &w, EmissionSample &out);

// Built by opal_scene_commit from the scene's lamps, emissive triangles and world.
struct LightTables;

}  // namespace opal
