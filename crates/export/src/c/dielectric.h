
/* ---- Interfaces of two transparent media ------------------------------------------------------
 * Indices of refraction are those of one side over the other. eta of a material is inside over
 * outside, n_i/n_o; of a view it is that of the far side over that of the side of the view. Cosines
 * are between a direction and the normal of a facet. */

/* A conversion, as each language has it. */
#ifndef STUDENT_T_IMPL_CAST
#ifdef __cplusplus
#define STUDENT_T_IMPL_CAST(type, x) static_cast<type>(x)
#else
#define STUDENT_T_IMPL_CAST(type, x) ((type)(x))
#endif
#endif

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
STUDENT_T_FUNCTION float student_t_impl_fresnel(float eta, float cosine, float refracted)
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
    return square > 0.0f ? student_t_impl_fresnel(eta, cosine, sqrtf(square) / eta) : 1.0f;
}

/* The cosine m.n below which facets of gamma < 2 that refract are only sampled: a view and a light
 * in single precision do not tell m.n to a hundredth there. The same for eta and 1/eta. */
STUDENT_T_FUNCTION float student_t_steep_cosine(float eta)
{
    return student_t_impl_min(2.9802322e-6f * (1.0f + eta) / fabsf(1.0f - eta), 0.01f);
}

STUDENT_T_FUNCTION float student_t_impl_dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* w to length 1, or null where its square is not a positive number of single precision. */
STUDENT_T_FUNCTION void student_t_impl_normalize(float w[3])
{
    const float length2 = student_t_impl_dot(w, w);
    const float r =
        length2 > 0.0f && length2 <= STUDENT_T_LARGEST ? 1.0f / sqrtf(length2) : 0.0f;
    w[0] *= r;
    w[1] *= r;
    w[2] *= r;
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
    s->transmittance = 1.0f - student_t_impl_fresnel(eta, facing, refracted);
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

/* ---- Parts of the light that a material returns ----------------------------------------------- */

/* One part: the weight f |l.n|/pdf and the density, both of this part alone. */
typedef struct student_t_impl_part {
    float weight, pdf;
} student_t_impl_part;

/* f of a part, without the cosine of the light. */
STUDENT_T_FUNCTION float student_t_impl_part_f(student_t_impl_part part, float cosine)
{
    return student_t_impl_finite(part.weight * part.pdf *
                                 student_t_impl_finite(1.0f / fabsf(cosine)));
}

/* A choice in [0, 1), and 0 for NaN: 1 would choose an event of probability 0. */
STUDENT_T_FUNCTION float student_t_impl_choice(float choice)
{
    return student_t_impl_min(student_t_impl_unit(choice), 0.99999994f);
}

/* Whether two directions are finite. */
STUDENT_T_FUNCTION int student_t_impl_are_finite(const float v[3], const float l[3])
{
    return student_t_impl_dot(v, v) + student_t_impl_dot(l, l) <= STUDENT_T_LARGEST;
}

/* What returns no light. */
STUDENT_T_FUNCTION student_t_sample student_t_impl_black(void)
{
    student_t_sample s;
    int i;
    s.event = STUDENT_T_ABSORBED;
    s.is_delta = 0;
    for (i = 0; i < 3; ++i) s.l[i] = s.m[i] = 0.0f;
    for (i = 0; i < STUDENT_T_CHANNELS; ++i) s.weight[i] = 0.0f;
    s.pdf = 0.0f;
    s.eta = 1.0f;
    return s;
}

/* ---- Dielectrics -------------------------------------------------------------------------------
 * A rough interface of two transparent media: every facet reflects F of the light and refracts the
 * rest, by Fresnel's equations and Snell's law (Walter et al. 2007, eq. 20-21). All channels are
 * the same.
 *
 * Views come from either side: z > 0 is outside, z < 0 inside, and l is on the side of v, or on the
 * other. A view below is replaced by its opposite, v -> -v and l -> -l, which leaves the facets as
 * they are. Normals are drawn by visibility and events by F, so that a weight is G2/G1 <= 1, and
 * for refracted radiance that times (n_v/n_l)^2. Of the opposite of a refracted light the masking is
 * that of a reflected one. f obeys f(v, l) = f(l, v) for reflection, and f(v, l)/n_v^2 =
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

/* A dielectric at a hit. */
typedef struct student_t_dielectric {
    student_t_lobe lobe;
    float eta; /* inside over outside */
    enum student_t_masking masking;
    int is_smooth; /* all events are deltas */
    int has_pole;  /* facets next to the horizon are only sampled */
} student_t_dielectric;

/* A dielectric of one bounce. eta is that inside over outside, taken at the nearer end of
 * [1e-3, 1e3], NaN at 1; within 1e-5 of 1 it is 1. */
STUDENT_T_FUNCTION student_t_dielectric student_t_dielectric_at(const student_t_lobe *lobe,
                                                                float eta,
                                                                enum student_t_masking masking)
{
    student_t_dielectric d;
    d.lobe = *lobe;
    d.eta = student_t_impl_index(eta);
    d.masking = masking;
    d.is_smooth = d.eta == 1.0f || student_t_effectively_smooth(lobe);
    d.has_pole = lobe->gamma < 2.0f;
    return d;
}

/* A view or its opposite, whichever is above the surface. */
typedef struct student_t_impl_seen {
    float v[3];
    float eta;  /* of the far side over that of the view's */
    float sign; /* -1 for a view from below */
} student_t_impl_seen;

/* Returns 0 for a view in the surface, or one that is not finite. */
STUDENT_T_FUNCTION int student_t_impl_see(const student_t_dielectric *d, const float v[3],
                                          student_t_impl_seen *seen)
{
    if (!((v[2] > 0.0f || v[2] < 0.0f) && student_t_impl_are_finite(v, v))) return 0;
    seen->sign = v[2] > 0.0f ? 1.0f : -1.0f;
    seen->eta = v[2] > 0.0f ? d->eta : 1.0f / d->eta;
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

/* What a facet sends to l, both as seen from above; scale is that of transmitted light. */
STUDENT_T_FUNCTION student_t_impl_part
student_t_impl_sent(const student_t_dielectric *d, const student_t_impl_seen *seen,
                    const student_t_impl_sender *s, const float l[3], float scale)
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
        facet = student_t_impl_facet_of(&d->lobe, seen->v, s->m, length2, opposite, d->masking);
        part.weight = facet.weight * scale;
        part.pdf = student_t_impl_finite(s->transmittance * s->jacobian * facet.density);
    } else {
        const float cosine = student_t_impl_min(student_t_impl_dot(seen->v, s->m), 1.0f);
        facet = student_t_impl_facet_of(&d->lobe, seen->v, s->m, length2, l, d->masking);
        part.weight = facet.weight;
        part.pdf = 0.25f * facet.density * student_t_fresnel_dielectric(seen->eta, cosine);
    }
    return part;
}

/* The facet between a view and a light as seen from above; returns 0 if there is none, or if it is
 * only sampled. */
STUDENT_T_FUNCTION int student_t_impl_between(const student_t_dielectric *d,
                                              const student_t_impl_seen *seen, const float l[3],
                                              student_t_impl_sender *s)
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
        l[0] = 2.0f * facing * s->m[0] - seen->v[0];
        l[1] = 2.0f * facing * s->m[1] - seen->v[1];
        l[2] = 2.0f * facing * s->m[2] - seen->v[2];
        s->refracts = 0;
        s->transmittance = s->jacobian = 0.0f;
        return l[2] > 0.0f;
    }
    return student_t_impl_refract(seen->eta, seen->v, facing, s, l) && l[2] < 0.0f;
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
    student_t_sample sample = student_t_impl_black();
    student_t_impl_seen seen;
    student_t_impl_sender s;
    student_t_impl_part part;
    float l[3], scale;
    int i;
    if (!student_t_impl_see(d, v, &seen)) return sample;
    scale = student_t_impl_scale(&seen, transport);
    choice = student_t_impl_choice(choice);
    s.m[0] = s.m[1] = 0.0f;
    s.m[2] = 1.0f;
    if (!d->is_smooth) student_t_lobe_sample_visible_normal(&d->lobe, seen.v, u, s.m);
    if (!student_t_impl_send(&seen, choice, &s, l)) return sample;
    sample.is_delta = d->is_smooth;
    if (d->is_smooth) {
        part.weight = s.refracts ? scale : 1.0f;
        part.pdf = 0.0f;
    } else {
        /* Decided as evaluation does. Of all but steep facets the drawn one is used as it is: what
         * is found between v and l differs by rounding alone. */
        if (d->has_pole && s.refracts && s.m[2] < 2.0f * student_t_steep_cosine(seen.eta)) {
            student_t_impl_sender found;
            if (student_t_impl_between(d, &seen, l, &found)) {
                s = found;
            } else {
                sample.is_delta = 1;
            }
        }
        part = student_t_impl_sent(d, &seen, &s, l, scale);
        if (sample.is_delta) part.pdf = 0.0f;
    }
    sample.event = s.refracts ? STUDENT_T_TRANSMITTED : STUDENT_T_REFLECTED;
    for (i = 0; i < 3; ++i) {
        sample.l[i] = seen.sign * l[i];
        sample.m[i] = s.m[i];
    }
    for (i = 0; i < STUDENT_T_CHANNELS; ++i) sample.weight[i] = part.weight;
    sample.pdf = part.pdf;
    sample.eta = s.refracts ? seen.eta : 1.0f;
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
    student_t_impl_part part;
    float there[3], value;
    int i;
    for (i = 0; i < STUDENT_T_CHANNELS; ++i) f[i] = 0.0f;
    if (d->is_smooth || !student_t_impl_see(d, v, &seen)) return 0.0f;
    for (i = 0; i < 3; ++i) there[i] = seen.sign * l[i];
    if (!((l[2] > 0.0f || l[2] < 0.0f) && student_t_impl_are_finite(l, l))) return 0.0f;
    if (!student_t_impl_between(d, &seen, there, &s)) return 0.0f;
    part = student_t_impl_sent(d, &seen, &s, there, student_t_impl_scale(&seen, transport));
    value = student_t_impl_part_f(part, l[2]);
    for (i = 0; i < STUDENT_T_CHANNELS; ++i) f[i] = value;
    return part.pdf;
}
