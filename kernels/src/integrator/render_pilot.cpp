// SPDX-License-Identifier: GPL-3.0-or-later
// What a render learns before its first pass: where photons are worth sending, and where camera paths are. The same for every
// pass, and for every machine that has a share of them.
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "integrator/path_tracer.h"
#include "integrator/render.h"
#include "lights/light_tables.h"

namespace opal {
namespace {

constexpr uint32_t kPilotPhotons = 1u << 16;  // in the first round of those that learn where to emit
constexpr uint32_t kPlanPhotons = 1u << 14;   // in each of the two halves that the plan compares
// The pilot's camera paths are counted from here, far above those of any pass.
constexpr uint32_t kPilotSample = 0x80000000u;

// One pixel's paths: their mean, and the variance of one.
struct PilotPixel {
  Vec3 mean;
  float variance = 0;
};

PilotPixel look_through(const PassContext &pass, uint32_t x, uint32_t y, RayCounts &counts) {
  Vec3 sum, squares;
  for (uint32_t s = 0; s < kPilotPaths; ++s) {
    const PathLight light = trace_camera_path(pass, x, y, kPilotSample + s, counts);
    const Vec3 rgb = light.emission + light.direct + light.indirect + light.caustics + light.medium;
    sum += rgb, squares += rgb * rgb;
  }
  const Vec3 mean = sum / float(kPilotPaths), spread = squares / float(kPilotPaths) - mean * mean;
  return {mean, std::max(0.0f, (spread.x + spread.y + spread.z) / 3) * (kPilotPaths / (kPilotPaths - 1.0f))};
}

// The whole frame is looked at whatever the region: a part rendered again is the same to the bit.
opal_render_settings of_whole_frame(opal_render_settings settings) {
  settings.region[0] = settings.region[1] = 0, settings.region[2] = settings.width, settings.region[3] = settings.height;
  return settings;
}

// With fewer photons fewer are gathered, so that one estimate blurs no wider: the passes' mean makes up for its noise.
void scale_photons(opal_render_settings &settings, double factor) {
  constexpr int kFewest = 4;
  settings.photons_per_pass = std::max(1, int(settings.photons_per_pass * factor));
  if (settings.volume_photons > 0) settings.volume_photons = std::max(1, int(settings.volume_photons * factor));
  if (factor < 1) settings.gather = std::min(settings.gather, std::max(kFewest, int(settings.gather * factor)));
}

float mean_square(const Vec3 &v) { return (sqr(v.x) + sqr(v.y) + sqr(v.z)) / 3; }

}  // namespace

bool Render::learn_emission() {
  const Stopwatch start;
  const uint32_t first_round = std::min(kPilotPhotons, uint32_t(settings_.photons_per_pass)), n = 3 * first_round;
  const opal_render_settings settings = of_whole_frame(settings_);
  PassContext pass(scene_, settings, filter_, 0);
  const PhotonTask task{n, kStreamPilot, true, scene_.any_medium};
  std::vector<EmissionTrial> trials;
  std::unique_ptr<EmissionGuide> guide;
  for (const uint32_t end : {first_round, n}) {
    const uint32_t begin = uint32_t(trials.size());
    trials.resize(end);
    const bool complete = parallel_for(int64_t(end - begin + 255) / 256, threads_, cancelled_, [&](int64_t i) {
      const uint32_t first = begin + uint32_t(i) * 256;
      try_photons(pass, task, first, std::min(end, first + 256), trials.data());
    });
    if (!complete || cancelled_) return false;
    guide = std::make_unique<EmissionGuide>(trials, scene_.lights->to_casters.cdf);
    pass.guide = guide.get();
  }
  guide_ = std::move(guide);
  statistics_.photon_seconds += start.seconds();
  return true;
}

// Two photon maps of the same size lie beside the same camera paths: what differs between the two is the photons' noise alone.
bool Render::plan_work() {
  const opal_render_statistics before = statistics_;
  const Stopwatch start;
  opal_render_settings settings = of_whole_frame(settings_);
  const int frame_width = settings.width, frame_height = settings.height;
  const int blocks_x = (frame_width + kPlanBlock - 1) / kPlanBlock, blocks_y = (frame_height + kPlanBlock - 1) / kPlanBlock;
  std::vector<PilotBlock> blocks(size_t(blocks_x) * size_t(blocks_y));
  const bool photons = wants_photons();
  if (photons) scale_photons(settings, std::min(1.0, double(kPlanPhotons) / settings_.photons_per_pass));
  const uint32_t n_photons = uint32_t(settings.photons_per_pass);
  const uint32_t apart = scene_.any_medium ? uint32_t(settings.volume_photons) : 0;
  int64_t photon_rays = 0;

  std::vector<PassContext> passes;
  passes.reserve(2);
  for (uint32_t half = 0; half < (photons ? 2u : 1u); ++half) {
    PassContext &pass = passes.emplace_back(scene_, settings, filter_, 0);
    if (!photons) continue;
    pass.guide = guide_.get();
    std::vector<PhotonChunk> chunks;
    if (!run_task(pass, {n_photons, kStreamPlan + half, true, apart == 0}, 0, 0, chunks)) return false;
    if (apart && !run_task(pass, {apart, kStreamPlan + 2 + half, false, true}, 0, 0, chunks)) return false;
    for (const PhotonChunk &chunk : chunks) {
      photon_rays += chunk.rays;
      for (const Splat &splat : chunk.splats) {
        const int x = int(splat.pixel) % frame_width, y = int(splat.pixel) / frame_width;
        PilotBlock &block = blocks[size_t(y / kPlanBlock * blocks_x + x / kPlanBlock)];
        constexpr float kShare = 0.5f / (kPlanBlock * kPlanBlock);  // of one of two halves, in one pixel
        block.brightness += splat.rgb * kShare;
        block.photon_variance += mean_square(splat.rgb) * kShare * float(n_photons);
      }
    }
    build_maps(pass, chunks);
  }

  const bool complete = parallel_for(int64_t(blocks.size()), threads_, cancelled_, [&](int64_t i) {
    PilotBlock &block = blocks[size_t(i)];
    const int x0 = int(i % blocks_x) * kPlanBlock, y0 = int(i / blocks_x) * kPlanBlock;
    RayCounts counts;
    for (int k = 0; k < kPilotPixels; ++k) {
      const uint32_t h = hash32(hash32(settings_.seed, uint32_t(i)), uint32_t(k));
      constexpr int kQuarter = kPlanBlock / 2;
      const int x = std::min(frame_width - 1, x0 + (k & 1) * kQuarter + int(h % kQuarter));
      const int y = std::min(frame_height - 1, y0 + (k >> 1) * kQuarter + int((h >> 8) % kQuarter));
      PilotPixel found[2];
      for (size_t half = 0; half < passes.size(); ++half)
        found[half] = look_through(passes[half], uint32_t(x), uint32_t(y), counts);
      block.brightness += found[0].mean / float(kPilotPixels);
      block.path_variance += found[0].variance / float(kPilotPixels);
      if (photons)
        block.photon_variance += 0.5f * mean_square(found[0].mean - found[1].mean) * float(n_photons) / float(kPilotPixels);
    }
    block.rays = float(counts.path + counts.shadow) / float(kPilotPixels * kPilotPaths * passes.size());
  });
  if (!complete || cancelled_) return false;

  const float rays_of_photon = photons ? float(photon_rays) / float(2 * (n_photons + apart)) : 0.0f;
  plan_ = WorkPlan(blocks, blocks_x, settings_.samples_per_pass, photons ? settings_.photons_per_pass : 0, rays_of_photon);
  if (photons) scale_photons(settings_, double(plan_.photons()) / double(settings_.photons_per_pass));
  statistics_ = before;
  statistics_.pilot_seconds += start.seconds();
  return true;
}

}  // namespace opal
