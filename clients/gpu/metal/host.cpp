// Runs the kernel that comes with an export for Metal, as C++ of the host: takes student_t.bin,
// reflects the view of `clients/c/lookup.c`, and prints the same lines. With TEXTURES defined the
// tables are a texture.
#include <cstdio>
#include <cstdlib>

#include "student_t_sample.metal"

int main(int count, char **arguments)
{
    using metal::float2;
    FILE *const file = count == 2 ? std::fopen(arguments[1], "rb") : nullptr;
    if (!file) {
        std::fprintf(stderr, "usage: host student_t.bin\n");
        return 2;
    }
    const size_t most = 1 << 20;
    float2 *const pairs = static_cast<float2 *>(std::malloc(most * sizeof(float2)));
    const size_t read = std::fread(pairs, sizeof(float2), most, file);
    std::fclose(file);
    if (read == 0 || read == most) return 1;

    const Query query = {{0.6, 0.0, 0.8}, 0, float2(0.3, 0.3), float2(0.2, 0.7)};
    Answer a;
#ifdef TEXTURES
    reflect_views({pairs}, &query, &a, 1, 0);
#else
    reflect_views(pairs, &query, &a, 1, 0);
#endif
    std::printf("light %.4f %.4f %.4f, f cos / pdf %.4f, pdf %.4f per steradian\n", double(a.l.x),
                double(a.l.y), double(a.l.z), double(a.weight), double(a.pdf));
    std::printf("of all light one bounce returns %.4f\n", double(a.albedo));
    return 0;
}
