/* What the JSON reader says about wrong files: each message whole, each place exact. */
#include <stdlib.h>

#include "scene_reading.h"

/* Text with '@' where the message must point (the mark itself is taken out), and the message after
 * "t.json:line:column: ". */
struct error_case {
    const char *text, *message;
};

static void check_text(const char *text, size_t length, const char *message)
{
    char *clean = malloc(length + 1), expected[2048];
    size_t used = 0, line = 1, column = 1, marks = 0;
    for (size_t i = 0; i < length; i++) {
        if (text[i] == '@') {
            marks++;
            continue;
        }
        clean[used++] = text[i];
        if (marks == 0 && text[i] == '\n') {
            line++;
            column = 1;
        } else if (marks == 0 && ((unsigned char)text[i] & 0xC0) != 0x80) {
            column++;
        }
    }
    clean = realloc(clean, used ? used : 1); /* a byte too far is seen by the sanitizer */
    if (marks != 1)
        fail_msg("the case \"%s\" has %zu marks", text, marks);
    struct turner_scene *scene;
    enum turner_result result = turner_scene_parse(&scene, clean, used, "t.json");
    free(clean);
    snprintf(expected, sizeof expected, "t.json:%zu:%zu: %s", line, column, message);
    if (result == TURNER_OK)
        fail_msg("accepted: %s", text);
    assert_int_equal(result, TURNER_BAD_INPUT);
    assert_null(scene);
    assert_string_equal(turner_message(), expected);
}

static void check_cases(const struct error_case *cases, size_t count)
{
    for (size_t i = 0; i < count; i++)
        check_text(cases[i].text, strlen(cases[i].text), cases[i].message);
}

#define CHECK_CASES(cases) check_cases(cases, sizeof(cases) / sizeof *(cases))

static void syntax(void **state)
{
    (void)state;
    static const struct error_case cases[] = {
        {" \n @", "the file is empty"},
        {"@nonsense", "\"nonsense\" is no JSON value; text wants double quotes"},
        {"@NaN", "\"NaN\" is no JSON value; text wants double quotes"},
        {"@}", "expected a value, but here is \"}\""},
        {"{\"version\": 1@", "the file ends here, but the \"{\" of line 1, column 1 is not closed; "
                             "it may be truncated"},
        {"{\"a\":\n [1, [2@", "the file ends here, but the \"[\" of line 2, column 6 is not "
                              "closed; it may be truncated"},
        {"{\"version\"@", "the file ends here, but the \"{\" of line 1, column 1 is not closed; it "
                          "may be truncated"},
        {"{@\"version", "this string is not closed; the file may be truncated"},
        {"{@\"version\n\": 1}", "this string is not closed at the end of the line"},
        {"{\"version\": 1@,}", "a comma before \"}\" is one too many"},
        {"[1@, ]", "a comma before \"]\" is one too many"},
        {"{\"version\": 1 @\"camera\": {}}", "expected \",\" or \"}\", but here is \"\"\""},
        {"[1 @2]", "expected \",\" or \"]\", but here is \"2\""},
        {"[1@}", "expected \",\" or \"]\", but here is \"}\""},
        {"{@version: 1}", "expected a key in double quotes, but here is \"v\""},
        {"{@1: 1}", "expected a key in double quotes, but here is \"1\""},
        {"{@'version': 1}", "JSON wants double quotes"},
        {"{@// a remark\n}", "JSON has no comments; use \"description\" instead"},
        {"{\"version\": 1, @# a remark\n}", "JSON has no comments; use \"description\" instead"},
        {"{\"version\" @= 1}", "expected \":\" after the key, but here is \"=\""},
        {"{\"version\": 1} @x", "expected the end of the file, but here is \"x\""},
        {"{\"version\": 1}@}", "expected the end of the file, but here is \"}\""},
        {"[@01]", "a number may not start with 0"},
        {"[@+1]", "expected a value, but here is \"+\""},
        {"[@.5]", "expected a value, but here is \".\""},
        {"[1.@]", "expected a digit after the decimal point, but here is \"]\""},
        {"[1e@]", "expected a digit of the exponent, but here is \"]\""},
        {"[-@x]", "expected a digit, but here is \"x\""},
        {"[@0.1234567890123456789012345678901234567890123456789012345678901234]",
         "this number has 66 characters; 63 are allowed"},
        {"[\"a@\\qb\"]", "unknown escape in a string; write \"\\\\\" for a backslash"},
        {"[\"@\\u12g4\"]", "\"\\u\" wants four hexadecimal digits"},
        {"[\"@\\u0000\"]", "the character \"\\u0000\" is not allowed"},
        {"[\"@\\udc00\"]", "half a surrogate pair"},
        {"[\"@\\ud800\\u0041\"]", "half a surrogate pair"},
        {"[\"@\\ud800\"]", "half a surrogate pair"},
        {"[\"a@\tb\"]", "byte 0x09 in a string; write it as \"\\u0009\""},
        {"@\x01", "expected a value, but here is byte 0x01"},
        {"@\xC3\xA4", "expected a value, but here is byte 0xC3"},
        {"[@\xEF\xBB\xBF]", "expected a value, but here is byte 0xEF"},
    };
    CHECK_CASES(cases);
}

static void encodings(void **state)
{
    (void)state;
    static const struct error_case cases[] = {
        {"[\"\xC3\xA4\xE2\x82\xAC\", \"@\xFF\"]",
         "byte 0xFF is not UTF-8; save the file as UTF-8"},
        {"[\"@\xC0\xAF\"]", "byte 0xC0 is not UTF-8; save the file as UTF-8"},
        {"[\"@\xED\xA0\x80\"]", "byte 0xED is not UTF-8; save the file as UTF-8"},
        {"[\"@\xE0\x9F\xBF\"]", "byte 0xE0 is not UTF-8; save the file as UTF-8"},
        {"[\"@\xF0\x8F\xBF\xBF\"]", "byte 0xF0 is not UTF-8; save the file as UTF-8"},
        {"[\"@\xF4\x90\x80\x80\"]", "byte 0xF4 is not UTF-8; save the file as UTF-8"},
        {"[\"@\xF5\x80\x80\x80\"]", "byte 0xF5 is not UTF-8; save the file as UTF-8"},
        {"[\"@\xE2\x82", "byte 0xE2 is not UTF-8; save the file as UTF-8"},
        {"@\xFF\xFE{\x01", "this is UTF-16; save the file as UTF-8"},
        {"@\xFE\xFF\x01{", "this is UTF-16; save the file as UTF-8"},
    };
    CHECK_CASES(cases);
    static const char nul_in_string[] = "[\"a@\0b\"]", nul_outside[] = "[1, @\0 2]";
    check_text(nul_in_string, sizeof nul_in_string - 1,
               "byte 0x00 in a string; write it as \"\\u0000\"");
    check_text(nul_outside, sizeof nul_outside - 1, "expected a value, but here is byte 0x00");
    /* columns do not count a byte order mark: this error is in column 2 */
    const char *marked = "\xEF\xBB\xBF[x]";
    struct turner_scene *scene;
    assert_int_equal(turner_scene_parse(&scene, marked, strlen(marked), "t.json"),
                     TURNER_BAD_INPUT);
    assert_string_equal(turner_message(),
                        "t.json:1:2: \"x\" is no JSON value; text wants double quotes");
}

static void nesting(void **state)
{
    (void)state;
    char text[64];
    memset(text, '[', sizeof text);
    struct turner_scene *scene;
    assert_int_equal(turner_scene_parse(&scene, text, sizeof text, "t.json"), TURNER_BAD_INPUT);
    assert_string_equal(turner_message(), "t.json:1:33: nested more than 32 deep");
    /* 32 are good JSON, whatever they mean */
    memset(text + 32, ']', 32);
    assert_int_equal(turner_scene_parse(&scene, text, sizeof text, "t.json"), TURNER_BAD_INPUT);
    assert_string_equal(turner_message(),
                        "t.json:1:1: expected an object, but here is a list (at $)");
}

static void root(void **state)
{
    (void)state;
    static const struct error_case cases[] = {
        {"@[]", "expected an object, but here is a list (at $)"},
        {"@null", "expected an object, but here is null (at $)"},
        {"@{\"camera\": {}}", "missing key \"version\" of a scene; write \"version\": 1 (at $)"},
        {"{\"version\": @2, \"unheard_of\": 1}",
         "version 2 is not known; this turner reads version 1 (at $.version)"},
        {"{\"version\": @\"1\"}",
         "expected an integer from 1 to 2147483647, but here is \"1\" (at $.version)"},
        {"{\"version\": @1.5}",
         "expected an integer from 1 to 2147483647, but here is 1.5 (at $.version)"},
        {"@{\"version\": 1}", "missing key \"camera\" of a scene (at $)"},
        {HEAD ", @\"materails\": {}}",
         "unknown key \"materails\", did you mean \"materials\"? (at $.materails)"},
        {HEAD ", @\"Ambient\": 1}", "unknown key \"Ambient\", did you mean \"ambient\"? (at "
                                    "$.Ambient)"},
        {HEAD ", @\"fog\": {}}",
         "unknown key \"fog\"; known for a scene: \"$schema\", \"version\", \"description\", \"shaders\", \"params\", "
         "\"settings\", \"camera\", \"cameras\", \"ambient\", \"background\", \"media\", \"materials\", "
         "\"meshes\", \"primitives\", \"groups\", \"instances\", \"lights\" (at $.fog)"},
        {HEAD ",\n \"ambient\": 1, @\"ambient\": 2}",
         "the key \"ambient\" is here twice (at $.ambient)"},
        {HEAD ", \"description\": @3}", "expected text, but here is 3 (at $.description)"},
        {HEAD ", \"ambient\": @\"red\"}", "expected a colour (a number, [r, g, b] or \"#rrggbb\"), "
                                          "but here is \"red\" (at $.ambient)"},
        {HEAD ", \"ambient\": @\"#12345g\"}", "expected a colour (a number, [r, g, b] or "
                                              "\"#rrggbb\"), but here is \"#12345g\" (at "
                                              "$.ambient)"},
        {HEAD ", \"ambient\": @[1, 2]}",
         "expected a list of 3 numbers, but here are 2 (at $.ambient)"},
        {HEAD ", \"ambient\": [1, 2, @-3]}",
         "expected a number of at least 0, but here is -3 (at $.ambient[2])"},
        {HEAD ", \"ambient\": [1, @\"2\", 3]}",
         "expected a number, but here is \"2\" (at $.ambient[1])"},
        {HEAD ", \"ambient\": @true}", "expected a colour (a number, [r, g, b] or \"#rrggbb\"), "
                                       "but here is true (at $.ambient)"},
        {HEAD ", \"ambient\": @1e999}",
         "this number is too large; 3.4e38 is the limit (at $.ambient)"},
        {HEAD ", \"ambient\": [0, @1e39, 0]}",
         "this number is too large; 3.4e38 is the limit (at $.ambient[1])"},
    };
    CHECK_CASES(cases);
}

static void settings(void **state)
{
    (void)state;
#define SETTINGS(text) HEAD ", \"settings\": {" text "}}"
    static const struct error_case cases[] = {
        {HEAD ", \"settings\": @[]}", "expected an object, but here is a list (at $.settings)"},
        {SETTINGS("\"size\": @640"),
         "expected a list of 2 numbers, but here is 640 (at $.settings.size)"},
        {SETTINGS("\"size\": [@0, 1]"),
         "expected an integer from 1 to 65536, but here is 0 (at $.settings.size[0])"},
        {SETTINGS("\"size\": [1, @65537]"),
         "expected an integer from 1 to 65536, but here is 65537 (at $.settings.size[1])"},
        {SETTINGS("\"depth\": @-1"),
         "expected an integer from 0 to 1024, but here is -1 (at $.settings.depth)"},
        {SETTINGS("\"depth\": @1025"),
         "expected an integer from 0 to 1024, but here is 1025 (at $.settings.depth)"},
        {SETTINGS("\"depth\": @1e999"),
         "expected an integer from 0 to 1024, but here is inf (at $.settings.depth)"},
        {SETTINGS("\"cutoff\": @-0.1"),
         "expected a number of at least 0, but here is -0.1 (at $.settings.cutoff)"},
        {SETTINGS("\"spp\": @0"),
         "expected an integer from 1 to 65536, but here is 0 (at $.settings.spp)"},
        {SETTINGS("\"shading\": @\"pong\""), "expected \"phong\" or \"energy_conserving\", but "
                                             "here is \"pong\"; did you mean \"phong\"? (at "
                                             "$.settings.shading)"},
        {SETTINGS("\"shadows\": @\"none\""),
         "expected \"opaque\" or \"tinted\", but here is \"none\" (at $.settings.shadows)"},
        {SETTINGS("\"shadows\": @false"),
         "expected \"opaque\" or \"tinted\", but here is false (at $.settings.shadows)"},
        {SETTINGS("\"spd_rays\": @1"),
         "expected true or false, but here is 1 (at $.settings.spd_rays)"},
        {SETTINGS("\"size\": [9, 2], \"spd_grid\": @true"),
         "\"spd_grid\" needs a picture of at least 3 rows (at $.settings.spd_grid)"},
        {SETTINGS("@\"Depth\": 3"),
         "unknown key \"Depth\", did you mean \"depth\"? (at $.settings.Depth)"},
        {SETTINGS("@\"a\\u001bb\\nc\": 3"),
         "unknown key \"a?b?c\"; known for settings: \"size\", \"depth\", \"cutoff\", \"error\", \"spp\", "
         "\"shading\", \"shadows\", \"exposure\", \"transfer\", \"spd_rays\", \"spd_grid\", \"methods\" (at "
         "$.settings[\"a?b?c\"])"},
    };
    CHECK_CASES(cases);
}

static void camera(void **state)
{
    (void)state;
#define CAMERA(text) "{\"version\": 1, \"camera\": {" text "}}"
    static const struct error_case cases[] = {
        {"{\"version\": 1, \"camera\": @{\"from\": [0, 0, 0]}}",
         "missing key \"at\" of a camera (at $.camera)"},
        {CAMERA("\"from\": [1, 2, 3], \"at\": @[1, 2, 3]"),
         "\"at\" is where \"from\" is; the camera has no direction (at $.camera.at)"},
        {CAMERA("\"from\": [0, 0, 0], \"at\": [0, 0, 1], \"up\": @[0, 0, -2]"),
         "\"up\" lies along the view; choose another (at $.camera.up)"},
        {"{\"version\": 1, \"camera\": @{\"from\": [0, 0, 0], \"at\": [0, 3, 0]}}",
         "\"up\" (0, 1, 0 by default) lies along the view; choose another (at $.camera)"},
        {CAMERA("\"from\": [0, 0, 0], \"at\": [0, 0, 1], \"up\": @[0, 0, 0]"),
         "expected a direction, but this has no length (at $.camera.up)"},
        {CAMERA("\"from\": [0, 0, 0], \"at\": [0, 0, 1], \"vfov\": @0"),
         "expected a number above 0 and below 180, but here is 0 (at $.camera.vfov)"},
        {CAMERA("\"from\": [0, 0, 0], \"at\": [0, 0, 1], \"vfov\": @180"),
         "expected a number above 0 and below 180, but here is 180 (at $.camera.vfov)"},
        {CAMERA("\"from\": [0, 0, 0], \"at\": [0, 0, 1], \"inside\": @\"water\""),
         "expected a list, but here is \"water\" (at $.camera.inside)"},
        {CAMERA("\"from\": [0, 0, 0], \"at\": [0, 0, 1], \"inside\": [@\"water\"]"),
         "no medium named \"water\" (at $.camera.inside[0])"},
        {CAMERA("\"from\": [0, 0, 0], \"at\": [0, 0, 1], \"inside\": "
                "@[1, 2, 3, 4, 5, 6, 7, 8, 9]"),
         "9 things here, but 8 are the limit (at $.camera.inside)"},
    };
    CHECK_CASES(cases);
}

static void backgrounds(void **state)
{
    (void)state;
#define BACKGROUND(text) HEAD ", \"background\": {" text "}}"
    static const struct error_case cases[] = {
        {HEAD ", \"background\": @{\"color\": 1}}", "missing key \"type\" (at $.background)"},
        {BACKGROUND("\"type\": @\"sky\""),
         "expected \"constant\", \"gradient\" or \"environment\", but here is \"sky\" (at "
         "$.background.type)"},
        {HEAD ", \"background\": @{\"type\": \"gradient\", \"top\": 1}}",
         "missing key \"bottom\" of a gradient background (at $.background)"},
        {BACKGROUND("\"type\": \"constant\", \"color\": 1, @\"top\": 1"),
         "unknown key \"top\"; known for a constant background: \"type\", \"color\" (at "
         "$.background.top)"},
        {BACKGROUND("\"type\": \"constant\", \"color\": 1, @\"type\": \"constant\""),
         "the key \"type\" is here twice (at $.background.type)"},
        {BACKGROUND("\"type\": \"environment\", \"file\": @\"\""),
         "expected the name of a file, but this is empty (at $.background.file)"},
    };
    CHECK_CASES(cases);
}

static void media_and_materials(void **state)
{
    (void)state;
#define MEDIA(text) HEAD ", \"media\": {" text "}}"
#define MATERIALS(text) HEAD ", \"materials\": {" text "}}"
#define MATERIAL(text) MATERIALS("\"m\": {" text "}")
    static const struct error_case cases[] = {
        {MEDIA("\"water\": @{}"), "missing key \"index\" of a medium (at $.media.water)"},
        {MEDIA("\"water\": {\"index\": @0}"),
         "expected a number above 0, but here is 0 (at $.media.water.index)"},
        {MEDIA("\"my water\": {\"index\": 1, \"priority\": @0.5}"),
         "expected an integer from -2147483648 to 2147483647, but here is 0.5 (at "
         "$.media[\"my water\"].priority)"},
        {MEDIA("\"w\": {\"index\": 1}, \"v\": {\"index\": 1},\n @\"w\": {\"index\": 2}"),
         "a medium named \"w\" is here twice (at $.media.w)"},
        {MATERIALS("@\"\": {}"), "this material needs a name (at $.materials[\"\"])"},
        {MATERIALS("\"a\": {}, @\"a\": {}"),
         "a material named \"a\" is here twice (at $.materials.a)"},
        {MATERIALS("\"glass\": {@\"k_rr\": 1}"),
         "unknown key \"k_rr\", did you mean \"k_r\"? (at $.materials.glass.k_rr)"},
        {MATERIAL("@\"exponnet\": 1"),
         "unknown key \"exponnet\", did you mean \"exponent\"? (at $.materials.m.exponnet)"},
        {MATERIAL("\"exponent\": @-1"),
         "expected a number of at least 0, but here is -1 (at $.materials.m.exponent)"},
        {MATERIAL("\"fresnel\": @\"exakt\""),
         "expected \"none\", \"schlick\" or \"exact\", but here is \"exakt\"; did you mean "
         "\"exact\"? (at $.materials.m.fresnel)"},
        {MATERIAL("\"k_t\": @1"),
         "light goes through, but into what? Add \"index\" (1.5 is glass) or \"medium\" (at "
         "$.materials.m.k_t)"},
        {MATERIAL("\"k_t\": 1, \"medium\": @\"water\""),
         "no medium named \"water\" (at $.materials.m.medium)"},
        {MATERIAL("\"medium\": @\"water\""), "no medium named \"water\" (at $.materials.m.medium)"},
        {MATERIAL("\"k_t\": 1, \"medium\": \"w\", @\"index\": 1.5"),
         "\"medium\" says this already; leave one out (at $.materials.m.index)"},
        {MATERIAL("\"k_t\": 1, @\"absorption\": 1"),
         "\"absorption\" goes with \"index\" (at $.materials.m.absorption)"},
        {MATERIAL("\"k_t\": 1, \"medium\": \"w\", @\"priority\": 1"),
         "\"priority\" goes with \"index\"; a medium has its own (at $.materials.m.priority)"},
        {MATERIAL("\"k_t\": 1, \"index\": @-1.5"),
         "expected a number above 0, but here is -1.5 (at $.materials.m.index)"},
        {MATERIAL("@\"eta\": 1.5"),
         "\"eta\" needs \"k\": a metal has a complex index; for glass use \"index\" (at "
         "$.materials.m.eta)"},
        {MATERIAL("@\"k\": 1.5"),
         "\"k\" needs \"eta\": a metal has a complex index (at $.materials.m.k)"},
        {MATERIAL("\"metal\": \"gold\", @\"eta\": 1"),
         "\"metal\" says this already; leave one out (at $.materials.m.eta)"},
        {MATERIAL("\"metal\": @\"brass\""),
         "expected \"gold\", \"silver\" or \"copper\", but here is \"brass\" (at "
         "$.materials.m.metal)"},
        {MATERIAL("\"eta\": 1, \"k\": 1, \"k_r\": 1, \"k_t\": @0.1, \"index\": 1"),
         "a metal lets no light through; leave out \"k_t\" or \"eta\" (at $.materials.m.k_t)"},
        {MATERIAL("\"eta\": 1, \"k\": 1, \"k_r\": 1, \"fresnel\": @\"schlick\""),
         "a metal with a complex index wants \"exact\"; for \"schlick\" give \"k_r\" alone (at "
         "$.materials.m.fresnel)"},
        {MATERIAL("\"k_r\": 1, \"fresnel\": @\"exact\""),
         "\"exact\" needs to know the mirror's index: add \"metal\", or \"eta\" and \"k\", or use "
         "\"schlick\" (at $.materials.m.fresnel)"},
        {MATERIAL("\"pattern\": {\"type\": \"checker\", \"colors\": @[1]}"),
         "a checker has 2 colours, but here are 1 (at $.materials.m.pattern.colors)"},
        {MATERIAL("\"pattern\": {\"type\": \"checker\", \"colors\": [1, @-1]}"),
         "expected a number of at least 0, but here is -1 (at $.materials.m.pattern.colors[1])"},
        {MATERIAL("\"pattern\": {\"type\": \"checker\", \"colors\": [1, 0], \"scale\": @[1, 0]}"),
         "a pattern cannot be scaled by 0 (at $.materials.m.pattern.scale)"},
        {HEAD ", \"settings\": {\"depth\": @65}, \"materials\": {\"a\": {\"k_r\": 1}, \"b\": "
              "{\"k_t\": 1, \"index\": 1.5}, \"c\": {\"k_r\": 1, \"k_t\": [0, 0, 1], \"index\": "
              "1.5}}}",
         "depth 65 is too much where a material both reflects and transmits, as \"c\" does; 64 is "
         "the limit then (at $.settings.depth)"},
        {HEAD ", \"settings\": {\"spd_rays\": true, \"depth\": @65}, \"materials\": {\"b\": "
              "{\"k_t\": 1, \"index\": 1.5}}}",
         "depth 65 is too much where a material both reflects and transmits, as \"b\" does; 64 is "
         "the limit then (at $.settings.depth)"},
    };
    CHECK_CASES(cases);
}

#define WITH_M HEAD ", \"materials\": {\"m\": {}, \"glass\": {}}"

static void primitives(void **state)
{
    (void)state;
#define SHAPE(text) WITH_M ", \"primitives\": [{" text ", \"material\": \"m\"}]}"
    static const struct error_case cases[] = {
        {WITH_M ", \"primitives\": @{}}",
         "expected a list, but here is an object (at $.primitives)"},
        {WITH_M ", \"primitives\": [@7]}",
         "expected an object, but here is 7 (at $.primitives[0])"},
        {WITH_M ", \"primitives\": [{\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 1, "
                "\"material\": @\"glas\"}]}",
         "no material named \"glas\"; did you mean \"glass\"? (at $.primitives[0].material)"},
        {WITH_M ", \"primitives\": [@{\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": "
                "1}]}",
         "missing key \"material\" of a sphere (at $.primitives[0])"},
        {SHAPE("\"type\": @\"shpere\""),
         "expected \"sphere\", \"plane\", \"cone\", \"cylinder\", \"box\" or \"mesh\", but here is "
         "\"shpere\"; did you mean \"sphere\"? (at $.primitives[0].type)"},
        {SHAPE("\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": @0"),
         "expected a number above 0, but here is 0 (at $.primitives[0].radius)"},
        {SHAPE("\"type\": \"sphere\", @\"centre\": [0, 0, 0], \"radius\": 1"),
         "unknown key \"centre\", did you mean \"center\"? (at $.primitives[0].centre)"},
        {SHAPE("\"type\": \"sphere\", \"center\": [0, @null, 0], \"radius\": 1"),
         "expected a number, but here is null (at $.primitives[0].center[1])"},
        {SHAPE("\"type\": \"plane\", \"point\": [0, 0, 0], \"normal\": @[0, 0, 0]"),
         "expected a direction, but this has no length (at $.primitives[0].normal)"},
        {SHAPE("\"type\": \"plane\", \"point\": [0, 0, 0], \"normal\": [0, 1, 0], \"tangent\": "
               "@[0, 3, 0]"),
         "\"tangent\" lies along \"normal\"; choose another (at $.primitives[0].tangent)"},
        {SHAPE("\"type\": \"cone\", \"base\": [1, 1, 1], \"apex\": @[1, 1, 1], \"base_radius\": 1"),
         "\"apex\" is where \"base\" is (at $.primitives[0].apex)"},
        {SHAPE("\"type\": \"cone\", \"base\": [1, 1, 1], \"apex\": [0, 0, 0], \"base_radius\": @0"),
         "one of the radii must be above 0 (at $.primitives[0].base_radius)"},
        {SHAPE("\"type\": \"cylinder\", \"base\": [1, 1, 1], \"apex\": [0, 0, 0], \"radius\": @0"),
         "expected a number above 0, but here is 0 (at $.primitives[0].radius)"},
        {SHAPE("\"type\": \"box\", \"min\": [0, 0, 0], \"max\": @[1, 0, 1]"),
         "\"max\" must be above \"min\" in x, y and z (at $.primitives[0].max)"},
        {WITH_M ", \"groups\": {\"g\": [@{\"type\": \"plane\", \"point\": [0, 0, 0], \"normal\": "
                "[0, 1, 0], \"material\": \"m\"}]}}",
         "a group cannot have planes, which have no end; put it into the scene's \"primitives\" "
         "(at $.groups.g[0])"},
    };
    CHECK_CASES(cases);
}

static void meshes(void **state)
{
    (void)state;
#define MESH(text) WITH_M ", \"meshes\": {\"a\": {" text "}}}"
#define CORNERS "\"positions\": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "
    static const struct error_case cases[] = {
        {WITH_M ", \"meshes\": {\"a\": @{}}}",
         "missing key: a mesh needs \"file\" or \"positions\" (at $.meshes.a)"},
        {MESH("\"file\": \"a.obj\", @\"positions\": []"),
         "a mesh has only one of \"file\" or \"positions\" (at $.meshes.a.positions)"},
        {MESH("\"file\": \"a.obj\", @\"uvs\": []"),
         "\"uvs\" goes with \"positions\", not with \"file\" (at $.meshes.a.uvs)"},
        {WITH_M ", \"meshes\": {\"a\": @{\"positions\": []}}}",
         "missing key: \"positions\" need \"triangles\" (at $.meshes.a)"},
        {MESH("\"positions\": [], \"triangles\": @[]"),
         "a mesh needs at least one triangle (at $.meshes.a.triangles)"},
        {MESH("\"positions\": [], \"triangles\": @[[0, 0, 0]]"),
         "these triangles have no \"positions\" to use (at $.meshes.a.triangles)"},
        {MESH(CORNERS "\"triangles\": [[0, 1, @3]]"),
         "expected an integer from 0 to 2, but here is 3 (at $.meshes.a.triangles[0][2])"},
        {MESH(CORNERS "\"triangles\": [[0, 1, 2], [0, 1, @-1]]"),
         "expected an integer from 0 to 2, but here is -1 (at $.meshes.a.triangles[1][2])"},
        {MESH(CORNERS "\"triangles\": [@[0, 1]]"),
         "a triangle has 3 corners, but here are 2 (at $.meshes.a.triangles[0])"},
        {MESH(CORNERS "\"triangles\": [[0, 1, 2]], \"normals\": @[[0, 0, 1]]"),
         "expected one for each of the 3 positions, but here are 1 (at $.meshes.a.normals)"},
        {MESH(CORNERS "\"triangles\": [[0, 1, 2]], \"normals\": [[0, 0, 1], @[0, 0, 0], [0, 0, "
                      "1]]"),
         "expected a direction, but this has no length (at $.meshes.a.normals[1])"},
        {MESH(CORNERS "\"triangles\": [[0, 1, 2]], \"uvs\": [[0, 0], @[0, 0, 0], [0, 0]]"),
         "expected a list of 2 numbers, but here are 3 (at $.meshes.a.uvs[1])"},
        {MESH(CORNERS "\"triangles\": [[0, 1, 2]], \"uvs\": [[0, 0], [0, @1e40], [0, 0]]"),
         "this number is too large; 3.4e38 is the limit (at $.meshes.a.uvs[1][1])"},
        {WITH_M ", \"meshes\": {\"teapot\": {" CORNERS "\"triangles\": [[0, 1, 2]]}}, "
                "\"primitives\": [{\"type\": \"mesh\", \"mesh\": @\"teepot\", \"material\": "
                "\"m\"}]}",
         "no mesh named \"teepot\"; did you mean \"teapot\"? (at $.primitives[0].mesh)"},
        {WITH_M ", \"meshes\": {\"a\": {" CORNERS "\"triangles\": [[0, 1, 2]]}}, \"primitives\": "
                "[{\"type\": \"mesh\", \"mesh\": \"a\", @\"smooth\": true, \"material\": \"m\"}]}",
         "\"smooth\" belongs to the mesh in \"meshes\" (at $.primitives[0].smooth)"},
        {WITH_M ", \"primitives\": [@{\"type\": \"mesh\", \"material\": \"m\"}]}",
         "missing key: a mesh primitive needs \"mesh\", \"file\" or \"positions\" (at "
         "$.primitives[0])"},
        {WITH_M ", \"primitives\": [{\"type\": \"mesh\", \"material\": \"m\", " CORNERS
                "\"triangles\": @[]}]}",
         "a mesh needs at least one triangle (at $.primitives[0].triangles)"},
    };
    CHECK_CASES(cases);
}

static void instances(void **state)
{
    (void)state;
#define INSTANCE(text) WITH_M ", \"groups\": {\"tree\": []}, \"instances\": [{" text "}]}"
#define TRANSFORM(text) INSTANCE("\"group\": \"tree\", \"transform\": " text)
    static const struct error_case cases[] = {
        {INSTANCE("\"group\": @\"trees\""),
         "no group named \"trees\"; did you mean \"tree\"? (at $.instances[0].group)"},
        {WITH_M ", \"instances\": [@{}]}",
         "missing key \"group\" of an instance (at $.instances[0])"},
        {INSTANCE("\"group\": \"tree\", \"material\": @\"M\""),
         "no material named \"M\" (at $.instances[0].material)"},
        {TRANSFORM("@1"), "expected a list, but here is 1 (at $.instances[0].transform)"},
        {TRANSFORM("@{}"),
         "missing key: a transform needs \"translate\", \"scale\", \"rotate\" or \"matrix\" (at "
         "$.instances[0].transform)"},
        {TRANSFORM("[{\"scale\": 1}, {\"scale\": 1, @\"rotate\": 1, \"axis\": [0, 1, 0]}]"),
         "a transform has only one of \"translate\", \"scale\", \"rotate\" or \"matrix\" (at "
         "$.instances[0].transform[1].rotate)"},
        {TRANSFORM("{\"scale\": @0}"),
         "this flattens space (its determinant is 0) (at $.instances[0].transform.scale)"},
        {TRANSFORM("[{\"scale\": @[1, 2]}]"), "expected a list of 3 numbers, but here are 2 (at "
                                              "$.instances[0].transform[0].scale)"},
        {TRANSFORM("[{\"scale\": @[1, 0, 1]}]"),
         "this flattens space (its determinant is 0) (at $.instances[0].transform[0].scale)"},
        {TRANSFORM("[@{\"rotate\": 10}]"),
         "missing key \"axis\" of a rotation (at $.instances[0].transform[0])"},
        {TRANSFORM("{\"scale\": 2, @\"axis\": [0, 1, 0]}"),
         "\"axis\" goes with \"rotate\" (at $.instances[0].transform.axis)"},
        {TRANSFORM("{\"rotate\": 2, \"axis\": @[0, 0, 0]}"),
         "expected a direction, but this has no length (at $.instances[0].transform.axis)"},
        {TRANSFORM("{\"matrix\": @[1, 0, 0, 0, 1, 0, 0, 0, 1]}"),
         "expected a list of 12 numbers, but here are 9 (at $.instances[0].transform.matrix)"},
        {TRANSFORM("{\"matrix\": @[1, 2, 3, 0, 2, 4, 6, 0, 0, 0, 1, 0]}"),
         "this flattens space (its determinant is 0) (at $.instances[0].transform.matrix)"},
        {TRANSFORM("@[{\"scale\": 1e30}, {\"scale\": 1e30}]"),
         "together these steps flatten space or leave the range of numbers (at "
         "$.instances[0].transform)"},
    };
    CHECK_CASES(cases);
}

static void lights(void **state)
{
    (void)state;
#define LIGHT(text) HEAD ", \"lights\": [{" text "}]}"
#define SPOT "\"type\": \"spot\", \"position\": [0, 5, 0], "
    static const struct error_case cases[] = {
        {LIGHT("\"type\": @\"area\""), "expected \"point\", \"directional\" or \"spot\", but here "
                                       "is \"area\" (at $.lights[0].type)"},
        {HEAD ", \"lights\": [@{\"type\": \"point\", \"position\": [0, 0, 0]}]}",
         "missing key: a point light needs \"intensity\" or \"flux\" (at $.lights[0])"},
        {LIGHT("\"type\": \"point\", \"position\": [0, 0, 0], \"intensity\": 1, @\"flux\": 1"),
         "a point light has only one of \"intensity\" or \"flux\" (at $.lights[0].flux)"},
        {LIGHT("\"type\": \"point\", \"position\": [0, 0, 0], \"flux\": 1, \"falloff\": "
               "@\"linear\""),
         "expected \"inverse_square\" or \"none\", but here is \"linear\" (at "
         "$.lights[0].falloff)"},
        {LIGHT("\"type\": \"directional\", \"direction\": @[0, 0, 0], \"irradiance\": 1"),
         "expected a direction, but this has no length (at $.lights[0].direction)"},
        {HEAD ", \"lights\": [@{" SPOT "\"inner\": 1, \"outer\": 2, \"flux\": 1}]}",
         "missing key: a spot light needs \"direction\" or \"at\" (at $.lights[0])"},
        {LIGHT(SPOT "\"at\": @[0, 5, 0], \"inner\": 1, \"outer\": 2, \"flux\": 1"),
         "\"at\" is where \"position\" is; the light has no direction (at $.lights[0].at)"},
        {LIGHT(SPOT "\"at\": [0, 0, 0], \"inner\": @30, \"outer\": 20, \"flux\": 1"),
         "\"inner\" must not be larger than \"outer\" (at $.lights[0].inner)"},
        {LIGHT(SPOT "\"at\": [0, 0, 0], \"inner\": 0, \"outer\": @0, \"flux\": 1"),
         "expected a number above 0 and of at most 180, but here is 0 (at $.lights[0].outer)"},
        {LIGHT(SPOT "\"at\": [0, 0, 0], \"inner\": 0, \"outer\": @1e-9, \"flux\": 1"),
         "the flux in so narrow a spot is too large a number (at $.lights[0].outer)"},
    };
    CHECK_CASES(cases);
}

static void limits(void **state)
{
    (void)state;
    char *text = malloc(1 << 20);
    size_t used = (size_t)sprintf(text, "%s", HEAD ", \"lights\": [");
    for (int i = 0; i <= TURNER_MAX_LIGHTS; i++)
        used += (size_t)sprintf(text + used, "%s1", i ? "," : "");
    strcpy(text + used, "]}");
    struct turner_scene *scene;
    assert_int_equal(turner_scene_parse(&scene, text, strlen(text), "t.json"), TURNER_BAD_INPUT);
    assert_string_equal(turner_message(), "t.json:1:74: 4097 things here, but 4096 are the limit "
                                          "(at $.lights)");

    used = (size_t)sprintf(text, "%s", HEAD ", \"materials\": {");
    for (int i = 0; i <= TURNER_MAX_MEDIA; i++)
        used += (size_t)sprintf(text + used, "%s\n\"m%d\":{\"k_t\":1,\"index\":1.%d}",
                                i ? "," : "", i, 1000 + i);
    strcpy(text + used, "}}");
    assert_int_equal(turner_scene_parse(&scene, text, strlen(text), "t.json"), TURNER_BAD_INPUT);
    assert_string_equal(turner_message(), "t.json:257:25: one medium too many; 255 are the limit, "
                                          "those of materials with an \"index\" included (at "
                                          "$.materials.m255.index)");

    used = (size_t)sprintf(text, "%s", WITH_M ", \"primitives\": [");
    for (int i = 0; i <= TURNER_MAX_PLANES; i++)
        used += (size_t)sprintf(text + used, "%s\n{\"type\":\"plane\",\"point\":[0,0,0],"
                                "\"normal\":[0,1,0],\"material\":\"m\"}", i ? "," : "");
    strcpy(text + used, "]}");
    assert_int_equal(turner_scene_parse(&scene, text, strlen(text), "t.json"), TURNER_BAD_INPUT);
    assert_string_equal(turner_message(), "t.json:66:1: one plane too many; 64 are the limit (at "
                                          "$.primitives[64])");

    /* a name of 255 bytes is good, one more is not */
    memset(text, 'n', 256);
    text[256] = '\0';
    char named[512];
    snprintf(named, sizeof named, HEAD ", \"media\": {\"%s\": {\"index\": 1}}}", text + 1);
    turner_scene_destroy(must_parse(named));
    snprintf(named, sizeof named, HEAD ", \"media\": {\"%s\": {\"index\": 1}}}", text);
    assert_int_equal(turner_scene_parse(&scene, named, strlen(named), "t.json"), TURNER_BAD_INPUT);
    assert_non_null(strstr(turner_message(), "this name has 256 bytes, but 255 are the limit"));
    free(text);
}

/* Cut anywhere, a scene is refused with a place; with any byte changed, it is never more than
 * refused. */
static void broken_anywhere(void **state)
{
    (void)state;
    static const char whole[] =
        HEAD ", \"materials\": {\"glass\": {\"k_t\": 0.9, \"k_r\": 1, \"index\": 1.5}}, "
             "\"primitives\": [{\"type\": \"sphere\", \"center\": [0, -1e0, 0], \"radius\": 1, "
             "\"material\": \"gl\\u0061ss\"}]}";
    const size_t length = sizeof whole - 1;
    turner_scene_destroy(must_parse(whole));
    for (size_t i = 0; i < length; i++) {
        char *cut = malloc(i ? i : 1);
        memcpy(cut, whole, i);
        struct turner_scene *scene;
        assert_int_equal(turner_scene_parse(&scene, cut, i, "t.json"), TURNER_BAD_INPUT);
        assert_memory_equal(turner_message(), "t.json:1:", 9);
        free(cut);
    }
    static const char bytes[] = "\0\"\\{}[],:0-ex \n\x80\xFF";
    for (size_t i = 0; i < length * (sizeof bytes - 1); i++) {
        char *changed = malloc(length);
        memcpy(changed, whole, length);
        changed[i / (sizeof bytes - 1)] = bytes[i % (sizeof bytes - 1)];
        struct turner_scene *scene;
        if (turner_scene_parse(&scene, changed, length, "t.json") != TURNER_OK)
            assert_memory_equal(turner_message(), "t.json:", 7);
        turner_scene_destroy(scene);
        free(changed);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(syntax),
        cmocka_unit_test(encodings),
        cmocka_unit_test(nesting),
        cmocka_unit_test(root),
        cmocka_unit_test(settings),
        cmocka_unit_test(camera),
        cmocka_unit_test(backgrounds),
        cmocka_unit_test(media_and_materials),
        cmocka_unit_test(primitives),
        cmocka_unit_test(meshes),
        cmocka_unit_test(instances),
        cmocka_unit_test(lights),
        cmocka_unit_test(limits),
        cmocka_unit_test(broken_anywhere),
    };
    turner_set_quiet(true);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
