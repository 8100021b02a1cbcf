// SPDX-License-Identifier: GPL-3.0-or-later
#include "media/density.h"

#include "shader/noise.h"

namespace opal {
namespace {

// exp(-40) is 4e-18: above forty scale heights there is nothing left to meet.
constexpr float kHighest = 40;

}  // namespace

float DensityField::at(const Vec3 &p, const Grid *of) const {
  switch (kind) {
    case DensityKind::Homogeneous: return 1;
    case DensityKind::Grid: return of ? of->value(of->to_lattice().point(p)) : 0.0f;
    case DensityKind::Height: {
      const float above = (p.z - base_height) / scale_height;
      return above <= 0 ? 1.0f : above >= kHighest ? 0.0f : std::exp(-above);
    }
    case DensityKind::Noise: {
      Fractal fractal;
      fractal.detail = noise_detail;
      const Vec3 q = p / noise_scale + noise_offset;
      return saturate(0.5f + noise_contrast * (fractal_noise(fractal, Point<3>{{q.x, q.y, q.z}}) - 0.5f));
    }
  }
  return 0;
}

MajorantSteps::MajorantSteps(const DensityField &field, const Grid *grid, const Vec3 &origin, const Vec3 &direction)
    : kind_(field.kind), grid_(grid) {
  switch (kind_) {
    case DensityKind::Homogeneous: break;
    case DensityKind::Noise:
      majorant_ = saturate(0.5f + 0.5f * std::abs(field.noise_contrast));
      mean_ = 0.5f;
      break;
    case DensityKind::Height:
      z_ = origin.z, slope_ = direction.z, scale_ = field.scale_height, base_ = field.base_height;
      end_ = 0;
      advance_height();
      break;
    case DensityKind::Grid: {
      leave_grid();
      if (!grid_ || !(grid_->majorant() > 0)) break;
      const Vec3 o = grid_->to_lattice().point(origin), d = grid_->to_lattice().vector(direction);
      float enter = 0;
      exit_ = kInfinity;
      for (int a = 0; a < 3; ++a) {
        const float high = float(grid_->bricks(a) * Grid::kCells);
        if (d[a] == 0) {
          if (!(o[a] >= 0 && o[a] < high)) return;
          continue;
        }
        const float t0 = -o[a] / d[a], t1 = (high - o[a]) / d[a];
        enter = std::max(enter, std::min(t0, t1)), exit_ = std::min(exit_, std::max(t0, t1));
      }
      if (!(enter < exit_)) return;
      stride_ = float(Grid::kCells) / std::max(length(d), 1e-30f);
      const Vec3 start = o + d * enter;
      for (int a = 0; a < 3; ++a) {
        at_[a] = std::clamp(int(std::floor(start[a] / Grid::kCells)), 0, grid_->bricks(a) - 1);
        step_[a] = d[a] > 0 ? 1 : -1;
        delta_[a] = d[a] != 0 ? float(Grid::kCells) / std::abs(d[a]) : kInfinity;
        next_[a] = d[a] != 0 ? (float((at_[a] + (d[a] > 0 ? 1 : 0)) * Grid::kCells) - o[a]) / d[a] : kInfinity;
      }
      if (enter > 0) end_ = enter, waiting_ = true;  // empty space up to the grid
      else show_brick();
      break;
    }
  }
}

void MajorantSteps::leave_grid() { end_ = kInfinity, majorant_ = mean_ = 0, at_[0] = -1; }

void MajorantSteps::advance() {
  if (kind_ == DensityKind::Grid) advance_grid();
  else if (kind_ == DensityKind::Height) advance_height();
  else end_ = kInfinity;
}

void MajorantSteps::show_brick() {
  const Grid::Brick &brick = grid_->brick(at_[0], at_[1], at_[2]);
  majorant_ = brick.majorant, mean_ = brick.mean;
  end_ = std::min({next_[0], next_[1], next_[2], exit_});
}

bool MajorantSteps::step_brick() {
  const int axis = next_[0] < next_[1] ? (next_[0] < next_[2] ? 0 : 2) : (next_[1] < next_[2] ? 1 : 2);
  at_[axis] += step_[axis];
  const bool inside = at_[axis] >= 0 && at_[axis] < grid_->bricks(axis) && next_[axis] < exit_;
  next_[axis] += delta_[axis];
  return inside;
}

void MajorantSteps::advance_grid() {
  if (at_[0] < 0) return leave_grid();
  if (waiting_) {
    waiting_ = false;
    return show_brick();
  }
  if (!step_brick()) return leave_grid();
  show_brick();
  // Empty bricks are passed in one interval, up to the next that is not.
  for (float end = end_; majorant_ == 0; end = end_) {
    if (!step_brick()) return leave_grid();
    if (grid_->brick(at_[0], at_[1], at_[2]).majorant > 0) {
      end_ = end, waiting_ = true;
      return;
    }
    show_brick();
  }
}

void MajorantSteps::advance_height() {
  const float begin = end_;
  const float z = z_ + slope_ * begin;
  const auto density = [&](float height) {
    const float above = (height - base_) / scale_;
    return above <= 0 ? 1.0f : std::exp(-above);
  };
  if (slope_ == 0) {
    majorant_ = mean_ = density(z), end_ = kInfinity;
    return;
  }
  const float above = (z - base_) / scale_;
  float far;
  if (slope_ > 0) far = above < 0 ? base_ : above >= kHighest ? kInfinity : z + 0.5f * scale_;
  else far = above <= 1e-4f ? -kInfinity : above > kHighest ? base_ + kHighest * scale_ : std::max(base_, z - 0.5f * scale_);
  end_ = std::isfinite(far) ? std::max((far - z_) / slope_, std::nextafter(begin, kInfinity)) : kInfinity;
  const float low = slope_ > 0 ? z : z_ + slope_ * end_;
  majorant_ = above >= kHighest && slope_ > 0  ? 0.0f
              : slope_ < 0 && above > kHighest ? 0.0f
                                               : density(std::isfinite(low) ? low : base_);
  mean_ = std::isfinite(end_) ? 0.5f * (density(z) + density(z_ + slope_ * end_)) : majorant_;
}

}  // namespace opal
