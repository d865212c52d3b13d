#include "scene/methods.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/nearest.h"

/* The methods that are a choice of words, those in the order of their enum. */
static const struct choice {
    const char *name;
    size_t member; /* of struct turner_methods, an enum */
    const char *words[6];
} choices[] = {
    {"sphere", offsetof(struct turner_methods, sphere), {"robust", "textbook", "f64"}},
    {"triangle", offsetof(struct turner_methods, triangle), {"watertight", "moller_trumbore"}},
    {"offset", offsetof(struct turner_methods, offset), {"error_bound", "none", "tmin", "ulp"}},
    {"fresnel_cosine", offsetof(struct turner_methods, fresnel_cosine), {"stable", "naive"}},
    {"fresnel", offsetof(struct turner_methods, fresnel),
     {"material", "none", "schlick", "exact"}},
    {"schlick_side", offsetof(struct turner_methods, schlick_side), {"transmitted", "incident"}},
    {"precision", offsetof(struct turner_methods, precision), {"f32", "f64"}},
    {"traversal", offsetof(struct turner_methods, traversal),
     {"auto", "bvh", "ray_query", "bvh_lane", "bvh_packet"}},
};

const struct turner_method turner_methods_list[] = {
    {"sphere", "textbook | robust | f64", "robust", "How a ray meets a sphere: the quadratic of "
     "the textbooks, the same solved about the ray's nearest point, or that one in double.",
     "Haines, Günther and Akenine-Möller, Ray Tracing Gems, ch. 7 (2019)"},
    {"triangle", "moller_trumbore | watertight", "watertight", "How a ray meets a triangle: the "
     "second lets no ray slip through a common edge or corner.",
     "Möller and Trumbore, JGT 2 (1997); Woop, Benthin and Wald, JCGT 2 (2013)"},
    {"offset", "none | tmin:<metres> | ulp | error_bound", "error_bound", "How a ray leaves a "
     "surface without meeting it again: not at all, by ignoring what is nearer than a constant, "
     "by a number of float spacings, or by a bound of the point's error.",
     "Wächter and Binder, Ray Tracing Gems, ch. 6 (2019); Pharr, Jakob and Humphreys, Physically "
     "Based Rendering, 3.9 (2016)"},
    {"fresnel_cosine", "naive | stable", "stable", "The cosine of the refracted direction: "
     "1 − η²(1 − c²), which cancels for indices that are nearly equal, or (1 − η)(1 + η) + (ηc)².",
     "docs/model.md, \"Secondary rays\""},
    {"fresnel", "material | none | schlick | exact", "material", "How much transmissive surfaces "
     "reflect: as each material says, or all by one formula.",
     "Fresnel (1823); Schlick, Computer Graphics Forum 13 (1994)"},
    {"schlick_side", "incident | transmitted", "transmitted", "The angle in Schlick's formula on "
     "the dense side: the ray's own, or that beyond the surface.",
     "Schlick, Computer Graphics Forum 13 (1994)"},
    {"precision", "f32 | f64", "f32", "The numbers of intersection, hit point, refraction and "
     "Fresnel terms; f64 needs a device that has it.", "IEEE 754"},
    {"aa", "1 | <n> | adaptive:<threshold>,<most>", "1", "Samples of a pixel: a number for each "
     "pixel, or up to a number where its corners and centre differ by more than the threshold.",
     "Hammersley (1960); Whitted, CACM 23 (1980)"},
    {"depth", "0 … 1024", "8", "How often light may be reflected or refracted.",
     "Whitted, CACM 23 (1980)"},
    {"cutoff", "0 … 1", "0.001953125", "Rays that count less in the pixel are not followed.",
     "Hall and Greenberg, IEEE CG&A 3 (1983)"},
    {"error", "0 | <radiance> | 1/<n>", "0", "Above 0, depth, cutoff and samples are chosen so that "
     "no pixel is estimated to be off by more in a channel; they take it back.",
     "docs/error.md"},
    {"traversal", "auto | bvh | bvh_lane | bvh_packet | ray_query", "auto", "Who finds what a ray "
     "meets: turner's own hierarchy, walked by each lane for itself or by the eight of a subgroup "
     "together, or the device's.", "docs/model.md, \"Ties\""},
};
const size_t turner_method_count = sizeof turner_methods_list / sizeof *turner_methods_list;

static const char *method_word(const void *user, size_t i)
{
    (void)user;
    return turner_methods_list[i].name;
}

enum turner_result turner_method_find(const struct turner_method **method, const char *name)
{
    for (size_t i = 0; i < turner_method_count; i++) {
        *method = &turner_methods_list[i];
        if (strcmp((*method)->name, name) == 0)
            return TURNER_OK;
    }
    const char *nearest = turner_nearest(name, turner_method_count, method_word, NULL);
    if (nearest)
        return turner_fail(TURNER_USAGE, "no method is called \"%s\"; did you mean \"%s\"? turner "
                                         "params lists all", name, nearest);
    return turner_fail(TURNER_USAGE, "no method is called \"%s\"; turner params lists all", name);
}

static const struct choice *find_choice(const char *name)
{
    for (size_t i = 0; i < sizeof choices / sizeof *choices; i++) {
        if (strcmp(choices[i].name, name) == 0)
            return &choices[i];
    }
    return NULL;
}

static bool choose(struct turner_methods *methods, const struct choice *choice, const char *value)
{
    for (int i = 0; choice->words[i]; i++) {
        if (strcmp(choice->words[i], value) == 0) {
            memcpy((char *)methods + choice->member, &i, sizeof i);
            return true;
        }
    }
    return false;
}

/* A number that ends where the letter `stop` stands; what comes after that, or NULL. */
static const char *read_real(double *out, const char *text, char stop, double least, double most)
{
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end != stop || !(value >= least && value <= most))
        return NULL;
    *out = value;
    return end + 1;
}

static const char *read_int(int *out, const char *text, char stop, int least, int most)
{
    char *end;
    errno = 0;
    long value = strtol(text, &end, 10);
    if (end == text || *end != stop || errno || value < least || value > most)
        return NULL;
    *out = (int)value;
    return end + 1;
}

bool turner_fraction(double *out, const char *text)
{
    double value, divisor = 1;
    const char *rest = read_real(&value, text, '/', 0, HUGE_VAL);
    if (rest ? !read_real(&divisor, rest, 0, DBL_MIN, HUGE_VAL)
             : !read_real(&value, text, 0, 0, HUGE_VAL))
        return false;
    *out = value / divisor;
    return isfinite(*out);
}

/* "tmin:<metres>" */
static bool set_tmin(struct turner_methods *methods, const char *value)
{
    if (!read_real(&methods->tmin, value + strlen("tmin:"), 0, 1e-30, 1e30))
        return false;
    methods->offset = TURNER_OFFSET_TMIN;
    return true;
}

static bool set_aa(struct turner_settings *settings, const char *value)
{
    static const char adaptive[] = "adaptive:";
    const size_t prefix = sizeof adaptive - 1;
    double threshold = 0;
    int samples;
    const char *count = value;
    int least = 1;
    if (strncmp(value, adaptive, prefix) == 0) {
        least = 5; /* corners and centre */
        count = read_real(&threshold, value + prefix, ',', 1e-9, 1e9);
    }
    if (!count || !read_int(&samples, count, 0, least, TURNER_MAX_SPP))
        return false;
    settings->aa_threshold = threshold;
    settings->spp = samples;
    return true;
}

static bool set_error(struct turner_settings *settings, const char *value)
{
    double error;
    if (!turner_fraction(&error, value) || (error != 0 && error < TURNER_ERROR_LEAST) ||
        error > TURNER_ERROR_MOST)
        return false;
    settings->error = error;
    return true;
}

static bool set(struct turner_settings *settings, const char *name, const char *value)
{
    const struct choice *choice = find_choice(name);
    if (strcmp(name, "offset") == 0 && strncmp(value, "tmin", 4) == 0)
        return value[4] == ':' && set_tmin(&settings->methods, value);
    if (choice)
        return choose(&settings->methods, choice, value);
    if (strcmp(name, "error") == 0)
        return set_error(settings, value);
    bool good;
    if (strcmp(name, "aa") == 0)
        good = set_aa(settings, value);
    else if (strcmp(name, "depth") == 0)
        good = read_int(&settings->depth, value, 0, 0, TURNER_MAX_DEPTH) &&
               (settings->depth_asked = true);
    else
        good = read_real(&settings->cutoff, value, 0, 0, 1);
    if (good)
        settings->error = 0; /* it would choose these itself */
    return good;
}

enum turner_result turner_method_set(struct turner_settings *settings, const char *name,
                                     const char *value)
{
    const struct turner_method *method;
    TURNER_TRY(turner_method_find(&method, name));
    if (!set(settings, name, value))
        return turner_fail(TURNER_USAGE, "method \"%s\" takes %s, not \"%s\"", name,
                           method->values, value);
    return TURNER_OK;
}

enum turner_result turner_method_assign(struct turner_settings *settings, const char *assignment)
{
    char name[TURNER_METHOD_TEXT];
    const char *equals = strchr(assignment, '=');
    if (!equals || (size_t)(equals - assignment) >= sizeof name)
        return turner_fail(TURNER_USAGE, "a method is chosen by name=value, as in sphere=textbook, "
                                         "not by \"%s\"", assignment);
    memcpy(name, assignment, (size_t)(equals - assignment));
    name[equals - assignment] = 0;
    return turner_method_set(settings, name, equals + 1);
}

void turner_method_text(char text[TURNER_METHOD_TEXT], const struct turner_settings *settings,
                        const char *name)
{
    const struct choice *choice = find_choice(name);
    int word = 0;
    if (choice)
        memcpy(&word, (const char *)&settings->methods + choice->member, sizeof word);
    if (strcmp(name, "offset") == 0 && word == TURNER_OFFSET_TMIN)
        snprintf(text, TURNER_METHOD_TEXT, "tmin:%.9g", settings->methods.tmin);
    else if (choice)
        snprintf(text, TURNER_METHOD_TEXT, "%s", choice->words[word]);
    else if (strcmp(name, "aa") == 0 && settings->aa_threshold > 0)
        snprintf(text, TURNER_METHOD_TEXT, "adaptive:%.9g,%d", settings->aa_threshold,
                 settings->spp);
    else if (strcmp(name, "aa") == 0)
        snprintf(text, TURNER_METHOD_TEXT, "%d", settings->spp);
    else if (strcmp(name, "error") == 0)
        snprintf(text, TURNER_METHOD_TEXT, "%.9g", settings->error);
    else if (strcmp(name, "depth") == 0)
        snprintf(text, TURNER_METHOD_TEXT, "%d", settings->depth);
    else
        snprintf(text, TURNER_METHOD_TEXT, "%.17g", settings->cutoff);
}

bool turner_methods_approximate(struct turner_methods *accurate,
                                const struct turner_methods *methods)
{
    *accurate = (struct turner_methods){
        .tmin = methods->tmin,
        .precision = methods->precision,
        .traversal = methods->traversal,
    };
    if (methods->sphere == TURNER_SPHERE_DOUBLE)
        accurate->sphere = TURNER_SPHERE_DOUBLE;
    if (methods->fresnel == TURNER_OVERRIDE_EXACT)
        accurate->fresnel = TURNER_OVERRIDE_EXACT;
    for (size_t i = 0; i < sizeof choices / sizeof *choices; i++) {
        size_t member = choices[i].member;
        if (memcmp((char *)accurate + member, (const char *)methods + member, sizeof(int)) != 0)
            return true;
    }
    return false;
}
