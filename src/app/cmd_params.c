#include <cjson/cJSON.h>
#include <getopt.h>
#include <stdio.h>
#include <string.h>

#include "app/app.h"
#include "scene/methods.h"

static void print_help(void)
{
    puts("Usage: turner params [--json] [NAME]…\n\n"
         "Lists what can be chosen by --method NAME=VALUE, and in a scene's settings under\n"
         "\"methods\" (depth and cutoff: directly): the values, the default, what it decides and\n"
         "where the method is from. The defaults are those that hold everywhere; the others show\n"
         "what they cost and where they fail.\n\n"
         "      --json   the same as JSON\n"
         "  -h, --help   this text\n\n"
         "Example: turner render scenes/fresnel.json -o schlick.png --method fresnel=schlick");
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

enum turner_result turner_cmd_params(int argc, char **argv)
{
    static const struct option options[] = {
        {"json", no_argument, NULL, 'j'}, {"help", no_argument, NULL, 'h'}, {0}};
    bool json = false;
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, "h", options, NULL)) != -1;) {
        if (option == 'h') {
            print_help();
            return TURNER_OK;
        }
        if (option != 'j')
            return turner_bad_option(argv);
        json = true;
    }
    for (int i = optind; i < argc; i++) {
        const struct turner_method *method;
        TURNER_TRY(turner_method_find(&method, argv[i]));
    }
    cJSON *list = cJSON_CreateArray();
    for (size_t i = 0; i < turner_method_count; i++) {
        const struct turner_method *method = &turner_methods_list[i];
        if (!wanted(method, argv + optind))
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
