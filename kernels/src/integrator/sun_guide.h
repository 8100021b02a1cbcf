// SPDX-License-Identifier: GPL-3.0-or-later
// Where light is likely to come from that a medium scatters out of a sun's beam.
//
// Drops and haze scatter forward: most of what is scattered once comes from round the sun, in an aureole as narrow as the phase
// function's forward lobe. A path that chooses its directions by its own phase function or surface alone looks there rarely and
// then finds much, which shows as bright specks. A part of the paths is therefore sent where the *next* event would scatter the
// sun into them: by the phase function about the sun's direction. One-sample multiple importance joins the two (Veach 1997,
// section 9.2.4).
#pragma once

#include "lights/light_tables.h"
#include "media/segment.h"

namespace opal {

class SunGuide {
 public:
  SunGuide() = default;  // no part in anything
  // In a medium; at most the part `most` of the paths, all of it where the suns give all light.
  SunGuide(const LightTables *lights, const MediumHere &here, const Wavelengths &w, float most) {
    if (!lights || lights->suns.empty() || !here.scatters() || !(most > 0)) return;
    float forward = 0;
    for (const MediumHere::Scatterer &part : here.parts) forward = std::max(forward, part.phase->value(w.nm[0], 1));
    if (forward < kPeaked / (4 * kPi) || forward > kBeam / (4 * kPi)) return;
    lights_ = lights, here_ = &here, part_ = most * lights->sun_share;
  }

  float part() const { return part_; }

  // A direction, `pick` choosing the sun.
  Vec3 sample(const Wavelengths &w, float pick, Vec2 u) const {
    const auto &suns = lights_->suns;
    size_t i = 0;
    for (; i + 1 < suns.size() && pick >= suns[i].share; ++i) pick -= suns[i].share;
    float density;
    return here_->sample_phase(w, suns[i].toward, std::min(std::max(pick, 0.0f) / suns[i].share, 1.0f), u, density);
  }
  // 1/sr at every wavelength: what sample() does at the hero.
  Spectrum density(const Wavelengths &w, const Vec3 &direction) const {
    Spectrum sum(0.0f);
    for (const LightTables::Sun &sun : lights_->suns) sum += here_->phase_value(w, dot(sun.toward, direction)) * sun.share;
    return sum;
  }
  // The density of choosing a direction by it or else with density `other`.
  Spectrum joined(const Wavelengths &w, const Vec3 &direction, const Spectrum &other) const {
    return part_ > 0 ? other * (1 - part_) + density(w, direction) * part_ : other;
  }

 private:
  // Times isotropic, straight on: flatter ones need no guide, and where the lobe is a beam (Henyey and Greenstein's from 0.87
  // on) it brings nothing: light then turns by many small steps.
  static constexpr float kPeaked = 3, kBeam = 100;

  const LightTables *lights_ = nullptr;
  const MediumHere *here_ = nullptr;
  float part_ = 0;
};

}  // namespace opal
