/* SPDX-License-Identifier: CC0-1.0 OR MIT
 *
 * student_t.h: microfacet lobes of the Student-t family, for C99, C++11, CUDA and HIP.
 *
 * The Student-t distribution of slopes (roughness sigma, the alpha of GGX and Beckmann; shape gamma
 * > 3/2; Ribardiere et al. 2017, doi:10.1111/cgf.13137) contains GGX (gamma = 2) and Beckmann
 * (gamma = infinity). This file has the functions; student_t_family.h has tables of every gamma,
 * and the file of a shape those of one, such as student_t_gamma_3.h:
 *
 *     #include "student_t_family.h" // or student_t_gamma_3.h
 *
 *     const enum student_t_masking masking = STUDENT_T_HEIGHT_CORRELATED;
 *     const float v[3] = {0.6f, 0.0f, 0.8f}, u[2] = {0.2f, 0.7f};
 *     float m[3], l[3], weight, pdf;
 *     student_t_lobe lobe = student_t_lobe_at(3.0f, 0.3f, 0.3f); // or student_t_gamma_3_lobe(0.3f,
 *     student_t_lobe_sample_visible_normal(&lobe, v, u, m);      // 0.3f), at a hit
 *     student_t_reflect(v, m, l);
 *     weight = student_t_lobe_reflection_weight(&lobe, v, l, masking); // f cos / pdf, for F = 1
 *     pdf = student_t_lobe_reflection_pdf(&lobe, v, m); // of l, per steradian
 *
 * student_t_materials.h has whole materials. What is said of a function of a lobe holds for that of
 * a shape, of the same name without "lobe_", which takes a shape and {sigma_x, sigma_y} instead.
 *
 * Towards a given light l student_t_lobe_eval_pdf returns f, for F = 1, and its density. Densities
 * are over all lights. Those below the horizon have their share of them, and the weight 0. Take the
 * weight of a sampled light from student_t_reflection_weight: f cos over the density has few
 * digits, or none, where both are subnormal, as in the far tails of Beckmann. A surface is better
 * rendered as a mirror where student_t_effectively_smooth says so. Facets that refract are resolved
 * from v and l above a cosine of 3e-6 (1 + eta)/|1 - eta| only, which matters for gamma < 2: see
 * docs/export.md.
 *
 * Frame. Directions are float[3], unit vectors in the tangent frame, in which the normal of the
 * surface is (0, 0, 1): v to the viewer, l to the light, m a microfacet normal, w any of them.
 * sigma is {sigma_x, sigma_y}, the alpha of GGX and Beckmann along the x and the y axis. Densities
 * are per steradian. All is one-sided: negate a direction on the other side of a transmitting
 * surface first, v -> -v and l -> -l. Facets stay where they are, and m above the horizon. A mirror
 * image {v_x, v_y, -v_z} sees other facets: its G1 and G2 are those of -v, its densities are not.
 *
 * Domain. No function reads outside its tables. With directions of length 1, null, or with NaN
 * among their coordinates, none but student_t_reflect returns NaN.
 *   gamma     Taken at the nearer end of the family's range, [1.501, infinity], NaN at 1.501.
 *   sigma     Taken at the nearer end of [1e-8, 1e6], NaN at 1e-8. Albedos are tabulated up to the
 *             sigma_max of the shape, at least 3, and beyond are those of sigma_max. Where a sigma
 *             is not above 0, or NaN, their surface is a mirror, which has the albedo 1.
 *   u         Two random numbers in [0, 1], ends included; others are taken at the nearer end, NaN
 *             at 0.
 *   v, l, w   At or below the horizon, z <= 0: masking is 0 and lambda infinite; weight, G2 and
 *             compensation are 0. Normals are still sampled, and albedos still read, as if z were
 *             0; densities are then those of D over the area seen from there.
 *   m         At or below the horizon, or facing away from v, densities are 0. Sampled normals have
 *             a cosine of at least 1e-18, down to which D is certified.
 *   NaN       Where a coordinate is NaN, results are finite but unspecified.
 *   overflow  A density is limited to the largest finite number.
 * An array that is written must not be one that is read.
 *
 * Albedos cost as much as some normals: look each up once, and that of a view for all its lights.
 * Those of single shapes are exact curves, and take three times as long as those of a family. With
 * STUDENT_T_FITTED_ALBEDO defined beforehand, and student_t_family.h included, they are read from
 * the family, too. Define it in all translation units of a program or in none.
 * They are those of round lobes. Where sigma_x and sigma_y differ, that of sqrt(sigma_x
 * sigma_y) stands in. It is off by some 0.07 where one is twice the other, and by up to 0.6, and
 * the compensating lobe then gives back so much too little or too much. All else is exact. A shape
 * from a set that was baked for lobes that are not round has their own, which are those of every
 * lobe of exactly this sigma_x and sigma_y.
 *
 * Accuracy. A family reads its tables as 16-bit codes: G1 agrees with the crate's Family to 5e-6,
 * normals to 1e-5 of the cumulative distribution, E to 2.5e-4. The file of a shape lists the errors
 * of its tables, measured against the model in double precision. These functions agree with the
 * Rust crate microfacet-sampler on the same tables, if sigma is at most 10 (beyond in brackets):
 * masking, weights and albedos to 2e-6, coordinates of normals to 1e-5 (1e-3), densities to a share
 * of 1e-5 + 2e-6 |ln(D sigma_x sigma_y)|, averages of albedos to 3e-5. For gamma < 1.6 and cosines
 * < 1e-6 albedos agree to 2e-5, < 1e-20 to 2e-4: there they are extrapolated by a power close to 0.
 * Where a compiler fuses products and sums, normals of gamma <= 2 agree to 1e-3 only
 * (-ffp-contract=off prevents it). With -ffast-math D, densities, weights and f of sigma from 1e-3
 * on are off by 2e-6 (clients/c/fast.c); below 1e-5 densities may be lost, and what is said of NaN
 * no longer holds.
 *
 * Copies. From C++17 on tables and functions are inline: a program has one copy of a shape, at one
 * address, all its translation units must include the same export of it, and inline functions and
 * classes of other headers may use both. In C and in C++ before they are static: each translation
 * unit that uses a shape has its own copy, at another address, 55 kB or so, and what is inline in a
 * header of C++ must not use them. There wrap what you need in one translation unit.
 *
 * CUDA and HIP. All functions are for host and device. In device code tables are in device memory,
 * and static whatever the standard. A shape has one address on the host and another on the device:
 * take it where it is used, and do not pass it to a kernel. A family is a block without pointers of
 * student_t_family_bytes(family) bytes: a kernel takes the address of a copy of it in managed or in
 * device memory, and makes lobes by student_t_family_lobe. NVRTC and hipRTC work, too.
 */
#ifndef STUDENT_T_H
#define STUDENT_T_H

/* Raised whenever the layout of tables changes: their files ask for theirs. */
#define STUDENT_T_LAYOUT 4

#if !defined(__CUDACC_RTC__) && !defined(__HIPCC_RTC__)
#include <math.h>
#include <string.h>
#endif

/* Qualifiers of functions and of tables; define them beforehand to have others. */
#if (defined(__cplusplus) && __cplusplus >= 201703L) || \
    (defined(_MSVC_LANG) && _MSVC_LANG >= 201703L)
#define STUDENT_T_IMPL_INLINE inline
#define STUDENT_T_IMPL_CONST inline const
#else
#define STUDENT_T_IMPL_INLINE static inline
#define STUDENT_T_IMPL_CONST static const
#endif
#ifndef STUDENT_T_FUNCTION
#if defined(__CUDACC__) || defined(__HIPCC__) || defined(__HIP__)
#define STUDENT_T_FUNCTION STUDENT_T_IMPL_INLINE __host__ __device__
#else
#define STUDENT_T_FUNCTION STUDENT_T_IMPL_INLINE
#endif
#endif
#ifndef STUDENT_T_DATA
#if defined(__CUDA_ARCH__) || (defined(__HIP_DEVICE_COMPILE__) && __HIP_DEVICE_COMPILE__)
/* nvcc takes no inline variables of a device where it compiles a whole program. */
#define STUDENT_T_DATA static __device__ const
#else
#define STUDENT_T_DATA STUDENT_T_IMPL_CONST
#endif
#endif

/* How masking of the view and shadowing of the light are combined: as G1(v) G1(l), or as
 * 1/(1 + lambda(v) + lambda(l)), the form of renderers (Heitz 2014, eq. 99,
 * https://jcgt.org/published/0003/02/03/). */
enum student_t_masking { STUDENT_T_UNCORRELATED = 0, STUDENT_T_HEIGHT_CORRELATED = 1 };

/* The albedos of a shape under one form of masking. */
typedef struct student_t_albedo_table {
    const float *values;   /* [sigmas][views][3]: E - 1, bias - E bias', F82 - E F82', where
                            * bias' and F82' are those of a mirror */
    const float *averages; /* [average_sigmas][3]: ln(1 - E_avg), the averages of bias and F82 */
    int sigmas, average_sigmas, views;
    /* The coordinate ln(1 + sigma/offset) + slow ln(sigma/first) + linear sigma, its value at the
     * first node, and the last less the first. */
    float offset, first, slow, linear, start, range;
    float sigma_min, sigma_max;
    /* The coordinate of views, see student_t_impl_view. */
    float weight, normal, share, kappa, spread, floor, slope;
} student_t_albedo_table;

/* The albedos of one lobe that is not round, baked for it. They are those of every lobe of the
 * shape with exactly this roughness. */
typedef struct student_t_turning_albedo {
    float sigma_x, sigma_y;
    enum student_t_masking masking;
    /* By azimuth in place of sigma, over a quarter turn, and one row of averages. Of its members
     * about sigma there is none but their number. */
    student_t_albedo_table table;
} student_t_turning_albedo;

/* What lookups of one gamma read of tables that may have more of them. */
typedef struct student_t_constants {
    int masking_crowded;   /* whether the coordinate of masking is 1 - sqrt(1 - it) */
    float masking_cells;
    float rows;            /* cells along the view, where the largest of three linear functions */
    float rows_first;      /* of r = 1 - z/(rho + length) is the place: rows_first (1 - r), */
    float rows_second;     /* rows_second_end - rows_second r, and rows - rows_third r */
    float rows_second_end;
    float rows_third;
    int numbers;           /* nodes of half a row */
    float along_scale;     /* 2^(1/4) (numbers - 1) */
    float across_scale;    /* 2^(1/4) cells */
    float heavy_per_row;   /* cells of heavy shares in a row of slopes; 0 without such shares */
} student_t_constants;

/* The numbers of one gamma. */
typedef struct student_t_law {
    float s;               /* 1/(gamma - 1), 0 for gamma = infinity */
    float d_s, d_power;    /* s and 1 - gamma/2 of D, where s is never 0 */
    float kappa;           /* of the coordinate of masking, z/(z + kappa rho) */
    float heavy_exponent;  /* 1/(2 gamma - 3) */
    float heavy_root_s;    /* sqrt(s) */
} student_t_law;

/* One shape gamma. Tables are even in the coordinate of their views or random numbers, and have a
 * cell more than that reaches: the place of the end itself. */
typedef struct student_t_shape {
    float gamma;           /* the largest finite number for infinity, which is Beckmann */
    int is_ggx;            /* gamma = 2: closed forms, and no tables but those of albedos */
    student_t_law law;
    student_t_constants constants;
    const float *masking;  /* [cells + 1][4]: cubics, of G1/coordinate/cells */
    const float *slopes;   /* [rows + 2][2][numbers][2], and a node: value and slope, the half for
                            * u <= 1/2 first */
    const float *across;   /* [cells + 1][4]: cubics */
    const float *heavy;    /* [cells + 1][4]: cubics, of the share of visible normals that is in no
                            * table; none for gamma >= 1.8 */
    student_t_albedo_table albedo[2]; /* by student_t_masking */
    const student_t_turning_albedo *turning; /* of lobes that are not round, or none */
    int turning_count;
} student_t_shape;

/* One of the two ranges of gamma of a family. Tables are at offsets, in bytes from the family; a
 * place of them has the values of all nodes of gamma side by side. */
typedef struct student_t_part {
    float gamma_min, gamma_max;
    float kappa;             /* that of masking, times (2 gamma - 3)/(gamma - 1) */
    student_t_constants constants;
    float first, scale;      /* r = 2 - s at the first of the slots, and slots in a unit of r */
    int slot_count, last;    /* last: the cell of what is beyond the slots */
    unsigned slots;          /* codes [slot_count]: the cell of each */
    unsigned cells;          /* student_t_impl_between [] */
    int shapes[3];           /* nodes of gamma: of slopes, of slopes across, of masking */
    unsigned slopes;         /* codes [rows + 1][2][numbers][shapes][2] and a node, as of a shape */
    unsigned columns;        /* [][2 numbers + 1][5], by STUDENT_T_IMPL_ROWS: start, step, square
                              * of codes of values, start and step of those of slopes */
    unsigned across[2];      /* codes [cells + 2][shapes][2] of values and slopes, and
                              * [cells + 2][2][2]: their starts and steps */
    unsigned masking[2];     /* the same of G1/coordinate/cells */
    unsigned rests[3];       /* codes [cells + 1][shapes][4]: cubics, of the visible area in tables,
                              * over that of a unit of rho in no table, with gamma as of masking;
                              * starts and steps; and [shapes]: factors */
    unsigned rhos;           /* [cells + 1][4]: cubics, of rho of the same views */
} student_t_part;

/* Rows of slopes of a family whose codes have steps in common. */
#define STUDENT_T_IMPL_ROWS 16

/* Coefficients along gamma and along the view of a family's albedos. */
#define STUDENT_T_VOLUME_SHAPES 37
#define STUDENT_T_VOLUME_VIEWS 29

/* Albedos of a family under one form of masking: coefficients of splines over (sigma, gamma, view),
 * quadratic, quadratic and cubic. */
typedef struct student_t_volume {
    float shapes[2], sigmas[2];     /* the ends of 2 gamma - 3 and of sigma */
    float first[2], density[2];     /* by shape and by sigma: coordinate of the first node, and
                                     * nodes in a unit */
    float averages_first, averages_density;
    float start[6], step[6];        /* of codes */
    unsigned codes[6];              /* [][37][29]: of sqrt(1 - E), and of bias and F82 less E times
                                     * those of a mirror; [][37]: of log2(1 - E_avg), and of the
                                     * averages of both; 0 where a family has no albedos */
} student_t_volume;

/* All shapes from gamma = 1.501 to infinity: one block of memory without pointers, of so many bytes
 * as it says, which may be copied anywhere, as to a GPU. */
typedef struct student_t_family {
    unsigned magic, layout, bytes;
    float seam;                     /* smaller gamma are those of the last part */
    int parts;
    student_t_part part[2];
    student_t_volume albedo[2];     /* by student_t_masking */
} student_t_family;

/* The weights of four nodes of gamma between two places, as cubics of the position; by table. */
typedef struct student_t_impl_between {
    float from, inverse;            /* the position is inverse (from - r) */
    int starts[3];
    float weights[3][4][4];         /* by power of the position, by node */
} student_t_impl_between;

typedef struct student_t_impl_window {
    int start;
    float weights[4];
} student_t_impl_window;

/* The lobe of one gamma and roughness: what a renderer makes at a hit, and hands to the functions
 * below. Of its members gamma, sigma_x and sigma_y are for users, to read. */
typedef struct student_t_lobe {
    float sigma_x;           /* in [1e-8, 1e6] */
    float gamma;             /* the largest finite number for infinity */
    float sigma_y;           /* in [1e-8, 1e6]; not beside the other, since compilers would load
                              * both at once, and wait until both are stored */
    int is_mirror;           /* a sigma was not above 0: its albedo is 1 */
    int is_ggx;              /* closed forms */
    student_t_law law;
    const student_t_constants *constants;
    const student_t_shape *shape;   /* its tables, or those of a family: */
    const student_t_family *family;
    const student_t_part *part;
    const student_t_family *albedos; /* whose fitted volume is its E; null: the shape's own curve */
    student_t_impl_window slopes, across, masking;
} student_t_lobe;

