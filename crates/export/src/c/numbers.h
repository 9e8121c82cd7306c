
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
