// SPDX-License-Identifier: GPL-3.0-or-later
#include "photons/photon_tracer.h"

#include "bsdf/gem.h"
#include "film/spectral_film.h"
#include "integrator/surface.h"
#include "scene/contact.h"
#include "photons/colour_trail.h"
#include "photons/transmittance_steps.h"

namespace opal {
namespace {

constexpr int kMaxEvents = 32768;
constexpr int kRouletteStart = 6;
constexpr float kMostSurvive = 0.98f;  // of photons, by roulette
constexpr float kNothing = 0x1p-40f;   // of what a photon set out with: no sum of floats sees it
constexpr float kUnseenUse = 0.25f;    // of a photon that the camera does not see at first hand: glass and mirrors may show it

EmissionNumbers emission_numbers(const Sampler &sampler) {
  return {sampler.get2d(kDimEmissionLight), sampler.get2d(kDimEmissionPosition), sampler.get2d(kDimEmissionDirection)};
}

// What is large and serves one photon after the other.
struct PhotonScratch {
  ColourTrail trail{Transport::Flux};
  Surface surface;  // where a follower leaves its light
};

class PhotonPath {
 public:
  PhotonPath(const PassContext &pass, const PhotonTask &task, uint32_t number, PhotonChunk &out, PhotonScratch &scratch)
      : pass_(pass),
        scene_(pass.scene),
        settings_(pass.settings),
        task_(task),
        sampler_(settings_.seed, task.stream + uint32_t(pass.pass), number),
        index_(PassContext::wavelength_index(sampler_.get1d(kDimWavelength))),
        w_(pass.wavelengths[index_]),
        out_(out),
        scratch_(scratch),
        trail_(scratch.trail) {
    trail_.close();
  }

  void trace() {
    if (!emit()) return;
    follow();
    out_.passed_over += interior_.passed_over();
    out_.media_passed_over += entered_.passed_over();
  }

 private:
  void follow() {
    out_.energy.emitted += double(flux_[0]);
    for (int events = 0; events < kMaxEvents; ++events) {
      const double before = double(flux_[0]);
      const bool goes_on = step(uint32_t(events));
      const double after = goes_on || end_ != End::Absorbed ? double(flux_[0]) : 0.0;
      out_.energy.absorbed += before - after;
      if (goes_on) continue;
      if (end_ == End::Stored) out_.energy.stored += after;
      if (end_ == End::Escaped) out_.energy.escaped += after;
      return;
    }
    out_.energy.absorbed += double(flux_[0]);
  }

  // How a photon that does not go on has ended.
  enum class End : uint8_t { Absorbed, Stored, Escaped };
  bool ended(End end) {
    end_ = end;
    return false;
  }

  bool emit() {
    static const std::vector<EmissionTarget> kEverywhere;
    const bool aimed = settings_.photons_carry == OPAL_CARRY_CAUSTICS;
    const float time = settings_.motion_blur ? sampler_.get1d(kDimTime) : 0.0f;
    EmissionSample &sample = emitted_;
    EmissionNumbers u = emission_numbers(sampler_);
    float density = 1;
    if (pass_.guide) u = pass_.guide->warp(u, density);
    if (!sample_emission(scene_, aimed ? scene_.casters : kEverywhere, u.pick, u.position, u.direction, time, w_, sample))
      return false;
    if (!source_emits_photons(scene_, settings_.photons_carry, sample.source)) return false;
    ray_ = sample.ray;
    flux_ = sample.flux * (1.0f / (float(task_.count) * density));
    if (sample.from_infinity && scene_.world_medium >= 0) flux_ *= arrives_through_the_world();
    start_ = flux_.max();
    entered_ = scene_.any_medium ? media_at(scene_, ray_.origin) : MediumSet{};
    interior_ = interior_at(scene_, ray_.origin);
    return flux_.is_finite() && start_ > 0;
  }

  // What the world's medium lets through of a sun's light or the world's before the ray begins.
  Spectrum arrives_through_the_world() const {
    MediumSet world;
    world.enter(MediumSet::kOfWorld, scene_.world_medium);
    RandomStream random(sampler_, kDimEmissionWay);
    return estimate_transmittance(scene_, media_that_fill(scene_, world, {}), w_, {ray_.origin, -ray_.direction}, kInfinity,
                                  random);
  }

  bool step(uint32_t events) {
    const uint32_t kind = sharp_events_ + rough_events_ == 0 ? uint32_t(OPAL_RAY_ALL & ~OPAL_RAY_CAMERA) : ray_kind_;
    const Hit hit = next_hit(scene_, ray_, kind);
    ++out_.rays;
    if (escapes(scene_, ray_, hit)) entered_.leave_bodies();
    media_ = media_that_fill(scene_, entered_, interior_);
    out_.media_passed_over += media_.passed_over();
    float t_end = hit.t;
    if (emitted_.reach < kInfinity && sharp_events_ + rough_events_ == 0)
      t_end = std::min(t_end, std::max(emitted_.reach - length(ray_.origin - emitted_.ray.origin), 0.0f));
    if (!media_.empty()) {
      trail_.close();
      bool alive = true;
      const uint32_t dimension = bounce_dimension(events, 0);
      const bool ended_there = any_varies(scene_, media_) ? travel_in_varying_medium(t_end, dimension, alive)
                                                          : travel_in_medium(t_end, dimension, alive);
      if (ended_there) return alive;
    }
    if (t_end < hit.t) return ended(End::Escaped);
    if (!hit.valid()) return ended(End::Escaped);
    absorb(scene_, interior_, hit.t, w_, flux_);
    const Material &material = scene_.material_at(hit);
    if (material.no_surface()) {
      trail_.close();
      surface_.sp = scene_.shading_point(ray_, hit);
      cross_medium(material, surface_.sp, entered_);
      go_on(ray_.direction);
      return true;
    }
    make_surface(scene_, ray_, hit, ray_kind_, uint32_t(sharp_events_ + rough_events_), interior_, w_, surface_);
    if (surface_.nothing) {
      trail_.close();
      cross_boundary(surface_.boundary, interior_);
      cross_medium(material, surface_.sp, entered_);
      go_on(ray_.direction);
      return true;
    }
    if (sharp_events_ + rough_events_ == 0 && !emission_reaches(emitted_, surface_.sp.p)) return false;
    const bool left = surface_.has_smooth_lobe && photon_is_left(settings_.photons_carry, sharp_events_, rough_events_);
    if (left && task_.on_surfaces) leave();
    if (!polished_gem()) trail_.close();
    end_ = left ? End::Stored : End::Absorbed;  // if this is where it ends
    if (!surface_.caster && !photon_goes_on(settings_.photons_carry) && !has_transparent_lobe()) return false;

    const uint32_t dimension = bounce_dimension(events, 0);
    BsdfSample sample;
    if (!bsdf_sample(surface_.closures, surface_.sp, w_, Transport::Flux, sampler_.get1d(dimension + kDimBsdfLobe),
                     sampler_.get2d(dimension + kDimBsdf), sample))
      return false;
    end_ = End::Absorbed;
    if (polished_gem()) keep_trail(hit, sample);
    flux_ *= sample.weight;
    for (int i = 0; i < kWavelengths; ++i) {
      path_pdf_[i] *= sample.pdf[i] / sample.pdf[0];
      if (path_pdf_[i] <= 0) flux_[i] = 0;
    }
    if (!flux_.is_finite() || flux_.is_zero()) return false;
    if (sample.scattering & kScatterTransparent) {
      cross_medium(material, surface_.sp, entered_);
      go_on(ray_.direction);
      return true;
    }
    const EventClass event = classify(surface_, sample, w_, Transport::Flux, sampler_.get1d(dimension + kDimSpare));
    if (event == EventClass::Rough && !photon_goes_on(settings_.photons_carry))
      return ended(left ? End::Stored : End::Absorbed);
    (event == EventClass::Rough ? rough_events_ : sharp_events_) += 1;
    if (!(sample.scattering & kScatterSpecular) && ++rough_bounces_ > settings_.max_depth) return false;
    if (sample.scattering & kScatterTransmit) {
      if (surface_.is_gem) cross_boundary(surface_.boundary, interior_);
      cross_medium(material, surface_.sp, entered_);
    }
    ray_kind_ = sample.scattering & kScatterTransmit  ? uint32_t(OPAL_RAY_TRANSMISSION)
                : sample.scattering & kScatterDiffuse ? uint32_t(OPAL_RAY_DIFFUSE)
                                                      : uint32_t(OPAL_RAY_GLOSSY);
    go_on(sample.wi);

    if (sharp_events_ + rough_events_ >= kRouletteStart) {
      const float survive = std::min(kMostSurvive, flux_.max() / (path_pdf_.average() * start_));
      if (!(sampler_.get1d(dimension + kDimRoulette) < survive)) return false;
      if (trail_.open()) trail_.survived(survive, kMostSurvive);
      flux_ *= 1 / survive;
    }
    return true;
  }

  bool polished_gem() const { return surface_.is_gem && surface_.closures.gem.alpha < kSpecularAlpha; }

  void keep_trail(const Hit &hit, const BsdfSample &sample) {
    const GemBoundary &gem = surface_.closures.gem;
    const bool transmission = sample.scattering & kScatterTransmit;
    if (trail_.open())
      trail_.add(hit, surface_.material, surface_.sp, gem, transmission, sample.pdf[0], absorption_table(scene_, interior_),
                 ray_kind_);
    else if ((sample.scattering & kScatterDispersive) && media_.empty() && path_pdf_[kWavelengths - 1] > 0)
      trail_.start(ray_, surface_.sp, gem, transmission, sample.pdf[0], flux_, path_pdf_, start_);
  }

  // Through media up to t_end. True: the way ended before, with a scattering (alive) or an absorption.
  bool travel_in_medium(float t_end, uint32_t dimension, bool &alive) {
    const MediumHere here = medium_here(scene_, media_, w_);
    if (!(here.extinction.max() > 0)) return false;
    const bool left = here.scatters() && photon_is_left(settings_.photons_carry, sharp_events_, rough_events_);
    const bool stores = left && task_.in_media;
    const bool as_beams = settings_.volume_estimate == OPAL_VOLUME_BEAMS;
    if (stores && as_beams) leave_beam(here, t_end);

    // The free path; photons of other wavelengths share it, weighed by what they would have done (Wilkie et al. 2014).
    const float sigma = here.extinction[0];
    const float t = sigma > 0 ? -std::log1p(-sampler_.get1d(dimension + kDimMedium)) / sigma : kInfinity;
    const bool collides = t < t_end;
    if (collides && t < reaches_from() && photon_goes_on(settings_.photons_carry)) {
      alive = false;
      end_ = End::Absorbed;
      return true;
    }
    if (stores && !as_beams && collides) leave_in_medium(here, t);
    if (!photon_goes_on(settings_.photons_carry)) {
      // What media scatter is done with: a share of the photon ends in them, and the rest carries on for surfaces.
      const double before = double(flux_[0]);
      flux_ *= transmittance_over(here.extinction, t_end);
      if (left) out_.energy.stored += before - double(flux_[0]), out_.energy.absorbed -= before - double(flux_[0]);
      alive = !flux_.is_zero();
      end_ = std::isfinite(t_end) ? End::Absorbed : End::Escaped;
      return !alive;
    }
    const Spectrum through = transmittance_over(here.extinction, std::min(t, t_end));
    if (!collides) {
      for (int i = 0; i < kWavelengths; ++i) {
        flux_[i] *= through[0] > 0 ? through[i] / through[0] : 0;
        path_pdf_[i] *= through[0] > 0 ? through[i] / through[0] : 0;
      }
      return false;
    }
    float phase_pdf = 0;
    const Vec3 forward = ray_.direction;
    const Vec3 direction = here.scatters() ? here.sample_phase(w_, forward, sampler_.get1d(dimension + kDimBsdfLobe),
                                                               sampler_.get2d(dimension + kDimMediumPhase), phase_pdf)
                                           : Vec3{};
    const float pdf = sigma * through[0] * phase_pdf;
    // Absorbed with the albedo's complement.
    const float albedo = here.scattering[0] / sigma;
    alive = pdf > 0 && sampler_.get1d(dimension + kDimRoulette) < albedo && settings_.max_depth > 0;
    end_ = End::Absorbed;
    if (!alive) return true;
    const Spectrum phase = here.phase_value(w_, dot(forward, direction));
    flux_ *= through * here.scattering * here.scattered(w_, forward, direction, nullptr) / (pdf * albedo);
    path_pdf_ *= through * here.extinction * phase / pdf;
    alive = flux_.is_finite() && !flux_.is_zero();
    ++rough_events_;
    ray_kind_ = OPAL_RAY_SCATTER;
    ray_ = {ray_.origin + forward * t, direction, 0, kInfinity, ray_.time};
    return true;
  }

  // The same in media that vary.
  bool travel_in_varying_medium(float t_end, uint32_t dimension, bool &alive) {
    const bool left = photon_is_left(settings_.photons_carry, sharp_events_, rough_events_);
    const bool stores = left && task_.in_media, goes_on = photon_goes_on(settings_.photons_carry);
    const bool as_beams = settings_.volume_estimate == OPAL_VOLUME_BEAMS;
    if (stores && as_beams) leave_varying_beams(t_end, dimension);

    MediumHere here;
    float t = 0;
    Walk walk{flux_, path_pdf_, path_pdf_};
    bool collides = false;
    if (goes_on || (stores && !as_beams)) {
      RayMedia media(scene_, media_, w_, ray_);
      RandomStream random(sampler_, dimension + kDimMedium);
      float depth = 0;
      collides = fly(media, t_end, random, walk, depth, t, here, [](const Spectrum &, const Spectrum &) {});
      if (stores && !as_beams && collides && t >= reaches_from())
        store_scattering(t, walk.throughput * here.scattering / walk.path_pdf.average());
    }
    if (!goes_on) {
      const double before = double(flux_[0]);
      if (std::isfinite(t_end)) {
        RayMedia media(scene_, media_, w_, ray_);
        RandomStream random(sampler_, dimension + kDimMediumDistance);
        Walk passed{flux_, path_pdf_, path_pdf_};
        float depth = 0;
        pass_through(media, t_end, random, passed, depth);
        flux_ = passed.throughput, path_pdf_ = passed.light_pdf;
      }
      if (left) out_.energy.stored += before - double(flux_[0]), out_.energy.absorbed -= before - double(flux_[0]);
      alive = flux_.is_finite() && !flux_.is_zero();
      end_ = std::isfinite(t_end) ? End::Absorbed : End::Escaped;
      return !alive;
    }
    if (!collides) {
      flux_ = walk.throughput, path_pdf_ = walk.path_pdf;
      return false;
    }
    end_ = End::Absorbed;
    const Vec3 forward = ray_.direction;
    const float albedo = here.scattering[0] / here.extinction[0];
    alive = albedo > 0 && t >= reaches_from() && sampler_.get1d(dimension + kDimRoulette) < albedo && settings_.max_depth > 0;
    if (!alive) return true;
    float phase_pdf = 0;
    const Vec3 direction = here.sample_phase(w_, forward, sampler_.get1d(dimension + kDimBsdfLobe),
                                             sampler_.get2d(dimension + kDimMediumPhase), phase_pdf);
    alive = phase_pdf > 0;
    if (!alive) return true;
    const Spectrum phase = here.phase_value(w_, dot(forward, direction));
    flux_ = walk.throughput * here.scattering * here.scattered(w_, forward, direction, nullptr) / (phase_pdf * albedo);
    path_pdf_ = walk.path_pdf * phase / phase_pdf;
    alive = flux_.is_finite() && !flux_.is_zero();
    ++rough_events_;
    ray_kind_ = OPAL_RAY_SCATTER;
    ray_ = {ray_.origin + forward * t, direction, 0, kInfinity, ray_.time};
    return true;
  }

  // Leaves a scattering event at distance t: of the photons that collide there, the share that is scattered.
  void leave_in_medium(const MediumHere &here, float t) {
    const Spectrum through = transmittance_over(here.extinction, t);
    store_scattering(t, flux_ * through * here.scattering / (path_pdf_ * through * here.extinction).average());
  }

  void store_scattering(float t, const Spectrum &flux) {
    if (!flux.is_finite() || flux.is_zero()) return;
    VolumePhoton photon;
    photon.position = ray_.origin + ray_.direction * t;
    photon.direction = pack_direction(ray_.direction);
    photon.media = media_key(media_);
    photon.set = PassContext::set_of(index_);
    store(flux, photon.flux);
    out_.volume.push_back(photon);
  }

  // Leaves the whole flight. One that leaves the scene ends where nothing is left of it, or far from everything.
  void leave_beam(const MediumHere &here, float t_end) {
    constexpr float kDepth = 16;  // exp(-16) = 1e-7
    float weakest = here.extinction[0];
    for (int k = 1; k < kWavelengths; ++k) weakest = std::min(weakest, here.extinction[k]);
    const float from = reaches_from(), to = std::min({t_end, weakest > 0 ? kDepth / weakest : kInfinity, far_away()});
    if (!(from < to)) return;
    store_beam(from, to, flux_ * transmittance_over(here.extinction, from) / path_pdf_.average(), here.extinction);
  }

  // In media that vary: the flight in pieces over which an estimate of the transmittance is constant.
  void leave_varying_beams(float t_end, uint32_t dimension) {
    RayMedia media(scene_, media_, w_, ray_);
    const Spectrum flux = flux_ / path_pdf_.average();
    const float start = reaches_from();
    transmittance_steps(media, std::min(t_end, far_away()), RandomStream(sampler_, dimension + kDimMarch),
                        [&](float from, float to, const Spectrum &through) {
                          if (std::max(from, start) < to) store_beam(std::max(from, start), to, flux * through, Spectrum(0.0f));
                        });
  }

  void store_beam(float from, float to, const Spectrum &flux, const Spectrum &extinction) {
    if (!flux.is_finite() || flux.is_zero()) return;
    PhotonBeam beam;
    beam.origin = ray_.origin + ray_.direction * from;
    beam.direction = ray_.direction;
    beam.length = to - from;
    beam.media = media_key(media_);
    beam.set = PassContext::set_of(index_);
    store(flux, beam.flux);
    for (int k = 0; k < kWavelengths; ++k) beam.extinction[PassContext::position_of(index_, uint32_t(k))] = extinction[k];
    out_.beams.push_back(beam);
  }

  // From the scene, the camera and where the photon began.
  float far_away() const {
    Bounds all = scene_.bounds;
    all.extend(camera_transform(scene_.camera, ray_.time).origin()), all.extend(emitted_.ray.origin);
    return 16 * all.radius();
  }

  // Lamps with soft falloff do not light what is too near (emission_reaches).
  float reaches_from() const {
    if (sharp_events_ + rough_events_ > 0) return 0;
    return std::max(0.0f, emission_reaches_from(emitted_) - length(ray_.origin - emitted_.ray.origin));
  }

  // By position in the set; of eight sets a lookup sees one.
  void store(const Spectrum &flux, float *out) const {
    for (int k = 0; k < kWavelengths; ++k) out[PassContext::position_of(index_, uint32_t(k))] = flux[k] * kWavelengthSets;
  }

  bool has_transparent_lobe() const {
    for (int i = 0; i < surface_.closures.count; ++i)
      if (surface_.closures.lobes[i].kind == LobeKind::Transparent) return true;
    return false;
  }

  void go_on(const Vec3 &direction) { ray_ = leave_surface(scene_, ray_, surface_.sp, direction); }

  // Leaves the photon: in the map, and on the film where the camera sees this point. Wavelengths that follow the hero are for
  // the film alone.
  void leave() {
    const Spectrum flux = flux_ / path_pdf_.average();
    const ShadingPoint &sp = surface_.sp;
    Photon photon;
    photon.position = sp.p;
    photon.direction = pack_direction(sp.wo);
    photon.normal = pack_direction(sp.ng);
    photon.set = PassContext::set_of(index_);
    store(flux, photon.flux);
    out_.photons.push_back(photon);
    if (trail_.open()) splat_with_followers();
    else splat(ray_, surface_, flux, path_pdf_);
  }

  void splat_with_followers() {
    const auto only = [](int k, float value) {
      Spectrum s(0.0f);
      s[k] = value;
      return s;
    };
    const size_t first = out_.splats.size(), first_spectral = out_.spectral.size();
    splat(ray_, surface_, only(0, flux_[0] * kWavelengths), only(0, 1));
    float together = path_pdf_[0];
    const int32_t absorption = absorption_table(scene_, interior_);
    ColourTrail::End end;
    for (int k = 1; k < kWavelengths; ++k) {
      if (!trail_.follow(scene_, w_, absorption, ray_kind_, k, end, out_.rays)) continue;
      Surface &there = scratch_.surface;
      make_surface(scene_, end.ray, end.hit, ray_kind_, uint32_t(sharp_events_ + rough_events_), interior_, w_, there);
      if (!there.has_smooth_lobe) continue;
      together += end.path_pdf;
      splat(end.ray, there, only(k, end.flux * kWavelengths), only(k, 1));
    }
    for (size_t i = first; i < out_.splats.size(); ++i) out_.splats[i].rgb *= 1 / together;
    for (size_t i = first_spectral; i < out_.spectral.size(); ++i) out_.spectral[i].second *= 1 / together;
  }

  void splat(const Ray &arrived, const Surface &surface, const Spectrum &flux, const Spectrum &path_pdf) {
    if (!(flux.max() > kNothing * start_)) return;
    const Vec2 offset = pass_.filter.sample(sampler_.get2d(kDimFilter));
    CameraConnection seen;
    if (!connect(scene_.camera, surface.sp.p, sampler_.get2d(kDimLens), ray_.time, seen,
                 pass_.filter.width() / float(settings_.width), pass_.filter.width() / float(settings_.height)))
      return;
    const float x = seen.film_x * float(settings_.width) + offset.x, y = seen.film_y * float(settings_.height) + offset.y;
    const int *region = settings_.region;
    if (!(x >= float(region[0]) && x < float(region[2]) && y >= float(region[1]) && y < float(region[3]))) return;
    if (!(scene_.groups[surface.sp.instance->group].visibility & OPAL_RAY_CAMERA)) return;
    const Spectrum f = rough_towards_camera(scene_, surface, seen.to_camera, seen.distance, w_);
    Spectrum radiance = flux * f * (seen.importance * float(settings_.width) * float(settings_.height));
    if (radiance.is_zero() || !radiance.is_finite()) return;
    Ray shadow = leave_surface(scene_, arrived, surface.sp, seen.to_camera);
    shadow.t_max = seen.distance;
    const Passage through =
        passage(scene_, shadow, entered_, interior_, settings_.transparent_depth, w_,
                RandomStream(sampler_, bounce_dimension(uint32_t(sharp_events_ + rough_events_), kDimSpare)));
    ++out_.rays;
    if (through.blocked()) return;
    radiance *= uplift(through.surfaces, w_) * through.medium;
    // The walk is the hero's: what follows it alone is weighed by the hero's density, which the passage is relative to.
    if (path_pdf[0] > 0) radiance *= path_pdf.average() / (path_pdf * through.light_pdf).average();
    const uint32_t pixel =
        (uint32_t(y) - uint32_t(region[1])) * uint32_t(region[2] - region[0]) + (uint32_t(x) - uint32_t(region[0]));
    out_.splats.push_back({pixel, photon_pass(sharp_events_, rough_events_), to_rgb(radiance, w_)});
    if (settings_.spectral_bins > 0)
      for (int k = 0; k < kWavelengths; ++k) {
        if (radiance[k] == 0) continue;
        const SpectralBin bin = spectral_bin(settings_, w_, k, radiance[k]);
        out_.spectral.push_back({pixel * uint32_t(settings_.spectral_bins) + bin.index, bin.value});
      }
  }

  const PassContext &pass_;
  const Scene &scene_;
  const opal_render_settings &settings_;
  const PhotonTask &task_;
  const Sampler sampler_;
  const uint32_t index_;
  const Wavelengths &w_;
  PhotonChunk &out_;
  PhotonScratch &scratch_;
  ColourTrail &trail_;

  EmissionSample emitted_;
  Ray ray_;
  uint32_t ray_kind_ = OPAL_RAY_DIFFUSE;
  InteriorStack interior_;
  MediumSet entered_;  // whose boundaries it has come through
  MediumSet media_;    // those that are there
  Surface surface_;
  Spectrum flux_{0.0f}, path_pdf_{1.0f};
  float start_ = 0;
  End end_ = End::Absorbed;
  int sharp_events_ = 0, rough_events_ = 0, rough_bounces_ = 0;
};

}  // namespace

void trace_photons(const PassContext &pass, const PhotonTask &task, uint32_t first, uint32_t last, PhotonChunk &out) {
  PhotonScratch scratch;
  for (uint32_t i = first; i < last; ++i) PhotonPath(pass, task, i, out, scratch).trace();
}

void try_photons(const PassContext &pass, const PhotonTask &task, uint32_t first, uint32_t last, EmissionTrial *trials) {
  PhotonChunk left;
  PhotonScratch scratch;
  for (uint32_t i = first; i < last; ++i) {
    left.photons.clear(), left.volume.clear(), left.beams.clear(), left.splats.clear(), left.spectral.clear();
    PhotonPath(pass, task, i, left, scratch).trace();
    EmissionTrial &trial = trials[i];
    trial.numbers = emission_numbers(Sampler(pass.settings.seed, task.stream + uint32_t(pass.pass), i));
    if (pass.guide) trial.numbers = pass.guide->warp(trial.numbers, trial.density);
    const bool in_media = !left.volume.empty() || !left.beams.empty();
    trial.use = (left.splats.empty() ? 0.0f : 1.0f) + (in_media ? 1.0f : 0.0f) + kUnseenUse * float(left.photons.size());
  }
}

}  // namespace opal
