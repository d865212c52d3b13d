/* reload_seconds SCENE.json [N]: how long it takes from saving a hook of 20 lines to its kernel being
 * ready, and to its picture; nothing of it in a cache. Prints the median and the worst of N (50), and
 * of each step. */
#include "gpu/specialise.h"
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

/* What the time goes into, in the order in which it is done. */
enum { EXPAND, COMPILE, REDUCE, VALIDATE, PROGRAM, FIRST, STAGES };
static const char *const stages[] = {"reading and expanding the source", "glslang", "specialising",
                                     "spirv-val",
                                     "reflection and pipeline", "the first dispatch"};

static void measure_stages(struct reload_bench *bench, double *seconds[STAGES], int i)
{
    const char *const dirs[] = {bench->folder};
    struct turner_shader_source source;
    struct turner_kernel kernel;
    struct turner_constant constants[TURNER_KERNEL_CONSTANTS];
    struct turner_spirv special;
    size_t count;
    double clock[STAGES + 1];
    clock[EXPAND] = turner_seconds();
    assert_ok(turner_shader_source_create(&source, "render.comp", dirs, 1));
    clock[COMPILE] = turner_seconds();
    assert_ok(turner_kernel_compile(&kernel, bench->kernel.kind, &source, true));
    clock[REDUCE] = turner_seconds();
    assert_ok(turner_kernel_specialisation(constants, &count, &kernel, &bench->renderer.needs,
                                           bench->renderer.flat.max_depth, bench->scene));
    assert_ok(turner_spirv_reduce(&special, &kernel.spirv, constants, count, false));
    clock[VALIDATE] = turner_seconds();
    assert_ok(turner_spirv_validate(&special));
    clock[PROGRAM] = turner_seconds();
    struct turner_program before = bench->renderer.program;
    assert_ok(turner_program_create(&bench->renderer.program, &bench->gpu, &special, NULL, 0,
                                    true));
    clock[FIRST] = turner_seconds();
    assert_ok(turner_renderer_warm(&bench->renderer));
    clock[STAGES] = turner_seconds();
    turner_program_destroy(&bench->gpu, &bench->renderer.program);
    bench->renderer.program = before;
    turner_spirv_destroy(&special);
    turner_kernel_destroy(&kernel);
    turner_shader_source_destroy(&source);
    for (int stage = 0; stage < STAGES; stage++)
        seconds[stage][i] = clock[stage + 1] - clock[stage];
}

/* Seconds of the processor, of all threads: what the time would be on a machine at rest, where nothing
 * runs side by side. */
static double cpu_seconds(void)
{
    struct timespec used;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
    return (double)used.tv_sec + 1e-9 * (double)used.tv_nsec;
}

/* Another hook each time, so that no cache has it. */
static void save(const struct reload_bench *bench, int number)
{
    char text[sizeof hook + 16];
    snprintf(text, sizeof text, hook, number);
    bench_write(bench, "surface.glsl", text, true);
}

int main(int argc, char **argv)
{
    static struct reload_bench bench;
    int count = argc > 2 ? atoi(argv[2]) : 50, base = (int)time(NULL) % 10000 * 200;
    if (argc < 2 || count < 1)
        return 2;
    bench_open(&bench, argv[1], true, false);
    double *ready = calloc((size_t)count, sizeof *ready), *seen = calloc((size_t)count, sizeof *seen);
    double *cpu = calloc((size_t)count, sizeof *cpu);
    double *parts[STAGES];
    for (int stage = 0; stage < STAGES; stage++)
        parts[stage] = calloc((size_t)count, sizeof *parts[stage]);
    for (int i = 0; i < count; i++) {
        float color[4];
        double start = turner_seconds(), cpu_start = cpu_seconds();
        save(&bench, base + 2 * i);
        assert_int_equal(bench_settle(&bench), TURNER_RELOAD_READY);
        ready[i] = turner_seconds() - start;
        bench_color(&bench, color);
        seen[i] = turner_seconds() - start;
        cpu[i] = cpu_seconds() - cpu_start;
        save(&bench, base + 2 * i + 1);
        measure_stages(&bench, parts, i);
    }
    print("from saving to a kernel that is ready", ready, count);
    print("from saving to 8x8 pixels drawn with it", seen, count);
    print("the same in seconds of the processor", cpu, count);
    for (int stage = 0; stage < STAGES; stage++) {
        print(stages[stage], parts[stage], count);
        free(parts[stage]);
    }
    free(cpu);
    free(ready);
    free(seen);
    return bench_close(&bench, 0);
}
