// SPDX-License-Identifier: GPL-3.0-or-later
// What camera paths bring to the film: kinds of light, layers, guides. See camera_path.h.
#include "integrator/camera_path.h"

namespace opal {

// ---- Bookkeeping ----

void CameraPath::add_after(Spectrum radiance, uint32_t events, bool caustic) {
  if (!radiance.is_finite()) return;
  const float limit = events <= 1 ? settings_.clamp_direct : settings_.clamp_indirect;
  Vec3 rgb = to_rgb(radiance, w_);
  if (limit > 0) {
    const float sum = std::abs(rgb.x) + std::abs(rgb.y) + std::abs(rgb.z);
    if (sum > limit * 3) rgb *= limit * 3 / sum, radiance *= limit * 3 / sum;
  }
  (medium_first_ ? light_.medium
   : caustic     ? light_.caustics
   : events == 0 ? light_.emission
   : events == 1 ? light_.direct
                 : light_.indirect) += rgb;
  if (keeps_layers_) add_to_layers(radiance, rgb);
  light_.spectral += radiance;
}

// ---- Layers for compositing ----

LayerTracker CameraPath::layers_after_surface(const Vec3 &wi, uint32_t scattering) const {
  LayerTracker after = layers_;
  if (surface_.is_gem) {
    after.meet_gem();
    return after;
  }
  Spectrum share(1.0f);
  if (layers_.needs_share()) {
    if (scattering & kScatterSpecular) share = Spectrum(0.0f);
    else if (!bsdf_is_only_diffuse(surface_.closures)) share = diffuse_share(wi);
  }
  after.meet_surface(share, (scattering & kScatterDiffuse) && (scattering & kScatterReflect));
  return after;
}

Spectrum CameraPath::diffuse_share(const Vec3 &wi) const {
  Spectrum unused;
  const Spectrum all = bsdf_eval(surface_.closures, surface_.sp, wi, w_, Transport::Radiance, unused);
  Spectrum share = bsdf_eval_diffuse_alone(surface_.closures, surface_.sp, wi, w_);
  for (int i = 0; i < kWavelengths; ++i) share[i] = all[i] > 0 ? share[i] / all[i] : 0.0f;
  return share;
}

int CameraPath::layer_of(const MediumHere &here, const Vec3 &light, const Vec3 &onward) const {
  return keeps_layers_ ? here.layer_of(w_, dot(light, onward)) : 0;
}

void CameraPath::part_veil() {
  veil_ = {};
  if (layers_.any_event()) return;
  MediumSet stopping;
  for (int i = 0; i < media_.count(); ++i) {
    const MediumSet::Entry &entry = media_[i];
    (scene_.media[size_t(entry.medium)].layer == OPAL_MEDIUM_LAYER_BASE ? stopping : veil_).enter(entry.instance, entry.medium);
  }
  if (!veil_.empty()) light_.veiled = true;
  if (clear_) media_ = stopping;
}

void CameraPath::see_through(float t, bool ends) {
  if (!layers_.any_event() && !veil_.empty()) layers_.see_through(veil_transmittance(t), ends);
}

Spectrum CameraPath::veil_transmittance(float t) const {
  if (StratifiedMedia::holds(scene_, veil_)) return StratifiedMedia(scene_, veil_, w_, ray_).transmittance(t);
  constexpr int kSteps = 128;
  const RayMedia media(scene_, veil_, w_, ray_);
  Spectrum depth(0.0f);
  if (std::isfinite(t)) {
    for (int i = 0; i < kSteps; ++i) depth += media.at((float(i) + 0.5f) * t / kSteps).extinction;
    return transmittance_over(depth, t / kSteps);
  }
  // To infinity in steps that grow, from centimetres to a thousand kilometres.
  constexpr float kFirst = 1e-2f, kGrowth = 1.155f;
  float from = 0;
  for (int i = 0; i < kSteps; ++i) {
    const float to = kFirst * std::pow(kGrowth, float(i));
    depth += media.at(0.5f * (from + to)).extinction * (to - from);
    from = to;
  }
  return transmittance_over(depth, 1);
}

void CameraPath::add_to_layers(const Spectrum &radiance, const Vec3 &rgb) {
  LayerLight &out = light_.layers;
  if (layers_.first() != Layer::Base) {
    out[layers_.first()] += rgb;
    return;
  }
  const Spectrum &share = layers_.base_share();
  if (share.is_zero()) {
    out[layers_.added()] += rgb;
    return;
  }
  const Spectrum kept = radiance * share;
  const Vec3 base = to_rgb(kept, w_);
  out[Layer::Base] += base;
  out[Layer::Behind] += base;
  out[Layer::Dimmed] += clear_ ? to_rgb(kept * layers_.through(), w_) : base;
  out[layers_.added()] += rgb - base;
}

void CameraPath::finish_layers() {
  LayerLight &out = light_.layers;
  out.alpha[size_t(layers_.first())] += light_.alpha;
  if (layers_.first() != Layer::Base) return;
  out.alpha[size_t(Layer::Behind)] += light_.alpha;
  out.alpha[size_t(Layer::Dimmed)] += light_.alpha * layers_.through().average();
}

void CameraPath::note_guides() {
  if (light_.hit || bounces_ > 0) return;
  const ClosureSet &set = surface_.closures;
  const bool only_transparent = set.count == 1 && set.lobes[0].kind == LobeKind::Transparent;
  if (only_transparent) return;
  light_.hit = true;
  light_.normal = surface_.sp.ns;
  light_.position = surface_.sp.p;
  light_.albedo = min(set.albedo + set.emission, Vec3{1, 1, 1});
  const Transform camera = camera_transform(scene_.camera, ray_.time);
  light_.depth = dot(surface_.sp.p - camera.origin(), -camera.axis(2));
}

}  // namespace opal
