// Runs the kernel that comes with an export for Metal, as C++ of the host: takes its tables,
// reflects the view of `clients/c/lookup.c`, and prints the same lines. With TEXTURES defined the
// tables are a texture, and with FAMILY they are of every gamma.
#include <cstdio>
#include <cstdlib>

#ifdef FAMILY
#include "student_t_family_sample.metal"
using Entry = metal::uint;
const float shape = 3.0;
#else
#include "student_t_sample.metal"
using Entry = metal::float2;
const metal::uint shape = 0;
#endif

int main(int count, char **arguments)
{
    using metal::float2;
    FILE *const file = count == 2 ? std::fopen(arguments[1], "rb") : nullptr;
    if (!file) {
        std::fprintf(stderr, "usage: host TABLES.bin\n");
        return 2;
    }
    const size_t most = 1 << 20;
    Entry *const entries = static_cast<Entry *>(std::malloc(most * sizeof(Entry)));
    const size_t read = std::fread(entries, sizeof(Entry), most, file);
    std::fclose(file);
    if (read == 0 || read == most) return 1;

    const Query query = {{0.6, 0.0, 0.8}, shape, float2(0.3, 0.3), float2(0.2, 0.7)};
    Answer a;
#ifdef TEXTURES
    reflect_views({entries}, &query, &a, 1, 0);
#else
    reflect_views(entries, &query, &a, 1, 0);
#endif
    std::printf("light %.4f %.4f %.4f, f cos / pdf %.4f, pdf %.4f per steradian\n", double(a.l.x),
                double(a.l.y), double(a.l.z), double(a.weight), double(a.pdf));
    std::printf("of all light one bounce returns %.4f\n", double(a.albedo));
    return 0;
}
