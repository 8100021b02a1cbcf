// SPDX-License-Identifier: GPL-3.0-or-later
// The C interface: renders and films.
#include "api/guarded.h"

namespace {

using namespace opal;

}  // namespace

extern "C" {

opal_render *opal_render_create(opal_scene *scene, const opal_render_settings *settings) {
  opal_render *render = nullptr;
  const int32_t status = guarded([&] {
    require(scene && settings, "No scene or settings");
    require(scene->top && !scene->geometry_dirty && !scene->instances_dirty && !scene->lights_dirty,
            "The scene was not committed");
    require(scene->has_camera, "The scene has no camera");
    const opal_render_settings &s = *settings;
    require(s.width > 0 && s.height > 0 && int64_t(s.width) * s.height < int64_t(kStreamPhotons),
            "The resolution is out of range");
    require(s.region[0] >= 0 && s.region[1] >= 0 && s.region[2] <= s.width && s.region[3] <= s.height &&
                s.region[0] < s.region[2] && s.region[1] < s.region[3],
            "The region to render is empty or lies outside the frame");
    require(s.samples_per_pass > 0, "A pass needs at least one sample");
    require(s.photons_per_pass >= 0 && s.photons_carry >= 0 && s.photons_carry <= OPAL_CARRY_NONE,
            "The photon settings are out of range");
    require(s.volume_estimate >= OPAL_VOLUME_POINTS && s.volume_estimate <= OPAL_VOLUME_BEAMS && s.volume_photons >= 0 &&
                std::isfinite(s.volume_radius) && s.volume_radius >= 0 && s.march_steps >= 1 && s.march_steps <= 256 &&
                s.march_tolerance >= 0,
            "The settings of photons in media are out of range");
    require(s.wavelength_first >= 360 && s.wavelength_last <= 830 && s.wavelength_last - s.wavelength_first >= 1,
            "The wavelengths must lie between 360 and 830 nm, at least 1 nm apart");
    require(s.spectral_bins >= 0 && s.spectral_bins <= 1000, "Between 0 and 1000 spectral bins are possible");
    if (s.wavelength_first != scene->colour.first_nm || s.wavelength_last != scene->colour.last_nm)
      scene->set_wavelengths(s.wavelength_first, s.wavelength_last);
    render = new opal_render(*scene, s);
    return 0;
  });
  return status == OPAL_OK ? render : nullptr;
}

void opal_render_destroy(opal_render *render) { delete render; }

int32_t opal_render_pass(opal_render *render, int32_t pass) {
  return guarded([&] {
    require(render && pass >= 0, "No such pass");
    if (!render->render_pass(pass)) return fail(OPAL_ERROR_CANCELLED, "Cancelled");
    return 0;
  });
}

void opal_render_cancel(opal_render *render) {
  if (render) render->cancel();
}

float opal_render_progress(const opal_render *render) { return render ? render->progress() : 0.0f; }

int32_t opal_film_read(const opal_render *render, int32_t pass, float *out) {
  return guarded([&] {
    require(render && out, "No render");
    require(render->read(pass, out), "The film does not keep this pass");
    return 0;
  });
}

int32_t opal_film_read_sums(const opal_render *render, int32_t pass, double *out) {
  return guarded([&] {
    require(render && out, "No render");
    require(render->read_sums(pass, out), "The film does not keep this pass");
    return 0;
  });
}

int32_t opal_film_depth_pass(const opal_render *render) { return render ? render->depth_pass() : -1; }

float opal_film_noise(const opal_render *render) { return render ? render->noise() : -1.0f; }

int32_t opal_render_get_statistics(const opal_render *render, opal_render_statistics *out) {
  return guarded([&] {
    require(render && out, "No render");
    *out = render->statistics();
    return 0;
  });
}

}  // extern "C"
