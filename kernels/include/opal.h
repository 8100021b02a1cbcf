/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Opal's C interface: build a scene, commit it, render passes, read the film.
 *
 * Conventions
 *   - Lengths are metres, wavelengths nanometres, angles radians, powers watts.
 *   - Colours are linear Rec.709 with a D65 white. Directions are unit vectors in world space.
 *   - Transforms are row-major 3x4 matrices (12 floats), object to world, column vectors.
 *   - Arrays are read during the call and copied; the caller keeps ownership.
 *   - A function that returns an int32_t gives a non-negative value (an index or 0) on success and a negative
 *     opal_status on failure; opal_last_error() then holds one sentence for the calling thread.
 *   - Building a scene is for one thread at a time. A committed scene may be rendered by one opal_render at a time
 *     while another thread calls opal_render_cancel, opal_render_progress or opal_film_read.
 *   - No call throws, prints or exits. */
#ifndef OPAL_H
#define OPAL_H

#include <stdint.h>

#if defined(_WIN32)
#define OPAL_EXPORT __declspec(dllexport)
#else
#define OPAL_EXPORT __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define OPAL_API_VERSION 1

/* Spectral tables run from 360 to 830 nm in steps of 1 nm, both ends included. */
#define OPAL_SPECTRUM_FIRST_NM 360
#define OPAL_SPECTRUM_SIZE 471

typedef enum opal_status {
  OPAL_OK = 0,
  OPAL_ERROR_ARGUMENT = -1,  /* a value is out of range, or an index does not exist */
  OPAL_ERROR_MEMORY = -2,    /* out of memory */
  OPAL_ERROR_EMBREE = -3,    /* Embree was not found, is too old, or reported an error */
  OPAL_ERROR_CANCELLED = -4, /* opal_render_cancel or opal_scene_cancel was called */
  OPAL_ERROR_INTERNAL = -5
} opal_status;

typedef struct opal_scene opal_scene;
typedef struct opal_render opal_render;

/* The message of the last failure on this thread; empty when there was none. */
OPAL_EXPORT const char *opal_last_error(void);
OPAL_EXPORT int32_t opal_api_version(void);
/* The micro-architecture level that this processor can run: 2 (x86-64-v2) or 3 (AVX2, FMA, BMI); 0 elsewhere. */
OPAL_EXPORT int32_t opal_cpu_level(void);

/* ---- Tables: the kernels hold no data of their own; the Python package passes it in. ---- */

typedef struct opal_tables {
  const float *observer; /* 3 x 471: CIE 1931 colour matching functions x, y, z */
  const float *d65;      /* 471: relative spectral power of D65, any scale */
  const float *basis;    /* 3 x 471: the linear uplift basis for red, green, blue */
} opal_tables;

/* embree_path: file or soname to open, or NULL to search the running process. threads: 0 takes every core. */
OPAL_EXPORT opal_scene *opal_scene_create(const opal_tables *tables, const char *embree_path, int32_t threads);
OPAL_EXPORT void opal_scene_destroy(opal_scene *scene);

/* ---- Images ---- */

enum { OPAL_PIXEL_U8 = 0, OPAL_PIXEL_F32 = 1 };
enum { OPAL_TRANSFER_LINEAR = 0, OPAL_TRANSFER_SRGB = 1 };

typedef struct opal_image_desc {
  int32_t width, height;
  int32_t channels;   /* 1, 3 or 4 */
  int32_t pixel_type; /* OPAL_PIXEL_* */
  int32_t transfer;   /* decoding applied after interpolation, as Cycles does */
  int32_t reserved;
  const void *pixels; /* rows from the bottom up */
} opal_image_desc;

OPAL_EXPORT int32_t opal_scene_add_image(opal_scene *scene, const opal_image_desc *image);

/* A table over the spectral range (index of refraction, absorption in 1/m, a lamp's relative power...). */
OPAL_EXPORT int32_t opal_scene_add_spectrum(opal_scene *scene, const float *values);
/* Replaces a table. Lamps that use it are counted anew by the next opal_scene_commit. */
OPAL_EXPORT int32_t opal_scene_set_spectrum(opal_scene *scene, int32_t spectrum, const float *values);

/* ---- Media ---- */

enum { OPAL_PHASE_ISOTROPIC = 0, OPAL_PHASE_HENYEY_GREENSTEIN = 1, OPAL_PHASE_RAYLEIGH = 2, OPAL_PHASE_TABLE = 3 };

typedef struct opal_phase_desc {
  int32_t kind;     /* OPAL_PHASE_* */
  float anisotropy; /* Henyey-Greenstein: mean cosine, -1..1 */
  int32_t n_wavelengths, n_angles;
  const float *wavelengths; /* table: nm, ascending */
  const float *angles;      /* table: radians between propagation directions, from 0 to pi, ascending */
  const float *values;      /* table: n_elevations x n_clocks x n_wavelengths x n_angles, 1/sr; each row is normalised */
  /* Tables only. Degree of polarisation of what scatters unpolarised light, as `values`: 1 is all perpendicular to the plane of
   * scattering, -1 all in it. NULL: 0. */
  const float *polarization;
  /* Particles that are not round and fall along -Z: the light's height over the horizon (radians, ascending) and the place on a
   * bow as seen by the camera, from 0 above the antisolar point to pi below it (ascending). 0 and NULL: the same all round. */
  int32_t n_elevations, n_clocks;
  const float *elevations, *clocks;
} opal_phase_desc;

OPAL_EXPORT int32_t opal_scene_add_phase(opal_scene *scene, const opal_phase_desc *phase);

/* A grid of voxels, kept as sparse bricks: what is 0 takes no memory. Voxel (i, j, k) is a sample at that place of index space,
 * trilinear between samples, 0 from one voxel beyond the grid on. */
typedef struct opal_grid_desc {
  int32_t size[3];     /* voxels along x, y, z, each 1 .. 16384 */
  int32_t channels;    /* 1, or 3 for colours (linear Rec.709) */
  float transform[12]; /* index space to the object's space (to world space for the world's medium) */
} opal_grid_desc;

/* What was wrong with the values of a block; each was taken as 0. */
typedef struct opal_grid_faults {
  int64_t not_finite, negative;
} opal_grid_faults;

/* Adds a grid of zeros. Fails with OPAL_ERROR_MEMORY, naming the size, where even the table of bricks does not fit. */
OPAL_EXPORT int32_t opal_scene_add_grid(opal_scene *scene, const opal_grid_desc *grid);
/* Writes size[0] x size[1] x size[2] voxels from `origin` on: values[x][y][z][channel]. *faults (may be NULL) is added to. */
OPAL_EXPORT int32_t opal_scene_set_grid_block(opal_scene *scene, int32_t grid, const int32_t origin[3], const int32_t size[3],
                                              const float *values, opal_grid_faults *faults);

enum { OPAL_DENSITY_HOMOGENEOUS = 0, OPAL_DENSITY_NOISE = 1, OPAL_DENSITY_GRID = 2, OPAL_DENSITY_HEIGHT = 3 };
/* What the emission spectrum is multiplied by. */
enum { OPAL_EMISSION_AS_DENSITY = 0, OPAL_EMISSION_EVERYWHERE = 1, OPAL_EMISSION_GRID = 2 };

/* A medium. Spectra come from opal_scene_add_spectrum, -1 for none; grids are 1 + a number from opal_scene_add_grid, 0 for
 * none. At a place p of the object's space extinction and scattering are the spectra times the density at p, which is
 *   HOMOGENEOUS  1;
 *   NOISE        clamp(1/2 + contrast (n - 1/2), 0, 1) of fractal gradient noise n in [0, 1] with lumps of noise_scale;
 *   GRID         the value of density_grid;
 *   HEIGHT       exp(-(z - base_height) / scale_height) above base_height, 1 below; as the world's medium it scatters nothing
 *                below base_height and everything in the scene: the ground goes on beyond what is modelled of it;
 * plus the colours that scattering_grid and absorption_grid hold (1/m); emission_grid adds radiance per metre. */
typedef struct opal_medium_desc {
  int32_t extinction; /* sigma_t, 1/m */
  int32_t scattering; /* sigma_s, 1/m */
  int32_t emission;   /* radiance per metre */
  int32_t phase;      /* from opal_scene_add_phase, -1: isotropic */
  int32_t density;    /* OPAL_DENSITY_* */
  int32_t density_grid;
  int32_t emission_density; /* OPAL_EMISSION_* */
  int32_t emission_density_grid;
  int32_t scattering_grid, absorption_grid, emission_grid; /* of 3 channels */
  uint32_t noise_seed;
  float noise_scale, noise_detail, noise_contrast; /* object space; octaves 0..15; >= 0 */
  float scale_height, base_height;                 /* object space */
  int32_t also; /* 1 + a medium added before that fills the same body, as if two bodies overlapped; 0: none */
} opal_medium_desc;

OPAL_EXPORT int32_t opal_scene_add_medium(opal_scene *scene, const opal_medium_desc *medium);
/* Which compositing layer shows what the medium scatters. BASE: the other engine renders the medium itself, as it does
 * surfaces. */
enum { OPAL_MEDIUM_LAYER_MEDIA = 0, OPAL_MEDIUM_LAYER_RAINBOW = 1, OPAL_MEDIUM_LAYER_BASE = 2 };
OPAL_EXPORT int32_t opal_scene_set_medium_layer(opal_scene *scene, int32_t medium, int32_t layer);
/* The medium that fills the world, outside of everything too; -1 for none. */
OPAL_EXPORT int32_t opal_scene_set_world_medium(opal_scene *scene, int32_t medium);

/* ---- Materials: a register program (see opal_shader.h) and an optional gem boundary ---- */

typedef struct opal_instruction {
  int32_t op;     /* opal_op of opal_shader.h */
  int32_t mode;   /* its variant */
  int32_t out;    /* first register written, -1 for none */
  int32_t in[13]; /* registers read, or integers, as the operation says; -1 for none */
} opal_instruction;

typedef struct opal_program {
  const opal_instruction *code;
  int32_t n_instructions;
  int32_t n_constants;    /* registers 0 .. n_constants-1 start with these values */
  const float *constants; /* n_constants x 4 */
  int32_t n_registers;    /* total, at most OPAL_MAX_REGISTERS */
  int32_t reserved;
} opal_program;

enum { OPAL_FRESNEL_EXACT = 0, OPAL_FRESNEL_SCHLICK = 1 };

typedef struct opal_gem_desc {
  int32_t index_spectrum;      /* n(lambda), from opal_scene_add_spectrum */
  int32_t absorption_spectrum; /* sigma_a(lambda) in 1/m, or -1 */
  float roughness;             /* 0..1, GGX alpha = roughness^2 */
  int32_t fresnel;             /* OPAL_FRESNEL_* */
  int32_t priority;            /* where two interiors overlap the higher one wins */
  int32_t reserved;
} opal_gem_desc;

typedef struct opal_material_desc {
  opal_program surface;
  const opal_gem_desc *gem; /* non-NULL replaces the surface program by a dielectric boundary */
  uint32_t flags;           /* OPAL_MATERIAL_* */
  int32_t medium;           /* 1 + the medium inside of the closed mesh, from opal_scene_add_medium; 0: none */
} opal_material_desc;

enum {
  OPAL_MATERIAL_CASTER = 1,             /* may make caustics: has a sharp enough specular lobe */
  OPAL_MATERIAL_EMISSIVE = 2,           /* its faces are light sources worth sampling */
  OPAL_MATERIAL_TRANSPARENT_SHADOW = 4, /* shadow rays must run the program (alpha, Transparent BSDF) */
  OPAL_MATERIAL_NO_SURFACE = 8          /* bounds a medium and nothing else: every ray goes straight through */
};

OPAL_EXPORT int32_t opal_scene_add_material(opal_scene *scene, const opal_material_desc *material);
OPAL_EXPORT int32_t opal_scene_update_material(opal_scene *scene, int32_t index, const opal_material_desc *material);

/* ---- Geometry ---- */

enum { OPAL_DOMAIN_CORNER = 0, OPAL_DOMAIN_VERTEX = 1, OPAL_DOMAIN_FACE = 2 };

typedef struct opal_attribute_desc {
  int32_t name;       /* the number that programs use for this attribute's name */
  int32_t domain;     /* OPAL_DOMAIN_* */
  int32_t components; /* 1..4 */
  int32_t reserved;
  const float *values; /* (3 n_triangles | n_vertices | n_triangles) x components */
} opal_attribute_desc;

typedef struct opal_mesh_desc {
  int32_t n_vertices, n_triangles;
  const float *positions;       /* n_vertices x 3; with motion: in the middle of the shutter */
  const float *positions_start; /* at shutter open, and at its close: both or neither (NULL) */
  const float *positions_end;
  const int32_t *triangles;      /* n_triangles x 3 */
  const float *corner_normals;   /* n_triangles x 3 x 3, or NULL: flat */
  const float *corner_tangents;  /* n_triangles x 3 x 4 (xyz, sign), or NULL */
  const int32_t *material_slots; /* n_triangles, or NULL: 0 */
  const float *generated;        /* n_vertices x 3 texture coordinates 0..1, or NULL: from the bounds */
  const opal_attribute_desc *attributes;
  int32_t n_attributes;
  int32_t reserved;
} opal_mesh_desc;

/* Places inside of an object at which a program is asked for what it emits. */
typedef struct opal_places_desc {
  int64_t n;
  const float *positions;                /* n x 3, object space */
  const float *generated;                /* n x 3 texture coordinates, or NULL: zeros */
  const float *transform;                /* 12: object to world, or NULL: the identity */
  const float *object_info;              /* 8, as in opal_instances_desc, or NULL */
  const opal_attribute_desc *attributes; /* of domain OPAL_DOMAIN_VERTEX: one value a place */
  int32_t n_attributes;
  int32_t reserved;
} opal_places_desc;

/* Writes what `program` emits at n places to out (n x 3): node trees of volumes become grids so. */
OPAL_EXPORT int32_t opal_scene_evaluate(const opal_scene *scene, const opal_program *program, const opal_places_desc *places,
                                        float *out);

/* Triangles with non-finite corners are dropped; *n_dropped (may be NULL) says how many. */
OPAL_EXPORT int32_t opal_scene_add_mesh(opal_scene *scene, const opal_mesh_desc *mesh, int32_t *n_dropped);

/* Kinds of ray, for visibility masks and the Light Path node. */
enum {
  OPAL_RAY_CAMERA = 1,
  OPAL_RAY_DIFFUSE = 2,
  OPAL_RAY_GLOSSY = 4,
  OPAL_RAY_TRANSMISSION = 8,
  OPAL_RAY_SHADOW = 16,
  OPAL_RAY_SCATTER = 32,
  OPAL_RAY_ALL = 63
};

typedef struct opal_instances_desc {
  int32_t mesh;
  int32_t count;
  const float *transforms;       /* count x 12; with motion: in the middle of the shutter */
  const float *transforms_start; /* at shutter open, and at its close: both or neither (NULL) */
  const float *transforms_end;
  const int32_t *materials; /* material of each slot; -1: the default grey */
  int32_t n_materials;
  uint32_t visibility;      /* OPAL_RAY_* bits */
  const float *object_info; /* count x 8: random 0..1, object index, material-independent colour rgba, 2 unused; or NULL */
  int32_t holdout;          /* non-zero: cuts alpha */
  int32_t light_group;      /* receiver set for light linking: bit index tested against lights, -1: every light */
} opal_instances_desc;

/* Returns the index of the first instance. */
OPAL_EXPORT int32_t opal_scene_add_instances(opal_scene *scene, const opal_instances_desc *instances);
OPAL_EXPORT int32_t opal_scene_set_transforms(opal_scene *scene, int32_t first_instance, int32_t count, const float *transforms,
                                              const float *transforms_start, const float *transforms_end);

/* ---- Lights ---- */

enum { OPAL_LIGHT_POINT = 0, OPAL_LIGHT_SPOT = 1, OPAL_LIGHT_SUN = 2, OPAL_LIGHT_RECTANGLE = 3, OPAL_LIGHT_ELLIPSE = 4 };

typedef struct opal_light_desc {
  int32_t type;         /* OPAL_LIGHT_* */
  int32_t spectrum;     /* relative spectral power in place of D65, brought to D65's luminance, or -1; `color` filters it */
  float transform[12];  /* looks along its local -Z */
  float color[3];       /* linear Rec.709: tint x temperature x strength factors, without the power */
  float power;          /* W as in Blender (sun: irradiance, W/m2); exposure already applied */
  float radius;         /* point, spot: of the sphere; sun: half of the angle (radians) */
  float spot_angle;     /* full cone angle */
  float spot_blend;     /* 0..1 */
  float size_u, size_v; /* area: edge lengths (rectangle) or axes (ellipse) along local X and Y */
  float spread;         /* area: full angle, pi is Lambertian */
  uint32_t visibility;  /* OPAL_RAY_* bits that can see it */
  int32_t cast_shadow;
  int32_t normalize;    /* power does not depend on size */
  int32_t caustics;     /* non-zero: may send caustic photons */
  int32_t soft_falloff; /* point, spot: a disc that faces each point it lights (Blender's default) instead of a sphere */
  int32_t reserved;
  uint64_t receivers; /* light linking: bit i lights receiver set i */
} opal_light_desc;

OPAL_EXPORT int32_t opal_scene_add_light(opal_scene *scene, const opal_light_desc *light);
OPAL_EXPORT int32_t opal_scene_clear_lights(opal_scene *scene);

typedef struct opal_world_desc {
  opal_program program; /* run with the direction as position; its emission is the radiance */
  uint32_t visibility;  /* OPAL_RAY_* bits */
  int32_t map_width;    /* resolution of the importance map; 0: uniform radiance */
  int32_t caustics;     /* non-zero: sends caustic photons */
  int32_t reserved;
} opal_world_desc;

/* world: NULL is black. */
OPAL_EXPORT int32_t opal_scene_set_world(opal_scene *scene, const opal_world_desc *world);

/* ---- Camera ---- */

enum { OPAL_CAMERA_PERSPECTIVE = 0, OPAL_CAMERA_ORTHOGRAPHIC = 1 };

typedef struct opal_camera_desc {
  int32_t type;
  int32_t blades;            /* under 3: a round aperture */
  float transform[12];       /* camera to world, looks along -Z, Y up; with motion: in the middle of the shutter */
  float transform_start[12]; /* at shutter open */
  float transform_end[12];   /* at shutter close */
  float window[4];           /* left, right, bottom, top of the full frame: at distance 1 (perspective) or in metres */
  float clip_start, clip_end;
  float aperture_radius; /* metres, 0: pinhole */
  float focus_distance;
  float blade_rotation;
  float aperture_ratio;  /* 1: round */
  int32_t polarizer;     /* 1: a linear polarising filter before the lens; it takes half of unpolarised light */
  float polarizer_angle; /* of what it lets through, radians from the camera's X axis towards Y */
} opal_camera_desc;

OPAL_EXPORT int32_t opal_scene_set_camera(opal_scene *scene, const opal_camera_desc *camera);

/* Builds what changed: acceleration structures, light tables, caster bounds. */
OPAL_EXPORT int32_t opal_scene_commit(opal_scene *scene);
/* Ends the commit that runs, or else the next one, with OPAL_ERROR_CANCELLED; from any thread. Another commit has to build
 * the rest before the scene is rendered. */
OPAL_EXPORT void opal_scene_cancel(opal_scene *scene);

typedef struct opal_scene_statistics {
  int64_t triangles, instances, lights, emissive_triangles, memory_bytes;
  double build_seconds; /* of the last opal_scene_commit */
  /* How often opal_scene_commit has built, since the scene was created: the structure of one mesh, the structure over all
   * instances, and the tables of lights. */
  int64_t mesh_builds, top_builds, light_builds;
} opal_scene_statistics;
OPAL_EXPORT int32_t opal_scene_get_statistics(const opal_scene *scene, opal_scene_statistics *out);

/* Nearest hits of n rays: the tracer's own intersection layer, for measuring and for tests.
 * origins, directions: n x 3. Out (each may be NULL): distance (inf: none), instance, triangle, barycentrics u, v (n x 2). */
OPAL_EXPORT int32_t opal_scene_intersect(const opal_scene *scene, int64_t n, const float *origins, const float *directions,
                                         float *distance, int32_t *instance, int32_t *triangle, float *barycentrics);

/* ---- Rendering ---- */

enum { OPAL_CARRY_CAUSTICS = 0, OPAL_CARRY_INDIRECT = 1, OPAL_CARRY_ALL = 2, OPAL_CARRY_NONE = 3 };
enum { OPAL_VOLUME_POINTS = 0, OPAL_VOLUME_BEAM_RADIANCE = 1, OPAL_VOLUME_BEAMS = 2 };
enum { OPAL_FILTER_BOX = 0, OPAL_FILTER_GAUSSIAN = 1, OPAL_FILTER_BLACKMAN_HARRIS = 2 };

typedef struct opal_render_settings {
  int32_t width, height; /* of the full frame */
  int32_t region[4];     /* x0, y0, x1, y1 of the pixels rendered, y up */
  int32_t samples_per_pass;
  int32_t photons_per_pass;  /* emitted */
  int32_t photons_carry;     /* OPAL_CARRY_* */
  int32_t gather;            /* photons in one estimate, at most */
  float radius;              /* of the first pass's kernel in metres; 0: chosen from the scene */
  float radius_shrink;       /* alpha of Knaus & Zwicker 2011, 2/3 for surfaces */
  int32_t max_depth;         /* bounces off surfaces; roulette ends paths before. Media scatter on, unless it is 0 */
  int32_t transparent_depth; /* Transparent BSDFs passed by one ray */
  float wavelength_first, wavelength_last; /* nm */
  uint32_t seed;
  int32_t filter;     /* OPAL_FILTER_* */
  float filter_width; /* pixels */
  float exposure;     /* factor on the film */
  int32_t transparent_film;
  float clamp_direct, clamp_indirect; /* 0: none (default) */
  int32_t motion_blur;
  int32_t spectral_bins;   /* 0: none; else bins of the spectral film between the wavelengths */
  int32_t threads;         /* 0: as the scene */
  uint32_t passes;         /* bit 1 << OPAL_PASS_*: what the film keeps; Combined always */
  int32_t volume_estimate; /* OPAL_VOLUME_*: how photons in media are looked up */
  int32_t volume_photons;  /* emitted a pass for media alone; 0: the photons of photons_per_pass serve both */
  float volume_radius;   /* of the first pass's kernel in media, metres; 0: radius, and if that is 0 chosen from the photons */
  int32_t march_steps;   /* POINTS: steps along a ray */
  float march_tolerance; /* POINTS: relative difference of neighbours above which a step is halved; 0: never */
  int32_t adaptive; /* a pilot shares out samples_per_pass, a mean then, over the picture, and weighs photons against them */
} opal_render_settings;

OPAL_EXPORT opal_render *opal_render_create(opal_scene *scene, const opal_render_settings *settings);
OPAL_EXPORT void opal_render_destroy(opal_render *render);
/* Renders pass number `pass` (0, 1, ...) and adds it to the film. Passes are independent given (seed, pass): any
 * subset in any order adds up. Returns OPAL_ERROR_CANCELLED when cancelled; the film then holds complete passes only. */
OPAL_EXPORT int32_t opal_render_pass(opal_render *render, int32_t pass);
OPAL_EXPORT void opal_render_cancel(opal_render *render);
/* Fraction of the running pass that is done, 0..1. */
OPAL_EXPORT float opal_render_progress(const opal_render *render);

enum {
  OPAL_PASS_COMBINED = 0,  /* RGBA, premultiplied */
  OPAL_PASS_DEPTH = 1,     /* 1 */
  OPAL_PASS_NORMAL = 2,    /* 3, world space */
  OPAL_PASS_POSITION = 3,  /* 3 */
  OPAL_PASS_ALBEDO = 4,    /* 3 */
  OPAL_PASS_EMISSION = 5,  /* 3: light seen at first hand, background included */
  OPAL_PASS_DIRECT = 6,    /* 3: one scattering event between lamp and camera */
  OPAL_PASS_INDIRECT = 7,  /* 3: more than one, caustics excluded */
  OPAL_PASS_CAUSTICS = 8,  /* 3: brought to a diffuse surface by a specular one */
  OPAL_PASS_MEDIUM = 9,    /* 3 */
  OPAL_PASS_SPECTRAL = 10, /* spectral_bins: radiance per nm, relative: 1 throughout has luminance 1 */
  OPAL_PASS_NOISE = 11,    /* 1: estimated standard error of the luminance */
  /* Layers for compositing over a picture that another engine made (src/integrator/layers.h); they add up to Combined,
   * Behind and Dimmed apart. 4 each: premultiplied, alpha is the share of camera rays whose first event fell there. */
  OPAL_PASS_LAYER_BASE = 12,   /* ordinary surfaces without caustics, dimmed by media, black where gems would light them */
  OPAL_PASS_LAYER_BEHIND = 13, /* the base as it would be if media before the camera took nothing away */
  OPAL_PASS_LAYER_CAUSTICS =
      14, /* light that gems and caustics bring to ordinary surfaces, and media outside of the camera's view */
  OPAL_PASS_LAYER_GEMS = 15,    /* gems and what is seen through them */
  OPAL_PASS_LAYER_MEDIA = 16,   /* what media scatter or give off towards the camera */
  OPAL_PASS_LAYER_RAINBOW = 17, /* the same of media that were set to the layer of rainbows */
  OPAL_PASS_LAYER_DIMMED = 18,  /* the base again, of the paths of Behind: over it, what media let through */
  OPAL_PASS_COUNT = 19
};

/* Writes the region's pixels, rows from the bottom up, interleaved channels. */
OPAL_EXPORT int32_t opal_film_read(const opal_render *render, int32_t pass, float *out);
/* The film's sums as they are kept, in double precision: exact, so films of different passes add up to the same bits in any
 * order. OPAL_PASS_NOISE gives the sums of squared luminance. Same layout as opal_film_read; divide by the passes done.
 * Depth is not a sum but the depth of the pass that opal_film_depth_pass names (-1: none). */
OPAL_EXPORT int32_t opal_film_read_sums(const opal_render *render, int32_t pass, double *out);
OPAL_EXPORT int32_t opal_film_depth_pass(const opal_render *render);
/* Average of the noise pass relative to brightness, for noise_threshold; negative before two passes. */
OPAL_EXPORT float opal_film_noise(const opal_render *render);

typedef struct opal_render_statistics {
  int64_t camera_rays, path_rays, shadow_rays, photons_emitted, photons_stored, splats;
  double camera_seconds, photon_seconds, build_seconds;
  int64_t memory_bytes;
  int64_t volume_photons_emitted, volume_photons_stored; /* points or beams in media */
  double search_seconds;                                 /* part of photon_seconds: building what photons are looked up in */
  int64_t photon_bytes;                                  /* of the last pass's photons and what finds them */
  /* Where the photons' energy went, in W at the photons' first wavelength, passes added up: emitted = stored + absorbed +
   * escaped. Stored: where a photon was left and went no further; absorbed: by surfaces and media, with what Russian
   * roulette added and took. */
  double energy_emitted, energy_stored, energy_absorbed, energy_escaped;
  double pilot_seconds; /* planning an adaptive render, before its first pass */
  /* How often a path came into a gem within 32 others, which is as many as it keeps account of: beyond, light gets lost. */
  int64_t gems_passed_over;
  /* How often a path came into a medium within 32 others, which is as many as it keeps account of: it was passed over. */
  int64_t media_passed_over;
} opal_render_statistics;
OPAL_EXPORT int32_t opal_render_get_statistics(const opal_render *render, opal_render_statistics *out);

#ifdef __cplusplus
}
#endif
#endif
