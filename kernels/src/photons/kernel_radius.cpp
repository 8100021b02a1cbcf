// SPDX-License-Identifier: GPL-3.0-or-later
#include "photons/kernel_radius.h"

#include "camera/camera.h"

#include <cmath>

namespace opal {

float pixel_footprint(const Scene &scene, const opal_render_settings &settings) {
  const opal_camera_desc &camera = scene.camera;
  const float pixel = (camera.window[1] - camera.window[0]) / float(settings.width);
  float distance = 1;
  if (camera.type == OPAL_CAMERA_PERSPECTIVE) {
    const Vec3 eye = camera_transform(camera, 0).origin();
    distance = kInfinity;
    for (const EmissionTarget &target : scene.casters)
      distance = std::min(distance, std::max(length(target.centre - eye), target.radius));
    if (!std::isfinite(distance)) distance = std::max(length(scene.bounds.centre() - eye), scene.bounds.radius());
  }
  return 4 * pixel * distance;
}

float radius_factor(int dimensions, float shrink, int pass) {
  // 1 - alpha is 1/5, 1/3, 3/7: 0.6, 1 and 9/7 times that of the plane.
  const double share = dimensions == 1 ? 0.6 : dimensions == 2 ? 1.0 : 9.0 / 7.0;
  const double alpha = std::max(0.01, 1 - share * (1 - double(clamp(shrink, 0.01f, 1.0f))));
  double volume = 1;
  for (int i = 1; i <= pass; ++i) volume *= (i + alpha) / (i + 1.0);
  return float(std::pow(volume, 1.0 / dimensions));
}

float surface_radius(const Scene &scene, const opal_render_settings &settings, int pass) {
  const float first = settings.radius > 0 ? settings.radius : pixel_footprint(scene, settings);
  return first * radius_factor(2, settings.radius_shrink, pass);
}

}  // namespace opal
