// SPDX-License-Identifier: GPL-3.0-or-later
// The camera: film position and lens position -> ray, and a point in the scene -> film position.
//
// Film coordinates run over the full frame, (0,0) at its lower left and (1,1) at its upper right. The camera looks along
// its local -Z with Y up; opal_camera_desc::transform is a rotation and a translation (scale is removed by the caller,
// as Blender ignores a camera's scale). The thin lens focuses the plane at focus_distance, and clipping is by planes
// perpendicular to the axis, both as in Cycles.
#pragma once

#include "core/vec.h"
#include "opal.h"

namespace opal {

// A point of the aperture, uniform over its area for uniform `u`, in units of the aperture's radius along the camera's X
// and Y: a disc, or a regular polygon of `blades` corners on the unit circle, turned by blade_rotation, its x divided by
// aperture_ratio.
Vec2 sample_aperture(const opal_camera_desc &camera, Vec2 u);

// The ray through film position (x, y), from lens position `lens` (uniform in [0,1)^2) at `time` in [0,1] of the shutter.
// t_min and t_max lie on the clipping planes. False where the description is degenerate.
bool generate_ray(const opal_camera_desc &camera, float x, float y, Vec2 lens, float time, Ray &ray);

// How a point of the scene is seen. All pixels' values are means over their area, the lens and the shutter, so with
// `lens` and `time` uniform, a photon of flux F that arrives at p and is scattered towards the camera adds
//
//     F * f * |cos| * importance * (width * height)
//
// to the pixel at (film_x, film_y), where f|cos| is what bsdf_eval(..., to_camera, ..., Transport::Flux) returns and
// width x height counts the pixels of the full frame. In formulas, with A the window's area and theta the angle between
// ray and axis: perspective 1/(A cos^3(theta) d^2), A at distance 1; orthographic 1/(A cos(theta)).
struct CameraConnection {
  Vec3 to_camera;           // unit, from p
  float distance = 0;       // to the near clipping plane: how far the shadow ray goes
  float lens_distance = 0;  // to the lens: the depth of p along the ray
  float film_x = 0, film_y = 0;
  float importance = 0;
};

// False where p is outside the frame, behind the camera or clipped. `margin` widens the frame, as a fraction of its size, so
// that pixel filters reach over its border.
bool connect(const opal_camera_desc &camera, const Vec3 &p, Vec2 lens, float time, CameraConnection &out, float margin_x = 0,
             float margin_y = 0);

// Camera to world at `time`.
Transform camera_transform(const opal_camera_desc &camera, float time);

}  // namespace opal
