#include <getopt.h>
#include <stdio.h>
#include <string.h>

#include "app/app.h"
#include "gpu/compiler.h"
#include "gpu/include.h"
#include "render/needs.h"
#include "scene/scene.h"

static void print_help(void)
{
    puts("Usage: turner check FILE…\n\n"
         "Reads scenes (.json .nff and meshes) and compiles shaders (.comp .glsl, looked for in\n"
         "their own folder first) without drawing anything. Says what each scene holds and needs\n"
         "of the kernel, or what is wrong as file:line:column: message. Exit status 0 when all is\n"
         "well, 3 otherwise.\n\n"
         "  -q, --quiet   say only what is wrong\n"
         "  -h, --help    this text");
}

static void describe(const char *path, const struct turner_scene *scene)
{
    size_t spheres = 0, cones = 0, triangles = 0;
    for (size_t g = 0; g < scene->group_count; g++) {
        spheres += scene->groups[g].sphere_count;
        cones += scene->groups[g].cone_count;
        for (size_t m = 0; m < scene->groups[g].mesh_count; m++)
            triangles += scene->groups[g].meshes[m].triangle_count;
    }
    printf("%s: %zu spheres, %zu cones, %zu triangles, %zu planes, %zu instances, %zu lights, "
           "%zu materials\n", path, spheres, cones, triangles, scene->plane_count,
           scene->instance_count, scene->light_count, scene->material_count);
    struct turner_needs needs = turner_needs_of(scene);
    printf("  needs");
    const char *separator = " ";
    for (uint32_t bit = 1; bit && bit <= needs.bits; bit <<= 1) {
        if (needs.bits & bit) {
            printf("%s%s", separator, turner_needs_name(bit));
            separator = ", ";
        }
    }
    puts("");
}

static enum turner_result check_scene(const char *path, bool quiet)
{
    struct turner_scene *scene;
    TURNER_TRY(turner_scene_load(&scene, path));
    if (!quiet)
        describe(path, scene);
    turner_scene_destroy(scene);
    return TURNER_OK;
}

/* Whether the kernel includes a file of that name. */
static bool includes(const struct turner_shader_source *source, const char *name)
{
    for (size_t i = 0; i < source->file_count; i++) {
        if (strcmp(source->files[i].name, name) == 0)
            return true;
    }
    return false;
}

/* `path` as a shader of its own (.comp), or as an include put into the renderer's place of it. */
static enum turner_result check_shader(const char *path, bool quiet)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    char folder[4096] = ".";
    if (slash)
        snprintf(folder, sizeof folder, "%.*s", (int)(slash - path), path);
    const char *const folders[] = {folder};
    const char *ending = strrchr(name, '.');
    struct turner_shader_source source;
    struct turner_spirv spirv = {0};
    enum turner_result result;
    TURNER_TRY_DONE(turner_shader_source_create(
        &source, ending && strcmp(ending, ".comp") == 0 ? name : "render.comp", folders, 1));
    if (!includes(&source, name)) {
        result = turner_fail(TURNER_BAD_INPUT, "%s: the kernel includes no file of that name; a "
                                               "shader replaces one of shaders/", path);
        goto done;
    }
    TURNER_TRY_DONE(turner_compile(&spirv, &source, NULL, 0));
    TURNER_TRY_DONE(turner_spirv_validate(&spirv));
    if (!quiet)
        printf("%s: compiles to %zu words of SPIR-V\n", path, spirv.count);
done:
    turner_spirv_destroy(&spirv);
    turner_shader_source_destroy(&source);
    return result;
}

static bool is_shader(const char *path)
{
    const char *ending = strrchr(path, '.');
    return ending && (strcmp(ending, ".comp") == 0 || strcmp(ending, ".glsl") == 0);
}

enum turner_result turner_cmd_check(int argc, char **argv)
{
    static const struct option options[] = {
        {"quiet", no_argument, NULL, 'q'}, {"help", no_argument, NULL, 'h'}, {0}};
    bool quiet = false;
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, "qh", options, NULL)) != -1;) {
        switch (option) {
        case 'q': quiet = true; break;
        case 'h': print_help(); return TURNER_OK;
        default: return turner_bad_option(argv);
        }
    }
    if (optind == argc)
        return turner_fail(TURNER_USAGE, "check takes scenes or shaders; see turner check --help");
    turner_set_quiet(quiet);
    enum turner_result worst = TURNER_OK;
    for (int i = optind; i < argc; i++) {
        enum turner_result result =
            is_shader(argv[i]) ? check_shader(argv[i], quiet) : check_scene(argv[i], quiet);
        if (result == TURNER_OK)
            continue;
        fprintf(stderr, "turner: error: %s\n", turner_message());
        turner_fail(result, "%s", ""); /* said already */
        worst = result;
    }
    return worst;
}
