// SPDX-License-Identifier: GPL-3.0-or-later
// The one predicate on path classes: which light the photons bring and which the camera's paths find.
//
// Every scattering event is Sharp (a lobe narrower than kSharpAlpha of a material that makes caustics) or Rough. Reading a path
// from its light, it is
//   direct    when the first event is rough:            L R ...
//   caustic   when sharp events come before a rough one: L S+ R ...
//   indirect  for what reaches a rough event after another rough one.
// Scattering in a medium is a rough event like any other: light that a gem throws into fog is a caustic there. A photon may
// be left at a rough event; the classes say whether it is, and the camera's paths leave out what it brings.
#pragma once

#include "bsdf/closure.h"
#include "lights/lights.h"
#include "opal.h"
#include "scene/scene.h"

namespace opal {

enum class EventClass : uint8_t { Rough, Sharp };

// Whether photons of this mode start at the source at all.
inline bool source_emits_photons(const Scene &scene, int carry, const SourceId &source) {
  if (carry == OPAL_CARRY_NONE) return false;
  if (carry != OPAL_CARRY_CAUSTICS) return true;
  if (scene.casters.empty()) return false;
  switch (source.kind) {
    case SourceKind::Lamp: return scene.lamps[source.index].desc.caustics != 0;
    case SourceKind::Triangle: return true;
    case SourceKind::World: return scene.world.caustics;
    default: return false;
  }
}

// Whether a photon with this history (events before the rough one it has reached) is left there.
inline bool photon_is_left(int carry, int sharp_events, int rough_events) {
  switch (carry) {
    case OPAL_CARRY_CAUSTICS: return rough_events == 0 && sharp_events > 0;
    case OPAL_CARRY_INDIRECT: return rough_events + sharp_events > 0;
    case OPAL_CARRY_ALL: return true;
    default: return false;
  }
}

// The film's pass that takes what a photon with this history brings, seen at first hand.
inline int32_t photon_pass(int sharp_events, int rough_events) {
  if (rough_events > 0) return OPAL_PASS_INDIRECT;
  return sharp_events > 0 ? OPAL_PASS_CAUSTICS : OPAL_PASS_DIRECT;
}

// Whether photons go on after a rough event.
inline bool photon_goes_on(int carry) { return carry == OPAL_CARRY_INDIRECT || carry == OPAL_CARRY_ALL; }

// For a camera path: light from `source` arrives at an event of class `event`; `after_rough` says whether a rough event
// lies between there and the camera. True: photons bring it, the path must not.
inline bool brought_by_photons(const Scene &scene, int carry, EventClass event, bool after_rough, const SourceId &source) {
  if (!source_emits_photons(scene, carry, source)) return false;
  if (event == EventClass::Rough) return carry == OPAL_CARRY_ALL || (carry == OPAL_CARRY_INDIRECT && after_rough);
  return after_rough;
}

// Whether camera paths go on after a rough event, or photons bring everything that would be found. Nothing emits the light
// of glowing media as photons: where there are such, paths go on for that light alone.
inline bool camera_goes_on_after_rough(const Scene &scene, int carry) {
  return carry == OPAL_CARRY_CAUSTICS || carry == OPAL_CARRY_NONE || scene.any_glowing_medium;
}
// Whether photons are looked up after this many rough events: those that bring all indirect light serve the first alone.
inline bool gathers_after_rough(int carry, uint32_t rough_events) { return carry == OPAL_CARRY_CAUSTICS || rough_events == 0; }

}  // namespace opal
