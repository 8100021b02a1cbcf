// SPDX-License-Identifier: GPL-3.0-or-later
// Camera paths in media, and photons they look up there. See camera_path.h.
#include "integrator/camera_path.h"
#include "lights/light_tables.h"
#include "media/mean_depths.h"

namespace opal {

// ---- Media ----

void CameraPath::pass_unscattered(const Spectrum &depth) {
  if (depth.max() <= 0) return;
  for (int i = 0; i < kWavelengths; ++i) {
    const float ratio = depth[i] == depth[0] ? 1.0f : std::exp(clamp(depth[0] - depth[i], -80.0f, 80.0f));
    throughput_[i] *= ratio, path_pdf_[i] *= ratio;
  }
  last_.pdf *= std::exp(-depth[0]);
}

bool CameraPath::travel_in_medium(float t_end) {
  if (!StratifiedMedia::holds(scene_, media_)) return travel_in_varying_medium(t_end);
  const StratifiedMedia media(scene_, media_, w_, ray_);
  const MediumHere &full = media.full();
  const uint32_t dimension = bounce_dimension(events_, 0);
  const bool may_go_on = may_scatter_again();
  if (!full.emission.is_zero()) add_emitted(full, t_end);
  if (full.scatters() && !final_ray_) {
    gather_along(media, t_end, dimension);
    gather_volume(CameraWay(media), t_end, layer_of(full), dimension);
  }

  const float t = media.reach_hero(-std::log1p(-sampler_.get1d(dimension + kDimMedium)));
  meet_lamps(std::min(t, t_end), &media);
  if (!(t < t_end)) {
    const Spectrum depth = media.depth(t_end);
    if (std::isfinite(depth[0])) {
      pass_unscattered(depth);
    } else {
      layers_.meet_medium(layer_of(full));
      alive_ = false;
    }
    return !alive_;
  }
  MediumHere scratch;
  const MediumHere &here = media.at(t, scratch);
  if (final_ray_ || !(here.scattering[0] > 0)) {
    layers_.meet_medium(layer_of(here));
    alive_ = false;
    return true;
  }
  if (!may_scatter(may_go_on)) return true;

  const GatherDistance gathered(scene_, ray_, t_end, media);
  const Spectrum through = media.transmittance(t);
  const float distance_pdf = here.extinction[0] * through[0];
  previous_pdf_ = path_pdf_ * (gathered.density(t) / distance_pdf);
  const Vec3 forward = ray_.direction;
  Spectrum phase;
  const Vec3 direction = sample_onward(here, forward, dimension, phase);
  const float phase_pdf = phase[0];
  if (!(phase_pdf > 0) || !(distance_pdf > 0)) {
    alive_ = false;
    return true;
  }
  throughput_ *= through * here.scattering * here.scattered(w_, -direction, -forward, filter()) / (distance_pdf * phase_pdf);
  path_pdf_ *= through * here.extinction * phase / (distance_pdf * phase_pdf);
  if (!throughput_.is_finite() || throughput_.is_zero()) {
    alive_ = false;
    return true;
  }
  if (clear_) see_through(t, true);
  layers_.meet_medium(layer_of(here, -direction, -forward));
  last_ = {};
  last_.light_was_sampled = true;
  last_.event = EventClass::Rough;
  last_.p = ray_.origin + ray_.direction * t;
  last_.transmissive = true;
  last_.pdf = phase_pdf;
  if (bounces_ == 0) medium_first_ = true;
  ++bounces_, ++events_, ++rough_events_;
  rough_in_medium_ = true;
  ray_kind_ = OPAL_RAY_SCATTER;
  ray_ = {last_.p, direction, 0, kInfinity, ray_.time};
  left_ = {};
  travelled_ = 0;
  roulette(sampler_.get1d(dimension + kDimRoulette), promise(here, direction));
  return true;
}

bool CameraPath::may_scatter(bool may_go_on) {
  const bool goes_on = camera_goes_on_after_rough(scene_, settings_.photons_carry);
  final_ray_ = !may_go_on || !goes_on;
  // Direct light is the path's own with INDIRECT: the scattered ray is next-event estimation's other half.
  if (!goes_on && settings_.photons_carry != OPAL_CARRY_INDIRECT) alive_ = false;
  return alive_;
}

bool CameraPath::brought_to_medium(const SourceId &source) const {
  return brought_by_photons(scene_, settings_.photons_carry, EventClass::Rough, rough_events_ > 0, source);
}

SunGuide CameraPath::guide(const MediumHere &here) const {
  return bounces_ < kGuidedEvents ? SunGuide(scene_.lights.get(), here, w_, kGuidedPart) : SunGuide();
}

Vec3 CameraPath::sample_onward(const MediumHere &here, const Vec3 &forward, uint32_t dimension, Spectrum &density) const {
  const SunGuide guided = guide(here);
  float u = sampler_.get1d(dimension + kDimTransparency), unused = 0;
  const float pick = sampler_.get1d(dimension + kDimBsdfLobe);
  const Vec2 at = sampler_.get2d(dimension + kDimMediumPhase);
  const Vec3 direction = u < guided.part() ? guided.sample(w_, pick, at) : here.sample_phase(w_, forward, pick, at, unused);
  density = guided.joined(w_, direction, here.phase_value(w_, dot(forward, direction)));
  return direction;
}

float CameraPath::promise(const MediumHere &here, const Vec3 &direction) const {
  const SunGuide guided = guide(here);
  return guided.part() > 0 ? std::max(1.0f, 4 * kPi * guided.density(w_, direction)[0]) : 1.0f;
}

Spectrum CameraPath::onward_density(const MediumHere &here, const Vec3 &forward, const Vec3 &direction) const {
  return guide(here).joined(w_, direction, here.phase_value(w_, dot(forward, direction)));
}

bool CameraPath::travel_in_varying_medium(float t_end) {
  const uint32_t dimension = bounce_dimension(events_, 0);
  const bool may_go_on = may_scatter_again();
  const MeanDepths depths(scene_, media_, w_, ray_, t_end);
  // Collisions find suns and sky often enough unless most rays meet nothing.
  const bool thin = -std::expm1(-depths.mean_depth(t_end)) < kThin && !scene_.lights->far.empty();
  const GatherDistance chosen(scene_, ray_, t_end, depths, thin ? 0.5f : 0.0f);
  if (!final_ray_ && !chosen.empty()) connect_at(chosen, t_end, dimension);
  if (!final_ray_) gather_in_varying(t_end, dimension);

  RayMedia media(scene_, media_, w_, ray_);
  RandomStream random(sampler_, dimension + kDimMedium);
  MediumHere here;
  const auto glow = [&](const Spectrum &contribution, const Spectrum &pdf) {
    const InMedium scope(*this, layer_of(here));
    add(contribution / pdf.average(), false);
  };
  Walk walk{throughput_, path_pdf_, previous_pdf_};
  const auto take = [&] { throughput_ = walk.throughput, path_pdf_ = walk.path_pdf, previous_pdf_ = walk.light_pdf; };
  float t = kInfinity, depth = 0, after = ray_.t_min;
  bool collided = false;
  // Lamps that the ray meets end an interval, so that what they add has come just so far.
  for (LampHit lamp; intersect_lamps(scene_, ray_, after, t_end, ray_kind_, w_, lamp);) {
    collided = fly(media, lamp.t, random, walk, depth, t, here, glow);
    if (collided) break;
    take();
    add_met({SourceKind::Lamp, lamp.lamp}, lamp.radiance, ray_.origin + ray_.direction * lamp.t, lamp.normal,
            lamp.t + travelled_);
    after = std::nextafter(lamp.t, kInfinity);
  }
  if (!collided) collided = fly(media, t_end, random, walk, depth, t, here, glow);
  if (!collided) {
    take();
    alive_ = throughput_.is_finite() && !throughput_.is_zero();
    if (!alive_) layers_.meet_medium(layer_of(here));
    return !alive_;
  }
  if (final_ray_ || here.scattering.is_zero()) {
    layers_.meet_medium(layer_of(here));
    alive_ = false;
    return true;
  }
  if (!may_scatter(may_go_on)) return true;

  throughput_ = walk.throughput * here.scattering, path_pdf_ = walk.path_pdf;
  const Vec3 forward = ray_.direction;
  last_ = {};
  last_.light_was_sampled = true;
  last_.event = EventClass::Rough;
  last_.p = ray_.origin + forward * t;
  last_.transmissive = true;
  const float straight = here.extinction.average() * std::exp(-depth);
  if (!chosen.empty()) last_.elsewhere = chosen.density(t) / std::max(straight, 1e-30f);
  if (clear_) see_through(t, true);
  connect_from_medium(here, forward, dimension);

  const Vec3 direction = sample_onward(here, forward, dimension, last_.phase);
  const float phase_pdf = last_.phase[0];
  if (!(phase_pdf > 0)) {
    alive_ = false;
    return true;
  }
  last_.pdf = phase_pdf;
  previous_pdf_ = path_pdf_;
  throughput_ *= here.scattered(w_, -direction, -forward, filter()) / phase_pdf;
  path_pdf_ *= last_.phase / phase_pdf;
  if (!throughput_.is_finite() || throughput_.is_zero()) {
    alive_ = false;
    return true;
  }
  layers_.meet_medium(layer_of(here, -direction, -forward));
  if (bounces_ == 0) medium_first_ = true;
  ++bounces_, ++events_, ++rough_events_;
  rough_in_medium_ = true;
  ray_kind_ = OPAL_RAY_SCATTER;
  ray_ = {last_.p, direction, 0, kInfinity, ray_.time};
  left_ = {};
  travelled_ = 0;
  roulette(sampler_.get1d(dimension + kDimRoulette), promise(here, direction));
  return true;
}

void CameraPath::connect_from_medium(const MediumHere &here, const Vec3 &forward, uint32_t dimension) {
  LightSample sample;
  if (!sample_light(scene_, last_.p, {}, true, -1, sampler_.get1d(dimension + kDimLightPick),
                    sampler_.get2d(dimension + kDimLight), w_, ray_.time, sample) ||
      !(sample.pdf > 0) || !(sample.visibility & OPAL_RAY_SCATTER) || brought_to_medium(sample.source))
    return;
  const Spectrum phase = onward_density(here, forward, sample.wi);
  const Spectrum share = last_.share(sample.dirac ? Spectrum(0.0f) : phase, sample.pdf);
  const Spectrum scattered = here.scattered(w_, -sample.wi, -forward, filter());
  const InMedium scope(*this, layer_of(here, -sample.wi, -forward));
  add_connected(throughput_ * share * scattered * sample.radiance, sample, last_.p, path_pdf_,
                sample.dirac ? Spectrum(0.0f) : phase, dimension + kDimLight);
}

void CameraPath::connect_at(const GatherDistance<MeanDepths> &chosen, float t_end, uint32_t dimension) {
  float distance_pdf = 0;
  const Vec2 u = sampler_.get2d(dimension + kDimMediumDistance);
  const float t = chosen.sample(u.x, u.y, distance_pdf);
  if (!(distance_pdf > 0) || !(t < t_end)) return;
  RayMedia media(scene_, media_, w_, ray_);
  const MediumHere here = media.at(t);
  if (!here.scatters()) return;
  const Vec3 p = ray_.origin + ray_.direction * t;
  LightSample sample;
  if (!sample_light(scene_, p, {}, true, -1, sampler_.get1d(dimension + kDimMediumPick),
                    sampler_.get2d(dimension + kDimMediumLight), w_, ray_.time, sample) ||
      !(sample.pdf > 0) || !(sample.visibility & OPAL_RAY_SCATTER) || brought_to_medium(sample.source))
    return;
  RandomStream random(sampler_, dimension + kDimMediumDistance);
  Walk walk{throughput_, path_pdf_, path_pdf_};
  float depth = 0;
  pass_through(media, t, random, walk, depth);
  if (walk.throughput.is_zero()) return;
  const Spectrum phase = onward_density(here, ray_.direction, sample.wi);
  LastEvent there;
  there.elsewhere = distance_pdf / std::max(here.extinction.average() * std::exp(-depth), 1e-30f);
  Spectrum share = there.share(sample.dirac ? Spectrum(0.0f) : phase, sample.pdf);
  for (int i = 0; i < kWavelengths; ++i) share[i] = 1 - share[i];
  const Spectrum scattered = here.scattering * here.scattered(w_, -sample.wi, -ray_.direction, filter());
  if (clear_) see_through(t, false);
  const InMedium scope(*this, layer_of(here, -sample.wi, -ray_.direction));
  add_connected(walk.throughput * scattered * share * sample.radiance / distance_pdf, sample, p, walk.light_pdf, Spectrum(0.0f),
                dimension + kDimMediumLight);
}

void CameraPath::add_connected(Spectrum light, const LightSample &sample, const Vec3 &p, const Spectrum &reached,
                               const Spectrum &path, uint32_t dimension) {
  if (light.is_zero() || !light.is_finite()) return;
  Passage passed;
  if (!passes({p, sample.wi, 0, kInfinity, ray_.time}, sample, dimension, passed)) return;
  const Spectrum pdf = reached * (passed.light_pdf * sample.pdf + path * passed.path_pdf);
  light *= uplift(passed.surfaces, w_) * passed.medium / pdf.average();
  add_scattered(light, false);
}

void CameraPath::add_emitted(const MediumHere &here, float t_end) {
  Spectrum emitted(0.0f);
  for (int i = 0; i < kWavelengths; ++i) {
    const float sigma = here.extinction[i];
    const float depth = sigma > 0 ? -std::expm1(-sigma * t_end) / sigma : t_end;
    if (std::isfinite(depth)) emitted[i] = here.emission[i] * depth;
  }
  const InMedium scope(*this, layer_of(here));
  add(throughput_ * emitted / path_pdf_.average(), false);
}

void CameraPath::gather_along(const StratifiedMedia &media, float t_end, uint32_t dimension) {
  const GatherDistance distances(scene_, ray_, t_end, media);
  float distance_pdf = 0;
  const Vec2 u = sampler_.get2d(dimension + kDimMediumDistance);
  const float t = distances.sample(u.x, u.y, distance_pdf);
  if (!(distance_pdf > 0) || !std::isfinite(t)) return;
  const Vec3 p = ray_.origin + ray_.direction * t;
  LightSample sample;
  if (!sample_light(scene_, p, {}, true, -1, sampler_.get1d(dimension + kDimMediumPick),
                    sampler_.get2d(dimension + kDimMediumLight), w_, ray_.time, sample) ||
      !(sample.pdf > 0))
    return;
  if (!(sample.visibility & OPAL_RAY_SCATTER)) return;
  if (brought_to_medium(sample.source)) return;
  MediumHere scratch;
  const MediumHere &here = media.at(t, scratch);
  const Spectrum phase = sample.dirac ? Spectrum(0.0f) : onward_density(here, ray_.direction, sample.wi);
  const Spectrum through = media.transmittance(t);
  Spectrum contribution =
      throughput_ * through * here.scattering * here.scattered(w_, -sample.wi, -ray_.direction, filter()) * sample.radiance;
  if (contribution.is_zero() || !contribution.is_finite()) return;
  Passage passed;
  if (!passes({p, sample.wi, 0, kInfinity, ray_.time}, sample, dimension + kDimMediumLight, passed)) return;
  Spectrum pdf = path_pdf_ * passed.light_pdf * (distance_pdf * sample.pdf);
  if (!sample.dirac) pdf += path_pdf_ * here.extinction * through * phase * passed.path_pdf;
  contribution *= uplift(passed.surfaces, w_) * passed.medium / pdf.average();
  if (clear_) see_through(t, false);
  const InMedium scope(*this, layer_of(here, -sample.wi, -ray_.direction));
  add_scattered(contribution, false);
}

bool CameraPath::gathers() const {
  return bounces_ > 0 && !pass_.photons.empty() && gathers_after_rough(settings_.photons_carry, rough_events_);
}

void CameraPath::gather() {
  const Spectrum flux = gather_photons(pass_.photons, surface_, w_, index_, settings_.gather);
  if (flux.is_zero()) return;
  const LayerTracker before = layers_;
  layers_.meet_photons();
  add_bounced(throughput_ * flux / path_pdf_.average(), settings_.photons_carry == OPAL_CARRY_CAUSTICS);
  layers_ = before;
}

void CameraPath::gather_volume(const CameraWay &way, float t_end, int layer, uint32_t dimension) {
  if (pass_.volume.empty() || !gathers_after_rough(settings_.photons_carry, rough_events_)) return;
  const Spectrum radiance = volume_radiance(pass_, {ray_.origin, ray_.direction, t_end, way, media_key(media_), filter(), w_,
                                                    index_, sampler_.get1d(dimension + kDimMarch), faces(t_end)});
  if (radiance.is_zero()) return;
  const InMedium scattered(*this, layer);
  layers_.meet_photons();
  add_bounced(throughput_ * radiance / path_pdf_.average(), settings_.photons_carry == OPAL_CARRY_CAUSTICS);
}

MediumFaces CameraPath::faces(float t_end) const {
  MediumFaces faces{left_, {}};
  if (!hit_.valid() || t_end < hit_.t) return faces;
  const Vec3 n = scene_.shading_point(ray_, hit_).ng;
  faces.end = dot(n, ray_.direction) > 0 ? -n : n;
  return faces;
}

void CameraPath::gather_in_varying(float t_end, uint32_t dimension) {
  float t_begin = 0;
  if (pass_.volume.empty() || !gathers_after_rough(settings_.photons_carry, rough_events_)) return;
  if (!pass_.volume.clip(ray_.origin, ray_.direction, PassContext::set_of(index_), t_begin, t_end)) return;
  const CameraWay way(scene_, media_, w_, ray_, t_end, RandomStream(sampler_, dimension + kDimMarch));
  gather_volume(way, t_end, layer_of(way.at(0.5f * (t_begin + t_end))), dimension);
}

}  // namespace opal
