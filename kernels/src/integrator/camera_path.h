// SPDX-License-Identifier: GPL-3.0-or-later
// One camera path, from lens to light.
//
// Wavelengths: the hero's geometry is followed. `throughput` is f / p(hero), `path_pdf` is p(lambda) / p(hero) of the
// path so far; with p_light in the same unit, a contribution is divided by the mean over wavelengths of the pdfs that
// could have produced it (Wilkie et al. 2014; the bookkeeping follows pbrt-v4's "rescaled path probabilities").
// Dispersion sets path_pdf of the other wavelengths to 0 and so leaves the hero alone with its full weight. What the hero meets
// behind gems some of the others are sent to find as well (photons/colour_trail.h): where they arrive, light is looked for as
// where the hero arrives, and from there the hero goes on alone.
#pragma once

#include "integrator/path_tracer.h"
#include "integrator/sun_guide.h"
#include "integrator/surface.h"
#include "media/gather_distance.h"
#include "media/stratified.h"
#include "photons/colour_trail.h"
#include "photons/gather.h"
#include "scene/contact.h"
#include "photons/volume_estimate.h"

namespace opal {

inline constexpr uint32_t kRouletteStart = 4;  // events before Russian roulette sets in
inline constexpr uint32_t kGuidedEvents =
    8;  // from the camera on: how many may be led to where the suns' light is scattered from
inline constexpr float kGuidedPart = 0.25f;
// Of the chance to meet a medium that varies: a lesser one makes it a thin one.
inline constexpr float kThin = 0.7f;
inline constexpr uint32_t kMostFreePasses = 32768;  // nothing physical gets there; guards against loops

// Where the path last scattered, as the light sampler saw it.
struct LastEvent {
  bool light_was_sampled = false;  // next-event estimation could have found what the ray finds now
  EventClass event = EventClass::Sharp;
  Vec3 p, normal;
  bool transmissive = false;
  int32_t light_group = -1;
  float pdf = 0;  // hero's, of the direction
  // In a medium that varies: light was also looked for at a distance chosen for it, with this density relative to all others',
  // and the phase function shares the rest with the connection from here.
  float elsewhere = 0;
  Spectrum phase{0.0f};

  // The share, of light from a direction, that is not left to chosen distances.
  Spectrum share(const Spectrum &phase_value, float light_pdf) const {
    Spectrum s(1.0f);
    for (int i = 0; i < kWavelengths; ++i) {
      const float here = phase_value[i] + light_pdf;
      if (elsewhere > 0 && light_pdf > 0) s[i] = here / (here + elsewhere * light_pdf);
    }
    return s;
  }
};

class MeanDepths;

class CameraPath {
 public:
  CameraPath(const PassContext &pass, uint32_t x, uint32_t y, uint32_t sample, RayCounts &counts, bool clear);
  PathLight trace();

 private:
  void step();
  // A path that meets the inner side of a gem without having entered came through a hole in its mesh: taken as having
  // entered there, so that radiance is not scaled up on the way out alone.
  void note_way_in(const Boundary &b);

  // ---- Light that the ray meets ----
  // Lamps before t_end; `media`, if there are any, in which the ray runs.
  void meet_lamps(float t_end, const StratifiedMedia *media);
  void meet_emission(const Hit &hit);
  void escape();
  void meet_surroundings();
  // Which part of what lies here shows behind all that was passed: that the path came here is chance, so it has a weight.
  float seen_through() const;
  // Whether photons bring what the ray has met.
  bool brought(const SourceId &source) const;
  void add_met(const SourceId &source, const Spectrum &radiance, const Vec3 &point, const Vec3 &normal, float distance);

  // ---- Scattering ----
  void scatter();
  // By the surface, or, where a medium before a diffuse one scatters a sun's light to it, from there.
  bool sample_surface(uint32_t dimension, BsdfSample &sample) const;
  // `here` has to outlive the guide.
  SunGuide surface_guide(MediumHere &here) const;
  void update_path_pdf(const BsdfSample &sample);
  // `promise`: how much more than usual the way it has taken may bring.
  void roulette(float u, float promise = 1);
  void go_straight_on();
  // The last ray of a path that looks for lamps only: on through what is transparent.
  void pass_or_stop();
  void sample_direct(uint32_t dimension);
  // A light hidden from a kind of ray does not light the lobes that send such rays: takes them out of `f`.
  void leave_out_blind_lobes(const LightSample &sample, bool with_diffuse, Spectrum &f) const;
  // What of a light sample arrives along a ray that starts so; false: nothing.
  bool passes(Ray shadow, const LightSample &sample, uint32_t dimension, Passage &through);

  // ---- Wavelengths that follow ----
  // Notes what a gem has done to the path, or, what it was being no polished gem, that nothing follows any more.
  void keep_trail(const BsdfSample &sample);
  // At the end of a trail: those that arrive find their light; what the hero finds here counts by its share among them.
  void bring_followers();
  // Light that one of them finds where it arrives; what it carries there and nothing of the hero's is in place.
  void find_light();
  // The hero goes on alone.
  void part_from_followers() { throughput_ *= company_, company_ = 1; }

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
  void pass_unscattered(const Spectrum &depth);
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
  bool travel_in_medium(float t_end);
  // Media scatter as often as it takes, milk thousands of times: roulette ends such paths, not the depth, unless that is 0.
  bool may_scatter_again() const { return settings_.max_depth > 0; }
  // Before a scattering in a medium: false where photons bring everything beyond it, and then the path has ended.
  bool may_scatter(bool may_go_on);
  // Whether photons bring what this source scatters directly into the ray.
  bool brought_to_medium(const SourceId &source) const;
  // Of events in media, as many as show specks; over many the guide's weights would add up.
  SunGuide guide(const MediumHere &here) const;
  // Where a path goes on after an event in a medium: by the phase function or where the sun is scattered to. `density` at every
  // wavelength.
  Vec3 sample_onward(const MediumHere &here, const Vec3 &forward, uint32_t dimension, Spectrum &density) const;
  // Towards a sun the next event brings as much more as the phase function is higher there than on the mean.
  float promise(const MediumHere &here, const Vec3 &direction) const;
  // The density with which sample_onward() chooses.
  Spectrum onward_density(const MediumHere &here, const Vec3 &forward, const Vec3 &direction) const;
  // The camera's filter where the camera sees a scattering at first hand. What lights it is taken as unpolarised.
  const Polariser *filter() const { return bounces_ == 0 ? &pass_.polariser : nullptr; }
  // The same through media that vary: delta tracking, and light looked for where it ends and at a distance chosen for it.
  bool travel_in_varying_medium(float t_end);
  // Direct light at the collision last_.p.
  void connect_from_medium(const MediumHere &here, const Vec3 &forward, uint32_t dimension);
  // Direct light at a distance chosen for the lamps' sake, or, in media so thin that most rays meet nothing, for theirs.
  void connect_at(const GatherDistance<MeanDepths> &chosen, float t_end, uint32_t dimension);
  // Light that a connection brings: `light` is f / p(hero) without the passage and the density of the light sample, `reached`
  // the density of the path up to p, `path` that of going the same way by itself.
  void add_connected(Spectrum light, const LightSample &sample, const Vec3 &p, const Spectrum &reached, const Spectrum &path,
                     uint32_t dimension);
  // Emission over the segment, in closed form: e (1 - exp(-sigma t)) / sigma.
  void add_emitted(const MediumHere &here, float t_end);
  // Light that reaches the segment directly and is scattered once into it: the other half of hitting a source after a
  // scattering event, joined with it by multiple importance.
  void gather_along(const StratifiedMedia &media, float t_end, uint32_t dimension);

  // ---- Photons ----
  // Seen at first hand, photons are splatted from their own side; everything else is looked up.
  bool gathers() const;
  void gather();
  // What photons scatter into the ray on its way through media, seen at first hand too.
  void gather_volume(const CameraWay &way, float t_end, int layer, uint32_t dimension);
  // What bounds the way through the media, if it ends where the ray meets something.
  MediumFaces faces(float t_end) const;
  // Follows a ray that has left a surface.
  void note_surface_left() { left_ = dot(surface_.sp.ng, ray_.direction) > 0 ? surface_.sp.ng : -surface_.sp.ng; }
  void gather_in_varying(float t_end, uint32_t dimension);

  // ---- Bookkeeping ----
  // Light met by the ray: bounces_ events lie between it and the camera.
  void add(const Spectrum &radiance, bool caustic) { add_after(radiance, bounces_, caustic); }
  // Light scattered once more, at the present surface.
  void add_scattered(const Spectrum &radiance, bool caustic) { add_after(radiance, bounces_ + 1, caustic); }
  void add_bounced(const Spectrum &radiance, bool caustic) { add_after(radiance, bounces_ + 2, caustic); }
  void add_after(Spectrum radiance, uint32_t events, bool caustic);

  // ---- Layers for compositing ----
  // The path's layers after light or path are scattered at the present surface into `wi`; `scattering` as sampled, 0 for a
  // light sample.
  LayerTracker layers_after_surface(const Vec3 &wi, uint32_t scattering) const;
  Spectrum diffuse_share(const Vec3 &wi) const;
  // The layer of an event in media: of overlapping ones that which scatters most of this light; without a direction, of what
  // is taken or given off.
  int layer_of(const MediumHere &here, const Vec3 &light, const Vec3 &onward) const;
  int layer_of(const MediumHere &here) const { return keeps_layers_ ? here.layer_of(w_, 0) : 0; }
  // Media that the layers' base leaves out, before the first event: a clear path is not stopped by them.
  void part_veil();
  void see_through(float t, bool ends);
  // What they let through between the ray's origin and t; by quadrature where they vary, for it only weighs what is measured.
  Spectrum veil_transmittance(float t) const;
  void add_to_layers(const Spectrum &radiance, const Vec3 &rgb);
  void finish_layers();
  void note_guides();

  const PassContext &pass_;
  const Scene &scene_;
  const opal_render_settings &settings_;
  const Sampler sampler_;
  const uint32_t index_;
  const Wavelengths &w_;
  const bool keeps_layers_;
  const bool clear_;  // not stopped by media before its first event; brings nothing but light for Behind and Dimmed
  RayCounts &counts_;
  Ray ray_;
  Hit hit_;    // what it meets
  Vec3 left_;  // the normal of the surface it comes from, on its side; 0: it begins in a medium or at the lens
  uint32_t ray_kind_ = OPAL_RAY_CAMERA;
  InteriorStack interior_;
  MediumSet entered_;  // whose boundaries it has come through
  MediumSet media_;    // those that are there
  MediumSet veil_;     // of a clear path: those that are there besides
  const Material *material_ = nullptr;
  Surface surface_;
  LastEvent last_;
  ColourTrail trail_{Transport::Radiance};
  float company_ = 1;  // by how much the throughput is lowered because others have found light beside the hero
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

}  // namespace opal
