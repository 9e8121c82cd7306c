
/* ---- One shape ---------------------------------------------------------------------------------
 * The functions of lobes by a shape and {sigma_x, sigma_y}, without a lobe of one's own. */

STUDENT_T_FUNCTION float
student_t_d(const student_t_shape *shape, const float sigma[2], const float m[3])
{
    student_t_lobe lobe;
    student_t_impl_make(&lobe, shape, sigma[0], sigma[1]);
    return student_t_lobe_d(&lobe, m);
}

STUDENT_T_FUNCTION float
student_t_g1(const student_t_shape *shape, const float sigma[2], const float w[3])
{
    student_t_lobe lobe;
    student_t_impl_make(&lobe, shape, sigma[0], sigma[1]);
    return student_t_lobe_g1(&lobe, w);
}

STUDENT_T_FUNCTION float
student_t_lambda(const student_t_shape *shape, const float sigma[2], const float w[3])
{
    student_t_lobe lobe;
    student_t_impl_make(&lobe, shape, sigma[0], sigma[1]);
    return student_t_lobe_lambda(&lobe, w);
}

STUDENT_T_FUNCTION float student_t_g2(const student_t_shape *shape, const float sigma[2],
                                      const float v[3], const float l[3],
                                      enum student_t_masking masking)
{
    student_t_lobe lobe;
    student_t_impl_make(&lobe, shape, sigma[0], sigma[1]);
    return student_t_lobe_g2(&lobe, v, l, masking);
}

STUDENT_T_FUNCTION void student_t_sample_visible_normal(const student_t_shape *shape,
                                                        const float sigma[2], const float v[3],
                                                        const float u[2], float m[3])
{
    student_t_lobe lobe;
    student_t_impl_make(&lobe, shape, sigma[0], sigma[1]);
    student_t_lobe_sample_visible_normal(&lobe, v, u, m);
}

STUDENT_T_FUNCTION float student_t_visible_normal_pdf(const student_t_shape *shape,
                                                      const float sigma[2], const float v[3],
                                                      const float m[3])
{
    student_t_lobe lobe;
    student_t_impl_make(&lobe, shape, sigma[0], sigma[1]);
    return student_t_lobe_visible_normal_pdf(&lobe, v, m);
}

STUDENT_T_FUNCTION float student_t_reflection_pdf(const student_t_shape *shape,
                                                  const float sigma[2], const float v[3],
                                                  const float m[3])
{
    student_t_lobe lobe;
    student_t_impl_make(&lobe, shape, sigma[0], sigma[1]);
    return student_t_lobe_reflection_pdf(&lobe, v, m);
}

STUDENT_T_FUNCTION float student_t_reflection_weight(const student_t_shape *shape,
                                                     const float sigma[2], const float v[3],
                                                     const float l[3],
                                                     enum student_t_masking masking)
{
    student_t_lobe lobe;
    student_t_impl_make(&lobe, shape, sigma[0], sigma[1]);
    return student_t_lobe_reflection_weight(&lobe, v, l, masking);
}

STUDENT_T_FUNCTION float student_t_albedo(const student_t_shape *shape, const float sigma[2],
                                          const float v[3], enum student_t_masking masking)
{
    student_t_lobe lobe;
    student_t_impl_make(&lobe, shape, sigma[0], sigma[1]);
    return student_t_lobe_albedo(&lobe, v, masking);
}

STUDENT_T_FUNCTION void student_t_albedo_parts(const student_t_shape *shape, const float sigma[2],
                                               const float v[3], enum student_t_masking masking,
                                               float scale_bias_f82[3])
{
    student_t_lobe lobe;
    student_t_impl_make(&lobe, shape, sigma[0], sigma[1]);
    student_t_lobe_albedo_parts(&lobe, v, masking, scale_bias_f82);
}

STUDENT_T_FUNCTION float student_t_albedo_average(const student_t_shape *shape,
                                                  const float sigma[2],
                                                  enum student_t_masking masking)
{
    student_t_lobe lobe;
    student_t_impl_make(&lobe, shape, sigma[0], sigma[1]);
    return student_t_lobe_albedo_average(&lobe, masking);
}

STUDENT_T_FUNCTION void student_t_albedo_average_parts(const student_t_shape *shape,
                                                       const float sigma[2],
                                                       enum student_t_masking masking,
                                                       float scale_bias_f82[3])
{
    student_t_lobe lobe;
    student_t_impl_make(&lobe, shape, sigma[0], sigma[1]);
    student_t_lobe_albedo_average_parts(&lobe, masking, scale_bias_f82);
}

STUDENT_T_FUNCTION float student_t_compensation(const student_t_shape *shape, const float sigma[2],
                                                const float v[3], const float l[3],
                                                enum student_t_masking masking)
{
    student_t_lobe lobe;
    student_t_impl_make(&lobe, shape, sigma[0], sigma[1]);
    return student_t_lobe_compensation(&lobe, v, l, masking);
}
