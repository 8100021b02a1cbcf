// SPDX-License-Identifier: GPL-3.0-or-later
// See aim.h.
#include "lights/aim.h"

#include "lights/directions.h"

namespace opal {

DirectionAim::DirectionAim(const Vec3 &x, const Emitter &emitter, const std::vector<EmissionTarget> &targets, float grow)
    : emitter_(emitter) {
  const bool limited = emitter.cone_omc < 2;
  for (const EmissionTarget &target : targets) {
    if (count_ == kMostTargets) break;
    const Vec3 to_target = target.centre - x;
    const float d2 = length_squared(to_target), radius = target.radius + grow;
    Part part{emitter.axis, 2, 1, true};
    if (d2 > sqr(radius)) {
      const float d = std::sqrt(d2);
      part = {to_target / d, one_minus_cos_from_sin2(sqr(radius) / d2), 0, false};
      const float spread = std::acos(1 - part.omc);
      if (limited) {
        // Nothing is sent there, or the emitter's own cone is the narrower one.
        const float reach = std::acos(1 - emitter.cone_omc);
        const float apart = std::acos(clamp(dot(part.axis, emitter.axis), -1, 1));
        if (apart > reach + spread + 1e-3f) continue;
        if (emitter.cone_omc < part.omc) part.whole = true, part.omc = emitter.cone_omc;
      }
      float cosine = 1;
      if (emitter.kind != Emitter::Kind::Everywhere) {
        cosine = dot(part.axis, emitter.axis);
        if (emitter.kind == Emitter::Kind::TwoSided) cosine = std::abs(cosine);
        cosine += std::sin(spread);  // the highest in the cone, nearly
        if (cosine <= 0) continue;
        cosine = clamp(cosine, 0.05f, 1.0f);
      }
      part.weight = cone_solid_angle(part.omc) * cosine;
      // A target that fills most of the view is no better than the emitter's own distribution.
      if (emitter.kind != Emitter::Kind::Everywhere && part.omc > 0.7f) part.whole = true;
    }
    if (part.whole && d2 <= sqr(radius))
      part.weight = emitter.kind == Emitter::Kind::Everywhere ? cone_solid_angle(emitter.cone_omc)
                    : emitter.kind == Emitter::Kind::OneSided ? kPi
                                                              : 2 * kPi;
    parts_[count_++] = part;
    total_ += part.weight;
  }
}

float DirectionAim::density(const Part &part, const Vec3 &d) const {
  if (!part.whole) return in_cone(d, part.axis, part.omc) ? 1 / cone_solid_angle(part.omc) : 0.0f;
  const float cosine = dot(d, emitter_.axis);
  if (emitter_.cone_omc < 2)
    return in_cone(d, emitter_.axis, emitter_.cone_omc) ? 1 / cone_solid_angle(emitter_.cone_omc) : 0.0f;
  switch (emitter_.kind) {
    case Emitter::Kind::OneSided: return std::max(cosine, 0.0f) * kInvPi;
    case Emitter::Kind::TwoSided: return std::abs(cosine) * 0.5f * kInvPi;
    default: return 1 / kFourPi;
  }
}

float DirectionAim::pdf(const Vec3 &d) const {
  float sum = 0;
  for (int i = 0; i < count_; ++i) sum += parts_[i].weight * density(parts_[i], d);
  return sum / total_;
}

bool DirectionAim::sample(float pick, Vec2 u, Vec3 &direction, float &pdf) const {
  if (!(total_ > 0)) return false;
  float x = pick * total_;
  int i = 0;
  while (i + 1 < count_ && x >= parts_[i].weight) x -= parts_[i++].weight;
  const Part &part = parts_[i];
  if (!part.whole) direction = sample_cone(Frame::from_z(part.axis), part.omc, u);
  else if (emitter_.cone_omc < 2) direction = sample_cone(Frame::from_z(emitter_.axis), emitter_.cone_omc, u);
  else if (emitter_.kind == Emitter::Kind::Everywhere) direction = sample_sphere(u);
  else {
    const bool behind = emitter_.kind == Emitter::Kind::TwoSided && u.x >= 0.5f;
    if (emitter_.kind == Emitter::Kind::TwoSided) u.x = behind ? reuse_above(u.x, 0.5f) : reuse_below(u.x, 0.5f);
    direction = sample_cosine(Frame::from_z(behind ? -emitter_.axis : emitter_.axis), u);
  }
  direction = normalize(direction);
  // The part it came from holds the direction whatever rounding says.
  float sum = 0;
  for (int k = 0; k < count_; ++k) {
    const float own = k == i && !part.whole ? 1 / cone_solid_angle(part.omc) : density(parts_[k], direction);
    sum += parts_[k].weight * own;
  }
  pdf = sum / total_;
  return pdf > 0;
}

ParallelAim::ParallelAim(const Vec3 &direction, const std::vector<EmissionTarget> &targets)
    : frame_(Frame::from_z(direction)), targets_(targets) {
  for (const EmissionTarget &t : targets) total_ += kPi * sqr(t.radius);
}

bool ParallelAim::sample(float pick, Vec2 u, Vec3 &point, float &pdf) const {
  if (!(total_ > 0)) return false;
  float x = pick * total_;
  size_t i = 0;
  while (i + 1 < targets_.size() && x >= kPi * sqr(targets_[i].radius)) x -= kPi * sqr(targets_[i++].radius);
  const Vec2 q = sample_disc(u);
  const EmissionTarget &target = targets_[i];
  point = target.centre + (frame_.x * q.x + frame_.y * q.y) * target.radius;
  int holding = 0;
  for (size_t k = 0; k < targets_.size(); ++k) {
    const Vec3 o = point - targets_[k].centre;
    holding += k == i || sqr(dot(o, frame_.x)) + sqr(dot(o, frame_.y)) <= sqr(targets_[k].radius);
  }
  pdf = float(holding) / total_;
  return true;
}

}  // namespace opal
