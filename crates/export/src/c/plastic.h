
/* ---- Plastics ----------------------------------------------------------------------------------
 * A rough dielectric coat over a Lambert base, which receives exactly the light that the coat
 * transmits; black from below. The coat reflects as a dielectric does. Of the light T(v) that it
 * transmits from the direction of v the base of albedo rho returns
 *
 *     f = T(v) T(l) rho/(pi eta^2 (1 - rho R)),
 *
 * with R the share of diffuse light from inside that the coat reflects, so that light between base
 * and coat is included however often it is reflected. T and R are albedos of the coat: a plastic
 * needs the table of its index, also for a coat of one bounce. With compensation a white base
 * returns all light. */

/* A plastic at a hit. It points to its lobe, which must stay where it is. */
typedef struct student_t_plastic {
    const student_t_lobe *lobe; /* of the coat */
    float eta;           /* of the coat, inside over outside */
    enum student_t_masking masking;
    int is_smooth;       /* the coat's reflection is a delta */
    student_t_impl_energy energy;
    float diffuse[STUDENT_T_CHANNELS]; /* rho/(eta^2 (1 - rho R)) */
    float mean;          /* the mean of that over the channels times the average of T */
    float plain;         /* share of the plain cosine in the density of light of the base and of
                          * the coat's further bounces; the rest is the interface's */
} student_t_plastic;

/* A plastic of a coat of a table's index and form of masking over a base of an albedo in each
 * channel, taken at the nearer end of [0, 1], NaN at 0. */
STUDENT_T_FUNCTION student_t_plastic
student_t_plastic_at(const student_t_lobe *lobe, const student_t_interface_table *table,
                     const float base[STUDENT_T_CHANNELS],
                     enum student_t_compensation_form compensation)
{
    student_t_plastic p;
    const student_t_impl_energy e = student_t_impl_energy_of(table, lobe, compensation);
    const float squared = table->eta * table->eta;
    /* By reciprocity the coat transmits T/eta^2 of diffuse light from inside, and without
     * compensation loses some: 1 - R is computed as their sum, not to lose its digits. */
    const float lost = e.compensation == STUDENT_T_SINGLE_BOUNCE ? e.lost[1] : 0.0f;
    const float out = e.transmitted + squared * lost;
    const float coat =
        e.compensation == STUDENT_T_KULLA_CONTY ? e.reflected[0] * e.lost[0] : 0.0f;
    float sum = 0.0f;
    int i;
    p.lobe = lobe;
    p.eta = table->eta;
    p.masking = table->masking;
    p.is_smooth = table->eta == 1.0f || student_t_effectively_smooth(lobe);
    p.energy = e;
    for (i = 0; i < STUDENT_T_CHANNELS; ++i) {
        const float rho = student_t_impl_unit(base[i]);
        const float left = squared * (1.0f - rho) + rho * out;
        p.diffuse[i] = left > 0.0f ? rho / left : 0.0f;
        sum += p.diffuse[i];
    }
    p.mean = sum / STUDENT_T_IMPL_CAST(float, STUDENT_T_CHANNELS) * e.transmitted;
    p.plain = coat > 0.0f ? p.mean / (p.mean + coat) : 1.0f;
    return p;
}

/* The share of a view's light that all bounces off the coat together transmit. */
STUDENT_T_FUNCTION float student_t_impl_entering(const student_t_plastic *p,
                                                 const student_t_impl_shares *s)
{
    return s->transmission * s->factor + (1.0f - p->energy.reflected[0]) * s->returned;
}

/* The probability of facets: their share of the light that returns. */
STUDENT_T_FUNCTION float student_t_impl_coat_share(const student_t_plastic *p,
                                                   const student_t_impl_shares *s)
{
    const float facets = s->reflection * s->factor;
    const float diffuse =
        student_t_impl_entering(p, s) * p->mean + p->energy.reflected[0] * s->returned;
    return diffuse > 0.0f ? facets / (facets + diffuse) : 1.0f;
}

/* The part of the coat's facets of a normal m, of any length, for a v.m of unit vectors. */
STUDENT_T_FUNCTION student_t_impl_part
student_t_impl_coat(const student_t_plastic *p, const student_t_impl_shares *s, const float v[3],
                    const float m[3], float length2, const float l[3], float cosine)
{
    student_t_impl_part part;
    const student_t_impl_facet facet =
        student_t_impl_facet_of(p->lobe, v, m, length2, l, p->masking);
    part.weight = facet.weight * s->factor *
                  student_t_fresnel_dielectric(p->eta, student_t_impl_min(cosine, 1.0f));
    part.pdf = 0.25f * facet.density;
    return part;
}

/* The same of the facet between v and l; none for a smooth coat. */
STUDENT_T_FUNCTION student_t_impl_part
student_t_impl_coat_between(const student_t_plastic *p, const student_t_impl_shares *s,
                            const float v[3], const float l[3], float m[3])
{
    student_t_impl_part none;
    float length2;
    none.weight = none.pdf = 0.0f;
    m[0] = v[0] + l[0];
    m[1] = v[1] + l[1];
    m[2] = v[2] + l[2];
    length2 = student_t_impl_dot(m, m);
    if (p->is_smooth || !(length2 > 0.0f && length2 <= STUDENT_T_LARGEST)) return none;
    return student_t_impl_coat(p, s, v, m, length2, l, 0.5f * sqrtf(length2));
}

/* The density of the base and of further bounces over that of the cosine. */
STUDENT_T_FUNCTION float student_t_impl_base_factor(const student_t_plastic *p, float cosine)
{
    if (!(p->plain < 1.0f)) return 1.0f;
    return p->plain + (1.0f - p->plain) *
                          student_t_impl_broad(student_t_impl_bands(&p->energy, 0), cosine);
}

/* pi f of the base and of the coat's further bounces: the first without its diffuse factor. */
STUDENT_T_FUNCTION float student_t_impl_base(const student_t_plastic *p,
                                             const student_t_impl_shares *s, float cosine,
                                             float *coat)
{
    const student_t_impl_shares there = student_t_impl_shares_of(&p->energy, 0, cosine);
    *coat = p->energy.reflected[0] * student_t_impl_further(&p->energy, s->returned, 0, &there);
    return student_t_impl_entering(p, s) * student_t_impl_entering(p, &there);
}

/* Samples a light for a view; absorbed, of weight 0, for views at or below the horizon or not
 * finite, and where a facet of the coat reflects light below it. choice and u are as for
 * dielectrics; u of light of the base is that of its direction. */
STUDENT_T_FUNCTION student_t_sample student_t_plastic_sample(const student_t_plastic *p,
                                                             const float v[3], float choice,
                                                             const float u[2])
{
    student_t_sample sample = student_t_impl_absorbed();
    student_t_impl_shares shares;
    student_t_impl_part facets, broad, both;
    float l[3], m[3], share, base, coat, factor;
    int i, is_facet;
    if (!(v[2] > 0.0f && student_t_impl_is_direction(v))) return sample;
    shares = student_t_impl_shares_of(&p->energy, 0, v[2]);
    share = student_t_impl_coat_share(p, &shares);
    is_facet = student_t_impl_choice(choice) < share;
    if (is_facet && p->is_smooth) {
        sample.event = STUDENT_T_REFLECTED;
        sample.is_delta = 1;
        sample.l[0] = -v[0];
        sample.l[1] = -v[1];
        sample.l[2] = v[2];
        sample.m[2] = 1.0f;
        for (i = 0; i < STUDENT_T_CHANNELS; ++i) sample.weight[i] = shares.reflection / share;
        return sample;
    }
    if (is_facet) {
        float facing, length2, twice;
        student_t_lobe_sample_visible_normal(p->lobe, v, u, m);
        facing = student_t_impl_dot(v, m);
        length2 = student_t_impl_dot(m, m);
        twice = 2.0f * facing / length2;
        for (i = 0; i < 3; ++i) l[i] = twice * m[i] - v[i];
        if (!(facing > 0.0f && l[2] > 0.0f)) return sample;
        facets = student_t_impl_coat(p, &shares, v, m, length2, l, facing / sqrtf(length2));
    } else {
        float number = student_t_impl_unit(u[0]);
        if (student_t_impl_chosen(&number, p->plain) || !p->energy.table) {
            student_t_impl_upward(number, u[1], l);
        } else {
            student_t_impl_sample_broad(student_t_impl_bands(&p->energy, 0), number, u[1], l);
        }
        if (!(l[2] > 0.0f)) return sample;
        facets = student_t_impl_coat_between(p, &shares, v, l, m);
        student_t_impl_normalize(m);
    }
    base = student_t_impl_base(p, &shares, l[2], &coat);
    factor = student_t_impl_base_factor(p, l[2]);
    sample.event = STUDENT_T_REFLECTED;
    for (i = 0; i < 3; ++i) {
        sample.l[i] = l[i];
        sample.m[i] = m[i];
    }
    for (i = 0; i < STUDENT_T_CHANNELS; ++i) {
        broad = student_t_impl_broad_part(l[2], factor, 1.0f, base * p->diffuse[i] + coat);
        both = student_t_impl_mix(share, facets, broad);
        sample.weight[i] = both.weight;
        sample.pdf = both.pdf;
    }
    return sample;
}

/* Fills f, without the cosine of the light, and returns the density with which
 * student_t_plastic_sample draws l; both are 0 where v or l is not above the horizon or not
 * finite. The reflection of a smooth coat is in neither. */
STUDENT_T_FUNCTION float student_t_plastic_eval_pdf(const student_t_plastic *p, const float v[3],
                                                    const float l[3],
                                                    float f[STUDENT_T_CHANNELS])
{
    student_t_impl_shares shares;
    student_t_impl_part facets, broad;
    float m[3], share, base, coat, factor, inverse, pdf = 0.0f;
    int i;
    for (i = 0; i < STUDENT_T_CHANNELS; ++i) f[i] = 0.0f;
    if (!(v[2] > 0.0f && l[2] > 0.0f && student_t_impl_is_direction(v) &&
          student_t_impl_is_direction(l))) return 0.0f;
    shares = student_t_impl_shares_of(&p->energy, 0, v[2]);
    share = student_t_impl_coat_share(p, &shares);
    facets = student_t_impl_coat_between(p, &shares, v, l, m);
    base = student_t_impl_base(p, &shares, l[2], &coat);
    factor = student_t_impl_base_factor(p, l[2]);
    inverse = student_t_impl_inverse_cosine(l[2]);
    for (i = 0; i < STUDENT_T_CHANNELS; ++i) {
        broad = student_t_impl_broad_part(l[2], factor, 1.0f, base * p->diffuse[i] + coat);
        f[i] = student_t_impl_finite(student_t_impl_f(facets.weight, facets.pdf, inverse) +
                                     student_t_impl_f(broad.weight, broad.pdf, inverse));
        pdf = share * facets.pdf + (1.0f - share) * broad.pdf;
    }
    return pdf;
}
