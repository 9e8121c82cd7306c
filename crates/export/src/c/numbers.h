
/* ---- Numbers ---------------------------------------------------------------------------------
 * Comparisons are written so that NaN takes the second value. */

#define STUDENT_T_LARGEST 3.4028234e38f
#define STUDENT_T_SMALLEST 1.17549435e-38f
#define STUDENT_T_IMPL_INVERSE_PI 0.318309886f

STUDENT_T_FUNCTION float student_t_impl_max(float a, float b) { return a > b ? a : b; }
STUDENT_T_FUNCTION float student_t_impl_min(float a, float b) { return a < b ? a : b; }

/* A cast, as either language likes it, and the pointer to nothing. */
#ifndef STUDENT_T_IMPL_CAST
#ifdef __cplusplus
#define STUDENT_T_IMPL_CAST(type, x) static_cast<type>(x)
#define STUDENT_T_IMPL_NULL nullptr
#else
#define STUDENT_T_IMPL_CAST(type, x) ((type)(x))
#define STUDENT_T_IMPL_NULL 0
#endif
#endif

/* The bits of a number, and the number of bits. */
STUDENT_T_FUNCTION int student_t_impl_bits(float x)
{
#if defined(__CUDA_ARCH__) || defined(__CUDACC_RTC__) || defined(__HIP_DEVICE_COMPILE__)
    return __float_as_int(x);
#else
    int bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
#endif
}

STUDENT_T_FUNCTION float student_t_impl_of_bits(int bits)
{
#if defined(__CUDA_ARCH__) || defined(__CUDACC_RTC__) || defined(__HIP_DEVICE_COMPILE__)
    return __int_as_float(bits);
#else
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
#endif
}

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
    const int cell = STUDENT_T_IMPL_CAST(int, x);
    *position = x - STUDENT_T_IMPL_CAST(float, cell);
    return cell;
}

/* The cubic of a cell. */
STUDENT_T_FUNCTION float student_t_impl_cubic(const float *c, float w)
{
    return (c[0] + w * c[1]) + (w * w) * (c[2] + w * c[3]);
}

/* scale (1 + part/whole)^power for part >= 0 and whole > 0, to a relative error of 4e-7 times one
 * plus its logarithm; 0 where the power is below 2^-126. It keeps the digits of a part that is
 * small compared with the whole; a whole below the least normal number counts as about that. */
STUDENT_T_FUNCTION float
student_t_impl_power_of_growth(float whole, float part, float power, float scale)
{
    /* sum/whole is 2^e (1 + t)/(1 - t) with |t| <= 0.2, since bits are linear between powers of
     * 2. */
    const float sum = whole + part;
    const int low = student_t_impl_bits(whole), high = student_t_impl_bits(sum);
    const int exponent = (high - low + 0x400000) >> 23;
    const float scaled = student_t_impl_of_bits(low + exponent * 0x800000);
    /* A small part keeps its digits, whatever a compiler makes of sums of differences. */
    const float excess = exponent == 0 ? part : sum - scaled;
    const float t = excess / (sum + scaled), y = t * t;
    /* log2 of that, by 2 artanh(t)/ln 2. */
    const float log = 2.88539007f + y * (0.96180225f + y * (0.57639026f + y * 0.43918935f));
    const float x = STUDENT_T_IMPL_CAST(float, exponent) * power + (t * power) * log;
    int nearest;
    float w, w2, high_part;
    if (!(x >= -126.0f && x <= 126.0f)) return x > 126.0f ? STUDENT_T_LARGEST : 0.0f;
    nearest = STUDENT_T_IMPL_CAST(int, x + 192.5f) - 192;
    w = x - STUDENT_T_IMPL_CAST(float, nearest); /* in [-1/2, 1/2] */
    w2 = w * w;
    high_part = (0.009618057f + w * 0.0013400428f) + w2 * 0.00015461445f;
    w = (1.0f + w * 0.69314718f) + w2 * (0.24022651f + w * 0.05550327f) + (w2 * w2) * high_part;
    return w * student_t_impl_of_bits((nearest + 127) * 0x800000) * scale;
}
