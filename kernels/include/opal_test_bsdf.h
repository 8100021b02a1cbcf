/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The surface scattering of the tracer, seen from tests: one node's closures, evaluated and sampled.
 *
 * Colours are linear Rec.709 and directions point away from the surface, as everywhere. A spectrum has OPAL_TEST_WAVELENGTHS
 * entries; for the nodes entry i is colour channel i % 3, for the gem it is the i-th of the given indices. */
#ifndef OPAL_TEST_BSDF_H
#define OPAL_TEST_BSDF_H

#include "opal.h"

#ifdef __cplusplus
extern "C" {
#endif

#define OPAL_TEST_WAVELENGTHS 8

typedef enum opal_test_node {
  OPAL_TEST_DIFFUSE = 0,     /* color, roughness */
  OPAL_TEST_TRANSLUCENT = 1, /* color */
  OPAL_TEST_GLOSSY = 2,      /* color, roughness, anisotropy, rotation */
  OPAL_TEST_GLASS = 3,       /* color, roughness, ior */
  OPAL_TEST_REFRACTION = 4,  /* color, roughness, ior */
  OPAL_TEST_TRANSPARENT = 5, /* color */
  OPAL_TEST_SHEEN = 6,       /* color, roughness */
  OPAL_TEST_METAL_F82 = 7,   /* color, color_2: the tint at the edge, roughness, anisotropy, rotation */
  OPAL_TEST_CONDUCTOR = 8,   /* color: n, color_2: k, roughness, anisotropy, rotation */
  OPAL_TEST_PRINCIPLED = 9,  /* color, roughness, ior, anisotropy, rotation, principled */
  OPAL_TEST_GEM = 10         /* roughness, eta, schlick */
} opal_test_node;

typedef struct opal_test_bsdf {
  int32_t node; /* opal_test_node */
  int32_t multiscatter, backfacing, schlick;
  int32_t flux; /* 0: radiance, carried from cameras; 1: flux, carried from lights */
  float wo[3], geometric_normal[3], shading_normal[3];
  float normal[3], tangent[3]; /* sockets; zero: not linked */
  float color[3], color_2[3];
  float roughness, ior, anisotropy, rotation;
  float eta[OPAL_TEST_WAVELENGTHS]; /* index behind / index in front of the gem's boundary */
  /* metallic, alpha, diffuse roughness, subsurface, specular level, transmission, coat, coat roughness, coat ior, sheen,
   * sheen roughness, emission strength, specular tint (3), coat tint (3), sheen tint (3) */
  float principled[21];
} opal_test_bsdf;

/* f |cos| and pdf for n directions (3 floats each); value and pdf: 8 floats each. rough_only: the part photons are left for. */
OPAL_EXPORT void opal_test_bsdf_eval(const opal_test_bsdf *bsdf, int32_t n, const float *wi, int32_t rough_only, float *value,
                                     float *pdf);
/* n samples from 3 numbers each: direction (3), weight (8), pdf (8), scattering flags (0: no sample), eta. */
OPAL_EXPORT void opal_test_bsdf_sample(const opal_test_bsdf *bsdf, int32_t n, const float *u, float *wi, float *weight,
                                       float *pdf, uint32_t *scattering, float *eta);
/* What the node adds up to: emission (3), transparency (3), albedo guide (3), sum of sample weights; returns the lobe count. */
OPAL_EXPORT int32_t opal_test_bsdf_summary(const opal_test_bsdf *bsdf, float *summary);

#ifdef __cplusplus
}
#endif
#endif
