// SPDX-License-Identifier: GPL-3.0-or-later
// From the sockets of Blender's shader nodes to lobes: one function a node, called while a material's program runs.
//
// Conventions shared by all of them:
// - `weight` is what reaches the node through Mix and Add Shader nodes; the node's own colour is a separate argument.
//   Both are linear Rec.709. Nothing is added where their product is (near) zero.
// - `normal` is the Normal socket: any length, in world space, towards the viewer's side as sp.ns is; a zero vector
//   means sp.ns. For lobes with a mirror direction it is bent until that stays above the surface, as Cycles does.
// - `roughness` is the socket (alpha = roughness^2); `ior` is the socket, i.e. that of the inside against the outside;
//   the back of a face sees its reciprocal.
// - `tangent` is the Tangent socket (a zero vector: any); `rotation` the Rotation socket, 1 a full turn.
// - `multiscatter` is the distribution "Multiscatter GGX": energy that leaves after several bounces between facets is
//   put back. "Beckmann" and "Ashikhmin-Shirley" are shaded as GGX.
// - Each function also adds its estimate of what it reflects and transmits to set.albedo.
#pragma once

#include "bsdf/closure.h"

namespace opal {

// Diffuse BSDF: Lambert at roughness 0, otherwise the energy-preserving Oren-Nayar of Cycles 4.3 and later.
void add_diffuse(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, const Vec3 &color, float roughness,
                 const Vec3 &normal);
void add_translucent(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, const Vec3 &color, const Vec3 &normal);
// Glossy BSDF. anisotropy in [-1, 1] (0: isotropic).
void add_glossy(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, const Vec3 &color, float roughness,
                float anisotropy, float rotation, const Vec3 &normal, const Vec3 &tangent, bool multiscatter);
// Metallic BSDF. F82: `base_color` at normal incidence and `edge_tint` at 82 degrees.
void add_metallic_f82(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, const Vec3 &base_color,
                      const Vec3 &edge_tint, float roughness, float anisotropy, float rotation, const Vec3 &normal,
                      const Vec3 &tangent, bool multiscatter);
// Metallic BSDF. Physical conductor: complex index n + ik for red, green and blue.
void add_metallic_conductor(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, const Vec3 &n, const Vec3 &k,
                            float roughness, float anisotropy, float rotation, const Vec3 &normal, const Vec3 &tangent,
                            bool multiscatter);
void add_glass(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, const Vec3 &color, float roughness, float ior,
               const Vec3 &normal, bool multiscatter);
void add_refraction(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, const Vec3 &color, float roughness, float ior,
                    const Vec3 &normal);
void add_transparent(ClosureSet &set, const Vec3 &weight, const Vec3 &color);
// Sheen BSDF, microfiber (the Ashikhmin distribution is shaded alike).
void add_sheen(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, const Vec3 &color, float roughness,
               const Vec3 &normal);
// Emission and Background: radiance = weight * color * strength.
void add_emission(ClosureSet &set, const Vec3 &weight, const Vec3 &color, float strength);
void add_holdout(ClosureSet &set, const Vec3 &weight);

// The sockets of the Principled BSDF (Blender 4.5 and 5.2), at their defaults.
struct PrincipledInputs {
  Vec3 base_color{0.8f, 0.8f, 0.8f};
  float metallic = 0;
  float roughness = 0.5f;
  float ior = 1.5f;
  float alpha = 1;
  Vec3 normal;  // zero: sp.ns
  float diffuse_roughness = 0;
  float subsurface_weight = 0;
  Vec3 subsurface_radius{1, 0.2f, 0.1f};
  float subsurface_scale = 0.05f;
  float subsurface_anisotropy = 0;
  float specular_ior_level = 0.5f;
  Vec3 specular_tint{1, 1, 1};
  float anisotropic = 0;
  float anisotropic_rotation = 0;
  Vec3 tangent;  // zero: any
  float transmission_weight = 0;
  float coat_weight = 0;
  float coat_roughness = 0.03f;
  float coat_ior = 1.5f;
  Vec3 coat_tint{1, 1, 1};
  Vec3 coat_normal;  // zero: sp.ns, whatever `normal` is
  float sheen_weight = 0;
  float sheen_roughness = 0.5f;
  Vec3 sheen_tint{1, 1, 1};
  Vec3 emission_color{1, 1, 1};
  float emission_strength = 0;
  float thin_film_thickness = 0;  // nm
  float thin_film_ior = 1.33f;
  bool multiscatter = true;  // distribution "Multiscatter GGX"
};
void add_principled(ClosureSet &set, const ShadingPoint &sp, const Vec3 &weight, const PrincipledInputs &in);

}  // namespace opal
