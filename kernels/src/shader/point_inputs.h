// SPDX-License-Identifier: GPL-3.0-or-later
// What a program may ask of the point it shades: coordinates, attributes, normals, tangents, and points nearby.
#pragma once

#include "scene/scene.h"
#include "shader/registers.h"

namespace opal {

// Object <-> world at the point's time; the identity for the world.
struct PointTransforms {
  Transform to_world, to_object;
};
PointTransforms point_transforms(const ShadingPoint &sp);
// Normals the other way round: into the object's space and back, of unit length.
Vec3 normal_to_object(const ShadingPoint &sp, const Vec3 &n);
Vec3 normal_to_world(const ShadingPoint &sp, const Vec3 &n);

Vec3 generated_coordinate(const ShadingPoint &sp);
Vec3 texture_coordinate(const ShadingPoint &sp, int mode);  // OPAL_COORDINATE_*
// The attribute's value, absent components 0 and alpha 1; false where the mesh has none of that name.
bool find_attribute(const ShadingPoint &sp, int name, Float4 &value, int &components);
Float4 attribute(const ShadingPoint &sp, int name, int mode, const Float4 &fallback);
Float4 geometry_input(const ShadingPoint &sp, int mode);   // OPAL_GEOMETRY_*
Float4 object_input(const ShadingPoint &sp, int mode);     // OPAL_OBJECT_*
float light_path_input(const ShadingPoint &sp, int mode);  // OPAL_PATH_*

// Unit tangent in world space: round an axis of Generated (0 X, 1 Y, 2 Z), or along U of the UV map `uv` (3).
Vec3 tangent_input(const ShadingPoint &sp, int mode, int uv);
// The Normal Map node: a unit normal towards the viewer's side, in world space.
Vec3 normal_map(const ShadingPoint &sp, int space, const Vec3 &color, float strength, int uv, bool flip_green);

// Unpolarised Fresnel reflectance of a dielectric at the angle of cosine `c`, eta = index behind / index in front.
float fresnel_dielectric(float c, float eta);
float fresnel_input(const ShadingPoint &sp, float ior, const Vec3 &normal);
float layer_weight(const ShadingPoint &sp, bool facing, float blend, const Vec3 &normal);

// A point of the same surface displaced by `offset` in its tangent plane.
ShadingPoint displaced(const ShadingPoint &sp, const Vec3 &offset);
// How far apart the Bump node compares heights: a tenth of a pixel as the default filter width has it, taken as 2 mrad;
// never under what single precision resolves.
float bump_step(const ShadingPoint &sp, float filter_width);

}  // namespace opal
