/* The methods by name, as the command line and scene files choose them. */
#ifndef TURNER_SCENE_METHODS_H
#define TURNER_SCENE_METHODS_H

#include "scene/scene.h"

struct turner_method {
    const char *name;
    const char *values;     /* "textbook | robust | f64", the way a person reads it */
    const char *standard;   /* the default, as turner_method_set takes it */
    const char *sentence;   /* what it decides */
    const char *source;     /* where the method is from */
};

/* All of them, in the order they are listed to people. */
extern const struct turner_method turner_methods_list[];
extern const size_t turner_method_count;

/* TURNER_USAGE, naming the nearest, when there is none of that name. */
enum turner_result turner_method_find(const struct turner_method **method, const char *name);

/* "1/255" or "0.004" whole as a number ≥ 0. */
bool turner_fraction(double *out, const char *text);

/* The range of settings.error, where it is not 0. */
#define TURNER_ERROR_LEAST 1e-6 /* of floats, with room for a few operations on them */
#define TURNER_ERROR_MOST 1e6

#define TURNER_METHOD_TEXT 64 /* bytes that hold any value */

/* Sets the method `name` to `value`: "sphere" to "textbook", "aa" to "adaptive:0.05,64", "depth" to
 * "4". TURNER_USAGE as turner_method_find, or naming the values there are. */
enum turner_result turner_method_set(struct turner_settings *settings, const char *name,
                                     const char *value);

/* "name=value" in one. */
enum turner_result turner_method_assign(struct turner_settings *settings, const char *assignment);

/* Whether some of the methods are less accurate than there are: `accurate` gets the defaults in their
 * place. What is a matter of taste, or as good, stays: traversal, doubles, exact Fresnel terms. */
bool turner_methods_approximate(struct turner_methods *accurate,
                                const struct turner_methods *methods);

/* The value as turner_method_set takes it; `name` is one of the list. */
void turner_method_text(char text[TURNER_METHOD_TEXT], const struct turner_settings *settings,
                        const char *name);

#endif
