// SPDX-License-Identifier: GPL-3.0-or-later
// A render: settings, film, and the running of passes on all threads.
#pragma once

#include "integrator/pass.h"
#include "integrator/work_plan.h"
#include "photons/photon_tracer.h"

#include <atomic>
#include <memory>
#include <mutex>

namespace opal {

// What photons splat in a pass, by kind of light; empty without photons.
struct SplatSums {
  std::vector<Vec3> direct, indirect, caustics;
};

class Render {
 public:
  Render(const Scene &scene, const opal_render_settings &settings);

  // False when cancelled; the film is then as before.
  bool render_pass(int number);
  void cancel() { cancelled_ = true; }
  float progress() const { return progress_.load(std::memory_order_relaxed); }
  bool read(int pass, float *out) const;
  bool read_sums(int pass, double *out) const;
  int depth_pass() const;
  float noise() const;
  opal_render_statistics statistics() const;

 private:
  // What is learnt before the first pass (render_pilot.cpp); false when cancelled.
  bool learn_emission();
  bool plan_work();
  bool trace_photons_of(PassContext &pass, PassBuffer &buffer, SplatSums &splats);
  bool run_task(const PassContext &pass, const PhotonTask &task, float from, float to, std::vector<PhotonChunk> &chunks);
  void build_maps(PassContext &pass, std::vector<PhotonChunk> &chunks);
  bool trace_camera_of(const PassContext &pass, PassBuffer &buffer, const SplatSums &splats);
  bool wants_photons() const;
  int width() const { return settings_.region[2] - settings_.region[0]; }
  int height() const { return settings_.region[3] - settings_.region[1]; }

  const Scene &scene_;
  opal_render_settings settings_;
  const PixelFilter filter_;
  const int threads_;
  mutable std::mutex film_mutex_;
  Film film_;
  opal_render_statistics statistics_{};
  std::unique_ptr<EmissionGuide> guide_;
  WorkPlan plan_;
  std::atomic<bool> cancelled_{false};
  std::atomic<float> progress_{0};
};

}  // namespace opal
