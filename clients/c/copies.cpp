/* Two translation units of C++17, of which this is either, have one copy of a shape and of its
 * functions, so that inline functions of other headers may use them. */
#include <cstdio>

#include "student_t_gamma_3.h"

typedef float (*masking_function)(const student_t_shape *, const float[2], const float[3]);

const student_t_shape *other_shape();
masking_function other_masking();

#ifdef OTHER_UNIT
const student_t_shape *other_shape() { return &student_t_gamma_3; }
masking_function other_masking() { return student_t_g1; }
#else
int main()
{
    const bool shared = other_shape() == &student_t_gamma_3 && other_masking() == student_t_g1;
    std::puts(shared ? "two translation units share one copy" : "each translation unit has a copy");
    return shared ? 0 : 1;
}
#endif
