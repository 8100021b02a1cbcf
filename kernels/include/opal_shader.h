/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The operations of a material's register program (opal_program of opal.h).
 *
 * A register is four floats. Registers 0 .. n_constants-1 are the program's constants: they are never written, and there
 * may be as many as one likes (tables live there). The others, at most OPAL_MAX_REGISTERS, are written before they are
 * read. A number stands in all four lanes of its register, so that a number is also the grey of that number and the
 * vector of three of it; a colour or vector stands in the first three, alpha (where there is one) in the fourth.
 *
 * Every operation says below what it reads: `name` is a register, `name?` a register or -1 (then the default in brackets
 * holds), `name=` a plain integer, `name#` the first of several constant registers, `name@` the index of an image.
 * Directions and positions are in world space; angles in radians; colours linear Rec.709.
 * The operations that shade run in order; their lobes are added up. All give what Blender's node of that name gives in
 * Cycles. */
#ifndef OPAL_SHADER_H
#define OPAL_SHADER_H

#define OPAL_MAX_REGISTERS 512
#define OPAL_MAX_CONSTANTS 1048576
#define OPAL_MAX_INSTRUCTIONS 65536

/* Tables read better than one item a line. */
/* clang-format off */

typedef enum opal_op {
  /* ---- Numbers and vectors ---- */
  OPAL_OP_GREY = 0,           /* value; mode OPAL_GREY_* -> the number that a colour or vector becomes */
  OPAL_OP_MATH = 1,           /* a, b?[0], c?[0]; mode OPAL_MATH_* */
  OPAL_OP_VECTOR_MATH = 2,    /* a, b?[0], c?[0], scale?[1]; mode OPAL_VECTOR_* -> vector, or number in all lanes */
  OPAL_OP_MIX = 3,            /* factor, a, b, flags= (OPAL_MIX_FLAG_*); mode OPAL_MIX_* */
  OPAL_OP_MAP_RANGE = 4,      /* value, from_min, from_max, to_min, to_max, steps?[4], flags= (1 vector, 2 clamp); mode OPAL_RANGE_* */
  OPAL_OP_CLAMP = 5,          /* value, min, max; mode 0 min-max, 1 range (the two in any order) */
  OPAL_OP_MAPPING = 6,        /* vector, location, rotation (XYZ Euler), scale; mode OPAL_MAPPING_* */
  OPAL_OP_VECTOR_ROTATE = 7,  /* vector, center, axis?, angle?, rotation?, invert=; mode OPAL_ROTATE_* */
  OPAL_OP_TRANSFORM = 8,      /* vector, matrix# (3 rows of 4), transposed or not by mode OPAL_TRANSFORM_* */
  OPAL_OP_TO_OBJECT = 9,      /* vector; mode OPAL_TRANSFORM_*: world -> the object's space */
  OPAL_OP_TO_WORLD = 10,      /* vector; mode OPAL_TRANSFORM_*: the object's space -> world */
  OPAL_OP_SEPARATE = 11,      /* color, component= (0..3); mode OPAL_COLOR_* -> number; component 3 is alpha */
  OPAL_OP_COMBINE = 12,       /* x, y, z; mode OPAL_COLOR_* */
  OPAL_OP_PACK = 13,          /* a, b, c?[0], d?[0]; mode 0: (a.x, b.x, c.x, d.x); mode 1: (a.xyz, b.x) */

  /* ---- Colours ---- */
  OPAL_OP_HUE_SATURATION = 20, /* factor, color, hue, saturation, value */
  OPAL_OP_INVERT = 21,         /* factor, color */
  OPAL_OP_GAMMA = 22,          /* color, gamma */
  OPAL_OP_BRIGHT_CONTRAST = 23, /* color, bright, contrast */
  OPAL_OP_TABLE = 25,          /* factor, table#, size=; mode: sum of OPAL_TABLE_* -> entry of the table at factor 0..1 */

  /* ---- What is known of the point ---- */
  OPAL_OP_COORDINATE = 40, /* mode OPAL_COORDINATE_* */
  OPAL_OP_ATTRIBUTE = 41,  /* name= (opal_attribute_desc.name), fallback?[0]; mode OPAL_ATTRIBUTE_* */
  OPAL_OP_GEOMETRY = 42,   /* mode OPAL_GEOMETRY_* */
  OPAL_OP_OBJECT_INFO = 43, /* mode OPAL_OBJECT_* */
  OPAL_OP_LIGHT_PATH = 44, /* mode OPAL_PATH_* */
  OPAL_OP_FRESNEL = 45,    /* ior, normal?[shading normal] */
  OPAL_OP_LAYER_WEIGHT = 46, /* blend, normal?[shading normal]; mode 0 Fresnel, 1 facing */
  OPAL_OP_NORMAL_MAP = 47, /* color, strength, uv= (attribute name, -1: any tangents), flags= (1 flip green); mode OPAL_NORMAL_* */
  OPAL_OP_BUMP = 48,       /* height, strength, distance, normal?[shading normal], filter_width?[1], invert=; the height's
                              part of the program is run again at two points nearby, a pixel's width at most away */
  OPAL_OP_TANGENT = 49,    /* uv= (attribute name or -1); mode 0 X, 1 Y, 2 Z (radial, from Generated), 3 UV map */

  /* ---- Textures; each writes the registers named, in order ---- */
  OPAL_OP_IMAGE = 60,       /* vector, image@, interpolation=, extension=, flags=, blend?[0], tiles# (or -1), n_tiles=; mode
                               OPAL_PROJECT_* -> rgba. With tiles (constants: UDIM number, image) image is -1 */
  OPAL_OP_CHECKER = 61,     /* vector, color1, color2, scale -> color, factor */
  OPAL_OP_NOISE = 62,       /* vector, w, scale, detail, roughness, lacunarity, offset, gain, distortion, dimensions= (1..4),
                               flags= (1 normalize, 2 color wanted); mode OPAL_NOISE_* -> factor, color */
  OPAL_OP_VORONOI = 63,     /* vector, w, scale, detail, roughness, lacunarity, smoothness, exponent, randomness, dimensions=,
                               metric= (0 Euclidean, 1 Manhattan, 2 Chebychev, 3 Minkowski), normalize=, hash= (0 PCG: Blender 5, 1 Jenkins:
                               Blender 4); mode OPAL_VORONOI_* -> distance, color, position (w in the fourth lane), radius */
  OPAL_OP_WAVE = 64,        /* vector, scale, distortion, detail, detail_scale, detail_roughness, phase, rings=, direction= (0 X, 1 Y,
                               2 Z, 3 diagonal or spherical), profile= (0 sine, 1 saw, 2 triangle) -> factor */
  OPAL_OP_MAGIC = 65,       /* vector, scale, distortion, depth= (0..10) -> color, factor */
  OPAL_OP_BRICK = 66,       /* vector, color1, color2, mortar, scale, mortar_size, mortar_smooth, bias, brick_width, row_height,
                               pattern# (1 constant: offset, offset frequency, squash, squash frequency) -> color, factor */
  OPAL_OP_GRADIENT = 67,    /* vector; mode OPAL_GRADIENT_* -> factor */
  OPAL_OP_WHITE_NOISE = 68, /* vector, w, dimensions= (1..4) -> value, color */

  /* ---- Lobes; `weight?[1]` is what Mix and Add Shader leave of the node ---- */
  OPAL_OP_DIFFUSE = 80,     /* weight?, color, roughness, normal? */
  OPAL_OP_TRANSLUCENT = 81, /* weight?, color, normal? */
  OPAL_OP_GLOSSY = 82,      /* weight?, color, roughness, anisotropy, rotation, normal?, tangent?, multiscatter= */
  OPAL_OP_METALLIC = 83,    /* weight?, a, b, roughness, anisotropy, rotation, normal?, tangent?, multiscatter=; mode 0: a, b are
                               base colour and edge tint; mode 1: index and extinction */
  OPAL_OP_GLASS = 84,       /* weight?, color, roughness, ior, normal?, multiscatter= */
  OPAL_OP_REFRACTION = 85,  /* weight?, color, roughness, ior, normal? */
  OPAL_OP_TRANSPARENT = 86, /* weight?, color */
  OPAL_OP_SHEEN = 87,       /* weight?, color, roughness, normal? */
  OPAL_OP_EMISSION = 88,    /* weight?, color, strength; Background too */
  OPAL_OP_HOLDOUT = 89,     /* weight? */
  OPAL_OP_PRINCIPLED = 90,  /* weight?, base_color, normal?, tangent?, coat_normal?, (specular tint, ior level), (coat tint, weight),
                               (sheen tint, weight), (emission colour, strength), (metallic, roughness, ior, alpha), (diffuse roughness,
                               subsurface weight, anisotropic, rotation), (transmission, coat roughness, coat ior, sheen
                               roughness), (film thickness nm, film ior); mode 1: multiple scattering GGX */

  OPAL_OP_COUNT = 91
} opal_op;

enum { OPAL_GREY_LUMINANCE = 0, OPAL_GREY_AVERAGE = 1 };

enum {
  OPAL_MATH_ADD, OPAL_MATH_SUBTRACT, OPAL_MATH_MULTIPLY, OPAL_MATH_DIVIDE, OPAL_MATH_MULTIPLY_ADD, OPAL_MATH_POWER,
  OPAL_MATH_LOGARITHM, OPAL_MATH_SQRT, OPAL_MATH_INVERSE_SQRT, OPAL_MATH_ABSOLUTE, OPAL_MATH_EXPONENT, OPAL_MATH_MINIMUM,
  OPAL_MATH_MAXIMUM, OPAL_MATH_LESS_THAN, OPAL_MATH_GREATER_THAN, OPAL_MATH_SIGN, OPAL_MATH_COMPARE, OPAL_MATH_SMOOTH_MIN,
  OPAL_MATH_SMOOTH_MAX, OPAL_MATH_ROUND, OPAL_MATH_FLOOR, OPAL_MATH_CEIL, OPAL_MATH_TRUNC, OPAL_MATH_FRACT,
  OPAL_MATH_MODULO, OPAL_MATH_FLOORED_MODULO, OPAL_MATH_WRAP, OPAL_MATH_SNAP, OPAL_MATH_PINGPONG, OPAL_MATH_SINE,
  OPAL_MATH_COSINE, OPAL_MATH_TANGENT, OPAL_MATH_ARCSINE, OPAL_MATH_ARCCOSINE, OPAL_MATH_ARCTANGENT, OPAL_MATH_ARCTAN2,
  OPAL_MATH_SINH, OPAL_MATH_COSH, OPAL_MATH_TANH, OPAL_MATH_RADIANS, OPAL_MATH_DEGREES, OPAL_MATH_COUNT
};
enum {
  OPAL_VECTOR_ADD, OPAL_VECTOR_SUBTRACT, OPAL_VECTOR_MULTIPLY, OPAL_VECTOR_DIVIDE, OPAL_VECTOR_MULTIPLY_ADD,
  OPAL_VECTOR_CROSS, OPAL_VECTOR_PROJECT, OPAL_VECTOR_REFLECT, OPAL_VECTOR_REFRACT, OPAL_VECTOR_FACEFORWARD,
  OPAL_VECTOR_DOT, OPAL_VECTOR_DISTANCE, OPAL_VECTOR_LENGTH, OPAL_VECTOR_SCALE, OPAL_VECTOR_NORMALIZE,
  OPAL_VECTOR_ABSOLUTE, OPAL_VECTOR_POWER, OPAL_VECTOR_SIGN, OPAL_VECTOR_MINIMUM, OPAL_VECTOR_MAXIMUM, OPAL_VECTOR_FLOOR,
  OPAL_VECTOR_CEIL, OPAL_VECTOR_FRACTION, OPAL_VECTOR_MODULO, OPAL_VECTOR_WRAP, OPAL_VECTOR_SNAP, OPAL_VECTOR_SINE,
  OPAL_VECTOR_COSINE, OPAL_VECTOR_TANGENT, OPAL_VECTOR_ROUND, OPAL_VECTOR_COUNT
};
enum {
  OPAL_MIX_MIX, OPAL_MIX_DARKEN, OPAL_MIX_MULTIPLY, OPAL_MIX_BURN, OPAL_MIX_LIGHTEN, OPAL_MIX_SCREEN, OPAL_MIX_DODGE,
  OPAL_MIX_ADD, OPAL_MIX_OVERLAY, OPAL_MIX_SOFT_LIGHT, OPAL_MIX_LINEAR_LIGHT, OPAL_MIX_DIFFERENCE, OPAL_MIX_EXCLUSION,
  OPAL_MIX_SUBTRACT, OPAL_MIX_DIVIDE, OPAL_MIX_HUE, OPAL_MIX_SATURATION, OPAL_MIX_COLOR, OPAL_MIX_VALUE, OPAL_MIX_COUNT
};
enum { OPAL_MIX_FLAG_CLAMP_FACTOR = 1, OPAL_MIX_FLAG_CLAMP_RESULT = 2, OPAL_MIX_FLAG_VECTOR_FACTOR = 4 };
enum { OPAL_RANGE_LINEAR, OPAL_RANGE_STEPPED, OPAL_RANGE_SMOOTHSTEP, OPAL_RANGE_SMOOTHERSTEP, OPAL_RANGE_COUNT };
enum { OPAL_MAPPING_POINT, OPAL_MAPPING_TEXTURE, OPAL_MAPPING_VECTOR, OPAL_MAPPING_NORMAL, OPAL_MAPPING_COUNT };
enum { OPAL_ROTATE_AXIS_ANGLE, OPAL_ROTATE_X, OPAL_ROTATE_Y, OPAL_ROTATE_Z, OPAL_ROTATE_EULER, OPAL_ROTATE_COUNT };
/* NORMAL multiplies by the transposed matrix and normalizes: give it the inverse of the transform. PROJECT divides by
 * the third row's result (window coordinates of a perspective camera). */
enum { OPAL_TRANSFORM_POINT, OPAL_TRANSFORM_VECTOR, OPAL_TRANSFORM_NORMAL, OPAL_TRANSFORM_PROJECT, OPAL_TRANSFORM_COUNT };
enum { OPAL_COLOR_RGB, OPAL_COLOR_HSV, OPAL_COLOR_HSL, OPAL_COLOR_COUNT };
enum { OPAL_TABLE_INTERPOLATE = 1, OPAL_TABLE_EXTRAPOLATE = 2, OPAL_TABLE_COMPONENTS = 4 /* x, y, z each looked up alone */ };
enum {
  OPAL_COORDINATE_GENERATED,  /* the mesh's texture space, 0..1; the direction for the world */
  OPAL_COORDINATE_NORMAL,     /* in the object's space */
  OPAL_COORDINATE_OBJECT,
  OPAL_COORDINATE_REFLECTION,
  OPAL_COORDINATE_POSITION,   /* world space; the direction for the world */
  OPAL_COORDINATE_COUNT
};
enum { OPAL_ATTRIBUTE_COLOR, OPAL_ATTRIBUTE_FACTOR, OPAL_ATTRIBUTE_ALPHA, OPAL_ATTRIBUTE_COUNT };
enum {
  OPAL_GEOMETRY_POSITION, OPAL_GEOMETRY_NORMAL, OPAL_GEOMETRY_TANGENT, OPAL_GEOMETRY_TRUE_NORMAL, OPAL_GEOMETRY_INCOMING,
  OPAL_GEOMETRY_PARAMETRIC, OPAL_GEOMETRY_BACKFACING, OPAL_GEOMETRY_COUNT
};
enum { OPAL_OBJECT_LOCATION, OPAL_OBJECT_COLOR, OPAL_OBJECT_ALPHA, OPAL_OBJECT_INDEX, OPAL_OBJECT_RANDOM, OPAL_OBJECT_COUNT };
enum {
  OPAL_PATH_IS_CAMERA, OPAL_PATH_IS_SHADOW, OPAL_PATH_IS_DIFFUSE, OPAL_PATH_IS_GLOSSY, OPAL_PATH_IS_SINGULAR,
  OPAL_PATH_IS_REFLECTION, OPAL_PATH_IS_TRANSMISSION, OPAL_PATH_IS_SCATTER, OPAL_PATH_LENGTH, OPAL_PATH_DEPTH, OPAL_PATH_COUNT
};
enum {
  OPAL_NORMAL_TANGENT, OPAL_NORMAL_OBJECT, OPAL_NORMAL_WORLD, OPAL_NORMAL_BLENDER_OBJECT, OPAL_NORMAL_BLENDER_WORLD,
  OPAL_NORMAL_COUNT
};
enum {
  OPAL_PROJECT_FLAT, OPAL_PROJECT_BOX, OPAL_PROJECT_SPHERE, OPAL_PROJECT_TUBE, OPAL_PROJECT_EQUIRECTANGULAR,
  OPAL_PROJECT_MIRROR_BALL, OPAL_PROJECT_COUNT
};
enum { OPAL_INTERPOLATE_LINEAR, OPAL_INTERPOLATE_CLOSEST, OPAL_INTERPOLATE_CUBIC, OPAL_INTERPOLATE_COUNT };
enum { OPAL_EXTEND_REPEAT, OPAL_EXTEND_EDGE, OPAL_EXTEND_CLIP, OPAL_EXTEND_MIRROR, OPAL_EXTEND_COUNT };
enum { OPAL_IMAGE_UNASSOCIATE_ALPHA = 1, OPAL_IMAGE_IGNORE_ALPHA = 2 };
enum { OPAL_NOISE_MULTIFRACTAL, OPAL_NOISE_RIDGED_MULTIFRACTAL, OPAL_NOISE_HYBRID_MULTIFRACTAL, OPAL_NOISE_FBM, OPAL_NOISE_HETERO_TERRAIN, OPAL_NOISE_COUNT };
enum { OPAL_VORONOI_F1, OPAL_VORONOI_F2, OPAL_VORONOI_SMOOTH_F1, OPAL_VORONOI_DISTANCE_TO_EDGE, OPAL_VORONOI_N_SPHERE_RADIUS, OPAL_VORONOI_COUNT };
enum {
  OPAL_GRADIENT_LINEAR, OPAL_GRADIENT_QUADRATIC, OPAL_GRADIENT_EASING, OPAL_GRADIENT_DIAGONAL, OPAL_GRADIENT_SPHERICAL,
  OPAL_GRADIENT_QUADRATIC_SPHERE, OPAL_GRADIENT_RADIAL, OPAL_GRADIENT_COUNT
};

/* clang-format on */

#endif
