
/* ---- Directions ------------------------------------------------------------------------------ */

/* A direction with its horizontal part times sigma. */
typedef struct student_t_impl_direction {
    float x, y, frame; /* horizontal part, and its length: scaled to 1 where it is short */
    float rho, z;      /* length of the horizontal part, and vertical part, >= 0, not both 0 */
    float rho2;        /* the square of rho, before the root */
} student_t_impl_direction;

/* By pointers, here and below: a small struct by value would be written member by member, and read
 * back at once, which waits for all of them. */
STUDENT_T_FUNCTION void student_t_impl_stretch(const student_t_lobe *lobe, const float w[3],
                                               student_t_impl_direction *d)
{
    d->x = lobe->sigma_x * w[0];
    d->y = lobe->sigma_y * w[1];
    d->rho2 = d->x * d->x + d->y * d->y;
    d->rho = sqrtf(d->rho2);
    d->z = student_t_impl_unit(w[2]);
    d->frame = d->rho;
    if (!(d->rho >= 1e-6f)) { /* else squares of normals would leave single precision */
        if (d->rho >= 1e-18f) { /* whose own square is still in it */
            d->x /= d->rho;
            d->y /= d->rho;
        } else { /* upright; straight down, null or NaN: at the horizon */
            d->x = 1.0f;
            d->y = 0.0f;
            d->z = d->z > 0.0f ? 1.0f : 0.0f; /* else the square of a small one would vanish */
            d->rho2 = d->rho = 1.0f - d->z;
        }
        d->frame = 1.0f;
    }
}

/* 1/(area of the microsurface seen from a direction) = G1/z, finite at grazing. */
STUDENT_T_FUNCTION float
student_t_impl_inverse_area(const student_t_lobe *lobe, const student_t_impl_direction *d)
{
    const student_t_constants *c = lobe->constants;
    if (lobe->is_ggx) {
        const float length = sqrtf(d->rho2 + d->z * d->z);
        return 2.0f / student_t_impl_max(d->z + length, STUDENT_T_SMALLEST);
    } else {
        const float cells = c->masking_cells, across = lobe->law.kappa * d->rho;
        const float area = student_t_impl_max(d->z + across, 1e-30f); /* less than any has */
        const float r = cells / area;
        float at = d->z * r, w;
        int cell;
        if (c->masking_crowded) at = (1.0f - sqrtf(student_t_impl_unit(across / area))) * cells;
        cell = student_t_impl_cell(at, &w);
        return student_t_impl_masking_at(lobe, cell, w) * r;
    }
}

/* A normal, normalised and raised to the least cosine, which keeps D finite; z times shrink. */
STUDENT_T_FUNCTION void student_t_impl_raise(float x, float y, float z, float shrink, float m[3])
{
    const float r = 1.0f / sqrtf(x * x + z * z + y * y);
    m[0] = x * r;
    m[1] = y * r;
    m[2] = student_t_impl_max(z * r * shrink, 1e-18f);
}

/* Turns a normal that rounding has put behind the silhouette back onto it. */
STUDENT_T_FUNCTION void student_t_impl_face(float vx, float vy, float vz, float m[3])
{
    const float facing = vx * m[0] + vy * m[1] + vz * m[2];
    if (facing < 0.0f) {
        const float length2 = student_t_impl_max(vx * vx + vy * vy + vz * vz, STUDENT_T_SMALLEST);
        const float back = facing / length2;
        student_t_impl_raise(m[0] - back * vx, m[1] - back * vy, m[2] - back * vz, 1.0f, m);
    }
}

/* ---- Normals and masking --------------------------------------------------------------------- */

/* D of a normal of any length, whose square is given. */
STUDENT_T_FUNCTION float
student_t_impl_d(const student_t_lobe *lobe, const float m[3], float length2)
{
    const float x = m[0] / lobe->sigma_x, y = m[1] / lobe->sigma_y, z = m[2];
    const float scale = 1.0f / (3.14159265f * lobe->sigma_x * lobe->sigma_y);
    const float z2 = z * z, part = lobe->law.d_s * (x * x + y * y);
    /* Of pi sigma_x sigma_y D = b^-gamma z^(2 gamma - 4), for a normal of length 1. */
    float root = length2 / student_t_impl_max(z2 + part, STUDENT_T_SMALLEST);
    if (!(z > 0.0f && part >= 0.0f)) return 0.0f;
    if (!lobe->is_ggx)
        root = student_t_impl_power_of_growth(z2, part, lobe->law.d_power, root);
    return student_t_impl_finite((scale * root) * root);
}

/* Normal distribution function D(m): D(m) (m.n) integrates to 1 over all m. */
STUDENT_T_FUNCTION float student_t_lobe_d(const student_t_lobe *lobe, const float m[3])
{
    return student_t_impl_d(lobe, m, 1.0f);
}

/* Smith's masking G1(w) in [0, 1]. */
STUDENT_T_FUNCTION float student_t_lobe_g1(const student_t_lobe *lobe, const float w[3])
{
    student_t_impl_direction d;
    student_t_impl_stretch(lobe, w, &d);
    return student_t_impl_min(d.z * student_t_impl_inverse_area(lobe, &d), 1.0f);
}

/* Smith's lambda(w) = 1/G1 - 1, infinite at and below the horizon. Its absolute error is that of
 * G1. */
STUDENT_T_FUNCTION float student_t_lobe_lambda(const student_t_lobe *lobe, const float w[3])
{
    return 1.0f / student_t_lobe_g1(lobe, w) - 1.0f;
}

/* G2 of the G1 of two directions. */
STUDENT_T_FUNCTION float student_t_impl_g2(float a, float b, enum student_t_masking masking)
{
    const float both = a * b, sum = a + b - both;
    if (masking == STUDENT_T_UNCORRELATED) return both;
    return sum > 0.0f ? both / sum : 0.0f;
}

/* Masking and shadowing G2 of view and light. */
STUDENT_T_FUNCTION float student_t_lobe_g2(const student_t_lobe *lobe, const float v[3],
                                           const float l[3], enum student_t_masking masking)
{
    return student_t_impl_g2(student_t_lobe_g1(lobe, v), student_t_lobe_g1(lobe, l), masking);
}

/* G2/G1(v) of the G1 of a view above the horizon and that of a light. */
STUDENT_T_FUNCTION float student_t_impl_weight(float a, float b, enum student_t_masking masking)
{
    if (!(b > 0.0f)) return 0.0f;
    if (masking == STUDENT_T_UNCORRELATED) return b;
    return b / (b + a * (1.0f - b));
}

/* The weight f cos/pdf of a light reflected off a sampled visible normal, without Fresnel:
 * G2(v, l)/G1(v) in [0, 1]. */
STUDENT_T_FUNCTION float student_t_lobe_reflection_weight(const student_t_lobe *lobe,
                                                          const float v[3], const float l[3],
                                                          enum student_t_masking masking)
{
    if (!(v[2] > 0.0f)) return 0.0f;
    return student_t_impl_weight(student_t_lobe_g1(lobe, v), student_t_lobe_g1(lobe, l), masking);
}

/* What a facet reflects or refracts between a view and a light. */
typedef struct student_t_impl_facet {
    float density; /* D G1(v)/v_z: four times the density of the reflected light */
    float weight;  /* G2(v, l)/G1(v) */
} student_t_impl_facet;

/* The facet of a normal m, whose length squared is given, between v and l, all above the horizon;
 * of light that is transmitted l is the opposite. */
STUDENT_T_FUNCTION student_t_impl_facet
student_t_impl_facet_of(const student_t_lobe *lobe, const float v[3], const float m[3],
                        float length2, const float l[3], enum student_t_masking masking)
{
    student_t_impl_facet facet;
    student_t_impl_direction d;
    float inverse, a;
    student_t_impl_stretch(lobe, v, &d);
    inverse = student_t_impl_inverse_area(lobe, &d);
    a = student_t_impl_min(d.z * inverse, 1.0f);
    facet.density = student_t_impl_finite(student_t_impl_d(lobe, m, length2) * inverse);
    facet.weight = student_t_impl_weight(a, student_t_lobe_g1(lobe, l), masking);
    return facet;
}

/* Returns f without the cosine, D G2/(4 (v.n) (l.n)), for facets that reflect all light, and in
 * *pdf the density with which visible normals reflect v to l, with one D for both. Both are 0 where
 * v or l is not above the horizon. */
STUDENT_T_FUNCTION float student_t_lobe_eval_pdf(const student_t_lobe *lobe, const float v[3],
                                                 const float l[3], enum student_t_masking masking,
                                                 float *pdf)
{
    float m[3], length2;
    student_t_impl_facet facet;
    *pdf = 0.0f;
    m[0] = v[0] + l[0];
    m[1] = v[1] + l[1];
    m[2] = v[2] + l[2];
    length2 = m[0] * m[0] + m[1] * m[1] + m[2] * m[2];
    if (!(v[2] > 0.0f && l[2] > 0.0f && length2 <= STUDENT_T_LARGEST)) return 0.0f;
    facet = student_t_impl_facet_of(lobe, v, m, length2, l, masking);
    *pdf = 0.25f * facet.density;
    return student_t_impl_finite(facet.weight * *pdf * student_t_impl_finite(1.0f / l[2]));
}

/* Whether a lobe is so narrow that its surface is better rendered as a mirror: whether the mean
 * absolute slope along the rougher direction is below 1e-3, and at most 2.5e-3 are masked at the
 * cosine 0.01. That is sigma below 1e-3 for gamma >= 2, 4e-4 for 1.8, 6e-5 for 1.6, 2e-5 for 1.55,
 * and 2e-7 for 1.501. */
STUDENT_T_FUNCTION int student_t_effectively_smooth(const student_t_lobe *lobe)
{
    const float sigma = student_t_impl_max(lobe->sigma_x, lobe->sigma_y);
    student_t_impl_direction d = {0.0f, 0.0f, 1.0f, 1.0f, 0.0f, 1.0f};
    float mean;
    if (!(0.56f * sigma < 1e-3f)) return 0; /* no gamma has a smaller mean than 0.56 sigma */
    mean = 2.0f / student_t_impl_inverse_area(lobe, &d);
    d.z = 0.01f;
    d.rho = 0.99995f * sigma;
    d.rho2 = d.rho * d.rho;
    return sigma * mean < 1e-3f && 1.0f - d.z * student_t_impl_inverse_area(lobe, &d) <= 2.5e-3f;
}
