#include <cjson/cJSON.h>
#include <getopt.h>
#include <stdio.h>
#include <string.h>

#include "app/params_list.h"
#include "scene/methods.h"

static void print_help(void)
{
    puts("Usage: turner params [--json] [NAME]…\n"
         "       turner params [--json] [--shader-dir DIR] [--set NAME=VALUE] [SCENE]\n\n"
         "Lists what can be chosen by --method NAME=VALUE, and in a scene's settings under\n"
         "\"methods\" (depth and cutoff: directly): the values, the default, what it decides and\n"
         "where the method is from. The defaults are those that hold everywhere; the others show\n"
         "what they cost and where they fail.\n\n"
         "With a scene or a folder of shaders: the parameters that the shaders' //!PARAM lines\n"
         "declare (docs/shaders.md), with type, range, default and the value they have.\n\n"
         "      --shader-dir DIR   take shaders from here first (may be repeated)\n"
         "      --no-scene-shaders leave out the shaders of the scene's own folder\n"
         "      --set NAME=VALUE   try whether a parameter takes a value (may be repeated)\n"
         "      --json             the same as JSON\n"
         "  -h, --help             this text\n\n"
         "Examples: turner render scenes/fresnel.json -o schlick.png --method fresnel=schlick\n"
         "          turner params shaders/examples/marble.json");
}

/* Prints `text` in lines of at most 96 letters, each after `indent` spaces. UTF-8. */
static void print_wrapped(const char *text, int indent)
{
    int column = 0;
    while (*text) {
        size_t bytes = strcspn(text, " ");
        int letters = 0;
        for (size_t i = 0; i < bytes; i++)
            letters += ((unsigned char)text[i] & 0xc0) != 0x80;
        if (column == 0 || indent + column + 1 + letters > 96) {
            printf("%s%*s", column ? "\n" : "", indent, "");
            column = 0;
        } else {
            putchar(' ');
            column++;
        }
        printf("%.*s", (int)bytes, text);
        column += letters;
        text += bytes + (text[bytes] == ' ');
    }
    putchar('\n');
}

static void print_method(const struct turner_method *method)
{
    printf("%s = %s   (default %s)\n", method->name, method->values, method->standard);
    print_wrapped(method->sentence, 4);
    print_wrapped(method->source, 4);
    putchar('\n');
}

static void add_json(cJSON *list, const struct turner_method *method)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "name", method->name);
    cJSON_AddStringToObject(object, "values", method->values);
    cJSON_AddStringToObject(object, "default", method->standard);
    cJSON_AddStringToObject(object, "sentence", method->sentence);
    cJSON_AddStringToObject(object, "source", method->source);
    cJSON_AddItemToArray(list, object);
}

static bool wanted(const struct turner_method *method, char **names)
{
    for (char **name = names; *name; name++) {
        if (strcmp(*name, method->name) == 0)
            return true;
    }
    return !*names;
}

static bool is_scene(const char *argument)
{
    return strchr(argument, '.') || strchr(argument, '/'); /* no method has those in its name */
}

static enum turner_result list_of_shaders(const struct turner_scene_options *options,
                                          const char *path, bool json)
{
    struct turner_scene *scene;
    if (path)
        TURNER_TRY(turner_scene_load(&scene, path));
    else
        scene = turner_scene_create();
    enum turner_result result = turner_params_list(options, scene, json);
    turner_scene_destroy(scene);
    return result;
}

static enum turner_result list_methods(char **names, bool json)
{
    for (char **name = names; *name; name++) {
        const struct turner_method *method;
        TURNER_TRY(turner_method_find(&method, *name));
    }
    cJSON *list = cJSON_CreateArray();
    for (size_t i = 0; i < turner_method_count; i++) {
        const struct turner_method *method = &turner_methods_list[i];
        if (!wanted(method, names))
            continue;
        if (json)
            add_json(list, method);
        else
            print_method(method);
    }
    if (json) {
        char *text = cJSON_Print(list);
        puts(text);
        cJSON_free(text);
    }
    cJSON_Delete(list);
    return TURNER_OK;
}

enum turner_result turner_cmd_params(int argc, char **argv)
{
    static const struct option long_options[] = {
        {"json", no_argument, NULL, 'j'},
        {"shader-dir", required_argument, NULL, TURNER_OPTION_SHADER_DIR},
        {"no-scene-shaders", no_argument, NULL, TURNER_OPTION_NO_SCENE_SHADERS},
        {"set", required_argument, NULL, TURNER_OPTION_SET},
        {"help", no_argument, NULL, 'h'},
        {0}};
    struct turner_scene_options options = TURNER_SCENE_OPTIONS;
    bool json = false;
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, "h", long_options, NULL)) != -1;) {
        if (option == 'h') {
            print_help();
            return TURNER_OK;
        }
        if (option == 'j')
            json = true;
        else
            TURNER_TRY(turner_scene_option_take(&options, option, argv));
    }
    bool scene = optind + 1 == argc && is_scene(argv[optind]);
    bool shaders = scene || options.render.shader_dir_count || options.param_count;
    if (shaders && optind < argc && !scene)
        return turner_fail(TURNER_USAGE, "parameters of shaders are listed for one scene, or none; "
                                         "see turner params --help");
    return shaders ? list_of_shaders(&options, scene ? argv[optind] : NULL, json)
                   : list_methods(argv + optind, json);
}
