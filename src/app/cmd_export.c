/* turner export: a scene for other programs. */
#include <getopt.h>
#include <stdio.h>
#include <string.h>

#include "app/povray.h"
#include "app/scene_options.h"
#include "scene/pov.h"

static const char help[] =
    "Usage: turner export SCENE --pov -o FILE.pov [OPTION]…\n"
    "Writes SCENE for another program: an independent second opinion on a picture.\n"
    "\n"
    "      --pov             as a POV-Ray 3.7 scene, the same to the last digit; what POV-Ray\n"
    "                        cannot say is an error that names it (docs/scenes.md has the list)\n"
    "      --anyway          it is a warning, and the picture another: to compare times\n"
    "  -o, --output FILE     appears whole or not at all\n"
    "      --run             draw it with POV-Ray at once: beside FILE.pov appear FILE.exr, linear\n"
    "                        and one sample a pixel, and FILE.log, what POV-Ray said\n"
    "      --size WxH        the picture it is meant for: POV-Ray takes the size on its own\n"
    "                        command line, and must be given the same there\n"
    "      --depth N         how often light may be reflected or refracted\n"
    "      --cutoff X        rays that count less are not followed; 0 follows all\n"
    "      --shading KIND    phong | energy_conserving\n"
    "      --shadows KIND    opaque | tinted\n"
    "  -q, --quiet           no warnings\n"
    "  -h, --help            this text\n"
    "\n"
    "Example: draw a scene with both and look at what differs:\n"
    "  turner export scene.json --pov -o povray.pov --size 320x240 --run\n"
    "  turner render scene.json -o turner.exr --size 320x240 --spp 1\n"
    "  turner compare povray.exr turner.exr -t 0.01 --heatmap differs.png\n";

struct arguments {
    const char *output;
    bool pov, run, anyway, quiet;
    struct turner_scene_options options;
};

enum { POV = TURNER_OPTION_OWN, RUN, ANYWAY };

static enum turner_result take(struct arguments *a, int option, char **argv)
{
    switch (option) {
    case 'o': a->output = optarg; return TURNER_OK;
    case 'q': a->quiet = true; return TURNER_OK;
    case POV: a->pov = true; return TURNER_OK;
    case RUN: a->run = true; return TURNER_OK;
    case ANYWAY: a->anyway = true; return TURNER_OK;
    }
    return turner_scene_option_take(&a->options, option, argv);
}

/* `path` is FOLDER/NAME.pov; its picture goes to FOLDER/NAME.exr. */
static enum turner_result draw(const struct turner_scene *scene, const char *path)
{
    const char *slash = strrchr(path, '/'), *file = slash ? slash + 1 : path;
    size_t length = strlen(file);
    char folder[4096], name[256];
    if (length < 5 || strcmp(file + length - 4, ".pov") != 0)
        return turner_fail(TURNER_USAGE, "%s: with --run the name must end in .pov", path);
    int end = !slash || slash == path ? 1 : (int)(slash - path);
    if (snprintf(folder, sizeof folder, "%.*s", end, slash ? path : ".") >= (int)sizeof folder ||
        snprintf(name, sizeof name, "%.*s", (int)length - 4, file) >= (int)sizeof name)
        return turner_fail(TURNER_USAGE, "%s: this name is too long", path);
    struct turner_image image;
    enum turner_result result = turner_povray_render(&image, scene, folder, name);
    turner_image_destroy(&image);
    return result;
}

enum turner_result turner_cmd_export(int argc, char **argv)
{
    static const struct option options[] = {
        {"pov", no_argument, NULL, POV},
        {"run", no_argument, NULL, RUN},
        {"anyway", no_argument, NULL, ANYWAY},
        {"output", required_argument, NULL, 'o'},
        {"size", required_argument, NULL, TURNER_OPTION_SIZE},
        {"depth", required_argument, NULL, TURNER_OPTION_DEPTH},
        {"cutoff", required_argument, NULL, TURNER_OPTION_CUTOFF},
        {"shading", required_argument, NULL, TURNER_OPTION_SHADING},
        {"shadows", required_argument, NULL, TURNER_OPTION_SHADOWS},
        {"quiet", no_argument, NULL, 'q'},
        {"help", no_argument, NULL, 'h'},
        {0}};
    struct arguments a = {.options = TURNER_SCENE_OPTIONS};
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, "o:qh", options, NULL)) != -1;) {
        if (option == 'h') {
            fputs(help, stdout);
            return TURNER_OK;
        }
        TURNER_TRY(take(&a, option, argv));
    }
    if (optind + 1 != argc)
        return turner_fail(TURNER_USAGE, "export takes one scene; see turner export --help");
    if (!a.pov)
        return turner_fail(TURNER_USAGE, "export to what? --pov is all there is");
    if (!a.output)
        return turner_fail(TURNER_USAGE, "export needs -o FILE.pov for what it writes");
    if (a.anyway && a.run)
        return turner_fail(TURNER_USAGE, "export draws only what POV-Ray can say: leave out --run "
                                         "or --anyway");
    turner_set_quiet(a.quiet);
    struct turner_scene *scene = NULL;
    enum turner_result result;
    TURNER_TRY_DONE(turner_scene_load(&scene, argv[optind]));
    TURNER_TRY_DONE(turner_scene_options_apply(&a.options, scene));
    TURNER_TRY_DONE(a.run      ? draw(scene, a.output)
                    : a.anyway ? turner_pov_write_anyway(scene, a.output)
                               : turner_pov_write(scene, a.output));
done:
    turner_scene_destroy(scene);
    return result;
}
