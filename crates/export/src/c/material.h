/* SPDX-License-Identifier: CC0-1.0 OR MIT
 *
 * student_t_materials.h: conductors, dielectrics and plastics of student_t.h's lobes.
 */
#ifndef STUDENT_T_MATERIALS_H
#define STUDENT_T_MATERIALS_H

#include "student_t.h"

/* The channels of weights and reflectances; define it beforehand to have another number. */
#ifndef STUDENT_T_CHANNELS
#define STUDENT_T_CHANNELS 3
#endif

/* How the light that one bounce loses to further ones is returned: not at all, by a factor on the
 * lobe (Turquin 2019; not reciprocal), or by a lobe of its own (Kulla & Conty 2017). */
enum student_t_compensation_form {
    STUDENT_T_SINGLE_BOUNCE = 0,
    STUDENT_T_TURQUIN = 1,
    STUDENT_T_KULLA_CONTY = 2
};

/* What is transported along a path: refraction scales radiance by (n_v/n_l)^2, and importance, or
 * photons, not. */
enum student_t_transport { STUDENT_T_RADIANCE = 0, STUDENT_T_IMPORTANCE = 1 };

/* What a sample is; the path of one that is absorbed ends with the weight 0. */
enum student_t_event { STUDENT_T_ABSORBED = 0, STUDENT_T_REFLECTED = 1, STUDENT_T_TRANSMITTED = 2 };

/* A sampled light. */
typedef struct student_t_sample {
    enum student_t_event event;
    int is_delta;     /* evaluation gives 0 for a delta: a mirror's, and what steep facets refract */
    float l[3];       /* the light, of unit length, away from the surface */
    float m[3];       /* the normal of its facet; n for a mirror, and halfway for further bounces */
    float weight[STUDENT_T_CHANNELS]; /* f |cos|/pdf */
    float pdf;        /* per steradian; 0 for a delta */
    float eta;        /* index on the side of l over that on the side of the view; 1 if reflected */
} student_t_sample;
