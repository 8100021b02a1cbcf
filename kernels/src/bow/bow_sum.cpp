// SPDX-License-Identifier: GPL-3.0-or-later
// The C door of opal_bow.h: the light of many sizes of drops from a few folds.
#include "opal_bow.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

constexpr int kCurves = 5;

// Where a place counted in points lies: the point before, and how far it is beyond.
struct Place {
  int before;
  double beyond;
  Place(double at, int points) : before(std::min(int(at), points - 2)), beyond(at - before) {}
};

// One size's fold: the mean of two, its curves side by side so that one place asks for one line of memory.
class SizedFold {
 public:
  SizedFold(const OpalFolds &f, double place)
      : folds_(f), points_(f.n_dark + f.n_points), curves_(size_t(points_) * kCurves), single_(size_t(f.n_single) * 2) {
    const int low = std::clamp(int(place), 0, std::max(f.n_folds - 2, 0)), high = std::min(low + 1, f.n_folds - 1);
    const double t = std::clamp(place - low, 0.0, 1.0);
    const auto mean = [&](const double *of, int count, int i) {
      const double a = of[size_t(low) * size_t(count) + size_t(i)], b = of[size_t(high) * size_t(count) + size_t(i)];
      return a + t * (b - a);
    };
    for (int c = 0; c < kCurves; ++c)
      for (int i = 0; i < points_; ++i) curves_[size_t(i * kCurves + c)] = mean(f.curves, points_ * kCurves, c * points_ + i);
    for (int c = 0; c < 2; ++c)
      for (int i = 0; i < f.n_single; ++i) single_[size_t(i * 2 + c)] = mean(f.single, f.n_single * 2, c * f.n_single + i);
    last = mean(f.ends, 3, 0), begin_ = mean(f.ends, 3, 1), end_ = mean(f.ends, 3, 2);
  }

  // Sums and differences of both polarisations, and the scale of zeta, at delta <= last.
  void two_rays(double delta, double out[kCurves]) const {
    const Place p(std::clamp(point(delta), 0.0, double(points_ - 1)), points_);
    const double *a = &curves_[size_t(p.before) * kCurves];
    for (int c = 0; c < kCurves; ++c) out[c] = a[c] + p.beyond * (a[c + kCurves] - a[c]);
  }

  void one_ray(double delta, double out[2]) const {
    const double along = std::clamp((delta - begin_) / std::max(end_ - begin_, 1e-12), 0.0, 1.0);
    const Place p(along * (folds_.n_single - 1), folds_.n_single);
    const double *a = &single_[size_t(p.before) * 2];
    for (int c = 0; c < 2; ++c) out[c] = a[c] + p.beyond * (a[c + 2] - a[c]);
  }

  double last;

 private:
  double point(double delta) const {
    if (delta < 0) return delta / folds_.dark * folds_.n_dark + folds_.n_dark;
    const double b = folds_.shortest, root = std::sqrt(std::min(delta / last, 1.0));
    const double s = (std::sqrt(b * b + 4 * (1 - b) * root) - b) / (2 * (1 - b));
    return folds_.n_dark + std::max(s * folds_.n_points - 1, 0.0);
  }

  const OpalFolds &folds_;
  int points_;
  double begin_, end_;
  std::vector<double> curves_, single_;
};

void add(const OpalFolds &f, const OpalAirySquares &airy, const SizedFold &fold, double caustic, double x, double share,
         double shadow, int n_angles, const double *angles, double *out) {
  const double larger = std::cbrt(x * x), per_step = 1 / airy.step, most = airy.n - 1;
  for (int i = 0; i < n_angles; ++i) {
    const double delta = f.side * (angles[i] - caustic);
    if (delta < -shadow) continue;
    double seen[2];
    if (delta > fold.last) {
      fold.one_ray(delta, seen);
    } else {
      double c[kCurves];
      fold.two_rays(delta, c);
      const double scale = larger * c[4], root = std::sqrt(scale);
      const Place z(std::clamp((scale * delta - airy.first) * per_step, 0.0, most), airy.n);
      const double *v = airy.value + z.before, *d = airy.slope + z.before;
      const double value = M_PI * root * (v[0] + z.beyond * (v[1] - v[0]));
      const double slope = M_PI / root * (d[0] + z.beyond * (d[1] - d[0]));
      seen[0] = c[0] * value + c[2] * slope, seen[1] = c[1] * value + c[3] * slope;
    }
    out[i] += share * seen[0], out[n_angles + i] += share * seen[1];
  }
}

}  // namespace

extern "C" int32_t opal_bow_sum(const OpalFolds *folds, const OpalAirySquares *airy, int32_t n_sizes, const double *place,
                                const double *angle, const double *x, const double *share, const double *shadow,
                                int32_t n_angles, const double *angles, double *out) {
  if (!folds || !airy || !folds->curves || !folds->ends || !folds->single || !airy->value || !airy->slope || !place || !angle ||
      !x || !share || !shadow || !angles || !out || n_sizes < 0 || n_angles < 0)
    return OPAL_ERROR_ARGUMENT;
  if (folds->n_folds < 1 || folds->n_dark < 1 || folds->n_points < 2 || folds->n_single < 2 || !(folds->dark > 0) ||
      !(folds->shortest > 0 && folds->shortest < 1) || airy->n < 2 || !(airy->step > 0))
    return OPAL_ERROR_ARGUMENT;
  for (int32_t i = 0; i < n_sizes; ++i)
    if (!std::isfinite(place[i]) || !std::isfinite(angle[i]) || !(x[i] > 0)) return OPAL_ERROR_ARGUMENT;
  try {
    std::fill_n(out, 2 * size_t(n_angles), 0.0);
    for (int32_t i = 0; i < n_sizes; ++i)
      add(*folds, *airy, SizedFold(*folds, place[i]), angle[i], x[i], share[i], shadow[i], n_angles, angles, out);
  } catch (...) {  // only an allocation can fail
    return OPAL_ERROR_MEMORY;
  }
  return OPAL_OK;
}
