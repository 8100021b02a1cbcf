// SPDX-License-Identifier: GPL-3.0-or-later
// A surface point made ready for scattering: its closures, and the split of their light into rough and sharp.
#pragma once

#include "bsdf/closure.h"
#include "integrator/path_class.h"
#include "media/tracking.h"
#include "scene/interior.h"
#include "scene/scene.h"

namespace opal {

struct Surface {
  ShadingPoint sp;
  ClosureSet closures;
  uint32_t material = 0;
  bool caster = false;  // its sharp lobes make caustics
  bool is_gem = false;
  bool nothing = false;  // a gem's boundary inside another interior: go straight on
  bool has_smooth_lobe = false;
  bool transmissive = false;  // light can arrive from behind
  Boundary boundary;          // gems
};

void make_surface(const Scene &scene, const Ray &ray, const Hit &hit, uint32_t ray_kind, uint32_t depth,
                  const InteriorStack &interior, const Wavelengths &w, Surface &out);

// f |cos| for light from wi, divided into what rough and what sharp lobes scatter; pdf of bsdf_sample.
struct SplitValue {
  Spectrum rough, sharp, pdf;
};
SplitValue evaluate(const Surface &surface, const Vec3 &wi, const Wavelengths &w, Transport transport);

// For light that arrives from surface.sp.wo: what rough lobes send towards a camera in direction `viewer`, as
// bsdf_eval_rough(..., Transport::Flux) would say. The surface is shaded anew as the camera sees it, because the weights of
// layered materials (and Layer Weight, Light Path nodes) depend on who looks.
Spectrum rough_towards_camera(const Scene &scene, const Surface &surface, const Vec3 &viewer, float distance,
                              const Wavelengths &w);

// The class of a sampled event: of a sum of rough and sharp lobes the sharp share is taken with its probability (`u`).
EventClass classify(const Surface &surface, const BsdfSample &sample, const Wavelengths &w, Transport transport, float u);

// What passes along a shadow ray that starts in these media and gems: `surfaces` is 0 behind opaque things, else the product of
// the straight-through transmittances of at most `max_layers` surfaces (linear Rec.709); `medium` is the media's share, exact
// where they are homogeneous and by ratio tracking where they vary, as f / p(hero). Multiple importance wants the densities
// relative to the hero's: `light_pdf` of this connection, `path_pdf` of a path that comes through by itself.
struct Passage {
  Vec3 surfaces{1, 1, 1};
  Spectrum medium{1.0f}, light_pdf{1.0f}, path_pdf{1.0f};
  bool blocked() const { return max_component(surfaces) <= 0; }
};
Passage passage(const Scene &scene, const Ray &ray, MediumSet entered, const InteriorStack &interior, int max_layers,
                const Wavelengths &w, RandomStream random);

}  // namespace opal
