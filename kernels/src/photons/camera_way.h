// SPDX-License-Identifier: GPL-3.0-or-later
// The media along a camera ray, as light that photons bring comes along it: transmittance and coefficients at every distance.
// In closed form where there is one; other media by one walk, which serves every photon near the ray.
#pragma once

#include "media/stratified.h"
#include "photons/transmittance_steps.h"

#include <optional>
#include <vector>

namespace opal {

class CameraWay {
 public:
  // `media` has to outlive the way.
  explicit CameraWay(const StratifiedMedia &media) : stratified_(&media) {}
  // Media that vary, up to t_end.
  CameraWay(const Scene &scene, const MediumSet &media, const Wavelengths &w, const Ray &ray, float t_end, RandomStream random)
      : varying_(std::in_place, scene, media, w, ray) {
    RayMedia walked(scene, media, w, ray);
    transmittance_steps(walked, t_end, random, [&](float, float to, const Spectrum &through) {
      ends_.push_back(to);
      through_.push_back(through);
    });
  }
  CameraWay(const CameraWay &) = delete;

  // From distance t to the eye.
  Spectrum transmittance(float t) const {
    if (stratified_) return stratified_->transmittance(t);
    const size_t i = size_t(std::upper_bound(ends_.begin(), ends_.end(), t) - ends_.begin());
    return i < ends_.size() ? through_[i] : Spectrum(0.0f);
  }
  // Coefficients at distance t; valid until asked again.
  const MediumHere &at(float t) const {
    if (stratified_) return stratified_->at(t, scratch_);
    return scratch_ = varying_->at(t);
  }
  // The extinction by which places along the ray are best chosen; 0 where that is not known.
  float falloff() const { return stratified_ && stratified_->homogeneous() ? stratified_->mean_extinction(0) : 0.0f; }

 private:
  const StratifiedMedia *stratified_ = nullptr;
  mutable MediumHere scratch_;
  std::optional<RayMedia> varying_;
  std::vector<float> ends_;  // of the pieces over which the transmittance is constant
  std::vector<Spectrum> through_;
};

}  // namespace opal
