/* ---- Numbers ---------------------------------------------------------------------------------
 * Comparisons are written so that NaN takes the second value. */

#define STUDENT_T_LARGEST 3.4028234e38f
#define STUDENT_T_SMALLEST 1.17549435e-38f

STUDENT_T_FUNCTION float student_t_impl_max(float a, float b) { return a > b ? a : b; }
STUDENT_T_FUNCTION float student_t_impl_min(float a, float b) { return a < b ? a : b; }

/* x in [0, 1], and 0 for NaN. */
STUDENT_T_FUNCTION float student_t_impl_unit(float x)
{
    return student_t_impl_min(student_t_impl_max(x, 0.0f), 1.0f);
}

/* A density, which may have overflowed; NaN, of arguments that are NaN, is 0. */
STUDENT_T_FUNCTION float student_t_impl_finite(float x)
{
    return student_t_impl_min(student_t_impl_max(x, 0.0f), STUDENT_T_LARGEST);
}

STUDENT_T_FUNCTION float student_t_impl_sigma(float sigma)
{
    return student_t_impl_min(student_t_impl_max(sigma, 1e-8f), 1e6f);
}

/* The cell of x, which is in [0, cells] to rounding, and the position in it; at the end, the cell
 * after the last. */
STUDENT_T_FUNCTION int student_t_impl_cell(float x, float *position)
{
    const int cell = (int)x;
    *position = x - (float)cell;
    return cell;
}

/* The cubic of a cell. */
STUDENT_T_FUNCTION float student_t_impl_cubic(const float *c, float w)
{
    return (c[0] + w * c[1]) + (w * w) * (c[2] + w * c[3]);
}

/* ---- Directions ------------------------------------------------------------------------------ */

/* A direction with its horizontal part times sigma. */
typedef struct student_t_impl_direction {
    float x, y, frame; /* horizontal part, and its length: scaled to 1 where it is short */
    float rho, z;      /* length of the horizontal part, and vertical part, >= 0, not both 0 */
    float rho2;        /* the square of rho, before the root */
} student_t_impl_direction;

STUDENT_T_FUNCTION student_t_impl_direction
student_t_impl_stretch(float sigma_x, float sigma_y, const float w[3])
{
    student_t_impl_direction d;
    d.x = sigma_x * w[0];
    d.y = sigma_y * w[1];
    d.rho2 = d.x * d.x + d.y * d.y;
    d.rho = sqrtf(d.rho2);
    d.z = student_t_impl_unit(w[2]);
    d.frame = d.rho;
    if (!(d.rho >= 1e-6f)) { /* else squares of normals would leave single precision */
        if (d.rho >= 1e-18f) { /* whose own square is still in it */
            d.x /= d.rho;
            d.y /= d.rho;
        } else { /* upright; straight down, null or NaN: at the horizon */
            d.x = 1.0f;
            d.y = 0.0f;
            d.z = d.z > 0.0f ? 1.0f : 0.0f; /* else the square of a small one would vanish */
            d.rho2 = d.rho = 1.0f - d.z;
        }
        d.frame = 1.0f;
    }
    return d;
}

/* 1/(area of the microsurface seen from a direction) = G1/z, finite at grazing. */
STUDENT_T_FUNCTION float
student_t_impl_inverse_area(const student_t_shape *shape, student_t_impl_direction d)
{
    if (shape->is_ggx) {
        const float length = sqrtf(d.rho2 + d.z * d.z);
        return 2.0f / student_t_impl_max(d.z + length, STUDENT_T_SMALLEST);
    } else {
        const float cells = shape->masking_cells, across = shape->kappa * d.rho;
        const float area = student_t_impl_max(d.z + across, 1e-30f); /* less than any has */
        const float r = cells / area;
        float at = d.z * r, w;
        int cell;
        if (shape->masking_crowded) at = (1.0f - sqrtf(student_t_impl_unit(across / area))) * cells;
        cell = student_t_impl_cell(at, &w);
        return student_t_impl_cubic(shape->masking + 4 * cell, w) * r;
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

/* Normal distribution function D(m): D(m) (m.n) integrates to 1 over all m. */
STUDENT_T_FUNCTION float
student_t_d(const student_t_shape *shape, const float sigma[2], const float m[3])
{
    const float sigma_x = student_t_impl_sigma(sigma[0]), sigma_y = student_t_impl_sigma(sigma[1]);
    const float x = m[0] / sigma_x, y = m[1] / sigma_y, z = m[2];
    const float scale = 1.0f / (3.14159265f * sigma_x * sigma_y);
    const float z2 = z * z, part = shape->d_s * (x * x + y * y);
    const float b = student_t_impl_max(z2 + part, STUDENT_T_SMALLEST);
    float root = 1.0f / b; /* of pi sigma_x sigma_y D = b^-gamma z^(2 gamma - 4) */
    if (!(z > 0.0f && part >= 0.0f)) return 0.0f;
    if (!shape->is_ggx) {
        /* ln(b/z2), where z2 may underflow. */
        const float growth =
            part < 1e3f * z2 ? log1pf(part / z2) : logf(b) - 2.0f * logf(z);
        root *= expf(shape->d_power * growth);
    }
    return student_t_impl_finite((scale * root) * root);
}

/* Smith's masking G1(w) in [0, 1]. */
STUDENT_T_FUNCTION float
student_t_g1(const student_t_shape *shape, const float sigma[2], const float w[3])
{
    const student_t_impl_direction d =
        student_t_impl_stretch(student_t_impl_sigma(sigma[0]), student_t_impl_sigma(sigma[1]), w);
    return student_t_impl_min(d.z * student_t_impl_inverse_area(shape, d), 1.0f);
}

/* Smith's lambda(w) = 1/G1 - 1, infinite at and below the horizon. Its absolute error is that of
 * G1. */
STUDENT_T_FUNCTION float
student_t_lambda(const student_t_shape *shape, const float sigma[2], const float w[3])
{
    return 1.0f / student_t_g1(shape, sigma, w) - 1.0f;
}

/* Masking and shadowing G2 of view and light. */
STUDENT_T_FUNCTION float student_t_g2(const student_t_shape *shape, const float sigma[2],
                                      const float v[3], const float l[3],
                                      enum student_t_masking masking)
{
    const float a = student_t_g1(shape, sigma, v), b = student_t_g1(shape, sigma, l);
    const float both = a * b, sum = a + b - both;
    if (masking == STUDENT_T_UNCORRELATED) return both;
    return sum > 0.0f ? both / sum : 0.0f;
}

/* The weight f cos/pdf of a light reflected off a sampled visible normal, without Fresnel:
 * G2(v, l)/G1(v) in [0, 1]. */
STUDENT_T_FUNCTION float student_t_reflection_weight(const student_t_shape *shape,
                                                     const float sigma[2], const float v[3],
                                                     const float l[3],
                                                     enum student_t_masking masking)
{
    const float b = student_t_g1(shape, sigma, l);
    if (!(v[2] > 0.0f && b > 0.0f)) return 0.0f;
    if (masking == STUDENT_T_UNCORRELATED) return b;
    return b / (b + student_t_g1(shape, sigma, v) * (1.0f - b));
}

