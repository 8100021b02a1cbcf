// SPDX-License-Identifier: GPL-3.0-or-later
// Camera paths through gems that disperse: the wavelengths that follow the hero to the light behind. See camera_path.h.
#include "integrator/camera_path.h"

#include <array>

namespace opal {
namespace {

// Which follow: every wavelength leads some paths, and a group has to be the same whichever of it does. Measured on a brilliant
// (benchmarks/gems.py): behind a rough event three more halve the noise of colours for a tenth more rays; in a stone that is
// seen at first hand facets part the wavelengths so soon that following them brings no more than paths of their own.
constexpr int kStride = 2;

Spectrum only(int k, float value) {
  Spectrum s(0.0f);
  s[k] = value;
  return s;
}

}  // namespace

void CameraPath::keep_trail(const BsdfSample &sample) {
  const bool polished = surface_.is_gem && surface_.closures.gem.alpha < kSpecularAlpha;
  if (!polished || final_ray_ || rough_events_ == 0) {
    trail_.close();
    return;
  }
  const GemBoundary &gem = surface_.closures.gem;
  const bool transmission = sample.scattering & kScatterTransmit;
  if (trail_.open())
    trail_.add(hit_, surface_.material, surface_.sp, gem, transmission, sample.pdf[0], absorption_table(scene_, interior_),
               ray_kind_);
  else if ((sample.scattering & kScatterDispersive) && media_.empty() && path_pdf_[kWavelengths - 1] > 0)
    trail_.start(ray_, surface_.sp, gem, transmission, sample.pdf[0], throughput_, path_pdf_, 1 / eta_scale_);
}

void CameraPath::bring_followers() {
  const int32_t absorption = absorption_table(scene_, interior_);
  std::array<ColourTrail::End, kWavelengths> ends;
  std::array<int, kWavelengths> arrived;
  int n = 0;
  float together = path_pdf_[0];
  for (int k = kStride; k < kWavelengths; k += kStride) {
    if (!trail_.follow(scene_, w_, absorption, ray_kind_, k, ends[size_t(n)], counts_.path)) continue;
    together += ends[size_t(n)].path_pdf;
    arrived[size_t(n++)] = k;
  }
  trail_.close();
  if (n == 0) return;

  const Ray ray = ray_;
  const Hit hit = hit_;
  const Spectrum throughput = throughput_, path_pdf = path_pdf_;
  for (int i = 0; i < n; ++i) {
    const ColourTrail::End &end = ends[size_t(i)];
    ray_ = end.ray, hit_ = end.hit;
    throughput_ = only(arrived[size_t(i)], end.flux / together);
    path_pdf_ = only(arrived[size_t(i)], 1);
    find_light();
  }
  ray_ = ray, hit_ = hit, path_pdf_ = path_pdf;
  company_ = together / path_pdf[0];
  throughput_ = throughput / company_;
}

void CameraPath::find_light() {
  meet_lamps(hit_.t, nullptr);
  if (!hit_.valid()) {
    meet_surroundings();
    return;
  }
  material_ = &scene_.material_at(hit_);
  make_surface(scene_, ray_, hit_, ray_kind_, bounces_, interior_, w_, surface_);
  meet_emission(hit_);
  if (!surface_.has_smooth_lobe) return;
  sample_direct(bounce_dimension(events_, 0));
  if (gathers()) gather();
}

}  // namespace opal
