// SPDX-License-Identifier: GPL-3.0-or-later
// Camera paths: surfaces, and what the ray meets. See camera_path.h.
#include "integrator/camera_path.h"

namespace opal {

CameraPath::CameraPath(const PassContext &pass, uint32_t x, uint32_t y, uint32_t sample, RayCounts &counts, bool clear)
    : pass_(pass),
      scene_(pass.scene),
      settings_(pass.settings),
      sampler_(settings_.seed, y * uint32_t(settings_.width) + x, sample),
      index_(PassContext::wavelength_index(sampler_.get1d(kDimWavelength))),
      w_(pass.wavelengths[index_]),
      keeps_layers_(keeps_layers(settings_)),
      clear_(clear),
      counts_(counts) {
  const Vec2 offset = pass.filter.sample(sampler_.get2d(kDimFilter));
  const float film_x = (float(x) + 0.5f + offset.x) / float(settings_.width);
  const float film_y = (float(y) + 0.5f + offset.y) / float(settings_.height);
  const float time = settings_.motion_blur ? sampler_.get1d(kDimTime) : 0.0f;
  alive_ = generate_ray(scene_.camera, film_x, film_y, sampler_.get2d(kDimLens), time, ray_);
  // Media begin where the camera does: what lies before its near clipping is not there, as in Cycles.
  ray_.origin += ray_.direction * ray_.t_min;
  ray_.t_max -= ray_.t_min;
  ray_.t_min = 0;
  entered_ = pass.camera_media;
  if (!pass.camera_interior.empty()) {
    interior_ = pass.camera_interior;
    // Within a gem radiance is n^2 times what it is outside; the film keeps L / n^2, so that white stays white.
    const Spectrum n = index_of_refraction(scene_, interior_.current(), w_);
    throughput_ /= n * n;
  }
  if (!clear_) ++counts_.camera;
}

PathLight CameraPath::trace() {
  light_.wavelength_index = index_;
  light_.spectral = Spectrum(0.0f);
  while (alive_ && events_ - bounces_ < kMostFreePasses) step();  // roulette ends real events
  if (keeps_layers_) finish_layers();
  counts_.passed_over += interior_.passed_over();
  counts_.media_passed_over += entered_.passed_over();
  return light_;
}

void CameraPath::step() {
  if (clear_ && !layers_.shows_base()) {
    alive_ = false;
    return;
  }
  const Hit hit = hit_ = next_hit(scene_, ray_, ray_kind_);
  ++counts_.path;
  if (hit.valid()) absorb(scene_, interior_, hit.t, w_, throughput_);
  if (escapes(scene_, ray_, hit)) entered_.leave_bodies();
  media_ = media_that_fill(scene_, entered_, interior_);
  counts_.media_passed_over += media_.passed_over();
  if (keeps_layers_) part_veil();
  if (!media_.empty()) {
    trail_.close();
    if (travel_in_medium(hit.t)) return;
  } else {
    if (trail_.open() && trail_.ends(scene_, hit)) bring_followers();
    meet_lamps(hit.t, nullptr);
  }
  if (clear_) see_through(hit.t, true);
  if (!hit.valid()) {
    escape();
    return;
  }
  material_ = &scene_.material_at(hit);
  if (material_->no_surface()) {
    trail_.close();
    surface_.sp = scene_.shading_point(ray_, hit);
    cross_medium(*material_, surface_.sp, entered_);
    go_straight_on();
    return;
  }
  make_surface(scene_, ray_, hit, ray_kind_, bounces_, interior_, w_, surface_);
  if (surface_.is_gem) note_way_in(surface_.boundary);
  if (surface_.nothing) {
    trail_.close();
    cross_boundary(surface_.boundary, interior_);
    cross_medium(*material_, surface_.sp, entered_);
    go_straight_on();
    return;
  }
  note_guides();
  meet_emission(hit);
  if (final_ray_) {
    pass_or_stop();
    return;
  }
  if (surface_.closures.holdout > 0 && bounces_ == 0) light_.alpha -= surface_.closures.holdout * seen_through();
  scatter();
}

void CameraPath::note_way_in(const Boundary &b) {
  if (b.entering || interior_.contains(b.entry.instance, b.entry.material)) return;
  throughput_ /= b.n_front * b.n_front;
  interior_.enter(b.entry);
}

// ---- Light that the ray meets ----

void CameraPath::meet_lamps(float t_end, const StratifiedMedia *media) {
  float after = ray_.t_min;
  LampHit lamp;
  while (intersect_lamps(scene_, ray_, after, t_end, ray_kind_, w_, lamp)) {
    const SourceId source{SourceKind::Lamp, lamp.lamp};
    const Unscattered passed(*this, media ? media->depth(lamp.t) : Spectrum(0.0f));
    if (clear_) see_through(lamp.t, false);
    add_met(source, lamp.radiance, ray_.origin + ray_.direction * lamp.t, lamp.normal, lamp.t + travelled_);
    after = std::nextafter(lamp.t, kInfinity);
  }
}

void CameraPath::meet_emission(const Hit &hit) {
  if (max_component(surface_.closures.emission) <= 0) return;
  const int triangle = scene_.find_emissive(hit.instance, hit.triangle);
  const SourceId source = triangle >= 0 ? SourceId{SourceKind::Triangle, uint32_t(triangle)} : SourceId{};
  add_met(source, uplift_light(surface_.closures.emission, w_), surface_.sp.p, surface_.sp.ng, hit.t + travelled_);
}

void CameraPath::escape() {
  alive_ = false;
  meet_surroundings();
}

float CameraPath::seen_through() const { return (throughput_ / path_pdf_.average()).average(); }

void CameraPath::meet_surroundings() {
  if (!interior_.empty()) {  // out through a hole
    const Spectrum n = index_of_refraction(scene_, interior_.current(), w_);
    throughput_ *= n * n;
  }
  const bool seen_at_first_hand = bounces_ == 0;
  if (seen_at_first_hand && settings_.transparent_film) light_.alpha -= seen_through();
  EscapedRadiance sources[8];
  const int n = escaped_radiance(scene_, ray_.direction, ray_kind_, w_, sources, 8);
  for (int i = 0; i < n; ++i) {
    if (seen_at_first_hand && settings_.transparent_film && sources[i].source.kind == SourceKind::World) continue;
    add_met(sources[i].source, sources[i].radiance, {}, {}, kInfinity);
  }
}

bool CameraPath::brought(const SourceId &source) const {
  const bool after_rough = last_.event == EventClass::Rough ? rough_events_ > 1 : rough_events_ > 0;
  return brought_by_photons(scene_, settings_.photons_carry, last_.event, after_rough, source);
}

void CameraPath::add_met(const SourceId &source, const Spectrum &radiance, const Vec3 &point, const Vec3 &normal,
                         float distance) {
  if (radiance.is_zero()) return;
  if (bounces_ > 0 && !lights_receiver(scene_, source, last_.light_group)) return;
  if (bounces_ > 0 && brought(source)) return;
  Spectrum pdf = path_pdf_, share(1.0f);
  if (last_.light_was_sampled && source.kind != SourceKind::None) {
    const float p = light_pdf(scene_, source, last_.p, last_.normal, last_.transmissive, last_.light_group, ray_.direction,
                              distance, normal, point, ray_.time);
    if (p > 0) pdf += previous_pdf_ * (p / last_.pdf);
    if (last_.elsewhere > 0) share = last_.share(last_.phase, p);
  }
  add(throughput_ * share * radiance / pdf.average(), last_.event == EventClass::Sharp && rough_events_ > 0);
}

// ---- Scattering ----

void CameraPath::scatter() {
  const ClosureSet &set = surface_.closures;
  if (set.count == 0) {
    alive_ = false;
    return;
  }
  const uint32_t dimension = bounce_dimension(events_, 0);
  // Depth limits hold what is rough; between mirrors and in gems roulette alone ends a path, or they would darken.
  const bool may_go_on = rough_bounces_ < uint32_t(std::max(0, settings_.max_depth));
  if (surface_.has_smooth_lobe) {
    sample_direct(dimension);
    if (gathers()) gather();
  }
  part_from_followers();

  BsdfSample sample;
  if (!sample_surface(dimension, sample)) {
    alive_ = false;
    return;
  }
  if (sample.scattering & kScatterTransparent) {
    trail_.close();
    cross_medium(*material_, surface_.sp, entered_);
    throughput_ *= sample.weight;
    update_path_pdf(sample);
    if (++transparent_layers_ > uint32_t(std::max(1, settings_.transparent_depth)) || throughput_.is_zero()) alive_ = false;
    else go_straight_on();
    return;
  }
  if (keeps_layers_) layers_ = layers_after_surface(sample.wi, sample.scattering);
  const EventClass event = classify(surface_, sample, w_, Transport::Radiance, sampler_.get1d(dimension + kDimSpare));
  const bool specular = (sample.scattering & kScatterSpecular) != 0;
  // The last bounce allowed still looks for lamps: that ray is next-event estimation's other half.
  if (!specular && !may_go_on) final_ray_ = true;
  if (event == EventClass::Rough && !camera_goes_on_after_rough(scene_, settings_.photons_carry)) {
    // Photons bring the rest, but for direct light, of which this ray is next-event estimation's other half.
    if (settings_.photons_carry != OPAL_CARRY_INDIRECT) {
      alive_ = false;
      return;
    }
    final_ray_ = true;
  }

  keep_trail(sample);
  throughput_ *= sample.weight;
  previous_pdf_ = path_pdf_;
  update_path_pdf(sample);
  if (!throughput_.is_finite() || throughput_.is_zero()) {
    alive_ = false;
    return;
  }
  last_ = {};  // nothing of an event in a medium before
  last_.light_was_sampled = !specular;
  last_.event = event;
  last_.p = surface_.sp.p;
  last_.normal = surface_.sp.ns;
  last_.transmissive = surface_.transmissive;
  last_.light_group = scene_.groups[surface_.sp.instance->group].light_group;
  last_.pdf = sample.pdf[0];
  ++bounces_;
  ++events_;
  if (!specular) ++rough_bounces_;
  if (event == EventClass::Rough) ++rough_events_, rough_in_medium_ = false;
  if (sample.scattering & kScatterTransmit) {
    if (surface_.is_gem) {
      cross_boundary(surface_.boundary, interior_);
      eta_scale_ *= sqr(sample.eta);
    }
    cross_medium(*material_, surface_.sp, entered_);
  }

  ray_kind_ = sample.scattering & kScatterTransmit  ? uint32_t(OPAL_RAY_TRANSMISSION)
              : sample.scattering & kScatterDiffuse ? uint32_t(OPAL_RAY_DIFFUSE)
                                                    : uint32_t(OPAL_RAY_GLOSSY);
  ray_ = leave_surface(scene_, ray_, surface_.sp, sample.wi);
  note_surface_left();
  travelled_ = 0;
  roulette(sampler_.get1d(dimension + kDimRoulette));
}

bool CameraPath::sample_surface(uint32_t dimension, BsdfSample &sample) const {
  MediumHere here;
  const SunGuide guided = surface_guide(here);
  const float pick = sampler_.get1d(dimension + kDimBsdfLobe);
  const Vec2 u = sampler_.get2d(dimension + kDimBsdf);
  Spectrum value;
  if (guided.part() > 0 && sampler_.get1d(dimension + kDimTransparency) < guided.part()) {
    sample.wi = guided.sample(w_, pick, u);
    value = bsdf_eval(surface_.closures, surface_.sp, sample.wi, w_, Transport::Radiance, sample.pdf);
    sample.scattering = kScatterDiffuse | (dot(sample.wi, surface_.sp.ng) > 0 ? kScatterReflect : kScatterTransmit);
    if (value.is_zero()) return false;
  } else {
    if (!bsdf_sample(surface_.closures, surface_.sp, w_, Transport::Radiance, pick, u, sample)) return false;
    if (!(guided.part() > 0)) return true;
    if (sample.scattering & (kScatterTransparent | kScatterSpecular)) {
      sample.weight /= 1 - guided.part();
      return true;
    }
    value = sample.weight * sample.pdf[0];
  }
  sample.pdf = guided.joined(w_, sample.wi, sample.pdf);
  sample.weight = value / sample.pdf[0];
  return true;
}

SunGuide CameraPath::surface_guide(MediumHere &here) const {
  if (media_.empty() || surface_.is_gem || bounces_ >= kGuidedEvents || !bsdf_is_only_diffuse(surface_.closures)) return {};
  here = medium_here(scene_, media_, w_);
  return {scene_.lights.get(), here, w_, kGuidedPart};
}

void CameraPath::update_path_pdf(const BsdfSample &sample) {
  if (!(sample.pdf[0] > 0)) return;
  for (int i = 0; i < kWavelengths; ++i) path_pdf_[i] *= sample.pdf[i] / sample.pdf[0];
  // A wavelength that could not have come this way carries nothing.
  for (int i = 0; i < kWavelengths; ++i)
    if (path_pdf_[i] <= 0) throughput_[i] = 0;
}

void CameraPath::roulette(float u, float promise) {
  if (bounces_ < kRouletteStart) return;
  const float q = clamp((throughput_.max() * eta_scale_ * promise) / path_pdf_.average(), 0.0f, 1.0f);
  // Where nothing is lost, a small chance to stop keeps the longest chains finite. Those that go on weigh the more: of n events
  // exp(n / 10000) in bodies of media, which most paths leave by themselves long before.
  // In the world's own medium, which has no end, paths that absorb nothing would wander away for ever.
  const bool endless = media_.count() == 1 && media_[0].instance == MediumSet::kOfWorld && rough_in_medium_;
  float most = 1;
  if (endless) most = bounces_ > 32 ? 0.95f : 1.0f;
  else if (rough_in_medium_) most = bounces_ > 4096 ? 0.9999f : 1.0f;
  else if (bounces_ > 256) most = 0.98f;
  const float survive = std::min(q, most);
  if (!(u < survive)) {
    alive_ = false;
    return;
  }
  if (trail_.open()) trail_.survived(survive, most);
  throughput_ *= 1 / survive;
}

void CameraPath::go_straight_on() {
  travelled_ += surface_.sp.ray_length;
  const float rest = std::max(0.0f, ray_.t_max - surface_.sp.ray_length);
  ray_ = leave_surface(scene_, ray_, surface_.sp, ray_.direction);
  ray_.t_max = rest;
  note_surface_left();
  ++events_;
}

void CameraPath::pass_or_stop() {
  throughput_ *= uplift(bsdf_transparency(surface_.closures), w_);
  if (throughput_.max() <= 0 || ++transparent_layers_ > uint32_t(settings_.transparent_depth)) alive_ = false;
  else go_straight_on();
}

void CameraPath::sample_direct(uint32_t dimension) {
  const bool rough_counts = settings_.photons_carry != OPAL_CARRY_ALL || scene_.any_glowing_medium;
  if (!rough_counts && !surface_.caster) return;
  const ShadingPoint &sp = surface_.sp;
  const int32_t group = scene_.groups[sp.instance->group].light_group;
  LightSample sample;
  if (!sample_light(scene_, sp.p, sp.ns, surface_.transmissive, group, sampler_.get1d(dimension + kDimLightPick),
                    sampler_.get2d(dimension + kDimLight), w_, ray_.time, sample) ||
      !(sample.pdf > 0))
    return;
  const SplitValue value = evaluate(surface_, sample.wi, w_, Transport::Radiance);
  const bool keep_rough =
      !brought_by_photons(scene_, settings_.photons_carry, EventClass::Rough, rough_events_ > 0, sample.source);
  const bool keep_sharp =
      !brought_by_photons(scene_, settings_.photons_carry, EventClass::Sharp, rough_events_ > 0, sample.source);
  Spectrum f(0.0f);
  if (keep_rough) f += value.rough;
  if (keep_sharp) f += value.sharp;
  leave_out_blind_lobes(sample, keep_rough, f);
  if (f.is_zero()) return;
  Spectrum contribution = throughput_ * f * sample.radiance;
  if (contribution.is_zero() || !contribution.is_finite()) return;
  Passage through;
  if (!passes(leave_surface(scene_, ray_, sp, sample.wi), sample, dimension + kDimLight, through)) return;
  if (!(path_pdf_[0] > 0)) {  // one that follows: the walk was the hero's, whose density the passage is relative to
    for (int i = 0; i < kWavelengths; ++i)
      through.path_pdf[i] = through.light_pdf[i] > 0 ? through.path_pdf[i] / through.light_pdf[i] : 0.0f;
    through.light_pdf = Spectrum(1.0f);
  }
  Spectrum pdf = path_pdf_ * through.light_pdf * sample.pdf;
  if (!sample.dirac) {
    MediumHere here;
    pdf += path_pdf_ * surface_guide(here).joined(w_, sample.wi, value.pdf) * through.path_pdf;
  }
  contribution *= uplift(through.surfaces, w_) * through.medium / pdf.average();
  const LayerTracker before = layers_;
  if (keeps_layers_) layers_ = layers_after_surface(sample.wi, 0);
  add_scattered(contribution, value.sharp.sum() > value.rough.sum() && rough_events_ > 0);
  layers_ = before;
}

void CameraPath::leave_out_blind_lobes(const LightSample &sample, bool with_diffuse, Spectrum &f) const {
  const bool behind = dot(sample.wi, surface_.sp.ng) < 0;
  const uint32_t kinds = behind ? OPAL_RAY_TRANSMISSION : OPAL_RAY_DIFFUSE | OPAL_RAY_GLOSSY, seen = sample.visibility & kinds;
  if (seen == kinds) return;
  if (seen == 0) {
    f = Spectrum(0.0f);
    return;
  }
  const Spectrum diffuse =
      with_diffuse ? bsdf_eval_diffuse(surface_.closures, surface_.sp, sample.wi, w_, Transport::Radiance) : Spectrum(0.0f);
  if (seen == OPAL_RAY_DIFFUSE) {
    f = diffuse;
    return;
  }
  for (int i = 0; i < kWavelengths; ++i) f[i] = std::max(0.0f, f[i] - diffuse[i]);
}

bool CameraPath::passes(Ray shadow, const LightSample &sample, uint32_t dimension, Passage &through) {
  if (!sample.cast_shadow) return true;
  shadow.t_max = std::isfinite(sample.distance) ? sample.distance * (1 - 1e-5f) : kInfinity;
  ++counts_.shadow;
  through = passage(scene_, shadow, entered_, interior_, settings_.transparent_depth, w_, RandomStream(sampler_, dimension));
  return !through.blocked();
}

PathLight trace_camera_path(const PassContext &pass, uint32_t x, uint32_t y, uint32_t sample, RayCounts &counts) {
  return CameraPath(pass, x, y, sample, counts, false).trace();
}

LayerLight trace_clear_path(const PassContext &pass, uint32_t x, uint32_t y, uint32_t sample, RayCounts &counts) {
  return CameraPath(pass, x, y, sample, counts, true).trace().layers;
}

}  // namespace opal
