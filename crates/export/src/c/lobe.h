
/* ---- Lobes: what a renderer makes at a hit ------------------------------------------------------
 * A lobe holds no memory: make it where it is used, and forget it. It points to its tables. */

STUDENT_T_FUNCTION float student_t_impl_sigma(float sigma)
{
    return student_t_impl_min(student_t_impl_max(sigma, 1e-8f), 1e6f);
}

#ifdef STUDENT_T_FITTED_ALBEDO
#define STUDENT_T_IMPL_ALBEDOS student_t_family_here()
STUDENT_T_FUNCTION const student_t_family *student_t_family_here(void);
#else
#define STUDENT_T_IMPL_ALBEDOS STUDENT_T_IMPL_NULL
#endif

/* Fills in the lobe of a shape: in place, since a copy would wait for what was written last. */
STUDENT_T_FUNCTION void student_t_impl_make(student_t_lobe *lobe, const student_t_shape *shape,
                                            float sigma_x, float sigma_y)
{
    const student_t_impl_window none = {0, {0.0f, 0.0f, 0.0f, 0.0f}};
    lobe->sigma_x = student_t_impl_sigma(sigma_x);
    lobe->gamma = shape->gamma;
    lobe->sigma_y = student_t_impl_sigma(sigma_y);
    lobe->is_mirror = !(sigma_x > 0.0f && sigma_y > 0.0f);
    lobe->is_ggx = shape->is_ggx;
    lobe->law = shape->law;
    lobe->constants = &shape->constants;
    lobe->shape = shape;
    lobe->family = STUDENT_T_IMPL_NULL;
    lobe->part = STUDENT_T_IMPL_NULL;
    lobe->albedos = STUDENT_T_IMPL_ALBEDOS;
    lobe->slopes = lobe->across = lobe->masking = none;
}

/* The lobe of one shape and a roughness along x and along y, such as
 * student_t_lobe_of(&student_t_gamma_3, 0.3f, 0.3f). */
STUDENT_T_FUNCTION student_t_lobe
student_t_lobe_of(const student_t_shape *shape, float sigma_x, float sigma_y)
{
    student_t_lobe lobe;
    student_t_impl_make(&lobe, shape, sigma_x, sigma_y);
    return lobe;
}
