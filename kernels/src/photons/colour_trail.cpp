// SPDX-License-Identifier: GPL-3.0-or-later
#include "photons/colour_trail.h"

#include "bsdf/gem.h"
#include "scene/contact.h"

namespace opal {
namespace {

// Whether the hero chose as its followers do. A flat face always serves; an interpolated normal that does not serve for one of
// the choices gives way to the face's own, where followers do not go.
bool chose_alike(const GemBoundary &gem, const ShadingPoint &sp, bool transmission, Transport transport) {
  Vec3 wi;
  float share, correction;
  return !sp.smooth || follow_polished(gem, 0, sp, transmission, transport, wi, share, correction);
}

}  // namespace

void ColourTrail::start(const Ray &arrived, const ShadingPoint &sp, const GemBoundary &gem, bool transmission, float share,
                        const Spectrum &flux, const Spectrum &path_pdf, float whole) {
  arrived_ = arrived, first_ = sp, flux_ = flux, path_pdf_ = path_pdf, whole_ = whole / kWavelengths;
  steps_.clear();
  add({}, 0, sp, gem, transmission, share, -1, 0);
}

void ColourTrail::add(const Hit &hit, uint32_t material, const ShadingPoint &sp, const GemBoundary &gem, bool transmission,
                      float share, int32_t absorption, uint32_t ray_kind) {
  open_ = chose_alike(gem, sp, transmission, transport_);
  if (open_)
    steps_.push_back({hit.instance, material, ray_kind, sp.backfacing, sp.smooth, transmission, absorption, share, gem});
}

bool ColourTrail::ends(const Scene &scene, const Hit &hit) const {
  if (!hit.valid()) return transport_ == Transport::Radiance;
  const Material &met = scene.material_at(hit);
  return !met.is_gem && !met.no_surface();
}

bool ColourTrail::follow(const Scene &scene, const Wavelengths &w, int32_t absorption, uint32_t ray_kind, int k, End &end,
                         int64_t &rays) const {
  end.flux = flux_[k], end.path_pdf = path_pdf_[k];
  float as_hero = flux_[k] / path_pdf_[k];  // what it would carry if it led: the choices' probabilities cancel
  const auto absorb = [&](int32_t table, float distance) {
    if (table < 0) return;
    const float left = std::exp(-lookup(scene.spectra[size_t(table)], w.nm[k]) * distance);
    end.flux *= left, as_hero *= left;
  };
  end.ray = arrived_;
  ShadingPoint sp = first_;
  for (size_t i = 0; i < steps_.size(); ++i) {
    const Step &step = steps_[i];
    if (i > 0) {
      end.hit = next_hit(scene, end.ray, step.ray_kind);
      ++rays;
      if (!end.hit.valid() || end.hit.instance != step.instance) return false;
      if (scene.material_index(end.hit.instance, end.hit.triangle) != step.material) return false;
      sp = scene.shading_point(end.ray, end.hit);
      if (sp.backfacing != step.backfacing) return false;
      if (!step.smooth) sp.ns = sp.ng, sp.smooth = false;
      absorb(step.absorption, end.hit.t);
    }
    Vec3 wi;
    float share, correction;
    if (!follow_polished(step.gem, k, sp, step.transmission, transport_, wi, share, correction)) return false;
    const bool scaled = step.transmission && transport_ == Transport::Radiance;
    end.flux *= share / step.hero_share * correction * (scaled ? 1 / sqr(step.gem.eta[k]) : 1.0f);
    end.path_pdf *= share / step.hero_share;
    as_hero *= correction;
    end.ray = leave_surface(scene, end.ray, sp, wi);
    if (step.survived > 0) {
      const float survives = std::min(step.most, as_hero / whole_);
      end.flux /= step.survived;
      end.path_pdf *= survives / step.survived;
      as_hero /= survives;
    }
  }
  end.hit = next_hit(scene, end.ray, ray_kind);
  ++rays;
  if (!ends(scene, end.hit)) return false;
  if (end.hit.valid()) absorb(absorption, end.hit.t);
  return end.path_pdf > 0 && std::isfinite(end.flux);
}

}  // namespace opal
