// SPDX-License-Identifier: GPL-3.0-or-later
// Steps that several shader nodes share when they set up their lobes.
#pragma once

#include "bsdf/lobes.h"
#include "bsdf/shading_normal.h"

namespace opal {

inline Vec3 saturate(const Vec3 &c) { return {saturate(c.x), saturate(c.y), saturate(c.z)}; }

// The Normal socket made a unit normal, and one whose mirror direction stays above the surface.
Vec3 shading_normal(const Vec3 &normal, const ShadingPoint &sp);
Vec3 mirror_normal(const Vec3 &normal, const ShadingPoint &sp);
Vec3 rotated_tangent(const Vec3 &tangent, const Vec3 &axis, float turns);

// Alphas and tangent of the Metallic and Principled BSDF; anisotropy in [0,1].
void set_anisotropy(Lobe &lobe, float roughness, float anisotropy, float rotation, const Vec3 &normal, const Vec3 &tangent);
// Fresnel terms, with their effect on sample_weight and the compensation for lost energy. Alphas must be set.
void set_f82(Lobe &lobe, const Vec3 &f0, const Vec3 &tint, const Vec3 &wo, bool multiscatter);
void set_glass(Lobe &lobe, float ior, bool backfacing, const Vec3 &f0_tint, const Vec3 &reflection_tint,
               const Vec3 &transmission_tint, const Vec3 &wo, bool multiscatter);
// Multiplies sample_weight by the lobe's albedo under its Fresnel term.
void weigh_lobe(Lobe &lobe, const Vec3 &wo);
// Adds the finished lobe to the denoiser's guide.
void finish_lobe(ClosureSet &set, Lobe &lobe, const Vec3 &wo);

// `color` is what further bounces meet, the weight includes it.
void add_diffuse_lobe(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, const Vec3 &color, float roughness,
                      const Vec3 &normal);
Lobe *add_sheen_lobe(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, float roughness, const Vec3 &normal);

}  // namespace opal
