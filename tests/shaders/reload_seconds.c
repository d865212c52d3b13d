/* reload_seconds SCENE [N]: how long it takes from saving a hook of 20 lines to its kernel being
 * ready, and to its picture; nothing of it in a cache. Prints the median and the worst of N (50). */
#include "reload_bench.h"

#include <time.h>

static const char hook[] =
    "//!PARAM scale float 4 0.5 20 \"\"\n"
    "//!PARAM strength float 1.5 0 5 \"\"\n"
    "float random_at(ivec3 p)\n"
    "{\n"
    "    uint s = uint(p.x) * 73856093u ^ uint(p.y) * 19349663u ^ uint(p.z) * 83492791u;\n"
    "    s = s * 747796405u + 2891336453u;\n"
    "    return float(s >> 8u) / 16777216.0;\n"
    "}\n"
    "float noise(vec3 p)\n"
    "{\n"
    "    ivec3 i = ivec3(floor(p));\n"
    "    vec3 f = fract(p);\n"
    "    return mix(random_at(i), random_at(i + ivec3(1, 0, 0)), f.x);\n"
    "}\n"
    "void user_surface(inout turner_gpu_material material, inout real3 ns, surface_t surface)\n"
    "{\n"
    "    vec3 p = scale * vec3(surface.point);\n"
    "    material.k_d *= 0.5 + 0.5 * sin(p.x + strength * noise(p)) + %d.0 / 100000.0;\n"
    "    material.k_s = vec3(0.2);\n"
    "}\n";

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void print(const char *what, double *seconds, int count)
{
    qsort(seconds, (size_t)count, sizeof *seconds, by_size);
    printf("%s: median %.0f ms, worst %.0f ms of %d\n", what, 1000 * seconds[count / 2],
           1000 * seconds[count - 1], count);
}

int main(int argc, char **argv)
{
    static struct reload_bench bench;
    int count = argc > 2 ? atoi(argv[2]) : 50;
    if (argc < 2 || count < 1)
        return 2;
    FILE *file = fopen(argv[1], "r");
    static char scene[65536];
    if (!file || !fread(scene, 1, sizeof scene - 1, file))
        return 3;
    fclose(file);
    bench_open(&bench, scene, true);
    double *ready = calloc((size_t)count, sizeof *ready), *seen = calloc((size_t)count, sizeof *seen);
    int base = (int)time(NULL) % 10000 * 10;
    for (int i = 0; i < count; i++) {
        char text[sizeof hook + 16];
        snprintf(text, sizeof text, hook, base + i);
        double start = turner_seconds();
        bench_write(&bench, "surface.glsl", text, true);
        assert_int_equal(bench_settle(&bench), TURNER_RELOAD_READY);
        ready[i] = turner_seconds() - start;
        float color[4];
        bench.renderer.settings.width = bench.renderer.settings.height = 8;
        bench.scene->settings.width = bench.scene->settings.height = 8;
        bench_color(&bench, color);
        seen[i] = turner_seconds() - start;
    }
    print("from saving to a kernel that is ready", ready, count);
    print("from saving to 8x8 pixels drawn with it", seen, count);
    free(ready);
    free(seen);
    return bench_close(&bench, 0);
}
