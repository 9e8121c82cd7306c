
/* ---- Visible normals ------------------------------------------------------------------------- */

/* The sine and the cosine of 2 pi u for u in [0, 1], to 2e-7: the polynomial through Chebyshev's
 * points of a quarter turn, in a fraction of a library's time. */
STUDENT_T_FUNCTION float student_t_impl_sine(float x)
{
    const float y = x * x;
    return x * (6.2831853f +
                y * (-41.34168f + y * (81.602475f + y * (-76.58117f + y * 39.759827f))));
}

STUDENT_T_FUNCTION void student_t_impl_turn(float u, float *sine, float *cosine)
{
    const float x = 0.5f - u, quarter = fabsf(x) - 0.25f, rest = 0.25f - fabsf(quarter);
    *sine = student_t_impl_sine(x < 0.0f ? -rest : rest);
    *cosine = student_t_impl_sine(quarter);
}

/* A visible normal of GGX by spherical caps (Dupuy & Benyoub 2023, doi:10.1111/cgf.14867). */
STUDENT_T_FUNCTION void student_t_impl_sample_cap(float sigma_x, float sigma_y, const float v[3],
                                                  const float u[2], float m[3])
{
    const float vz = student_t_impl_max(v[2], 0.0f);
    float x = sigma_x * v[0], y = sigma_y * v[1], z = vz;
    float length = sqrtf(x * x + y * y + z * z), height, up, radius, sine, cosine;
    if (!(length >= 1e-6f)) { /* the squares of a short view would leave single precision */
        const float r = length > 0.0f ? 1.0f / length : 0.0f;
        x *= r;
        y *= r;
        z = length > 0.0f ? z * r : 1.0f;
        if (!(length > 0.0f)) x = y = 0.0f;
        length = 1.0f;
    }
    /* First the height of the half vector, so that it keeps its digits where the cap ends at -z; at
     * least 2^-24 of the cap's: on the horizon a normal may have no length. */
    height = student_t_impl_max(1.0f - student_t_impl_unit(u[0]), 5.9604645e-8f) * (length + z);
    up = height - z;
    radius = sqrtf(student_t_impl_max((length - up) * (length + up), 0.0f));
    student_t_impl_turn(student_t_impl_unit(u[1]), &sine, &cosine);
    x = sigma_x * (x + radius * cosine);
    y = sigma_y * (y + radius * sine);
    {
        const float vx = v[0], vy = v[1];
        student_t_impl_raise(x, y, height, 1.0f, m);
        student_t_impl_face(vx, vy, vz, m);
    }
}

/* The distance of a random number from the nearer of 0 and 1, and 0 outside them. */
STUDENT_T_FUNCTION float student_t_impl_end(float u)
{
    return student_t_impl_max(student_t_impl_min(u, 1.0f - u), 0.0f);
}

/* -1 if so, else 1: no branch, which no processor could predict of a random number. */
STUDENT_T_FUNCTION float student_t_impl_sign(int negative)
{
    return STUDENT_T_IMPL_CAST(float, 1 - 2 * negative);
}

/* A visible normal by inverting the distributions of two slopes, which are independent: x : z in
 * the plane of incidence and t : tz across it, in units of sqrt(z z + s x x). Tables hold the
 * distance g of a slope's half tangent from the end of its half, so that the slope is 2(1 - g) over
 * g(2 - g). */
STUDENT_T_FUNCTION void student_t_impl_sample_tables(const student_t_lobe *lobe, const float v[3],
                                                     const float u[2], float m[3])
{
    const student_t_constants *c = lobe->constants;
    student_t_impl_direction d;
    float along = u[0], number = 1.0f, length, at, silhouette, x, z, t, tz, norm;
    float sign = 1.0f, shrink = 1.0f, clear;
    int is_heavy = 0;

    /* The slope across. */
    {
        const float root = sqrtf(sqrtf(student_t_impl_end(u[1])));
        float w, g;
        const int cell = student_t_impl_cell(root * c->across_scale, &w);
        g = student_t_impl_across_at(lobe, cell, w);
        t = (g - 1.0f) * student_t_impl_sign(u[1] > 0.5f);
        tz = g * (2.0f - g);
    }

    /* The view, among the rows of the table, and the g of its silhouette in the first half. */
    student_t_impl_stretch(lobe, v, &d);
    length = sqrtf(d.rho2 + d.z * d.z);
    {
        const float steep = length + d.z;
        /* Next to normal incidence 1 - tau loses digits, which the narrow cells there need. */
        silhouette = c->heavy_per_row > 0.0f ? d.rho * (steep + d.rho) / (steep * (d.rho + length))
                                  : 1.0f - d.z / (d.rho + length);
        silhouette = student_t_impl_unit(silhouette);
        at = student_t_impl_max(c->rows_first - c->rows_first * silhouette,
                                c->rows_second_end - c->rows_second * silhouette);
        at = student_t_impl_max(at, c->rows - c->rows_third * silhouette);
    }

    /* The first number chooses between the tables and what is in none, which comes last. */
    if (c->heavy_per_row > 0.0f) {
        float rest;
        const float share = student_t_impl_share_at(lobe, at, &rest);
        along = student_t_impl_unit(along);
        is_heavy = along > rest;
        number = is_heavy ? student_t_impl_min((1.0f - along) / share, 1.0f) : 1.0f;
        along /= rest;
    }

    /* Half the slope in the plane. */
    if (is_heavy) {
        /* (1 + s x x)^(-1/2) = number^exponent, at least 2^-100; what would make z subnormal is
         * kept apart. */
        const float power = log2f(student_t_impl_max(number, 1e-37f)) * lobe->law.heavy_exponent;
        const float zeta = exp2f(student_t_impl_max(power, -100.0f));
        const float large = student_t_impl_max(zeta, 1e-15f);
        x = 0.5f * sqrtf(student_t_impl_max((1.0f - zeta) * (1.0f + zeta), 0.0f));
        z = large * lobe->law.heavy_root_s;
        shrink = zeta / large;
        clear = x + z;
    } else {
        const int half = along > 0.5f;
        const float root = sqrtf(sqrtf(student_t_impl_end(along)));
        float w, between, g;
        const int cell = student_t_impl_cell(root * c->along_scale, &w);
        const int row = student_t_impl_cell(at, &between);
        g = student_t_impl_along_at(lobe, row, half, cell, between, w);
        x = g - 1.0f;
        z = g * (2.0f - g);
        sign = student_t_impl_sign(half);
        clear = g - silhouette * (0.5f + 0.5f * sign);
    }

    /* The normal, turned to the azimuth of the view. */
    norm = sqrtf(z * z + (4.0f * lobe->law.s) * (x * x));
    {
        const float vx = v[0], vy = v[1];
        const float ahead = x * (sign * tz), aside = norm * t;
        student_t_impl_raise(lobe->sigma_x * (ahead * d.x - aside * d.y),
                             lobe->sigma_y * (ahead * d.y + aside * d.x),
                             z * (0.5f * (d.frame * tz)), shrink, m);
        /* v.m is at least rho length/|m| times g tz less that of the silhouette, from which ten
         * roundings, of terms of up to rho length (3 + 6 |t|)/|m|, cannot take it below 0. */
        if (!(clear * tz >= 2e-6f * tz + 4e-6f * fabsf(t)))
            student_t_impl_face(vx, vy, d.z, m);
    }
}

/* A normal m visible from v, from two numbers. u[0] chooses the slope along the azimuth of the view
 * and u[1] that across, both rising (for gamma < 1.8 within either of two parts); for GGX they are
 * height and azimuth of a point of a spherical cap. m is of unit length and above the horizon. */
STUDENT_T_FUNCTION void student_t_lobe_sample_visible_normal(const student_t_lobe *lobe,
                                                             const float v[3], const float u[2],
                                                             float m[3])
{
    if (lobe->is_ggx) {
        student_t_impl_sample_cap(lobe->sigma_x, lobe->sigma_y, v, u, m);
    } else {
        student_t_impl_sample_tables(lobe, v, u, m);
    }
}

/* Density of visible normals, max(0, v.m) D(m) G1(v)/(v.n). */
STUDENT_T_FUNCTION float student_t_lobe_visible_normal_pdf(const student_t_lobe *lobe,
                                                           const float v[3], const float m[3])
{
    student_t_impl_direction d;
    const float facing = student_t_impl_max(v[0] * m[0] + v[1] * m[1] + v[2] * m[2], 0.0f);
    const float density = facing * student_t_lobe_d(lobe, m);
    student_t_impl_stretch(lobe, v, &d);
    return student_t_impl_finite(density * student_t_impl_inverse_area(lobe, &d));
}

/* The light l = 2 (v.m) m - v that v is reflected to. */
STUDENT_T_FUNCTION void student_t_reflect(const float v[3], const float m[3], float l[3])
{
    const float twice = 2.0f * (v[0] * m[0] + v[1] * m[1] + v[2] * m[2]);
    l[0] = twice * m[0] - v[0];
    l[1] = twice * m[1] - v[1];
    l[2] = twice * m[2] - v[2];
}

/* Density of the light that v is reflected to by a visible normal m: that of m over 4 v.m, which is
 * D(m) G1(v)/(4 v.n). */
STUDENT_T_FUNCTION float student_t_lobe_reflection_pdf(const student_t_lobe *lobe, const float v[3],
                                                  const float m[3])
{
    student_t_impl_direction d;
    if (!(v[0] * m[0] + v[1] * m[1] + v[2] * m[2] > 0.0f)) return 0.0f;
    student_t_impl_stretch(lobe, v, &d);
    return student_t_impl_finite(0.25f * student_t_lobe_d(lobe, m) *
                                 student_t_impl_inverse_area(lobe, &d));
}

