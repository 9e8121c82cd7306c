// The functions for real time in Metal, as C++: D is that of the closed form in C.
#include <cstdio>
#include <initializer_list>

#include "student_t_closed.h"
#include "student_t_realtime.metal"

int main()
{
    using metal::float2;
    using metal::float3;
    const float cosines[] = {0.02, 0.3, 0.8, 1.0};
    float worst = 0.0;
    for (float gamma : {1.6, 2.0, 3.0, 20.0})
        for (float sigma : {0.01, 0.3, 1.0})
            for (float z : cosines) {
                const float sine = metal::sqrt(1.0 - z * z);
                const float3 m(0.6 * sine, -0.8 * sine, z);
                const float2 both(sigma, 0.5 * sigma);
                const float got = student_t_surface_d(student_t_surface(gamma, both), m);
                const float c_sigma[] = {both.x, both.y}, c_m[] = {m.x, m.y, m.z};
                const float want = student_t_closed_d(gamma, c_sigma, c_m);
                // In far tails there is nothing left.
                if (want > 1e-20) worst = metal::max(worst, metal::abs(got / want - 1.0));
            }
    std::printf("Metal for real time, on the host: D is that in C to %.0e\n", double(worst));
    return worst < 1e-4 ? 0 : 1;
}
