// SPDX-License-Identifier: GPL-3.0-or-later
// One camera path, from lens to light.
//
// Wavelengths: the hero's geometry is followed. `throughput` is f / p(hero), `path_pdf` is p(lambda) / p(hero) of the
// path so far; with p_light in the same unit, a contribution is divided by the mean over wavelengths of the pdfs that
// could have produced it (Wilkie et al. 2014; the bookkeeping follows pbrt-v4's "rescaled path probabilities").
// Dispersion sets path_pdf of the other wavelengths to 0 and so leaves the hero alone with its full weight.
#include "integrator/path_tracer.h"

#include "integrator/sun_guide.h"
#include "integrator/surface.h"
#include "media/stratified.h"
#include "photons/gather.h"
#include "scene/contact.h"
#include "photons/volume_estimate.h"

namespace opal {
namespace {

constexpr uint32_t kRouletteStart = 4;  // events before Russian roulette sets in
constexpr uint32_t kGuidedEvents = 8;   // from the camera on: how many may be led to where the suns' light is scattered from
constexpr float kGuidedPart = 0.25f;
constexpr uint32_t kMaxEvents = 32768;  // nothing physical gets there; guards against loops of free passes

// Where the path last scattered, as the light sampler saw it.
struct LastEvent {
  bool light_was_sampled = false;  // next-event estimation could have found what the ray finds now
  EventClass event = EventClass::Sharp;
  Vec3 p, normal;
  bool transmissive = false;
  int32_t light_group = -1;
  float pdf = 0;  // hero's, of the direction
  // In a medium that varies: light was also looked for at equiangular distances, with this density relative to all others', and
  // the phase function shares the rest with the connection from here.
  float elsewhere = 0;
  Spectrum phase{0.0f};

  // The share, of light from a direction, that is not left to equiangular distances.
  Spectrum share(const Spectrum &phase_value, float light_pdf) const {
    Spectrum s(1.0f);
    for (int i = 0; i < kWavelengths; ++i) {
      const float here = phase_value[i] + light_pdf;
      if (elsewhere > 0 && light_pdf > 0) s[i] = here / (here + elsewhere * light_pdf);
    }
    return s;
  }
};

class CameraPath {
 public:
  CameraPath(const PassContext &pass, uint32_t x, uint32_t y, uint32_t sample, RayCounts &counts)
      : pass_(pass),
        scene_(pass.scene),
        settings_(pass.settings),
        sampler_(settings_.seed, y * uint32_t(settings_.width) + x, sample),
        index_(PassContext::wavelength_index(sampler_.get1d(kDimWavelength))),
        w_(pass.wavelengths[index_]),
        keeps_layers_(keeps_layers(settings_)),
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
    ++counts_.camera;
  }

  PathLight trace() {
    light_.wavelength_index = index_;
    light_.spectral = Spectrum(0.0f);
    while (alive_ && events_ < kMaxEvents) step();
    if (keeps_layers_) finish_layers();
    return light_;
  }

 private:
  void step() {
    const Hit hit = hit_ = next_hit(scene_, ray_, ray_kind_);
    ++counts_.path;
    if (hit.valid()) absorb(scene_, interior_, hit.t, w_, throughput_);
    media_ = media_that_fill(scene_, entered_, interior_);
    if (!media_.empty()) {
      if (travel_in_medium(hit.t)) return;
    } else {
      meet_lamps(hit.t, nullptr);
    }
    if (!hit.valid()) {
      escape();
      return;
    }
    material_ = &scene_.material_at(hit);
    if (material_->no_surface()) {
      surface_.sp = scene_.shading_point(ray_, hit);
      cross_medium(*material_, surface_.sp, entered_);
      go_straight_on();
      return;
    }
    make_surface(scene_, ray_, hit, ray_kind_, bounces_, interior_, w_, surface_);
    if (surface_.is_gem) note_way_in(surface_.boundary);
    if (surface_.nothing) {
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
    if (surface_.closures.holdout > 0 && bounces_ == 0) light_.alpha *= 1 - surface_.closures.holdout;
    scatter();
  }

  // A path that meets the inner side of a gem without having entered came through a hole in its mesh: taken as having
  // entered there, so that radiance is not scaled up on the way out alone.
  void note_way_in(const Boundary &b) {
    if (b.entering || interior_.contains(b.entry.instance, b.entry.material)) return;
    throughput_ /= b.n_front * b.n_front;
    interior_.enter(b.entry);
  }

  // ---- Light that the ray meets ----

  // Lamps before t_end; `media`, if there are any, in which the ray runs.
  void meet_lamps(float t_end, const StratifiedMedia *media) {
    float after = ray_.t_min;
    LampHit lamp;
    while (intersect_lamps(scene_, ray_, after, t_end, ray_kind_, w_, lamp)) {
      const SourceId source{SourceKind::Lamp, lamp.lamp};
      const Unscattered passed(*this, media ? media->depth(lamp.t) : Spectrum(0.0f));
      add_met(source, lamp.radiance, ray_.origin + ray_.direction * lamp.t, lamp.normal, lamp.t + travelled_);
      after = std::nextafter(lamp.t, kInfinity);
    }
  }

  void meet_emission(const Hit &hit) {
    if (max_component(surface_.closures.emission) <= 0) return;
    const int triangle = scene_.find_emissive(hit.instance, hit.triangle);
    const SourceId source = triangle >= 0 ? SourceId{SourceKind::Triangle, uint32_t(triangle)} : SourceId{};
    add_met(source, uplift_light(surface_.closures.emission, w_), surface_.sp.p, surface_.sp.ng, hit.t + travelled_);
  }

  void escape() {
    alive_ = false;
    if (!interior_.empty()) {  // out through a hole
      const Spectrum n = index_of_refraction(scene_, interior_.current(), w_);
      throughput_ *= n * n;
    }
    const bool seen_at_first_hand = bounces_ == 0;
    if (seen_at_first_hand && settings_.transparent_film) light_.alpha = 0;
    EscapedRadiance sources[8];
    const int n = escaped_radiance(scene_, ray_.direction, ray_kind_, w_, sources, 8);
    for (int i = 0; i < n; ++i) {
      if (seen_at_first_hand && settings_.transparent_film && sources[i].source.kind == SourceKind::World) continue;
      add_met(sources[i].source, sources[i].radiance, {}, {}, kInfinity);
    }
  }

  // Whether photons bring what the ray has met.
  bool brought(const SourceId &source) const {
    const bool after_rough = last_.event == EventClass::Rough ? rough_events_ > 1 : rough_events_ > 0;
    return brought_by_photons(scene_, settings_.photons_carry, last_.event, after_rough, source);
  }

  void add_met(const SourceId &source, const Spectrum &radiance, const Vec3 &point, const Vec3 &normal, float distance) {
    if (radiance.is_zero()) return;
    if (bounces_ > 0 && !lights_receiver(scene_, source, last_.light_group)) return;
    if (bounces_ > 0 && brought(source)) return;
    Spectrum pdf = path_pdf_, share(1.0f);
    if (last_.light_was_sampled && source.kind != SourceKind::None) {
      const float p = light_pdf(scene_, source, last_.p, last_.normal, last_.transmissive, last_.light_group, ray_.direction,
                                distance, normal, point);
      if (p > 0) pdf += previous_pdf_ * (p / last_.pdf);
      if (last_.elsewhere > 0) share = last_.share(last_.phase, p);
    }
    add(throughput_ * share * radiance / pdf.average(), last_.event == EventClass::Sharp && rough_events_ > 0);
  }

  // ---- Scattering ----

  void scatter() {
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

    BsdfSample sample;
    if (!sample_surface(dimension, sample)) {
      alive_ = false;
      return;
    }
    if (sample.scattering & kScatterTransparent) {
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

    throughput_ *= sample.weight;
    previous_pdf_ = path_pdf_;
    update_path_pdf(sample);
    if (!throughput_.is_finite() || throughput_.is_zero()) {
      alive_ = false;
      return;
    }
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

  // By the surface, or, where a medium before a diffuse one scatters a sun's light to it, from there.
  bool sample_surface(uint32_t dimension, BsdfSample &sample) const {
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

  // `here` has to outlive the guide.
  SunGuide surface_guide(MediumHere &here) const {
    if (media_.empty() || surface_.is_gem || bounces_ >= kGuidedEvents || !bsdf_is_only_diffuse(surface_.closures)) return {};
    here = medium_here(scene_, media_, w_);
    return {scene_.lights.get(), here, w_, kGuidedPart};
  }

  void update_path_pdf(const BsdfSample &sample) {
    if (!(sample.pdf[0] > 0)) return;
    for (int i = 0; i < kWavelengths; ++i) path_pdf_[i] *= sample.pdf[i] / sample.pdf[0];
    // A wavelength that could not have come this way carries nothing.
    for (int i = 0; i < kWavelengths; ++i)
      if (path_pdf_[i] <= 0) throughput_[i] = 0;
  }

  // `promise`: how much more than usual the way it has taken may bring.
  void roulette(float u, float promise = 1) {
    if (bounces_ < kRouletteStart) return;
    const float q = clamp((throughput_.max() * eta_scale_ * promise) / path_pdf_.average(), 0.0f, 1.0f);
    // Where nothing is lost, a small chance to stop keeps the longest chains finite.
    // In the world's own medium, which has no end, paths that absorb nothing would wander away for ever.
    const bool endless = media_.count() == 1 && media_[0].instance == ~0u && rough_in_medium_;
    const float most = endless && bounces_ > 32 ? 0.95f : bounces_ > 256 ? (rough_in_medium_ ? 0.999f : 0.98f) : 1.0f;
    const float survive = std::min(q, most);
    if (!(u < survive)) {
      alive_ = false;
      return;
    }
    throughput_ *= 1 / survive;
  }

  void go_straight_on() {
    travelled_ += surface_.sp.ray_length;
    const float rest = std::max(0.0f, ray_.t_max - surface_.sp.ray_length);
    ray_ = leave_surface(scene_, ray_, surface_.sp, ray_.direction);
    ray_.t_max = rest;
    note_surface_left();
    ++events_;
  }

  // The last ray of a path that looks for lamps only: on through what is transparent.
  void pass_or_stop() {
    throughput_ *= uplift(bsdf_transparency(surface_.closures), w_);
    if (throughput_.max() <= 0 || ++transparent_layers_ > uint32_t(settings_.transparent_depth)) alive_ = false;
    else go_straight_on();
  }

  void sample_direct(uint32_t dimension) {
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
    // Lamps hidden from a kind of ray do not light the lobes that send such rays.
    const bool behind = dot(sample.wi, sp.ng) < 0;
    Spectrum f(0.0f);
    if (keep_rough && sample.visibility & (behind ? OPAL_RAY_TRANSMISSION : OPAL_RAY_DIFFUSE)) f += value.rough;
    if (keep_sharp && sample.visibility & (behind ? OPAL_RAY_TRANSMISSION : OPAL_RAY_GLOSSY)) f += value.sharp;
    if (f.is_zero()) return;
    Spectrum contribution = throughput_ * f * sample.radiance;
    if (contribution.is_zero() || !contribution.is_finite()) return;
    Passage through;
    if (!passes(offset_origin(sp, sample.wi), sample, dimension + kDimLight, through)) return;
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

  // What of a light sample arrives; false: nothing.
  bool passes(const Vec3 &origin, const LightSample &sample, uint32_t dimension, Passage &through) {
    if (!sample.cast_shadow) return true;
    const Ray shadow{origin, sample.wi, 0, std::isfinite(sample.distance) ? sample.distance * (1 - 1e-5f) : kInfinity,
                     ray_.time};
    ++counts_.shadow;
    through = passage(scene_, shadow, entered_, interior_, settings_.transparent_depth, w_, RandomStream(sampler_, dimension));
    return !through.blocked();
  }

  // ---- Media ----

  // For as long as it lives, throughput and densities are those of having come through an optical depth without an event.
  class Unscattered {
   public:
    Unscattered(CameraPath &path, const Spectrum &depth)
        : path_(path), throughput_(path.throughput_), path_pdf_(path.path_pdf_), pdf_(path.last_.pdf) {
      path.pass_unscattered(depth);
    }
    ~Unscattered() { path_.throughput_ = throughput_, path_.path_pdf_ = path_pdf_, path_.last_.pdf = pdf_; }
    Unscattered(const Unscattered &) = delete;

   private:
    CameraPath &path_;
    const Spectrum throughput_, path_pdf_;
    const float pdf_;
  };

  // Coming through without an event has probability T(hero).
  void pass_unscattered(const Spectrum &depth) {
    if (depth.max() <= 0) return;
    for (int i = 0; i < kWavelengths; ++i) {
      const float ratio = depth[i] == depth[0] ? 1.0f : std::exp(clamp(depth[0] - depth[i], -80.0f, 80.0f));
      throughput_[i] *= ratio, path_pdf_[i] *= ratio;
    }
    last_.pdf *= std::exp(-depth[0]);
  }

  // For as long as it lives, light that is added comes from an event in a medium.
  class InMedium {
   public:
    InMedium(CameraPath &path, int layer) : path_(path), layers_(path.layers_), first_(path.medium_first_) {
      if (path.bounces_ == 0) path.medium_first_ = true;
      path.layers_.meet_medium(layer);
    }
    ~InMedium() { path_.layers_ = layers_, path_.medium_first_ = first_; }
    InMedium(const InMedium &) = delete;

   private:
    CameraPath &path_;
    const LayerTracker layers_;
    const bool first_;
  };

  // Carries the ray through its media up to t_end. True: it was scattered or absorbed on the way.
  bool travel_in_medium(float t_end) {
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
        if (keeps_layers_) layers_.pass_media(media.replaced_transmittance(t_end));
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

  // Media scatter as often as it takes, milk thousands of times: roulette ends such paths, not the depth, unless that is 0.
  bool may_scatter_again() const { return settings_.max_depth > 0; }

  // Before a scattering in a medium: false where photons bring everything beyond it, and then the path has ended.
  bool may_scatter(bool may_go_on) {
    const bool goes_on = camera_goes_on_after_rough(scene_, settings_.photons_carry);
    final_ray_ = !may_go_on || !goes_on;
    // Direct light is the path's own with INDIRECT: the scattered ray is next-event estimation's other half.
    if (!goes_on && settings_.photons_carry != OPAL_CARRY_INDIRECT) alive_ = false;
    return alive_;
  }

  // Whether photons bring what this source scatters directly into the ray.
  bool brought_to_medium(const SourceId &source) const {
    return brought_by_photons(scene_, settings_.photons_carry, EventClass::Rough, rough_events_ > 0, source);
  }

  // Of events in media, as many as show specks; over many the guide's weights would add up.
  SunGuide guide(const MediumHere &here) const {
    return bounces_ < kGuidedEvents ? SunGuide(scene_.lights.get(), here, w_, kGuidedPart) : SunGuide();
  }
  // Where a path goes on after an event in a medium: by the phase function or where the sun is scattered to. `density` at every
  // wavelength.
  Vec3 sample_onward(const MediumHere &here, const Vec3 &forward, uint32_t dimension, Spectrum &density) const {
    const SunGuide guided = guide(here);
    float u = sampler_.get1d(dimension + kDimTransparency), unused = 0;
    const float pick = sampler_.get1d(dimension + kDimBsdfLobe);
    const Vec2 at = sampler_.get2d(dimension + kDimMediumPhase);
    const Vec3 direction = u < guided.part() ? guided.sample(w_, pick, at) : here.sample_phase(w_, forward, pick, at, unused);
    density = guided.joined(w_, direction, here.phase_value(w_, dot(forward, direction)));
    return direction;
  }
  // Towards a sun the next event brings as much more as the phase function is higher there than on the mean.
  float promise(const MediumHere &here, const Vec3 &direction) const {
    const SunGuide guided = guide(here);
    return guided.part() > 0 ? std::max(1.0f, 4 * kPi * guided.density(w_, direction)[0]) : 1.0f;
  }
  // The density with which sample_onward() chooses.
  Spectrum onward_density(const MediumHere &here, const Vec3 &forward, const Vec3 &direction) const {
    return guide(here).joined(w_, direction, here.phase_value(w_, dot(forward, direction)));
  }

  // The camera's filter where the camera sees a scattering at first hand. What lights it is taken as unpolarised.
  const Polariser *filter() const { return bounces_ == 0 ? &pass_.polariser : nullptr; }

  // The same through media that vary: delta tracking, and light looked for where it ends and at equiangular distances.
  bool travel_in_varying_medium(float t_end) {
    const uint32_t dimension = bounce_dimension(events_, 0);
    const bool may_go_on = may_scatter_again();
    const GatherDistance lamps = GatherDistance::equiangular(scene_, ray_, t_end);
    if (!final_ray_ && !lamps.empty()) connect_at_equiangular(lamps, t_end, dimension);
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
      else if (keeps_layers_ && bounces_ == 0) layers_.pass_media(marched_transmittance(t_end));
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
    if (!lamps.empty()) last_.elsewhere = lamps.density(t) / std::max(straight, 1e-30f);
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

  // Direct light at the collision last_.p.
  void connect_from_medium(const MediumHere &here, const Vec3 &forward, uint32_t dimension) {
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

  // Direct light at a distance chosen for the lamps' sake, however thin the medium is there.
  void connect_at_equiangular(const GatherDistance &lamps, float t_end, uint32_t dimension) {
    float distance_pdf = 0;
    const Vec2 u = sampler_.get2d(dimension + kDimMediumDistance);
    const float t = lamps.sample(u.x, u.y, distance_pdf);
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
    const InMedium scope(*this, layer_of(here, -sample.wi, -ray_.direction));
    add_connected(walk.throughput * scattered * share * sample.radiance / distance_pdf, sample, p, walk.light_pdf,
                  Spectrum(0.0f), dimension + kDimMediumLight);
  }

  // Light that a connection brings: `light` is f / p(hero) without the passage and the density of the light sample, `reached`
  // the density of the path up to p, `path` that of going the same way by itself.
  void add_connected(Spectrum light, const LightSample &sample, const Vec3 &p, const Spectrum &reached, const Spectrum &path,
                     uint32_t dimension) {
    if (light.is_zero() || !light.is_finite()) return;
    Passage passed;
    if (!passes(p, sample, dimension, passed)) return;
    const Spectrum pdf = reached * (passed.light_pdf * sample.pdf + path * passed.path_pdf);
    light *= uplift(passed.surfaces, w_) * passed.medium / pdf.average();
    add_scattered(light, false);
  }

  // Emission over the segment, in closed form: e (1 - exp(-sigma t)) / sigma.
  void add_emitted(const MediumHere &here, float t_end) {
    Spectrum emitted(0.0f);
    for (int i = 0; i < kWavelengths; ++i) {
      const float sigma = here.extinction[i];
      const float depth = sigma > 0 ? -std::expm1(-sigma * t_end) / sigma : t_end;
      if (std::isfinite(depth)) emitted[i] = here.emission[i] * depth;
    }
    const InMedium scope(*this, layer_of(here));
    add(throughput_ * emitted / path_pdf_.average(), false);
  }

  // Light that reaches the segment directly and is scattered once into it: the other half of hitting a source after a
  // scattering event, joined with it by multiple importance.
  void gather_along(const StratifiedMedia &media, float t_end, uint32_t dimension) {
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
    if (!passes(p, sample, dimension + kDimMediumLight, passed)) return;
    Spectrum pdf = path_pdf_ * passed.light_pdf * (distance_pdf * sample.pdf);
    if (!sample.dirac) pdf += path_pdf_ * here.extinction * through * phase * passed.path_pdf;
    contribution *= uplift(passed.surfaces, w_) * passed.medium / pdf.average();
    const InMedium scope(*this, layer_of(here, -sample.wi, -ray_.direction));
    add_scattered(contribution, false);
  }

  // ---- Photons ----

  // Seen at first hand, photons are splatted from their own side; everything else is looked up.
  bool gathers() const {
    return bounces_ > 0 && !pass_.photons.empty() && gathers_after_rough(settings_.photons_carry, rough_events_);
  }

  void gather() {
    const Spectrum flux = gather_photons(pass_.photons, surface_, w_, index_, settings_.gather);
    if (flux.is_zero()) return;
    const LayerTracker before = layers_;
    layers_.meet_photons();
    add_bounced(throughput_ * flux / path_pdf_.average(), settings_.photons_carry == OPAL_CARRY_CAUSTICS);
    layers_ = before;
  }

  // What photons scatter into the ray on its way through media, seen at first hand too.
  void gather_volume(const CameraWay &way, float t_end, bool rainbow, uint32_t dimension) {
    if (pass_.volume.empty() || !gathers_after_rough(settings_.photons_carry, rough_events_)) return;
    const Spectrum radiance = volume_radiance(pass_, {ray_.origin, ray_.direction, t_end, way, media_key(media_), filter(), w_,
                                                      index_, sampler_.get1d(dimension + kDimMarch), faces(t_end)});
    if (radiance.is_zero()) return;
    const InMedium scattered(*this, rainbow);
    add_bounced(throughput_ * radiance / path_pdf_.average(), settings_.photons_carry == OPAL_CARRY_CAUSTICS);
  }

  // What bounds the way through the media, if it ends where the ray meets something.
  MediumFaces faces(float t_end) const {
    MediumFaces faces{left_, {}};
    if (!hit_.valid() || t_end < hit_.t) return faces;
    const Vec3 n = scene_.shading_point(ray_, hit_).ng;
    faces.end = dot(n, ray_.direction) > 0 ? -n : n;
    return faces;
  }
  // Follows a ray that has left a surface.
  void note_surface_left() { left_ = dot(surface_.sp.ng, ray_.direction) > 0 ? surface_.sp.ng : -surface_.sp.ng; }

  void gather_in_varying(float t_end, uint32_t dimension) {
    float t_begin = 0;
    if (pass_.volume.empty() || !gathers_after_rough(settings_.photons_carry, rough_events_)) return;
    if (!pass_.volume.clip(ray_.origin, ray_.direction, PassContext::set_of(index_), t_begin, t_end)) return;
    const CameraWay way(scene_, media_, w_, ray_, t_end, RandomStream(sampler_, dimension + kDimMarch));
    gather_volume(way, t_end, layer_of(way.at(0.5f * (t_begin + t_end))), dimension);
  }

  // ---- Bookkeeping ----

  // Light met by the ray: bounces_ events lie between it and the camera.
  void add(const Spectrum &radiance, bool caustic) { add_after(radiance, bounces_, caustic); }
  // Light scattered once more, at the present surface.
  void add_scattered(const Spectrum &radiance, bool caustic) { add_after(radiance, bounces_ + 1, caustic); }
  void add_bounced(const Spectrum &radiance, bool caustic) { add_after(radiance, bounces_ + 2, caustic); }

  void add_after(Spectrum radiance, uint32_t events, bool caustic) {
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

  // The path's layers after light or path are scattered at the present surface into `wi`; `scattering` as sampled, 0 for a
  // light sample.
  LayerTracker layers_after_surface(const Vec3 &wi, uint32_t scattering) const {
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

  Spectrum diffuse_share(const Vec3 &wi) const {
    Spectrum unused;
    const Spectrum all = bsdf_eval(surface_.closures, surface_.sp, wi, w_, Transport::Radiance, unused);
    Spectrum share = bsdf_eval_diffuse_alone(surface_.closures, surface_.sp, wi, w_);
    for (int i = 0; i < kWavelengths; ++i) share[i] = all[i] > 0 ? share[i] / all[i] : 0.0f;
    return share;
  }

  // The layer of an event in media: of overlapping ones that which scatters most of this light; without a direction, of what
  // is taken or given off.
  int layer_of(const MediumHere &here, const Vec3 &light, const Vec3 &onward) const {
    return keeps_layers_ ? here.layer_of(w_, dot(light, onward)) : 0;
  }
  int layer_of(const MediumHere &here) const { return keeps_layers_ ? here.layer_of(w_, 0) : 0; }

  // Transmittance of the media that vary between the ray's origin and t_end, by quadrature: it only weighs what is measured.
  Spectrum marched_transmittance(float t_end) const {
    constexpr int kSteps = 128;
    const RayMedia media(scene_, media_, w_, ray_);
    Spectrum depth(0.0f);
    if (std::isfinite(t_end)) {
      for (int i = 0; i < kSteps; ++i) depth += media.at((float(i) + 0.5f) * t_end / kSteps).replaced;
      return transmittance_over(depth, t_end / kSteps);
    }
    // To infinity in steps that grow, from centimetres to a thousand kilometres.
    constexpr float kFirst = 1e-2f, kGrowth = 1.155f;
    float from = 0;
    for (int i = 0; i < kSteps; ++i) {
      const float to = kFirst * std::pow(kGrowth, float(i));
      depth += media.at(0.5f * (from + to)).replaced * (to - from);
      from = to;
    }
    return transmittance_over(depth, 1);
  }

  void add_to_layers(const Spectrum &radiance, const Vec3 &rgb) {
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
    out[layers_.added()] += rgb - base;
    Spectrum behind = kept;
    for (int i = 0; i < kWavelengths; ++i) behind[i] /= std::max(layers_.camera_through()[i], 1e-6f);
    out[Layer::Behind] += to_rgb(behind, w_);
  }

  void finish_layers() {
    light_.layers.alpha[size_t(layers_.first())] += light_.alpha;
    if (layers_.first() == Layer::Base)
      light_.layers.alpha[size_t(Layer::Behind)] += light_.alpha / std::max(layers_.camera_through().average(), 1e-6f);
  }

  void note_guides() {
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

  const PassContext &pass_;
  const Scene &scene_;
  const opal_render_settings &settings_;
  const Sampler sampler_;
  const uint32_t index_;
  const Wavelengths &w_;
  const bool keeps_layers_;
  RayCounts &counts_;

  Ray ray_;
  Hit hit_;    // what it meets
  Vec3 left_;  // the normal of the surface it comes from, on its side; 0: it begins in a medium or at the lens
  uint32_t ray_kind_ = OPAL_RAY_CAMERA;
  InteriorStack interior_;
  MediumSet entered_;  // whose boundaries it has come through
  MediumSet media_;    // those that are there
  const Material *material_ = nullptr;
  Surface surface_;
  LastEvent last_;
  PathLight light_;
  LayerTracker layers_;
  Spectrum throughput_{1.0f}, path_pdf_{1.0f}, previous_pdf_{1.0f};
  float eta_scale_ = 1, travelled_ = 0;
  uint32_t events_ = 0;         // everything, free passes included: addresses the random numbers
  uint32_t bounces_ = 0;        // real changes of direction
  uint32_t rough_bounces_ = 0;  // those that are not mirrors
  uint32_t rough_events_ = 0;   // of class Rough
  uint32_t transparent_layers_ = 0;
  bool alive_ = true;
  bool rough_in_medium_ = false;  // the last rough event was a medium's
  bool medium_first_ = false;     // the first event was a medium's
  bool final_ray_ = false;        // only lamps are looked for: photons bring everything else
};

}  // namespace

PathLight trace_camera_path(const PassContext &pass, uint32_t x, uint32_t y, uint32_t sample, RayCounts &counts) {
  return CameraPath(pass, x, y, sample, counts).trace();
}

}  // namespace opal
