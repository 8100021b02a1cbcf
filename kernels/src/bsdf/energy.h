// SPDX-License-Identifier: GPL-3.0-or-later
// Directional albedos of GGX lobes and what follows from them: putting back the energy that leaves after several bounces
// between facets, and dimming what lies under a reflecting layer.
//
// Kulla & Conty 2017, "Revisiting Physically Based Shading at Imageworks", in the form of Cycles: the single-scattering
// lobe is scaled by 1/E, and the weight darkened by what the metal or dielectric absorbs on the way.
// Roughness here is the socket's (alpha = roughness^2), cos the cosine between the normal and the viewer.
#pragma once

#include "bsdf/closure.h"

namespace opal {

struct Albedo {
  float directional = 1;  // at this cosine
  float average = 1;      // over 2 cos d(cos)
};
// Of a rough mirror.
Albedo ggx_mirror_albedo(float roughness, float cosine);
// Of a rough dielectric boundary, reflection and transmission together; eta below 1 is the dense side. On that side Cycles'
// (used for its Glass) is somewhat above what the lobe gives; ggx_gem_albedo is exact and directional only.
Albedo ggx_glass_albedo(float roughness, float cosine, float eta);
float ggx_gem_albedo(float roughness, float cosine, float eta);
// Where between f0 and 1 the reflectance of a rough dielectric lies, and of Schlick's curve.
float ggx_dielectric_position(float roughness, float cosine, float eta);
float ggx_schlick_position(float roughness, float cosine);

// The socket's roughness that a lobe's alphas stand for.
float lobe_roughness(const Lobe &lobe);

// Estimates of what the lobe reflects and transmits of a white furnace, without its weight.
struct LobeAlbedo {
  Vec3 reflected, transmitted;
};
LobeAlbedo lobe_albedo(const Lobe &lobe, const Vec3 &wo);

// Scales a Microfacet or Glass lobe so that with a colourless Fresnel term nothing is lost. `average_fresnel` is the mean
// reflectance (or, for glass, the tint) that light meets at every further bounce.
void preserve_energy(Lobe &lobe, const Vec3 &wo, const Vec3 &average_fresnel);

// Weight of what lies under a layer that reflects `albedo` of the light that `weight` lets in.
Vec3 weight_below(const Vec3 &albedo, const Vec3 &weight);

}  // namespace opal
