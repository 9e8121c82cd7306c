
/* ---- Albedos --------------------------------------------------------------------------------- */

/* Weights of the polynomial through six even nodes at a, a place among them from 0 to 5. */
STUDENT_T_FUNCTION void student_t_impl_six_weights(float a, float weights[6])
{
    const float b = a - 1.0f, c = a - 2.0f, d = a - 3.0f, e = a - 4.0f, f = a - 5.0f;
    weights[0] = b * c * d * e * f * (-1.0f / 120.0f);
    weights[1] = a * c * d * e * f * (1.0f / 24.0f);
    weights[2] = a * b * d * e * f * (-1.0f / 12.0f);
    weights[3] = a * b * c * e * f * (1.0f / 12.0f);
    weights[4] = a * b * c * d * f * (-1.0f / 24.0f);
    weights[5] = a * b * c * d * e * (1.0f / 120.0f);
}

/* The same of six of n even nodes about x; returns the first of them. */
STUDENT_T_FUNCTION int student_t_impl_six(float x, int n, float weights[6])
{
    const float last = STUDENT_T_IMPL_CAST(float, n - 1);
    const float at = student_t_impl_min(student_t_impl_max(x, 0.0f), last);
    int start = STUDENT_T_IMPL_CAST(int, at) - 2;
    start = start < n - 6 ? start : n - 6;
    start = start > 0 ? start : 0;
    student_t_impl_six_weights(at - STUDENT_T_IMPL_CAST(float, start), weights);
    return start;
}

/* The albedos of a lobe, or of its round stand-in where none are baked for it. */
typedef struct student_t_impl_albedo {
    enum student_t_masking masking;
    float sigma;             /* 0: a mirror */
    float less;              /* 2 gamma - 3 */
    /* Of a shape: */
    const student_t_albedo_table *table;
    float coordinate;        /* in [0, 1] */
    float floor;             /* cosine of the first view */
    int row[6];              /* the six nodes along sigma, or by azimuth */
    float weights[6];
    /* Of a lobe that is not round, whose sigma, floor, rows and weights are those of a view: */
    const student_t_turning_albedo *turning;
    /* Of a family, where there is no table: */
    const student_t_family *family;
    const student_t_volume *volume;
    int first[2];            /* of the three coefficients by shape and by sigma */
    float by_shape[3], by_sigma[3];
} student_t_impl_albedo;

/* Near log2(x), by a polynomial of the mantissa; nodes are where the same polynomial puts them. */
STUDENT_T_FUNCTION float student_t_impl_octaves(float x)
{
    const int bits = student_t_impl_bits(x);
    const float m = student_t_impl_of_bits((bits & 0x7fffff) | 0x3f800000) - 1.0f;
    return STUDENT_T_IMPL_CAST(float, (bits >> 23) - 127) +
           m * (m * (m - 4.0f) + 10.0f) * (1.0f / 7.0f);
}

/* The first of three coefficients at x >= 0, a place among nodes, and their weights. */
STUDENT_T_FUNCTION int student_t_impl_three(float x, float weights[3])
{
    const int start = STUDENT_T_IMPL_CAST(int, student_t_impl_max(x, 0.0f) + 0.5f);
    const float d = x - STUDENT_T_IMPL_CAST(float, start), half = 0.5f * d;
    const float ends = half * d + 0.125f;
    weights[0] = ends - half;
    weights[1] = 1.0f - (ends + ends);
    weights[2] = ends + half;
    return start;
}

/* The cosine of the first view of a table. */
STUDENT_T_FUNCTION float student_t_impl_floor(const student_t_albedo_table *t, float sigma)
{
    return t->floor * (t->slope * sigma) / (t->floor + t->slope * sigma);
}

/* The albedos that were baked for a lobe, or none. */
STUDENT_T_FUNCTION const student_t_turning_albedo *
student_t_impl_turning_of(const student_t_lobe *lobe, enum student_t_masking masking)
{
    int i;
    if (!lobe->shape) return STUDENT_T_IMPL_NULL;
    for (i = 0; i < lobe->shape->turning_count; ++i) {
        const student_t_turning_albedo *own = &lobe->shape->turning[i];
        /* A difference of 0: compilers warn of floating-point numbers that are compared. */
        const float off = fabsf(lobe->sigma_x - own->sigma_x) + fabsf(lobe->sigma_y - own->sigma_y);
        if (own->masking == masking && !(off > 0.0f)) return own;
    }
    return STUDENT_T_IMPL_NULL;
}

/* Filled in where it stays, as lobes are. */
STUDENT_T_FUNCTION void student_t_impl_albedo_of(const student_t_lobe *lobe,
                                                 enum student_t_masking masking,
                                                 student_t_impl_albedo *a)
{
    const student_t_impl_albedo none = {masking, 0.0f, 0.0f, STUDENT_T_IMPL_NULL, 0.0f, 0.0f,
                                        {0, 0, 0, 0, 0, 0},
                                        {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}, STUDENT_T_IMPL_NULL,
                                        STUDENT_T_IMPL_NULL, STUDENT_T_IMPL_NULL, {0, 0},
                                        {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    const int form = masking == STUDENT_T_UNCORRELATED ? 0 : 1;
    const float stand_in = sqrtf(lobe->sigma_x * lobe->sigma_y);
    /* What the other kind of tables needs stays 0: compilers warn of copies of what is not set. */
    *a = none;
    a->less = student_t_impl_min(2.0f * lobe->gamma - 3.0f, 1e30f);
    a->turning = student_t_impl_turning_of(lobe, masking);
    if (a->turning) {
        a->table = &a->turning->table;
        a->sigma = stand_in;
    } else if (lobe->albedos) {
        const student_t_volume *t = &lobe->albedos->albedo[form];
        const float s =
            student_t_impl_min(student_t_impl_max(stand_in, t->sigmas[0]), t->sigmas[1]);
        const float d = student_t_impl_min(student_t_impl_max(a->less, t->shapes[0]), t->shapes[1]);
        const float octaves = student_t_impl_octaves(s);
        const float shape = sqrtf(sqrtf(d / (d + 3.0f)));
        const float sigma = student_t_impl_octaves(1.0f + 60.0f * s) + 0.2f * octaves + s;
        a->family = lobe->albedos;
        a->volume = t;
        a->less = d;
        a->sigma = s;
        a->coordinate = (octaves + 2.0f * s - t->averages_first) * t->averages_density;
        a->first[0] = student_t_impl_three((shape - t->first[0]) * t->density[0], a->by_shape);
        a->first[1] = student_t_impl_three((sigma - t->first[1]) * t->density[1], a->by_sigma);
        if (t->codes[0] == 0u) a->sigma = 0.0f; /* without albedos nothing is lost */
    } else {
        const student_t_albedo_table *t = &lobe->shape->albedo[form];
        int i;
        a->table = t;
        a->sigma = student_t_impl_min(student_t_impl_max(stand_in, t->sigma_min), t->sigma_max);
        a->floor = student_t_impl_floor(t, a->sigma);
        a->coordinate = log1pf(a->sigma / t->offset) + t->slow * logf(a->sigma / t->first) +
                       t->linear * a->sigma;
        a->coordinate = (a->coordinate - t->start) / t->range;
        a->row[0] = student_t_impl_six(
            a->coordinate * STUDENT_T_IMPL_CAST(float, t->sigmas - 1), t->sigmas, a->weights);
        for (i = 1; i < 6; ++i) a->row[i] = a->row[0] + i;
        if (!t->values) a->sigma = 0.0f; /* without albedos nothing is lost */
    }
    if (lobe->is_mirror) a->sigma = 0.0f;
}

/* The row of a node beyond either end of n azimuths, where a quarter turn is mirrored. */
STUDENT_T_FUNCTION int student_t_impl_mirrored(int node, int n)
{
    while (n > 1 && (node < 0 || node >= n)) node = node < 0 ? -node : 2 * (n - 1) - node;
    return n > 1 ? node : 0;
}

/* Albedos at the azimuth of v. The nodes are even in the angle half-way between that and the one
 * in unit slopes; what replaces sigma is the roughness along v. */
STUDENT_T_FUNCTION void student_t_impl_turned(student_t_impl_albedo *a, const float v[3])
{
    const student_t_turning_albedo *own = a->turning;
    const float r = sqrtf(v[0] * v[0] + v[1] * v[1]);
    float x = 1.0f, y = 0.0f, at;
    int first, i;
    /* Along the normal the azimuth is arbitrary; NaN fails the comparison, too. */
    if (r > 0.0f && r < 1e30f) {
        x = fabsf(v[0]) / r;
        y = fabsf(v[1]) / r;
    }
    at = atan2f(sqrtf(own->sigma_y) * y, sqrtf(own->sigma_x) * x) * 0.63661977f; /* 2/pi */
    at = student_t_impl_min(at, 1.0f) * STUDENT_T_IMPL_CAST(float, own->table.sigmas - 1);
    x *= own->sigma_x;
    y *= own->sigma_y;
    a->sigma = sqrtf(x * x + y * y);
    a->floor = student_t_impl_floor(a->table, a->sigma);
    first = STUDENT_T_IMPL_CAST(int, at) - 2;
    student_t_impl_six_weights(at - STUDENT_T_IMPL_CAST(float, first), a->weights);
    for (i = 0; i < 6; ++i) a->row[i] = student_t_impl_mirrored(first + i, own->table.sigmas);
}

/* Within about how much of the horizon light is lost, as a cosine. */
STUDENT_T_FUNCTION float student_t_impl_reach(const student_t_impl_albedo *a)
{
    return a->sigma * (1.0f + 1.0f / (6.0f * a->less));
}

/* The cell of a view in a volume, in which four coefficients begin, and their weights. */
STUDENT_T_FUNCTION int
student_t_impl_view_of_volume(const student_t_impl_albedo *a, float mu, float weights[4])
{
    const float d = a->less, sine = sqrtf((1.0f - mu) * (1.0f + mu));
    const float x = d * mu / (d * mu + (6.0f * a->sigma * d + a->sigma) * sine);
    const float h = mu / (1.0f + sine);
    const float at = 14.3f * sqrtf(sqrtf(x)) + 11.7f * sqrtf(sqrtf(h)); /* of 26 cells */
    const int cell = STUDENT_T_IMPL_CAST(int, at);
    const float t = at - STUDENT_T_IMPL_CAST(float, cell), rest = 1.0f - t;
    weights[0] = rest * rest * rest * (1.0f / 6.0f);
    weights[1] = 2.0f / 3.0f - t * t * (1.0f - 0.5f * t);
    weights[2] = 2.0f / 3.0f - rest * rest * (1.0f - 0.5f * rest);
    weights[3] = t * t * t * (1.0f / 6.0f);
    return cell;
}

/* A channel of a volume at a view. */
STUDENT_T_FUNCTION float student_t_impl_channel(const student_t_impl_albedo *a, int channel,
                                                int cell, const float weights[4])
{
    const student_t_volume *t = a->volume;
    const unsigned short *codes =
        student_t_impl_codes(a->family, t->codes[channel]) +
        (a->first[1] * STUDENT_T_VOLUME_SHAPES + a->first[0]) * STUDENT_T_VOLUME_VIEWS + cell;
    float sum[4] = {0.0f, 0.0f, 0.0f, 0.0f};
    int i, j, k;
    for (i = 0; i < 3; ++i) {
        for (j = 0; j < 3; ++j) {
            const unsigned short *four =
                codes + (i * STUDENT_T_VOLUME_SHAPES + j) * STUDENT_T_VOLUME_VIEWS;
            const float w = a->by_sigma[i] * a->by_shape[j];
            for (k = 0; k < 4; ++k) sum[k] += w * STUDENT_T_IMPL_CAST(float, four[k]);
        }
    }
    return t->start[channel] +
           t->step[channel] * ((sum[0] * weights[0] + sum[1] * weights[1]) +
                               (sum[2] * weights[2] + sum[3] * weights[3]));
}

/* The share lost, of a volume. */
STUDENT_T_FUNCTION float
student_t_impl_lost_of_volume(const student_t_impl_albedo *a, int cell, const float weights[4])
{
    const float root = student_t_impl_channel(a, 0, cell, weights);
    return student_t_impl_min(root * root, 1.0f);
}

/* The coordinate of a view by its cosine mu, before it is stretched to [0, 1]. */
STUDENT_T_FUNCTION float student_t_impl_view(const student_t_impl_albedo *a, float mu)
{
    const student_t_albedo_table *t = a->table;
    const float sine = sqrtf((1.0f - mu) * (1.0f + mu));
    const float x = mu / (mu + t->kappa * a->sigma * sine), h = mu / (1.0f + sine);
    const float nu = t->spread * a->sigma;
    const float roots = t->share * sqrtf(sqrtf(x)) + (1.0f - t->share) * sqrtf(sqrtf(h));
    return t->weight * x + t->normal * (nu / (nu + sine)) +
           (1.0f - t->weight - t->normal) * roots;
}

/* Averages of a mirror's bias and F82 over the hemisphere. */
#define STUDENT_T_IMPL_SCHLICK_AVERAGE (1.0f / 21.0f)
#define STUDENT_T_IMPL_F82_AVERAGE 0.14009036f /* 117649/839808 */

/* Bias and F82 of a mirror: (1 - mu)^5 and 7^7/6^6 mu (1 - mu)^6. */
STUDENT_T_FUNCTION void student_t_impl_mirror(float mu, float *bias, float *f82)
{
    const float k = 1.0f - mu, k2 = k * k, k4 = k2 * k2;
    *bias = k4 * k;
    *f82 = 17.651384f * mu * (k4 * k2);
}

/* E - 1, bias and F82 at a cosine mu from the first view up. */
STUDENT_T_FUNCTION void student_t_impl_moments_at(const student_t_impl_albedo *a, float mu,
                                                  float moments[3])
{
    const student_t_albedo_table *t = a->table;
    const float start = student_t_impl_view(a, a->floor);
    const float at = (student_t_impl_view(a, mu) - start) / (1.0f - start);
    float weights[6], sum[3] = {0.0f, 0.0f, 0.0f}, e, mirror_bias, mirror_f82;
    const float views = STUDENT_T_IMPL_CAST(float, t->views - 1);
    const int first = student_t_impl_six(at * views, t->views, weights);
    /* Weights sum to 1: differences from a node in the middle have less to round than values. */
    const float *middle = t->values + 3 * (a->row[2] * t->views + first + 2);
    int i, j, k;
    for (i = 0; i < 6; ++i) {
        const float *node = t->values + 3 * (a->row[i] * t->views + first);
        for (j = 0; j < 6; ++j, node += 3) {
            const float w = a->weights[i] * weights[j];
            for (k = 0; k < 3; ++k) sum[k] += w * (node[k] - middle[k]);
        }
    }
    e = middle[0] + sum[0];
    e = student_t_impl_min(student_t_impl_max(e, -1.0f), 0.0f);
    moments[0] = e;
    student_t_impl_mirror(mu, &mirror_bias, &mirror_f82);
    moments[1] = middle[1] + sum[1] + (1.0f + e) * mirror_bias;
    moments[2] = middle[2] + sum[2] + (1.0f + e) * mirror_f82;
}

/* E - 1, bias and F82 at any cosine, to the limits that they near with a power of it. */
STUDENT_T_FUNCTION void student_t_impl_moments_to_grazing(const student_t_impl_albedo *a, float mu,
                                                          float moments[3])
{
    moments[0] = 0.0f;
    if (a->sigma > 0.0f && !a->table) {
        float weights[4], bias, f82, e;
        const int cell = student_t_impl_view_of_volume(a, mu, weights);
        e = 1.0f - student_t_impl_lost_of_volume(a, cell, weights);
        student_t_impl_mirror(mu, &bias, &f82);
        moments[0] = e - 1.0f;
        moments[1] = student_t_impl_channel(a, 1, cell, weights) + e * bias;
        moments[2] = student_t_impl_channel(a, 2, cell, weights) + e * f82;
        return;
    }
    if (a->sigma > 0.0f)
        student_t_impl_moments_at(a, student_t_impl_max(mu, a->floor), moments);
    if (!(a->sigma > 0.0f) || (mu < a->floor && !(moments[0] < 0.0f))) {
        /* What loses nothing is a mirror, which nears no limit. */
        student_t_impl_mirror(mu, &moments[1], &moments[2]);
    } else if (mu < a->floor) {
        float above[3], power = 1.0f, more = 0.0f;
        int i;
        student_t_impl_moments_at(a, 4.0f * a->floor, above);
        if (a->masking != STUDENT_T_UNCORRELATED) {
            const float ratio = above[0] / moments[0];
            power = ratio > 1.0f ? student_t_impl_min(0.5f * log2f(ratio), 1.0f) : 0.0f;
        }
        if (power > 0.0f) {
            const float whole = expm1f(power * 1.38629436f); /* 4^power - 1 */
            more = (mu > 0.0f ? -expm1f(power * logf(mu / a->floor)) : 1.0f) / whole;
        }
        for (i = 0; i < 3; ++i) moments[i] += more * (moments[i] - above[i]);
        moments[0] = student_t_impl_min(student_t_impl_max(moments[0], -1.0f), 0.0f);
    }
}

/* The same of a view; lobes that are not round look at its azimuth. */
STUDENT_T_FUNCTION void student_t_impl_moments(const student_t_impl_albedo *a, const float v[3],
                                               float moments[3])
{
    const float mu = student_t_impl_unit(v[2]);
    if (a->turning && a->sigma > 0.0f) {
        student_t_impl_albedo turned = *a;
        student_t_impl_turned(&turned, v);
        student_t_impl_moments_to_grazing(&turned, mu, moments);
        return;
    }
    student_t_impl_moments_to_grazing(a, mu, moments);
}

/* The share of light lost, 1 - E, with its digits where E is close to 1. */
STUDENT_T_FUNCTION float student_t_impl_lost(const student_t_impl_albedo *a, const float v[3])
{
    float moments[3];
    if (a->sigma > 0.0f && !a->table) {
        float weights[4];
        const int cell = student_t_impl_view_of_volume(a, student_t_impl_unit(v[2]), weights);
        return student_t_impl_lost_of_volume(a, cell, weights);
    }
    student_t_impl_moments(a, v, moments);
    return -moments[0];
}

/* ln(1 - E_avg), or what stands for -infinity, and the averages of bias and F82. */
STUDENT_T_FUNCTION void student_t_impl_averages(const student_t_impl_albedo *a, float averages[3])
{
    const student_t_albedo_table *t = a->table;
    float weights[6];
    const float *node;
    int i;
    averages[0] = -1e30f;
    averages[1] = STUDENT_T_IMPL_SCHLICK_AVERAGE;
    averages[2] = STUDENT_T_IMPL_F82_AVERAGE;
    if (!(a->sigma > 0.0f)) return;
    if (!t) {
        const student_t_volume *volume = a->volume;
        float sum[3], by_sigma[3], e;
        const int first = student_t_impl_three(a->coordinate, by_sigma);
        int j, k;
        for (k = 0; k < 3; ++k) {
            const unsigned short *codes = student_t_impl_codes(a->family, volume->codes[3 + k]) +
                                          first * STUDENT_T_VOLUME_SHAPES + a->first[0];
            sum[k] = 0.0f;
            for (i = 0; i < 3; ++i, codes += STUDENT_T_VOLUME_SHAPES)
                for (j = 0; j < 3; ++j)
                    sum[k] += by_sigma[i] * a->by_shape[j] * STUDENT_T_IMPL_CAST(float, codes[j]);
            sum[k] = volume->start[3 + k] + volume->step[3 + k] * sum[k];
        }
        if (sum[0] < -120.0f) return; /* next to nothing is lost */
        e = 1.0f - student_t_impl_min(exp2f(sum[0]), 1.0f);
        averages[0] = sum[0] * 0.69314718f;
        averages[1] = sum[1] + e * averages[1];
        averages[2] = sum[2] + e * averages[2];
        return;
    }
    if (a->turning) {
        for (i = 0; i < 3; ++i) averages[i] = t->averages[i];
        return;
    }
    i = student_t_impl_six(a->coordinate * STUDENT_T_IMPL_CAST(float, t->average_sigmas - 1),
                           t->average_sigmas, weights);
    node = t->averages + 3 * i;
    averages[0] = averages[1] = averages[2] = 0.0f;
    for (i = 0; i < 6; ++i, node += 3) {
        averages[0] += weights[i] * node[0];
        averages[1] += weights[i] * node[1];
        averages[2] += weights[i] * node[2];
    }
}

STUDENT_T_FUNCTION float student_t_impl_lost_average(const student_t_impl_albedo *a)
{
    float averages[3];
    student_t_impl_averages(a, averages);
    return student_t_impl_min(expf(averages[0]), 1.0f);
}

/* Scale, bias and F82, each in its range. */
STUDENT_T_FUNCTION void student_t_impl_limit(float e, float bias, float f82, float parts[3])
{
    parts[1] = student_t_impl_min(student_t_impl_max(bias, 0.0f), e);
    parts[0] = e - parts[1];
    parts[2] = student_t_impl_unit(f82);
}

/* Directional albedo E of one bounce with F = 1, in [0, 1], for a view or light v: of the lobe if
 * it is round or its shape has albedos of its roughness, and else of the round lobe of
 * sqrt(sigma_x sigma_y), which is off by up to 0.6. */
STUDENT_T_FUNCTION float student_t_lobe_albedo(const student_t_lobe *lobe,
                                          const float v[3], enum student_t_masking masking)
{
    student_t_impl_albedo a;
    student_t_impl_albedo_of(lobe, masking, &a);
    return 1.0f - student_t_impl_lost(&a, v);
}

/* Its parts: Schlick's reflectance F0 + (F90 - F0)(1 - v.m)^5 has the albedo F0 scale + F90 bias,
 * with scale + bias = E. F82 is the moment of (v.m)(1 - v.m)^6 over its peak, at v.m = 1/7: a metal
 * of OpenPBR, whose tint lowers the reflectance there by b, has b F82 less. */
STUDENT_T_FUNCTION void student_t_lobe_albedo_parts(const student_t_lobe *lobe,
                                               const float v[3], enum student_t_masking masking,
                                               float scale_bias_f82[3])
{
    student_t_impl_albedo a;
    float moments[3];
    student_t_impl_albedo_of(lobe, masking, &a);
    student_t_impl_moments(&a, v, moments);
    student_t_impl_limit(1.0f + moments[0], moments[1], moments[2], scale_bias_f82);
}

/* The average of E over the hemisphere of views, weighted by the cosine. */
STUDENT_T_FUNCTION float student_t_lobe_albedo_average(const student_t_lobe *lobe,
                                                  enum student_t_masking masking)
{
    student_t_impl_albedo a;
    student_t_impl_albedo_of(lobe, masking, &a);
    return 1.0f - student_t_impl_lost_average(&a);
}

/* The averages of the parts. */
STUDENT_T_FUNCTION void student_t_lobe_albedo_average_parts(const student_t_lobe *lobe,
                                                       enum student_t_masking masking,
                                                       float scale_bias_f82[3])
{
    student_t_impl_albedo a;
    float averages[3];
    student_t_impl_albedo_of(lobe, masking, &a);
    student_t_impl_averages(&a, averages);
    student_t_impl_limit(1.0f - student_t_impl_min(expf(averages[0]), 1.0f), averages[1],
                         averages[2], scale_bias_f82);
}

/* The lobe of further bounces from three losses; what loses nothing gets nothing back. */
STUDENT_T_FUNCTION float student_t_impl_kulla_conty(float lost_v, float lost_l, float average)
{
    return average > STUDENT_T_SMALLEST
               ? STUDENT_T_IMPL_INVERSE_PI * (lost_v * lost_l) / average
               : 0.0f;
}

/* The lobe of all bounces after the first with F = 1, a BRDF without the cosine:
 * (1 - E(v))(1 - E(l))/(pi (1 - E_avg)) per steradian (Kulla & Conty 2017). For a conductor
 * multiply it by F_avg^2 E_avg/(1 - F_avg (1 - E_avg)), with F_avg its average reflectance, which
 * is (20 F0 + F90)/21 for Schlick's. Drawing lights by the cosine suits it for sigma >= 0.3; smooth
 * surfaces lose their light at grazing, where such samples have weights of the order of 1/sigma. */
STUDENT_T_FUNCTION float student_t_lobe_compensation(const student_t_lobe *lobe, const float v[3],
                                                     const float l[3],
                                                     enum student_t_masking masking)
{
    student_t_impl_albedo a;
    if (!(v[2] > 0.0f && l[2] > 0.0f)) return 0.0f;
    student_t_impl_albedo_of(lobe, masking, &a);
    return student_t_impl_kulla_conty(student_t_impl_lost(&a, v), student_t_impl_lost(&a, l),
                                      student_t_impl_lost_average(&a));
}

/* The same from albedos E(v), E(l) and E_avg that are at hand: a renderer looks up that of a view
 * once for all its lights, and the average once for a material. 0 where E_avg is not below 1. */
STUDENT_T_FUNCTION float student_t_compensation_from(float e_v, float e_l, float e_average)
{
    return student_t_impl_kulla_conty(1.0f - e_v, 1.0f - e_l, 1.0f - e_average);
}
