
/* ---- Reflectances of metals --------------------------------------------------------------------
 * Make a reflectance once for a material where it is constant: its average takes a quadrature, of
 * some microseconds, for Fresnel's equations and for a tint that darkens more than F0. */

enum student_t_reflectance_form {
    STUDENT_T_SCHLICK = 0, /* F0 + (F90 - F0)(1 - mu)^5 */
    STUDENT_T_F82 = 1,     /* Schlick's of F90 = 1 less a dip about mu = 1/7 */
    STUDENT_T_ETA_K = 2    /* Fresnel's equations */
};

/* The reflectance of facets by the cosine mu = v.m, by channel. */
typedef struct student_t_reflectance {
    enum student_t_reflectance_form form;
    float a[STUDENT_T_CHANNELS]; /* F0, or eta */
    float b[STUDENT_T_CHANNELS]; /* F90, the depth of the dip, or k */
    float average[STUDENT_T_CHANNELS]; /* over the hemisphere, weighted by the cosine */
} student_t_reflectance;

STUDENT_T_FUNCTION float student_t_impl_schlick(float f0, float f90, float mu)
{
    const float x = 1.0f - mu, x2 = x * x;
    return f0 + (f90 - f0) * (x2 * x2 * x);
}

/* Reflectance of a conductor of index eta + ik (Born & Wolf 1999, section 14.4). The smaller of a
 * and b of the refracted wave's a + ib comes from their product, so that neither suffers
 * cancellation. */
STUDENT_T_FUNCTION float student_t_impl_fresnel(float eta, float k, float mu)
{
    const float sin2 = 1.0f - mu * mu, product = eta * k;
    const float real = (eta - 1.0f) * (eta + 1.0f) - k * k + mu * mu;
    const float modulus = hypotf(real, product + product);
    const float large = sqrtf(0.5f * (modulus + fabsf(real)));
    float small, a, b, less, more, perpendicular, parallel, across;
    if (!(large > 0.0f)) return 1.0f; /* at the critical angle without absorption */
    small = product / large;
    a = real >= 0.0f ? large : small;
    b = real >= 0.0f ? small : large;
    less = a - mu;
    more = a + mu;
    perpendicular = (less * less + b * b) / (more * more + b * b);
    less = a * mu - sin2;
    more = a * mu + sin2;
    across = b * mu;
    parallel = (less * less + across * across) / (more * more + across * across);
    return 0.5f * perpendicular * (1.0f + parallel);
}

/* The reflectance of a channel at a cosine in [0, 1]. */
STUDENT_T_FUNCTION float
student_t_impl_reflectance(enum student_t_reflectance_form form, float a, float b, float mu)
{
    if (form == STUDENT_T_SCHLICK) {
        return student_t_impl_schlick(a, b, mu);
    } else if (form == STUDENT_T_F82) {
        float weight, dip;
        student_t_impl_mirror(mu, &weight, &dip);
        /* Near its peak the dip of a small F0 and tint exceeds Schlick's reflectance. */
        return student_t_impl_max(a + (1.0f - a) * weight - b * dip, 0.0f);
    }
    return student_t_impl_fresnel(a, b, mu);
}

/* The reflectance of light at a cosine v.m, taken at the nearer end of [0, 1], NaN at 0. */
STUDENT_T_FUNCTION void student_t_reflectance_at(const student_t_reflectance *r, float cosine,
                                                 float f[STUDENT_T_CHANNELS])
{
    const float mu = student_t_impl_unit(cosine);
    int i;
    for (i = 0; i < STUDENT_T_CHANNELS; ++i)
        f[i] = student_t_impl_reflectance(r->form, r->a[i], r->b[i], mu);
}

/* The average 2 int F(mu) mu dmu of a channel, by the rule of Gauss and Legendre with eight points
 * in each of eight panels: to 2e-6, and to 2e-5 across a kink. */
STUDENT_T_FUNCTION float
student_t_impl_reflectance_average(enum student_t_reflectance_form form, float a, float b)
{
    const float places[4] = {0.0917173212f, 0.262766205f, 0.398333239f, 0.480144928f};
    const float weights[4] = {0.181341892f, 0.156853323f, 0.111190517f, 0.0506142681f};
    float sum = 0.0f;
    int panel, i, side;
    for (panel = 0; panel < 8; ++panel) {
        float part = 0.0f;
        for (i = 0; i < 4; ++i) {
            for (side = 0; side < 2; ++side) {
                const float place = side ? 0.5f + places[i] : 0.5f - places[i];
                const float mu = 0.125f * (STUDENT_T_IMPL_CAST(float, panel) + place);
                part += weights[i] * mu * student_t_impl_reflectance(form, a, b, mu);
            }
        }
        sum += 0.25f * part;
    }
    return student_t_impl_unit(sum);
}

/* Schlick's approximation F0 + (F90 - F0)(1 - mu)^5 (1994, doi:10.1111/1467-8659.1330233). Both are
 * taken at the nearer end of [0, 1], NaN at 0. In closed form: cheap enough for a texture of F0. */
STUDENT_T_FUNCTION student_t_reflectance
student_t_schlick(const float f0[STUDENT_T_CHANNELS], const float f90[STUDENT_T_CHANNELS])
{
    student_t_reflectance r;
    int i;
    r.form = STUDENT_T_SCHLICK;
    for (i = 0; i < STUDENT_T_CHANNELS; ++i) {
        r.a[i] = student_t_impl_unit(f0[i]);
        r.b[i] = student_t_impl_unit(f90[i]);
        r.average[i] = r.a[i] + (r.b[i] - r.a[i]) * STUDENT_T_IMPL_SCHLICK_AVERAGE;
    }
    return r;
}

/* The metal of OpenPBR: Schlick's of F90 = 1, with a tint of the reflectance at mu = 1/7, about 82
 * degrees (Kutz, Hasan & Edmondson 2021, Novel aspects of the Adobe Standard Material, eq. 2-5); 0
 * where that formula is negative. Both are taken at the nearer end of [0, 1], NaN at 0. */
STUDENT_T_FUNCTION student_t_reflectance
student_t_f82(const float f0[STUDENT_T_CHANNELS], const float tint[STUDENT_T_CHANNELS])
{
    student_t_reflectance r;
    int i;
    r.form = STUDENT_T_F82;
    for (i = 0; i < STUDENT_T_CHANNELS; ++i) {
        r.a[i] = student_t_impl_unit(f0[i]);
        r.b[i] = (1.0f - student_t_impl_unit(tint[i])) *
                 student_t_impl_schlick(r.a[i], 1.0f, 1.0f / 7.0f);
        /* The dip is largest at its peak; where F0 exceeds that, the formula is never negative. */
        r.average[i] = r.a[i] >= r.b[i]
                           ? r.a[i] + (1.0f - r.a[i]) * STUDENT_T_IMPL_SCHLICK_AVERAGE -
                                 r.b[i] * STUDENT_T_IMPL_F82_AVERAGE
                           : student_t_impl_reflectance_average(r.form, r.a[i], r.b[i]);
    }
    return r;
}

/* Fresnel's equations for the complex index eta + ik relative to the medium outside. eta is taken
 * at the nearer end of [1e-6, 1e6] and k of [0, 1e6], NaN at the lower. */
STUDENT_T_FUNCTION student_t_reflectance
student_t_eta_k(const float eta[STUDENT_T_CHANNELS], const float k[STUDENT_T_CHANNELS])
{
    student_t_reflectance r;
    int i;
    r.form = STUDENT_T_ETA_K;
    for (i = 0; i < STUDENT_T_CHANNELS; ++i) {
        r.a[i] = student_t_impl_min(student_t_impl_max(eta[i], 1e-6f), 1e6f);
        r.b[i] = student_t_impl_min(student_t_impl_max(k[i], 0.0f), 1e6f);
        r.average[i] = student_t_impl_reflectance_average(r.form, r.a[i], r.b[i]);
    }
    return r;
}

/* ---- Light of further bounces ------------------------------------------------------------------
 * It is drawn in closed form: a share by the plain cosine, so that no weight exceeds twenty times
 * that of the cosine, and the rest in proportion to 1/(x + c^2) with x = cos^2 theta, in which the
 * cosine-weighted measure is uniform. A surface loses its light within c of the horizon, and beyond
 * about as (c/cos theta)^2. */

#define STUDENT_T_IMPL_PLAIN 0.05f

typedef struct student_t_impl_grazing {
    float square;  /* c^2 */
    float octaves; /* between c^2 and 1 + c^2 */
    float scale;   /* what makes the density one in total */
} student_t_impl_grazing;

STUDENT_T_FUNCTION student_t_impl_grazing student_t_impl_grazing_of(float reach)
{
    student_t_impl_grazing g;
    const float c = student_t_impl_min(student_t_impl_max(reach, 1e-9f), 1.0f);
    g.square = c * c;
    g.octaves = log2f(1.0f + 1.0f / g.square);
    g.scale = (1.0f - STUDENT_T_IMPL_PLAIN) / (0.69314718f * g.octaves);
    return g;
}

/* A direction above the horizon, or on it. */
STUDENT_T_FUNCTION void
student_t_impl_grazing_sample(const student_t_impl_grazing *g, const float u[2], float l[3])
{
    const float number = student_t_impl_unit(u[0]);
    float x;
    if (number < STUDENT_T_IMPL_PLAIN) {
        x = number / STUDENT_T_IMPL_PLAIN;
    } else {
        const float within = (number - STUDENT_T_IMPL_PLAIN) / (1.0f - STUDENT_T_IMPL_PLAIN);
        x = student_t_impl_unit(g->square * (exp2f(within * g->octaves) - 1.0f));
    }
    student_t_impl_upward(x, u[1], l);
}

/* Its density over that of the cosine, |cos|/pi. */
STUDENT_T_FUNCTION float
student_t_impl_grazing_factor(const student_t_impl_grazing *g, float cosine)
{
    return STUDENT_T_IMPL_PLAIN + g->scale / (cosine * cosine + g->square);
}

/* The factor of the lobe of Kulla & Conty for an average reflectance F,
 * F^2 E_avg/(1 - F(1 - E_avg)), from the average loss 1 - E_avg. */
STUDENT_T_FUNCTION float student_t_impl_bounces(float reflected, float lost)
{
    const float below = 1.0f - reflected * lost;
    /* F = 1 and E_avg = 0: infinitely many bounces that lose nothing. */
    return below > 0.0f ? reflected * reflected * (1.0f - lost) / below : 1.0f;
}

/* Turquin's factor 1 + F0 (1 - E)/E on the facets (Turquin 2019, Practical multiple scattering
 * compensation for microfacet models, eq. 16). */
STUDENT_T_FUNCTION float student_t_impl_turquin(float lost, float f0)
{
    return 1.0f + student_t_impl_min(f0 * lost / student_t_impl_max(1.0f - lost, 1e-6f), 1e6f);
}

/* Facets, drawn with the probability p, and a broad lobe, drawn with 1 - p: weights f |cos|/pdf and
 * densities of each alone. Where p is 1 there is no broad lobe. */
typedef struct student_t_impl_mixture {
    float p, facets_pdf, broad_pdf;
    float facets[STUDENT_T_CHANNELS], broad[STUDENT_T_CHANNELS];
} student_t_impl_mixture;

STUDENT_T_FUNCTION float student_t_impl_mixture_pdf(const student_t_impl_mixture *m)
{
    return m->p * m->facets_pdf + (1.0f - m->p) * m->broad_pdf;
}

STUDENT_T_FUNCTION void
student_t_impl_mixture_weight(const student_t_impl_mixture *m, float weight[STUDENT_T_CHANNELS])
{
    float pdf[2], shares[2];
    int i;
    pdf[0] = m->facets_pdf;
    pdf[1] = m->broad_pdf;
    student_t_impl_mixing(m->p, pdf, shares);
    for (i = 0; i < STUDENT_T_CHANNELS; ++i)
        weight[i] = m->facets[i] * shares[0] + m->broad[i] * shares[1];
}

/* ---- Conductors --------------------------------------------------------------------------------
 * Every facet reflects F of the light and absorbs the rest: f = D F G2/(4 cos cos) (Cook & Torrance
 * 1982, doi:10.1145/357290.357293), drawn by visible normals, with a weight of at most 1. A
 * compensation adds the light of further bounces. Black from below. */

/* A conductor at a hit; it holds no memory, and points to its lobe, which must live as long. */
typedef struct student_t_conductor {
    const student_t_lobe *lobe;
    student_t_reflectance reflectance;
    enum student_t_masking masking;
    int is_smooth; /* a mirror */
    enum student_t_compensation_form compensation;
    /* What follows is set with a compensation only. */
    student_t_impl_albedo albedo;
    float bounces[STUDENT_T_CHANNELS]; /* of Turquin F at normal incidence */
    /* And this for Kulla & Conty: the average loss, the means of bounces and of the average
     * reflectance over the channels, and the density of the broad lobe. */
    float lost, multiple, single;
    student_t_impl_grazing grazing;
} student_t_conductor;

STUDENT_T_FUNCTION void student_t_impl_compensate(student_t_conductor *c)
{
    const student_t_reflectance *r = &c->reflectance;
    int i;
    student_t_impl_albedo_of(c->lobe, c->masking, &c->albedo);
    if (c->compensation == STUDENT_T_TURQUIN) {
        for (i = 0; i < STUDENT_T_CHANNELS; ++i) {
            c->bounces[i] = r->a[i];
            if (r->form == STUDENT_T_ETA_K)
                c->bounces[i] = student_t_impl_fresnel(r->a[i], r->b[i], 1.0f);
        }
        return;
    }
    c->lost = student_t_impl_lost_average(&c->albedo);
    c->multiple = c->single = 0.0f;
    for (i = 0; i < STUDENT_T_CHANNELS; ++i) {
        c->bounces[i] = student_t_impl_bounces(r->average[i], c->lost);
        c->multiple += c->bounces[i] / STUDENT_T_IMPL_CAST(float, STUDENT_T_CHANNELS);
        c->single += r->average[i] / STUDENT_T_IMPL_CAST(float, STUDENT_T_CHANNELS);
    }
    c->grazing = student_t_impl_grazing_of(student_t_impl_reach(&c->albedo));
}

/* A conductor of a lobe, which is pointed to, and the reflectance of its facets, which is copied.
 * Without compensation this is a copy alone; with one it looks up what does not depend on a view.
 * Members are copied one by one: compilers copy a struct in blocks, wait until each member that was
 * just written is in memory, and take it for memory from then on. */
STUDENT_T_FUNCTION student_t_conductor student_t_conductor_at(
    const student_t_lobe *lobe, const student_t_reflectance *reflectance,
    enum student_t_masking masking, enum student_t_compensation_form compensation)
{
    student_t_conductor c;
    int i;
    c.lobe = lobe;
    c.reflectance.form = reflectance->form;
    for (i = 0; i < STUDENT_T_CHANNELS; ++i) {
        c.reflectance.a[i] = reflectance->a[i];
        c.reflectance.b[i] = reflectance->b[i];
        c.reflectance.average[i] = reflectance->average[i];
    }
    c.masking = masking;
    c.is_smooth = student_t_effectively_smooth(lobe);
    c.compensation = c.is_smooth ? STUDENT_T_SINGLE_BOUNCE : compensation;
    if (c.compensation != STUDENT_T_SINGLE_BOUNCE) student_t_impl_compensate(&c);
    return c;
}

/* The probability of facets: their share of the light that returns, as an estimate, from the loss
 * 1 - E of the view. */
STUDENT_T_FUNCTION float student_t_impl_conductor_share(const student_t_conductor *c, float lost)
{
    float facets, broad;
    if (c->compensation != STUDENT_T_KULLA_CONTY) return 1.0f;
    facets = (1.0f - lost) * c->single;
    broad = lost * c->multiple;
    return broad > 0.0f ? facets / (facets + broad) : 1.0f;
}

/* One bounce and the compensation of what it loses of the view's light, for a light above the
 * horizon. */
STUDENT_T_FUNCTION student_t_impl_mixture
student_t_impl_conductor_mixture(const student_t_conductor *c, float lost, const float l[3],
                                 const student_t_impl_white *white)
{
    const float cosine = l[2];
    student_t_impl_mixture m;
    int i;
    student_t_reflectance_at(&c->reflectance, white->cosine, m.facets);
    for (i = 0; i < STUDENT_T_CHANNELS; ++i) {
        m.facets[i] *= white->weight;
        m.broad[i] = 0.0f;
    }
    m.p = student_t_impl_conductor_share(c, lost);
    m.facets_pdf = white->pdf;
    m.broad_pdf = 0.0f;
    if (c->compensation == STUDENT_T_TURQUIN) {
        for (i = 0; i < STUDENT_T_CHANNELS; ++i)
            m.facets[i] *= student_t_impl_turquin(lost, c->bounces[i]);
    } else {
        /* pi times the lobe of Kulla & Conty 2017; what loses nothing gets nothing back. */
        const float factor = student_t_impl_grazing_factor(&c->grazing, cosine);
        const float lobe = c->lost > STUDENT_T_SMALLEST
                               ? lost * student_t_impl_lost(&c->albedo, l) / c->lost
                               : 0.0f;
        for (i = 0; i < STUDENT_T_CHANNELS; ++i) m.broad[i] = c->bounces[i] * lobe / factor;
        m.broad_pdf = factor * (cosine * STUDENT_T_IMPL_INVERSE_PI);
    }
    return m;
}

/* A light for a view. It is absorbed where the view is not above the horizon, or the drawn facet
 * reflects below it: that path ends with a weight of 0, which counts in a mean. */
STUDENT_T_FUNCTION student_t_sample student_t_conductor_sample(const student_t_conductor *c,
                                                               const float v[3], float choice,
                                                               const float u[2])
{
    student_t_sample s = student_t_impl_absorbed();
    student_t_impl_white white;
    int i;
    if (!(v[2] > 0.0f && student_t_impl_is_direction(v))) return s;
    if (c->is_smooth) {
        s.event = STUDENT_T_REFLECTED;
        s.is_delta = 1;
        s.l[0] = -v[0];
        s.l[1] = -v[1];
        s.l[2] = v[2];
        s.m[2] = 1.0f;
        student_t_reflectance_at(&c->reflectance, v[2], s.weight);
        return s;
    }
    if (c->compensation == STUDENT_T_SINGLE_BOUNCE) {
        if (!student_t_impl_draw(c->lobe, c->masking, v, u, s.m, s.l, &white))
            return student_t_impl_absorbed();
        student_t_reflectance_at(&c->reflectance, white.cosine, s.weight);
        for (i = 0; i < STUDENT_T_CHANNELS; ++i) s.weight[i] *= white.weight;
        s.pdf = white.pdf;
    } else {
        const float lost = student_t_impl_lost(&c->albedo, v);
        student_t_impl_mixture mixture;
        if (student_t_impl_choice(choice) < student_t_impl_conductor_share(c, lost)) {
            if (!student_t_impl_draw(c->lobe, c->masking, v, u, s.m, s.l, &white))
                return student_t_impl_absorbed();
        } else {
            float scale;
            student_t_impl_grazing_sample(&c->grazing, u, s.l);
            if (!(s.l[2] > 0.0f)) return student_t_impl_absorbed();
            white = student_t_impl_halfway(c->lobe, c->masking, v, s.l, s.m);
            scale = 0.5f / student_t_impl_max(white.cosine, 1e-19f); /* 1/|v + l| */
            for (i = 0; i < 3; ++i) s.m[i] *= scale;
        }
        mixture = student_t_impl_conductor_mixture(c, lost, s.l, &white);
        student_t_impl_mixture_weight(&mixture, s.weight);
        s.pdf = student_t_impl_mixture_pdf(&mixture);
    }
    s.event = STUDENT_T_REFLECTED;
    return s;
}

/* f by channel, without the cosine; returns the density with which a sample is l. */
STUDENT_T_FUNCTION float student_t_conductor_eval_pdf(const student_t_conductor *c,
                                                      const float v[3], const float l[3],
                                                      float f[STUDENT_T_CHANNELS])
{
    student_t_impl_white white;
    float m[3], inverse;
    int i;
    for (i = 0; i < STUDENT_T_CHANNELS; ++i) f[i] = 0.0f;
    if (c->is_smooth || !(v[2] > 0.0f && l[2] > 0.0f)) return 0.0f;
    if (!(student_t_impl_is_direction(v) && student_t_impl_is_direction(l))) return 0.0f;
    white = student_t_impl_halfway(c->lobe, c->masking, v, l, m);
    inverse = student_t_impl_inverse_cosine(l[2]);
    if (c->compensation == STUDENT_T_SINGLE_BOUNCE) {
        const float all = student_t_impl_f(white.weight, white.pdf, inverse);
        student_t_reflectance_at(&c->reflectance, white.cosine, f);
        for (i = 0; i < STUDENT_T_CHANNELS; ++i) f[i] *= all;
        return white.pdf;
    } else {
        const float lost = student_t_impl_lost(&c->albedo, v);
        const student_t_impl_mixture mixture =
            student_t_impl_conductor_mixture(c, lost, l, &white);
        for (i = 0; i < STUDENT_T_CHANNELS; ++i)
            f[i] = student_t_impl_finite(
                student_t_impl_f(mixture.facets[i], mixture.facets_pdf, inverse) +
                student_t_impl_f(mixture.broad[i], mixture.broad_pdf, inverse));
        return student_t_impl_mixture_pdf(&mixture);
    }
}
