// SPDX-License-Identifier: GPL-3.0-or-later
// Closures: what a surface program leaves behind, and the questions the integrators ask of it.
//
// A ClosureSet is a weighted sum of lobes. Weights and colours are linear Rec.709; they become spectra when a lobe is
// evaluated. The gem boundary is a set with one lobe whose index of refraction is a spectrum.
#pragma once

#include "core/spectrum.h"
#include "core/vec.h"
#include "scene/shading_point.h"

#include <cstdint>

namespace opal {

enum class LobeKind : uint8_t {
  Diffuse,      // Lambert
  OrenNayar,    // params: A, B; f0: the part that is scattered several times
  Translucent,  // Lambert through the surface
  Microfacet,   // GGX reflection
  Glass,        // GGX reflection and transmission, sampled together
  Refraction,   // GGX transmission alone
  Sheen,        // params: a, b of the linearly transformed cosine
  Transparent,  // straight through
  Gem           // spectral dielectric boundary
};

// Kinds of Fresnel term for Microfacet and Glass lobes.
enum class FresnelKind : uint8_t {
  None,         // the weight alone
  Dielectric,   // exact, from eta
  Generalized,  // f0, f90 in RGB, Schlick-shaped by the exact dielectric curve of eta or an exponent
  F82,          // metal: Schlick from f0, less f90 cos (1 - cos)^6 (the dip near 82 degrees)
  Conductor     // metal: complex index n = f0, k = f90, in RGB
};

struct Lobe {
  LobeKind kind = LobeKind::Diffuse;
  FresnelKind fresnel = FresnelKind::None;
  Vec3 weight;              // RGB factor, includes mixing and energy compensation
  float sample_weight = 0;  // relative probability of choosing this lobe, >= 0
  Vec3 normal;              // towards the viewer's side
  Vec3 tangent;
  float alpha_x = 0, alpha_y = 0;  // GGX; below kSpecularAlpha the lobe is a mirror
  float eta = 1;                   // index behind / index in front, as seen from the viewer's side
  Vec3 f0, f90{1, 1, 1};
  Vec3 reflection_tint{1, 1, 1}, transmission_tint{1, 1, 1};
  float exponent = -1;     // Generalized: below 0 uses the dielectric curve
  float energy_scale = 1;  // multiple scattering between facets
  float bare = 1;          // factor that undoes the dimming by glossy layers above (Principled diffuse)
  float params[4] = {};
};

// A lobe narrower than this is treated as perfectly specular.
inline constexpr float kSpecularAlpha = 1e-4f;
// Narrower than this it makes caustics; wider it can receive photons.
inline constexpr float kSharpAlpha = 0.1f;
inline constexpr int kMaxLobes = 16;

// The gem boundary (see bsdf/gem.h).
struct GemBoundary {
  Spectrum eta;  // n(behind) / n(in front) at the path's wavelengths
  Spectrum n_front, n_behind;
  float alpha = 0;
  bool schlick = false;
  bool dispersive = false;  // eta differs between wavelengths
};

struct ClosureSet {
  Lobe lobes[kMaxLobes];
  int count = 0;
  Vec3 emission;  // RGB radiance
  Vec3 holdout_or_unused;
  float holdout = 0;
  Vec3 albedo;  // guide for the denoiser
  GemBoundary gem;

  // Adds a lobe unless its weight is (near) zero or the set is full; returns it or nullptr.
  // `weight` gives sample_weight its default: the average of |weight|.
  Lobe *add(LobeKind kind, const Vec3 &weight, const Vec3 &normal);
};

// What sampling chose; also the classes of the path predicate.
enum Scattering : uint32_t {
  kScatterReflect = 1,
  kScatterTransmit = 2,
  kScatterDiffuse = 4,
  kScatterGlossy = 8,
  kScatterSpecular = 16,     // a Dirac lobe: pdf and value are those of the one direction
  kScatterTransparent = 32,  // straight through; does not count as a bounce
  kScatterDispersive = 64    // direction depends on wavelength: pdf differs between wavelengths
};

// Radiance is carried from cameras, flux (importance's adjoint) from lights: refraction scales the first by
// (n2/n1)^2 and shading normals the second (Veach 1997, chapter 5).
enum class Transport : uint8_t { Radiance, Flux };

struct BsdfSample {
  Vec3 wi;
  Spectrum weight;  // f |cos| / pdf of the hero, per wavelength
  Spectrum pdf;     // of choosing wi, per wavelength (Dirac: of choosing the lobe; 0 where a wavelength could not go this way)
  uint32_t scattering = 0;
  float eta = 1;        // n(new side) / n(old side) for transmission, hero wavelength
  float roughness = 1;  // of the chosen lobe: 0 mirror .. 1 diffuse
};

// Chooses a direction. `lobe_u` picks the lobe, `u` the direction. False when nothing can be sampled.
bool bsdf_sample(const ClosureSet &set, const ShadingPoint &sp, const Wavelengths &w, Transport transport, float lobe_u, Vec2 u,
                 BsdfSample &out);
// f |cos| summed over the non-Dirac lobes; pdf (solid angle) of bsdf_sample choosing wi, per wavelength.
Spectrum bsdf_eval(const ClosureSet &set, const ShadingPoint &sp, const Vec3 &wi, const Wavelengths &w, Transport transport,
                   Spectrum &pdf);
// Whether any lobe is not Dirac, i.e. next-event estimation and photon gathering make sense here.
bool bsdf_has_smooth_lobe(const ClosureSet &set);
// The part of bsdf_eval (f |cos|) that lobes of GGX alpha above kSharpAlpha and diffuse ones bring: where photons are left.
Spectrum bsdf_eval_rough(const ClosureSet &set, const ShadingPoint &sp, const Vec3 &wi, const Wavelengths &w,
                         Transport transport);
// The part of bsdf_eval (f |cos|) of diffuse lobes.
Spectrum bsdf_eval_diffuse(const ClosureSet &set, const ShadingPoint &sp, const Vec3 &wi, const Wavelengths &w,
                           Transport transport);
// The same of light carried from the camera as it is without glossy layers above them; what remains of a material once
// glossy scattering is left out, as Cycles leaves it out after a diffuse bounce when caustics are off.
Spectrum bsdf_eval_diffuse_alone(const ClosureSet &set, const ShadingPoint &sp, const Vec3 &wi, const Wavelengths &w);
bool bsdf_is_only_diffuse(const ClosureSet &set);
// Straight-through transmittance (Transparent lobes) and its complement.
Vec3 bsdf_transparency(const ClosureSet &set);

}  // namespace opal
