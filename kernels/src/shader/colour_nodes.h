// SPDX-License-Identifier: GPL-3.0-or-later
// The colour nodes as functions: Mix's blend modes, hue and saturation, invert, gamma, brightness and contrast.
//
// Colours are linear Rec.709, as in Cycles; hue, saturation, value and lightness are the hexcone models of Smith 1978.
#pragma once

#include "core/vec.h"
#include "opal_shader.h"

namespace opal {

Vec3 rgb_to_hsv(const Vec3 &rgb);
Vec3 hsv_to_rgb(const Vec3 &hsv);
Vec3 rgb_to_hsl(const Vec3 &rgb);
Vec3 hsl_to_rgb(const Vec3 &hsl);

Vec3 blend(int mode, float factor, const Vec3 &a, const Vec3 &b);
Vec3 hue_saturation(float factor, const Vec3 &color, float hue, float saturation, float value);
Vec3 gamma_correct(const Vec3 &color, float gamma);
Vec3 bright_contrast(const Vec3 &color, float bright, float contrast);
float srgb_to_linear(float encoded);

}  // namespace opal
