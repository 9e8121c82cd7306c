
/* ---- Interfaces of two transparent media ------------------------------------------------------
 * Indices of refraction are those of one side over the other. eta of a material is inside over
 * outside, n_i/n_o; of a view it is that of the far side over that of the side of the view. Cosines
 * are between a direction and the normal of a facet. */

/* eta as materials take it: at the nearer end of [1e-3, 1e3], NaN at 1, and 1 within 1e-5 of it,
 * where single precision does not tell refracted light from what goes straight on. */
STUDENT_T_FUNCTION float student_t_impl_index(float eta)
{
    if (!(fabsf(eta - 1.0f) >= 1e-5f)) return 1.0f;
    return student_t_impl_min(student_t_impl_max(eta, 1e-3f), 1e3f);
}

/* The square of eta times the refracted cosine, by Snell's law; not above 0 where all light is
 * reflected. As a product it keeps a small cosine where eta is near 1. */
STUDENT_T_FUNCTION float student_t_impl_refracted2(float eta, float cosine)
{
    return (eta - 1.0f) * (eta + 1.0f) + cosine * cosine;
}

/* Reflectance of unpolarised light from the cosines on both sides; the same from either. */
STUDENT_T_FUNCTION float student_t_impl_fresnel_of(float eta, float cosine, float refracted)
{
    const float p = (eta * cosine - refracted) / (eta * cosine + refracted);
    const float s = (cosine - eta * refracted) / (cosine + eta * refracted);
    return 0.5f * (p * p + s * s);
}

/* The exact reflectance of a dielectric in [0, 1] for unpolarised light at a cosine in [0, 1], of
 * eta > 0 seen from the view: 1 beyond the critical angle and at grazing, 0 everywhere for eta = 1.
 * The rest is refracted. */
STUDENT_T_FUNCTION float student_t_fresnel_dielectric(float eta, float cosine)
{
    const float square = student_t_impl_refracted2(eta, cosine);
    if (eta == 1.0f) return 0.0f; /* also at grazing, where the formula is 0/0 */
    return square > 0.0f ? student_t_impl_fresnel_of(eta, cosine, sqrtf(square) / eta) : 1.0f;
}

/* The cosine m.n below which facets of gamma < 2 that refract are only sampled: a view and a light
 * in single precision do not tell m.n to a hundredth there. The same for eta and 1/eta. */
STUDENT_T_FUNCTION float student_t_steep_cosine(float eta)
{
    return student_t_impl_min(2.9802322e-6f * (1.0f + eta) / fabsf(1.0f - eta), 0.01f);
}

/* A facet between a view above the surface and a light. */
typedef struct student_t_impl_sender {
    float m[3];          /* above the horizon */
    int refracts;
    float transmittance; /* 1 - F */
    float jacobian;      /* density of the light over that of m and v.m, and v.m: |l.m| eta^2/(v.m +
                          * eta l.m)^2 v.m (Walter et al. 2007, eq. 17,
                          * doi:10.2312/EGWR/EGSR07/195-206) */
} student_t_impl_sender;

/* From both cosines and the length of v + eta l. */
STUDENT_T_FUNCTION void student_t_impl_refracts(student_t_impl_sender *s, float eta, float facing,
                                                float refracted, float length)
{
    const float ratio = eta / length;
    s->refracts = 1;
    s->transmittance = 1.0f - student_t_impl_fresnel_of(eta, facing, refracted);
    s->jacobian = facing * refracted * ratio * ratio;
}

/* The light l that the facet s->m of v.m = facing refracts; returns 0 where all is reflected. */
STUDENT_T_FUNCTION int student_t_impl_refract(float eta, const float v[3], float facing,
                                              student_t_impl_sender *s, float l[3])
{
    const float cosine = student_t_impl_min(facing, 1.0f);
    const float square = student_t_impl_refracted2(eta, cosine);
    float refracted, along;
    if (!(square > 0.0f)) return 0;
    refracted = sqrtf(square) / eta;
    along = cosine / eta - refracted;
    l[0] = along * s->m[0] - v[0] / eta;
    l[1] = along * s->m[1] - v[1] / eta;
    l[2] = along * s->m[2] - v[2] / eta;
    student_t_impl_normalize(l);
    /* v.m + eta l.m = v.m - eta |l.m|, without the cancellation where eta is near 1. */
    student_t_impl_refracts(s, eta, cosine, refracted,
                            (1.0f - eta) * (1.0f + eta) / (cosine + eta * refracted));
    return 1;
}

/* The facet that refracts v above the surface into l below; returns 0 if there is none. */
STUDENT_T_FUNCTION int student_t_impl_refracting_facet(float eta, const float v[3],
                                                       const float l[3], student_t_impl_sender *s)
{
    /* In double precision, because v + eta l cancels where eta is near 1. */
    const double n = STUDENT_T_IMPL_CAST(double, eta);
    double h[3], length, scale;
    float facing, refracted;
    int i;
    for (i = 0; i < 3; ++i)
        h[i] = STUDENT_T_IMPL_CAST(double, v[i]) + n * STUDENT_T_IMPL_CAST(double, l[i]);
    length = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    /* None of light that goes straight on with eta = 1, where the facet is not determined. */
    if (!(length > 0.0)) return 0;
    scale = h[2] < 0.0 ? -1.0 / length : 1.0 / length;
    for (i = 0; i < 3; ++i) s->m[i] = STUDENT_T_IMPL_CAST(float, h[i] * scale);
    facing = student_t_impl_dot(v, s->m);
    refracted = -student_t_impl_dot(l, s->m);
    if (!(facing > 0.0f && refracted > 0.0f)) return 0;
    student_t_impl_refracts(s, eta, facing, refracted, STUDENT_T_IMPL_CAST(float, length));
    return 1;
}

/* ---- Parts of the light that a material returns ---------------------------------------------- */

/* One part: the weight f |l.n|/pdf and the density, both of this part alone. */
typedef struct student_t_impl_part {
    float weight, pdf;
} student_t_impl_part;

/* Two parts, of which a sample takes the first with probability p. */
STUDENT_T_FUNCTION student_t_impl_part student_t_impl_mix(float p, student_t_impl_part a,
                                                          student_t_impl_part b)
{
    student_t_impl_part mixed;
    float pdf[2], shares[2];
    pdf[0] = a.pdf;
    pdf[1] = b.pdf;
    student_t_impl_mixing(p, pdf, shares);
    mixed.weight = a.weight * shares[0] + b.weight * shares[1];
    mixed.pdf = p * a.pdf + (1.0f - p) * b.pdf;
    return mixed;
}

/* Whether a choice takes a part of probability p; the choice becomes that which is left in it. */
STUDENT_T_FUNCTION int student_t_impl_chosen(float *choice, float p)
{
    const int is_first = *choice < p;
    *choice = is_first ? *choice / p
                       : student_t_impl_choice((*choice - p) / (1.0f - p)); /* may round to 1 */
    return is_first;
}

/* ---- The energy of interfaces ------------------------------------------------------------------
 * The shares of light that one bounce off an interface reflects and transmits, by gamma, sigma and
 * view, from the file of an index such as student_t_eta_1p5.h. The rest is left to further bounces,
 * which compensations return, and coats account for. */

/* The shares seen from one side, at nodes of gamma, of sigma and of the view's cosine. */
typedef struct student_t_interface_side {
    const float *values;   /* [shapes][sigmas][views][2]: reflected and transmitted */
    const float *averages; /* [shapes][sigmas][4], over views: reflected, transmitted, log2 of what
                            * is lost, and transmitted with Turquin's factor */
    const float *bands;    /* [shapes][sigmas][2][33], of the density of further bounces: factors on
                            * that of the cosine, and the share below, at the cosines (i/32)^4 */
    int views;
    int parts;             /* 1 seen from the thin side; 2 or 3 from the dense one, which meet at
                            * kinks */
    float share, scale, heavy, floor, slope; /* the coordinate of views */
    float weight, normal, spread;            /* of one part */
    float root, kink, sharp, between;        /* of several */
} student_t_interface_side;

/* Interfaces of one index under one form of masking. */
typedef struct student_t_interface_table {
    float eta; /* inside over outside */
    enum student_t_masking masking;
    float smooth_transmitted; /* the average that a smooth interface transmits from outside */
    double inverse;           /* 1/eta of the dense side over the thin one */
    int shapes, sigmas;
    float gamma_min, gamma_max, sigma_min, sigma_max; /* what is covered */
    float shape_scale, shape_first, shape_range; /* ln(1 + scale/(2 gamma - 3)) */
    float offset, first, slow, linear; /* ln(1 + sigma/offset) + slow ln(sigma/first) + linear
                                        * sigma, its value at the first node, */
    float sigma_first, sigma_range;    /* and that of the last less it */
    student_t_interface_side sides[2]; /* seen from outside and from inside */
} student_t_interface_table;

/* The shares of one view. */
typedef struct student_t_impl_shares {
    float reflection, transmission, lost;
    float factor;   /* Turquin's on facets, or 1 */
    float returned; /* by the lobe of Kulla & Conty: all that is lost, or 0 */
} student_t_impl_shares;

/* An interface at one gamma and sigma. */
typedef struct student_t_impl_energy {
    const student_t_interface_table *table; /* none: a smooth interface, or one bounce */
    enum student_t_compensation_form compensation;
    float eta, sigma, gamma;
    float lost[2];      /* averages of what is lost from outside and from inside, */
    float reflected[2]; /* the share of it that further bounces reflect, */
    float transmitted;  /* and of what is transmitted from outside, compensation included */
    float start;        /* of the coordinate of views outside */
    int shape, roughness, shape_nodes, sigma_nodes, nearest;
    float shape_weights[6], sigma_weights[6];
} student_t_impl_energy;

/* Weights of the polynomial through n <= 6 nodes 0, 1 ... at x. */
STUDENT_T_FUNCTION void student_t_impl_few(float x, int n, float weights[6])
{
    int i, j;
    for (i = 0; i < n; ++i) {
        weights[i] = 1.0f;
        for (j = 0; j < n; ++j)
            if (j != i)
                weights[i] *= (x - STUDENT_T_IMPL_CAST(float, j)) /
                              STUDENT_T_IMPL_CAST(float, i - j);
    }
}

/* The nodes about a place among n even ones, from 0 at the first to 1 at the last; returns the
 * first, and how many are read. */
STUDENT_T_FUNCTION int student_t_impl_places(float place, int n, float weights[6], int *count)
{
    const float x = place * STUDENT_T_IMPL_CAST(float, n - 1);
    *count = n < 6 ? n : 6;
    if (n >= 6) return student_t_impl_six(x, n, weights);
    student_t_impl_few(x, n, weights);
    return 0;
}

/* ab/(a + b), and 0 where either is 0. */
STUDENT_T_FUNCTION float student_t_impl_harmonic(float a, float b)
{
    return a > 0.0f && b > 0.0f ? a * b / (a + b) : 0.0f;
}

/* kappa sigma of a coordinate of views. */
STUDENT_T_FUNCTION float student_t_impl_knee(const student_t_interface_side *t, float sigma,
                                             float gamma)
{
    return (t->scale + t->heavy / (2.0f * gamma - 3.0f)) * sigma;
}

/* The coordinate of views of the thin side, before it is stretched to [0, 1]. */
STUDENT_T_FUNCTION float student_t_impl_thin(const student_t_interface_side *t, float sigma,
                                             float gamma, float mu)
{
    const float sine = sqrtf((1.0f - mu) * (1.0f + mu)), nu = t->spread * sigma;
    const float x = mu / (mu + student_t_impl_knee(t, sigma, gamma) * sine);
    const float h = mu / (1.0f + sine);
    const float roots = t->share * sqrtf(sqrtf(x)) + (1.0f - t->share) * sqrtf(sqrtf(h));
    return t->weight * x + t->normal * (nu / (nu + sine)) +
           (1.0f - t->weight - t->normal) * roots;
}

/* A term of the coordinate of the dense side: fourth roots in the first part, none above. */
STUDENT_T_FUNCTION double student_t_impl_smooth(double share, double knee, int part, double mu)
{
    const double sine = sqrt((1.0 - mu) * (1.0 + mu));
    const double x = mu / (mu + knee * sine), h = mu / (1.0 + sine);
    return part == 0 ? share * sqrt(sqrt(x)) + (1.0 - share) * sqrt(sqrt(h))
                     : share * x + (1.0 - share) * h;
}

STUDENT_T_FUNCTION double student_t_impl_kink(double q, double whole, double width, double range)
{
    q = whole > 0.0 ? q / whole : 0.0;
    return asinh(sqrt(q > 0.0 ? q : 0.0) / width) / range;
}

/* The six nodes about a view of the dense side, all on one side of each kink: where level facets
 * begin to reflect totally, and where upright ones begin to transmit. In double precision, because
 * the coordinate is steep there. */
STUDENT_T_FUNCTION int student_t_impl_dense(const student_t_interface_side *t, double inverse,
                                            float sigma, float gamma, float cosine,
                                            float weights[6])
{
    const double critical = sqrt((1.0 - inverse) * (1.0 + inverse));
    const double knee = STUDENT_T_IMPL_CAST(double, student_t_impl_knee(t, sigma, gamma));
    const double share = STUDENT_T_IMPL_CAST(double, t->share);
    const double root = STUDENT_T_IMPL_CAST(double, t->root);
    const double between = STUDENT_T_IMPL_CAST(double, t->between);
    const double sharp = STUDENT_T_IMPL_CAST(double, t->sharp);
    const double width = sqrt(STUDENT_T_IMPL_CAST(double, t->kink * sigma) + sharp * sharp);
    const double range = asinh(1.0 / width);
    const double low =
        STUDENT_T_IMPL_CAST(double, student_t_impl_harmonic(t->floor, t->slope * sigma));
    const double floor = low > 0.0 && critical > 0.0 ? low * critical / (low + critical) : 0.0;
    const double upright = inverse > floor ? inverse : floor;
    const int cells = t->views / t->parts;
    double ends[4], mu = STUDENT_T_IMPL_CAST(double, cosine), first, last, at, from, to, within;
    int part = 0, k;
    ends[0] = floor;
    ends[1] = ends[2] = critical;
    ends[3] = 1.0;
    if (t->parts == 2) {
        ends[2] = 1.0;
    } else if (critical < upright) {
        ends[2] = upright;
    } else {
        ends[1] = upright;
    }
    if (mu < floor) mu = floor;
    for (k = 1; k < t->parts; ++k) part += mu >= ends[k];
    first = student_t_impl_smooth(share, knee, part, ends[part]);
    last = student_t_impl_smooth(share, knee, part, ends[part + 1]);
    at = student_t_impl_smooth(share, knee, part, mu) - first;
    at = last - first > 0.0 ? at / (last - first) : 0.0;
    from = student_t_impl_kink(mu - ends[part], ends[part + 1] - ends[part], width, range);
    to = 1.0 - student_t_impl_kink(ends[part + 1] - mu, ends[part + 1] - ends[part], width, range);
    if (part == 0) {
        within = (1.0 - root) * at + root * to;
    } else if (part + 1 < t->parts) {
        within = (1.0 - 2.0 * between * root) * at + between * root * (from + to);
    } else {
        within = (1.0 - root) * at + root * from;
    }
    return part * cells +
           student_t_impl_six(STUDENT_T_IMPL_CAST(float, within) *
                                  STUDENT_T_IMPL_CAST(float, cells),
                              cells + 1, weights);
}

/* The shares of a view of this cosine, on side 0 outside and 1 inside. */
STUDENT_T_FUNCTION student_t_impl_shares
student_t_impl_shares_of(const student_t_impl_energy *e, int side, float cosine)
{
    student_t_impl_shares s;
    const float mu = student_t_impl_unit(fabsf(cosine));
    if (!e->table) {
        s.reflection = student_t_fresnel_dielectric(side == 0 ? e->eta : 1.0f / e->eta, mu);
        s.transmission = 1.0f - s.reflection;
        s.lost = 0.0f;
    } else {
        const student_t_interface_side *t = &e->table->sides[side];
        float weights[6], sum[2] = {0.0f, 0.0f};
        int first, i, j, k;
        if (t->parts == 1) {
            const float floor = student_t_impl_harmonic(t->floor, t->slope * e->sigma);
            const float start =
                side == 0 ? e->start : student_t_impl_thin(t, e->sigma, e->gamma, floor);
            float at = 0.0f;
            if (mu > floor)
                at = (student_t_impl_thin(t, e->sigma, e->gamma, mu) - start) / (1.0f - start);
            first = student_t_impl_six(at * STUDENT_T_IMPL_CAST(float, t->views - 1), t->views,
                                       weights);
        } else {
            first = student_t_impl_dense(t, e->table->inverse, e->sigma, e->gamma, mu, weights);
        }
        for (i = 0; i < e->shape_nodes; ++i) {
            const int row = (e->shape + i) * e->table->sigmas + e->roughness;
            for (j = 0; j < e->sigma_nodes; ++j) {
                const float w = e->shape_weights[i] * e->sigma_weights[j];
                const float *node = t->values + 2 * ((row + j) * t->views + first);
                for (k = 0; k < 6; ++k) {
                    sum[0] += w * weights[k] * node[2 * k];
                    sum[1] += w * weights[k] * node[2 * k + 1];
                }
            }
        }
        /* Interpolation may leave [0, 1] by the table's error. */
        s.reflection = student_t_impl_unit(sum[0]);
        s.transmission = student_t_impl_unit(sum[1]);
        s.lost = student_t_impl_max(1.0f - s.reflection - s.transmission, 0.0f);
    }
    s.factor =
        e->compensation == STUDENT_T_TURQUIN ? student_t_impl_turquin(s.lost, 1.0f) : 1.0f;
    s.returned = e->compensation == STUDENT_T_KULLA_CONTY ? s.lost : 0.0f;
    return s;
}

/* The averages of one side, of the nodes about the place. */
STUDENT_T_FUNCTION void student_t_impl_side_averages(const student_t_impl_energy *e, int side,
                                                     float averages[4])
{
    int i, j, k;
    for (k = 0; k < 4; ++k) averages[k] = 0.0f;
    for (i = 0; i < e->shape_nodes; ++i) {
        const int row = (e->shape + i) * e->table->sigmas + e->roughness;
        for (j = 0; j < e->sigma_nodes; ++j) {
            const float w = e->shape_weights[i] * e->sigma_weights[j];
            const float *node = e->table->sides[side].averages + 4 * (row + j);
            for (k = 0; k < 4; ++k) averages[k] += w * node[k];
        }
    }
    /* A logarithm of -24 stands for nothing. */
    averages[2] =
        averages[2] > -23.0f ? student_t_impl_min(exp2f(averages[2]), 1.0f) : 0.0f;
}

/* An interface that loses nothing to further bounces, or whose losses are not returned. */
STUDENT_T_FUNCTION student_t_impl_energy student_t_impl_smooth_energy(float eta,
                                                                      float transmitted)
{
    student_t_impl_energy e;
    int i;
    e.table = STUDENT_T_IMPL_NULL;
    e.compensation = STUDENT_T_SINGLE_BOUNCE;
    e.eta = eta;
    e.sigma = e.gamma = e.start = 0.0f;
    e.lost[0] = e.lost[1] = 0.0f;
    e.reflected[0] = e.reflected[1] = 1.0f;
    e.transmitted = transmitted;
    e.shape = e.roughness = e.shape_nodes = e.sigma_nodes = e.nearest = 0;
    for (i = 0; i < 6; ++i) e.shape_weights[i] = e.sigma_weights[i] = 0.0f;
    return e;
}

/* The node with the largest weight. */
STUDENT_T_FUNCTION int student_t_impl_largest(const float weights[6], int count)
{
    int best = 0, i;
    for (i = 1; i < count; ++i)
        if (weights[i] > weights[best]) best = i;
    return best;
}

/* The interface of a lobe, round or of sqrt(sigma_x sigma_y). */
STUDENT_T_FUNCTION student_t_impl_energy
student_t_impl_energy_of(const student_t_interface_table *t, const student_t_lobe *lobe,
                         enum student_t_compensation_form compensation)
{
    student_t_impl_energy e = student_t_impl_smooth_energy(t->eta, t->smooth_transmitted);
    float at, averages[2][4], crossing[2], flux, inside, squared;
    int side;
    if (t->eta == 1.0f || student_t_effectively_smooth(lobe)) return e;
    e.table = t;
    e.compensation = compensation;
    e.gamma = student_t_impl_min(student_t_impl_max(lobe->gamma, t->gamma_min), t->gamma_max);
    e.sigma = student_t_impl_max(sqrtf(lobe->sigma_x * lobe->sigma_y), t->sigma_min);
    e.sigma = student_t_impl_min(e.sigma, t->sigma_max);
    at = t->shapes > 1 ? log1pf(t->shape_scale / (2.0f * e.gamma - 3.0f)) - t->shape_first : 0.0f;
    if (t->shapes > 1) at /= t->shape_range;
    e.shape = student_t_impl_places(at, t->shapes, e.shape_weights, &e.shape_nodes);
    at = 0.0f;
    if (t->sigmas > 1)
        at = (log1pf(e.sigma / t->offset) + t->slow * logf(e.sigma / t->first) +
              t->linear * e.sigma - t->sigma_first) /
             t->sigma_range;
    e.roughness = student_t_impl_places(at, t->sigmas, e.sigma_weights, &e.sigma_nodes);
    e.nearest =
        (e.shape + student_t_impl_largest(e.shape_weights, e.shape_nodes)) * t->sigmas +
        e.roughness + student_t_impl_largest(e.sigma_weights, e.sigma_nodes);
    if (t->sides[0].parts == 1) {
        const float floor =
            student_t_impl_harmonic(t->sides[0].floor, t->sides[0].slope * e.sigma);
        e.start = student_t_impl_thin(&t->sides[0], e.sigma, e.gamma, floor);
    }

    /* By reciprocity the lost flux that changes sides is the same in both directions. It is split
     * as one bounce splits its light, and the smaller of the two results is taken. */
    for (side = 0; side < 2; ++side) {
        float *a = averages[side], sum;
        student_t_impl_side_averages(&e, side, a);
        sum = a[0] + a[1];
        e.lost[side] = a[2];
        crossing[side] = sum > 0.0f ? a[2] * a[1] / sum : 0.0f;
    }
    squared = t->eta * t->eta;
    flux = student_t_impl_min(crossing[0], squared * crossing[1]);
    inside = flux / squared;
    crossing[0] = e.lost[0] > 0.0f ? student_t_impl_min(flux / e.lost[0], 1.0f) : 0.0f;
    crossing[1] = e.lost[1] > 0.0f ? student_t_impl_min(inside / e.lost[1], 1.0f) : 0.0f;
    e.reflected[0] = 1.0f - crossing[0];
    e.reflected[1] = 1.0f - crossing[1];
    e.transmitted = averages[0][compensation == STUDENT_T_TURQUIN ? 3 : 1];
    if (compensation == STUDENT_T_KULLA_CONTY) e.transmitted += crossing[0] * e.lost[0];
    return e;
}

/* pi times the lobe of further bounces between a view, of which `returned` is lost, and a light on
 * a side, over the share of the lost light that goes there. */
STUDENT_T_FUNCTION float student_t_impl_further(const student_t_impl_energy *e, float returned,
                                                int side, const student_t_impl_shares *there)
{
    const float average = e->lost[side];
    return average > STUDENT_T_SMALLEST ? returned * there->lost / average : 0.0f;
}

/* The square of the cosine (i/32)^4 at the end of a band. */
STUDENT_T_FUNCTION float student_t_impl_band(int i)
{
    const float t = STUDENT_T_IMPL_CAST(float, i) / 32.0f, c = (t * t) * (t * t);
    return c * c;
}

/* The density of further bounces on a side over that of the cosine: that of the nearest node of
 * the table, so that densities are exact and weights vary a little. */
STUDENT_T_FUNCTION const float *student_t_impl_bands(const student_t_impl_energy *e, int side)
{
    return e->table->sides[side].bands + 66 * e->nearest;
}

STUDENT_T_FUNCTION float student_t_impl_broad(const float *bands, float cosine)
{
    const float mu = student_t_impl_unit(fabsf(cosine));
    int band = STUDENT_T_IMPL_CAST(int, 32.0f * sqrtf(sqrtf(mu)));
    float from, w;
    if (band > 31) band = 31;
    from = student_t_impl_band(band);
    w = student_t_impl_unit((mu * mu - from) / (student_t_impl_band(band + 1) - from));
    return bands[band] + w * (bands[band + 1] - bands[band]);
}

/* A light of that density. */
STUDENT_T_FUNCTION void student_t_impl_sample_broad(const float *bands, float u, float turn,
                                                    float l[3])
{
    const float *shares = bands + 33;
    float within, a, b, w;
    int band = 0, step;
    u = student_t_impl_unit(u);
    for (step = 16; step > 0; step /= 2)
        if (shares[band + step] < u) band += step;
    within = student_t_impl_unit((u - shares[band]) / (shares[band + 1] - shares[band]));
    /* The inverse of the quadratic distribution of a linear density. */
    a = bands[band];
    b = bands[band + 1];
    w = student_t_impl_min(
        within * (a + b) / (a + sqrtf(a * a + within * (b - a) * (b + a))), 1.0f);
    student_t_impl_upward(student_t_impl_band(band) + w * (student_t_impl_band(band + 1) -
                                                           student_t_impl_band(band)),
                          turn, l);
}

/* The part of a broad lobe, from its density over that of the cosine, the share of its lights on
 * this side, and pi f over that share. */
STUDENT_T_FUNCTION student_t_impl_part student_t_impl_broad_part(float cosine, float factor,
                                                                 float share, float lobe)
{
    student_t_impl_part part;
    part.weight = lobe / factor;
    part.pdf = share * factor * (STUDENT_T_IMPL_INVERSE_PI * fabsf(cosine));
    return part;
}

/* The shares of light that one bounce reflects and transmits, for a view of this cosine from
 * outside, or from inside where it is negative. The lobe's gamma and sqrt(sigma_x sigma_y) are
 * taken at the nearer end of what the table covers; a lobe that is effectively smooth loses
 * nothing. Errors of round lobes are those that microfacet-bake inspect shows of the set. */
STUDENT_T_FUNCTION void student_t_interface_shares(const student_t_interface_table *table,
                                                   const student_t_lobe *lobe, float cos_theta,
                                                   float reflected_transmitted[2])
{
    const student_t_impl_energy e =
        student_t_impl_energy_of(table, lobe, STUDENT_T_SINGLE_BOUNCE);
    const student_t_impl_shares s = student_t_impl_shares_of(&e, cos_theta < 0.0f, cos_theta);
    reflected_transmitted[0] = s.reflection;
    reflected_transmitted[1] = s.transmission;
}

/* ---- Dielectrics -------------------------------------------------------------------------------
 * A rough interface of two transparent media: every facet reflects F of the light and refracts the
 * rest, by Fresnel's equations and Snell's law (Walter et al. 2007, eq. 20-21). All channels are
 * the same.
 *
 * Views come from either side: z > 0 is outside, z < 0 inside, and l is on the side of v, or on the
 * other. A view below is replaced by its opposite, v -> -v and l -> -l, which leaves the facets as
 * they are. Normals are drawn by visibility and events by F, so that a weight is G2/G1 <= 1, and
 * for refracted radiance that times (n_v/n_l)^2. The masking of a refracted light is that of its
 * opposite. f obeys f(v, l) = f(l, v) for reflection, and f(v, l)/n_v^2 =
 * f(l, v)/n_l^2 for refracted radiance.
 *
 * A lobe that is effectively smooth, and eta = 1, have deltas alone, n being their facet: light is
 * mirrored, refracted or, for eta = 1, goes straight on. For |eta - 1| < 1e-3 the facet between two
 * directions is known to 1e-8/|eta - 1| only, and f and density of a narrow lobe err by some per
 * cent; samples do not.
 *
 * For gamma < 2 D has a pole at the horizon, and facets of m.n below student_t_steep_cosine(eta)
 * are only sampled: the light that they refract is flagged as a delta and has its whole weight, and
 * f and density are those of the other facets alone. So a renderer that weights by densities stays
 * unbiased, as for a mirror. Of light transmitted at 50 degrees into glass (eta 1.5, sigma 0.3)
 * that is 94 % at gamma 1.501, 12 % at 1.55, 0.65 % at 1.65 and 0.02 % at 1.8. */

/* A dielectric at a hit. It points to its lobe, which must stay where it is, and to the tables of
 * its index. */
typedef struct student_t_dielectric {
    const student_t_lobe *lobe;
    float eta; /* inside over outside */
    enum student_t_masking masking;
    int is_smooth; /* all events are deltas */
    int has_pole;  /* facets next to the horizon are only sampled */
    int is_compensated;
    student_t_impl_energy energy; /* where it is compensated */
} student_t_dielectric;

/* A dielectric of one bounce. eta is that inside over outside, taken at the nearer end of
 * [1e-3, 1e3], NaN at 1; within 1e-5 of 1 it is 1. */
STUDENT_T_FUNCTION student_t_dielectric student_t_dielectric_at(const student_t_lobe *lobe,
                                                                float eta,
                                                                enum student_t_masking masking)
{
    student_t_dielectric d;
    d.lobe = lobe;
    d.eta = student_t_impl_index(eta);
    d.masking = masking;
    d.is_smooth = d.eta == 1.0f || student_t_effectively_smooth(lobe);
    d.has_pole = lobe->gamma < 2.0f;
    d.is_compensated = 0;
    d.energy = student_t_impl_smooth_energy(d.eta, 0.0f);
    return d;
}

/* A dielectric of a table's index and form of masking, whose further bounces are returned.
 * Turquin's form multiplies a view's facets by 1/(R + T), of its shares of one bounce, and is not
 * reciprocal. Kulla & Conty's adds a broad lobe on either side. Shares are those of
 * student_t_interface_shares, and their errors, too. */
STUDENT_T_FUNCTION student_t_dielectric
student_t_dielectric_compensated(const student_t_lobe *lobe,
                                 const student_t_interface_table *table,
                                 enum student_t_compensation_form compensation)
{
    student_t_dielectric d = student_t_dielectric_at(lobe, table->eta, table->masking);
    d.is_compensated = !d.is_smooth && compensation != STUDENT_T_SINGLE_BOUNCE;
    if (d.is_compensated) d.energy = student_t_impl_energy_of(table, lobe, compensation);
    return d;
}

/* A view or its opposite, whichever is above the surface. */
typedef struct student_t_impl_seen {
    float v[3];
    float eta;  /* of the far side over that of the view's */
    float sign; /* -1 for a view from below */
    int side;   /* 1 for a view from below */
} student_t_impl_seen;

/* Returns 0 for a view in the surface, or one that is not finite. */
STUDENT_T_FUNCTION int student_t_impl_see(const student_t_dielectric *d, const float v[3],
                                          student_t_impl_seen *seen)
{
    if (!((v[2] > 0.0f || v[2] < 0.0f) && student_t_impl_is_direction(v))) return 0;
    seen->sign = v[2] > 0.0f ? 1.0f : -1.0f;
    seen->eta = v[2] > 0.0f ? d->eta : 1.0f / d->eta;
    seen->side = v[2] < 0.0f;
    seen->v[0] = seen->sign * v[0];
    seen->v[1] = seen->sign * v[1];
    seen->v[2] = seen->sign * v[2];
    return 1;
}

/* The factor on transmitted light. */
STUDENT_T_FUNCTION float student_t_impl_scale(const student_t_impl_seen *seen,
                                              enum student_t_transport transport)
{
    return transport == STUDENT_T_RADIANCE ? 1.0f / (seen->eta * seen->eta) : 1.0f;
}

/* What a facet sends to l, both as seen from above; scale is that of transmitted light, and factor
 * that of Turquin's compensation. */
STUDENT_T_FUNCTION student_t_impl_part
student_t_impl_sent(const student_t_dielectric *d, const student_t_impl_seen *seen,
                    const student_t_impl_sender *s, const float l[3], float scale, float factor)
{
    student_t_impl_part part;
    student_t_impl_facet facet;
    const float length2 = student_t_impl_dot(s->m, s->m);
    if (s->refracts) {
        /* The opposite of the light is above the surface. */
        float opposite[3];
        opposite[0] = -l[0];
        opposite[1] = -l[1];
        opposite[2] = -l[2];
        facet = student_t_impl_facet_of(d->lobe, seen->v, s->m, length2, opposite, d->masking);
        part.weight = facet.weight * factor * scale;
        part.pdf = student_t_impl_finite(s->transmittance * s->jacobian * facet.density);
    } else {
        const float cosine = student_t_impl_min(student_t_impl_dot(seen->v, s->m), 1.0f);
        facet = student_t_impl_facet_of(d->lobe, seen->v, s->m, length2, l, d->masking);
        part.weight = facet.weight * factor;
        part.pdf = 0.25f * facet.density * student_t_fresnel_dielectric(seen->eta, cosine);
    }
    return part;
}

/* The facet between a view and a light as seen from above; returns 0 if there is none, or if it is
 * only sampled. */
STUDENT_T_FUNCTION int student_t_impl_sender_of(const student_t_dielectric *d,
                                                const student_t_impl_seen *seen,
                                                const float l[3], student_t_impl_sender *s)
{
    if (l[2] > 0.0f) {
        s->m[0] = seen->v[0] + l[0];
        s->m[1] = seen->v[1] + l[1];
        s->m[2] = seen->v[2] + l[2];
        student_t_impl_normalize(s->m);
        s->refracts = 0;
        s->transmittance = s->jacobian = 0.0f;
        return 1;
    }
    return student_t_impl_refracting_facet(seen->eta, seen->v, l, s) &&
           (!d->has_pole || s->m[2] >= student_t_steep_cosine(seen->eta));
}

/* The light that the facet s->m reflects or refracts, as the choice says; returns 0 where it
 * reflects light below the horizon, or refracts it above. */
STUDENT_T_FUNCTION int student_t_impl_send(const student_t_impl_seen *seen, float choice,
                                           student_t_impl_sender *s, float l[3])
{
    const float facing = student_t_impl_dot(seen->v, s->m);
    if (!(facing > 0.0f)) return 0;
    if (choice < student_t_fresnel_dielectric(seen->eta, student_t_impl_min(facing, 1.0f))) {
        student_t_reflect(seen->v, s->m, l);
        s->refracts = 0;
        s->transmittance = s->jacobian = 0.0f;
        return l[2] > 0.0f;
    }
    return student_t_impl_refract(seen->eta, seen->v, facing, s, l) && l[2] < 0.0f;
}

/* The lobe of further bounces at l, as seen from above. */
STUDENT_T_FUNCTION student_t_impl_part
student_t_impl_bounced(const student_t_dielectric *d, const student_t_impl_seen *seen,
                       const float l[3], float scale, float returned)
{
    const student_t_impl_energy *e = &d->energy;
    const float reflected = e->reflected[seen->side];
    const int is_reflected = l[2] > 0.0f, side = is_reflected ? seen->side : 1 - seen->side;
    const student_t_impl_shares there = student_t_impl_shares_of(e, side, l[2]);
    const float lobe = student_t_impl_further(e, returned, side, &there);
    return student_t_impl_broad_part(
        l[2], student_t_impl_broad(student_t_impl_bands(e, side), l[2]),
        is_reflected ? reflected : 1.0f - reflected, is_reflected ? lobe : lobe * scale);
}

/* The shares of a view; those of one bounce, which nothing reads, without compensation. */
STUDENT_T_FUNCTION student_t_impl_shares
student_t_impl_account(const student_t_dielectric *d, const student_t_impl_seen *seen)
{
    student_t_impl_shares none;
    if (d->is_compensated) return student_t_impl_shares_of(&d->energy, seen->side, seen->v[2]);
    none.reflection = none.transmission = none.lost = none.returned = 0.0f;
    none.factor = 1.0f;
    return none;
}

/* Samples a light for a view of either side. choice and u are random numbers in [0, 1], taken at
 * the nearer end, NaN at 0; they are used independently: choice for the event, u for the facet. A
 * sample is absorbed, of weight 0, where its facet reflects light below the horizon or refracts it
 * above, and for views in the surface (z = 0) or not finite. Its eta is that on the side of l over
 * that on the side of v. */
STUDENT_T_FUNCTION student_t_sample student_t_dielectric_sample(const student_t_dielectric *d,
                                                                const float v[3], float choice,
                                                                const float u[2],
                                                                enum student_t_transport transport)
{
    student_t_sample sample = student_t_impl_absorbed();
    student_t_impl_seen seen;
    student_t_impl_sender s;
    student_t_impl_shares shares;
    student_t_impl_part part;
    float l[3], scale;
    int i, is_facet, has_facet = 1;
    if (!student_t_impl_see(d, v, &seen)) return sample;
    shares = student_t_impl_account(d, &seen);
    scale = student_t_impl_scale(&seen, transport);
    choice = student_t_impl_choice(choice);
    is_facet = !(shares.returned > 0.0f) ||
               student_t_impl_chosen(&choice, 1.0f - shares.returned);
    s.m[0] = s.m[1] = 0.0f;
    s.m[2] = 1.0f;
    if (!is_facet) {
        const int is_reflected = student_t_impl_chosen(&choice, d->energy.reflected[seen.side]);
        const int side = is_reflected ? seen.side : 1 - seen.side;
        student_t_impl_sample_broad(student_t_impl_bands(&d->energy, side), u[0], u[1], l);
        if (!(l[2] > 0.0f)) return sample;
        if (!is_reflected)
            for (i = 0; i < 3; ++i) l[i] = -l[i];
        has_facet = student_t_impl_sender_of(d, &seen, l, &s);
    } else {
        if (!d->is_smooth) student_t_lobe_sample_visible_normal(d->lobe, seen.v, u, s.m);
        if (!student_t_impl_send(&seen, choice, &s, l)) return sample;
    }
    sample.is_delta = d->is_smooth;
    if (d->is_smooth) {
        part.weight = s.refracts ? scale : 1.0f;
        part.pdf = 0.0f;
    } else {
        /* Decided as evaluation does. Of all but steep facets the drawn one is used as it is: what
         * is found between v and l differs by rounding alone. */
        if (is_facet && d->has_pole && s.refracts &&
            s.m[2] < 2.0f * student_t_steep_cosine(seen.eta)) {
            student_t_impl_sender found;
            if (student_t_impl_sender_of(d, &seen, l, &found)) {
                s = found;
            } else {
                sample.is_delta = 1;
            }
        }
        part.weight = part.pdf = 0.0f;
        if (has_facet) part = student_t_impl_sent(d, &seen, &s, l, scale, shares.factor);
        if (sample.is_delta) {
            part.weight /= 1.0f - shares.returned;
            part.pdf = 0.0f;
        } else if (shares.returned > 0.0f) {
            part = student_t_impl_mix(
                1.0f - shares.returned, part,
                student_t_impl_bounced(d, &seen, l, scale, shares.returned));
        }
    }
    sample.event = l[2] < 0.0f ? STUDENT_T_TRANSMITTED : STUDENT_T_REFLECTED;
    for (i = 0; i < 3; ++i) {
        sample.l[i] = seen.sign * l[i];
        sample.m[i] = has_facet ? s.m[i] : 0.0f;
    }
    for (i = 0; i < STUDENT_T_CHANNELS; ++i) sample.weight[i] = part.weight;
    sample.pdf = part.pdf;
    sample.eta = l[2] < 0.0f ? seen.eta : 1.0f;
    return sample;
}

/* Fills f, without the cosine of the light, and returns the density with which
 * student_t_dielectric_sample draws l; deltas are in neither. Both are 0 for directions in the
 * surface (z = 0) or not finite, and limited to the largest finite number. */
STUDENT_T_FUNCTION float student_t_dielectric_eval_pdf(const student_t_dielectric *d,
                                                       const float v[3], const float l[3],
                                                       enum student_t_transport transport,
                                                       float f[STUDENT_T_CHANNELS])
{
    student_t_impl_seen seen;
    student_t_impl_sender s;
    student_t_impl_shares shares;
    student_t_impl_part part, bounced;
    float there[3], value, scale, inverse;
    int i;
    for (i = 0; i < STUDENT_T_CHANNELS; ++i) f[i] = 0.0f;
    if (d->is_smooth || !student_t_impl_see(d, v, &seen)) return 0.0f;
    for (i = 0; i < 3; ++i) there[i] = seen.sign * l[i];
    if (!((l[2] > 0.0f || l[2] < 0.0f) && student_t_impl_is_direction(l))) return 0.0f;
    shares = student_t_impl_account(d, &seen);
    scale = student_t_impl_scale(&seen, transport);
    part.weight = part.pdf = 0.0f;
    if (student_t_impl_sender_of(d, &seen, there, &s))
        part = student_t_impl_sent(d, &seen, &s, there, scale, shares.factor);
    inverse = student_t_impl_inverse_cosine(l[2]);
    value = student_t_impl_f(part.weight, part.pdf, inverse);
    if (shares.returned > 0.0f) {
        bounced = student_t_impl_bounced(d, &seen, there, scale, shares.returned);
        value += student_t_impl_f(bounced.weight, bounced.pdf, inverse);
        value = student_t_impl_finite(value);
        part = student_t_impl_mix(1.0f - shares.returned, part, bounced);
    }
    for (i = 0; i < STUDENT_T_CHANNELS; ++i) f[i] = value;
    return part.pdf;
}
