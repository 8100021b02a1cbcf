// SPDX-License-Identifier: GPL-3.0-or-later
// Layers for compositing: what of a camera path's light a picture without gems and media already shows, and where the rest
// goes.
//
// The base is what a path tracer renders in which gems absorb all light, media take light away along every segment and
// scatter none, and nothing but diffuse lobes scatters after a diffuse reflection (no caustics, as Cycles understands it).
// Everything else falls into one layer by the first event that the camera sees: a gem, a medium, a rainbow, or an ordinary
// surface, whose added light is sorted by what brought it. The layers' sum is the picture, path by path.
//
// What media before the camera let through is the quotient of two more films, Dimmed and Behind: the base with those media and
// without. Both are of the same clear paths, which no such medium stops on their way to the first event, so that the quotient
// is as good where next to nothing comes through as where nearly all does.
#pragma once

#include "core/spectrum.h"
#include "core/vec.h"
#include "opal.h"

#include <array>

namespace opal {

// In the order of OPAL_PASS_LAYER_BASE onward.
enum class Layer : uint8_t { Base, Behind, Caustics, Gems, Media, Rainbow, Dimmed };
inline constexpr int kLayers = 7;

// Light and alpha by layer.
struct LayerLight {
  std::array<Vec3, kLayers> rgb{};
  std::array<float, kLayers> alpha{};

  Vec3 &operator[](Layer layer) { return rgb[size_t(layer)]; }
  void take(Layer layer, const LayerLight &b) {
    rgb[size_t(layer)] = b.rgb[size_t(layer)], alpha[size_t(layer)] = b.alpha[size_t(layer)];
  }
  void operator+=(const LayerLight &b) {
    for (size_t i = 0; i < kLayers; ++i) rgb[i] += b.rgb[i], alpha[i] += b.alpha[i];
  }
};

// What one camera path has met so far.
class LayerTracker {
 public:
  // Of a clear path: what media that do not stop it let through of its present segment up to where something is met, and, with
  // true, that the segment ends there.
  void see_through(const Spectrum &transmittance, bool ends) {
    segment_ = transmittance;
    if (ends) through_ *= segment_, segment_ = Spectrum(1.0f);
  }

  void meet_gem() {
    if (!any_event_) first_ = Layer::Gems;
    any_event_ = true;
    base_share_ = Spectrum(0.0f);
  }

  void meet_medium(int medium_layer) {
    if (medium_layer == OPAL_MEDIUM_LAYER_BASE) {  // the base scatters there too, and after it nothing is left out
      any_event_ = true, after_diffuse_ = false;
      return;
    }
    const Layer layer = medium_layer == OPAL_MEDIUM_LAYER_RAINBOW ? Layer::Rainbow : Layer::Media;
    if (!any_event_) first_ = layer;
    else if (!base_share_.is_zero()) added_ = layer;  // a gem's light stays the gem's
    any_event_ = true;
    base_share_ = Spectrum(0.0f);
  }

  // `share`: what of the event's light the base shows (see needs_share); `diffuse`: a diffuse lobe reflected.
  void meet_surface(const Spectrum &share, bool diffuse) {
    any_event_ = true;
    if (base_share_.is_zero()) return;
    base_share_ *= share;
    after_diffuse_ |= diffuse;
  }
  // Whether the base leaves out all but diffuse lobes at the next surface.
  bool needs_share() const { return after_diffuse_ && first_ == Layer::Base && !base_share_.is_zero(); }

  void meet_photons() {
    if (!any_event_) first_ = Layer::Base;
    any_event_ = true;
    base_share_ = Spectrum(0.0f);
  }

  Layer first() const { return first_; }
  Layer added() const { return added_; }
  const Spectrum &base_share() const { return base_share_; }
  bool any_event() const { return any_event_; }
  // Whether the base may show anything more of this path.
  bool shows_base() const { return first_ == Layer::Base && !base_share_.is_zero(); }
  Spectrum through() const { return through_ * segment_; }

 private:
  Layer first_ = Layer::Base;      // of the first event; Base: an ordinary surface, or none
  Layer added_ = Layer::Caustics;  // where light on ordinary surfaces goes that the base does not have
  bool any_event_ = false, after_diffuse_ = false;
  Spectrum base_share_{1.0f}, through_{1.0f}, segment_{1.0f};
};

}  // namespace opal
