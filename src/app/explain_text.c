/* Two trees as one, in 100 columns: on the left which ray, then its numbers by the device, by the
 * reference, and the bits in which they agree. */
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "app/explain.h"

enum {
    COLUMNS = 100,
    LEFT = 32,      /* columns before the numbers */
    CELL = 9,       /* of a number beside another tree's */
    LONE_CELL = 20, /* of one alone */
    LEVELS = 8      /* indented; deeper ones are said in words */
};

struct page {
    FILE *out;
    const struct turner_explanation *explanation;
    const struct turner_ray_comparison *comparison;
    bool both; /* two trees, not one */
};

/* Both numbers of a quantity; of a ray that one side lacks one is NULL. */
struct numbers {
    const long double *device, *reference;
    int count;
};

/* ---- pieces of a line ---- */

/* Columns of UTF-8 text. */
static int columns(const char *text)
{
    int count = 0;
    for (; *text; text++)
        count += ((unsigned char)*text & 0xc0) != 0x80;
    return count;
}

/* As many digits as there is room for, without zeros at the end. */
static void print_cell(FILE *out, long double value, int width)
{
    char text[64] = "nan";
    for (int digits = width == CELL ? 7 : 15; digits > 0 && !isnan(value); digits--) {
        snprintf(text, sizeof text, "%.*Lg", digits, value + 0); /* −0 is 0 */
        if ((int)strlen(text) <= width)
            break;
    }
    fprintf(out, "%*s", width, text);
}

static void print_cells(const struct page *page, const long double *values, int count)
{
    int width = page->both ? CELL : LONE_CELL;
    for (int i = 0; i < (page->both ? 3 : count); i++) {
        if (i)
            fputc(' ', page->out);
        if (values && i < count)
            print_cell(page->out, values[i], width);
        else
            fprintf(page->out, "%*s", width, "");
    }
}

static int print_guides(const struct page *page, uint32_t depth)
{
    int levels = depth > LEVELS ? LEVELS : (int)depth;
    for (int i = 0; i < levels; i++)
        fputs("│ ", page->out);
    return 2 * levels;
}

/* A line of numbers; `note` may be NULL, bits TURNER_NO_BITS. */
static void print_row(const struct page *page, int indented, const char *label,
                      struct numbers numbers, int bits, const char *note)
{
    int used = indented + columns(label);
    fprintf(page->out, "%s%*s", label, used < LEFT ? LEFT - used : 1, "");
    if (page->both) {
        print_cells(page, numbers.device, numbers.count);
        fputs(" │ ", page->out);
        print_cells(page, numbers.reference, numbers.count);
        fputs(" │", page->out);
        if (bits != TURNER_NO_BITS)
            fprintf(page->out, " %2d", bits);
    } else {
        print_cells(page, numbers.reference, numbers.count);
    }
    fprintf(page->out, "%s\n", note ? note : "");
}

/* ---- words ---- */

static void print_name(FILE *out, const char *what, const char *name, uint32_t index)
{
    if (name)
        fprintf(out, "%s \"%s\"", what, name);
    else
        fprintf(out, "%s %" PRIu32, what, index);
}

static void print_place(const struct page *page, const struct turner_ray_place *place)
{
    static const char *const kinds[] = {"plane", "sphere", "cone", "triangle"};
    const struct turner_scene *scene = page->explanation->scene;
    fprintf(page->out, "%s %" PRIu32, kinds[place->kind], place->index);
    if (place->instance) {
        uint32_t group = scene->instances[place->instance - 1].group;
        print_name(page->out, " of group", scene->groups[group].name, group);
        fprintf(page->out, " (instance %" PRIu32 ")", place->instance - 1);
    }
    print_name(page->out, ", material", scene->materials[place->material].name, place->material);
}

static const char *light_kind(const struct turner_scene *scene, uint32_t light)
{
    static const char *const kinds[] = {"directional", "point", "spot"};
    return kinds[scene->lights[light].kind];
}

/* "reflected ray", "shadow ray to light 2 (spot)" */
static void print_kind(const struct page *page, const struct turner_ray_record *ray)
{
    static const char *const kinds[] = {"camera ray", "shadow ray to light", "reflected ray",
                                        "refracted ray"};
    bool sent = ray->end != TURNER_RAY_FACES_AWAY && ray->end != TURNER_RAY_OUT_OF_REACH;
    fputs(sent ? kinds[ray->kind] : "no ray to light", page->out);
    if (ray->kind == TURNER_RAY_SHADOW)
        fprintf(page->out, " %" PRIu32 " (%s)", ray->light,
                light_kind(page->explanation->scene, ray->light));
}

static void print_media(const struct page *page, const struct turner_ray_record *ray)
{
    for (uint32_t i = 0; i < ray->media_count; i++) {
        const struct turner_medium *medium = &page->explanation->scene->media[ray->media[i]];
        fputs(i == 0 ? " in" : " within", page->out);
        if (medium->name)
            fprintf(page->out, " \"%s\"", medium->name);
        else
            fprintf(page->out, " medium %" PRIu32, ray->media[i]);
        if (i == 0)
            fprintf(page->out, " (index %g)", medium->index);
    }
}

static void print_end(const struct page *page, const struct turner_ray_tree *tree, uint32_t index)
{
    const struct turner_ray_record *ray = &tree->rays[index];
    size_t crossings;
    const struct turner_ray_crossing *crossing =
        turner_ray_tree_crossings(tree, index, &crossings);
    if (crossings == 1) {
        fputs("through ", page->out);
        print_place(page, &crossing->place);
        fputs(", ", page->out);
    } else if (crossings > 1) {
        fprintf(page->out, "through %zu surfaces, ", crossings);
    }
    switch (ray->end) {
    case TURNER_RAY_BACKGROUND: fputs("leaves the scene", page->out); break;
    case TURNER_RAY_SURFACE: print_place(page, &ray->place); break;
    case TURNER_RAY_CUT:
        fputs(ray->depth > (uint32_t)page->explanation->scene->settings.depth
                  ? "not followed: too deep" : "not followed: below the cutoff", page->out);
        break;
    case TURNER_RAY_LIGHT: fputs("arrives", page->out); break;
    case TURNER_RAY_BLOCKED:
        fputs("in shadow of ", page->out);
        print_place(page, &ray->place);
        break;
    case TURNER_RAY_GIVEN_UP:
        fputs("has nothing left after ", page->out);
        print_place(page, &ray->place);
        break;
    case TURNER_RAY_FACES_AWAY:
        fprintf(page->out, "behind the surface, N·L = %.3Lg", ray->n_l);
        break;
    case TURNER_RAY_OUT_OF_REACH: fputs("sends nothing here", page->out); break;
    case TURNER_RAY_UNFINISHED: fputs("ran into the bound of a loop", page->out); break;
    }
    if (ray->total)
        fputs(", total internal reflection", page->out);
}

/* ---- a ray ---- */

static const struct turner_ray_record *record(const struct turner_ray_tree *tree, uint32_t index)
{
    return index == TURNER_NONE ? NULL : &tree->rays[index];
}

/* A ray's first line, or lines where it is long: they break after commas and colons. */
static void print_wrapped(const struct page *page, uint32_t depth, char *text)
{
    int used = print_guides(page, depth);
    for (char *rest = text; rest;) {
        char *end = NULL; /* of what fits */
        for (char *at = strchr(rest, ' '); at; at = strchr(at + 1, ' ')) {
            *at = 0;
            if (strchr(",:;", at[-1]) && used + columns(rest) <= COLUMNS)
                end = at;
            *at = ' ';
        }
        if (used + columns(rest) <= COLUMNS)
            end = NULL;
        if (end)
            *end = 0;
        fprintf(page->out, "%s\n", rest);
        rest = end ? end + 1 : NULL;
        if (rest) {
            used = print_guides(page, depth) + 4;
            fputs("    ", page->out);
        }
    }
}

static void write_header(const struct page *page, size_t index)
{
    const struct turner_ray_comparison *c = page->comparison;
    const struct turner_ray_pair *pair = &c->pairs[index];
    const struct turner_ray_record *a = record(c->device, pair->device);
    const struct turner_ray_record *b = record(c->reference, pair->reference);
    const struct turner_ray_record *ray = b ? b : a;
    fprintf(page->out, "#%zu ", index);
    print_kind(page, ray);
    if (ray->depth > LEVELS)
        fprintf(page->out, " (depth %" PRIu32 ")", ray->depth);
    if (ray->kind != TURNER_RAY_SHADOW)
        print_media(page, ray);
    if (page->both && !(a && b))
        fprintf(page->out, ", %s alone", a ? "device" : "reference");
    bool alike = !(a && b) || (a->end == b->end && turner_rays_end_alike(c->device, pair->device,
                                                                         c->reference,
                                                                         pair->reference));
    fputs(": ", page->out);
    if (alike) {
        print_end(page, b ? c->reference : c->device, b ? pair->reference : pair->device);
    } else {
        fputs("by the device: ", page->out);
        print_end(page, c->device, pair->device);
        fputs("; by the reference: ", page->out);
        print_end(page, c->reference, pair->reference);
    }
    if (c->parts == index)
        fputs(", <── they part here", page->out);
}

static void print_header(const struct page *page, size_t index)
{
    const struct turner_ray_comparison *c = page->comparison;
    const struct turner_ray_pair *pair = &c->pairs[index];
    const struct turner_ray_record *a = record(c->device, pair->device);
    const struct turner_ray_record *b = record(c->reference, pair->reference);
    struct page line = *page;
    char *text = NULL;
    size_t size;
    line.out = open_memstream(&text, &size);
    if (!line.out)
        return;
    write_header(&line, index);
    fclose(line.out);
    print_wrapped(page, (b ? b : a)->depth, text);
    free(text);
}

static bool unit(const long double v[3])
{
    return v[0] == 1 && v[1] == 1 && v[2] == 1;
}

static bool zero(const long double v[3])
{
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

/* The rows of one ray, by what it is. */
struct rows {
    const struct page *page;
    size_t pair;
    uint32_t depth;
    const struct turner_ray_record *a, *b, *any;
};

/* In the place of a quantity: none of those that decide, and one whose bits say nothing (origins
 * lie off their surfaces by more than rounding, on purpose). */
enum { OTHER = TURNER_RAY_QUANTITIES, WITHOUT_BITS };

static void put(const struct rows *rows, const char *label, size_t offset, int count,
                int quantity)
{
    const struct turner_ray_comparison *c = rows->page->comparison;
    struct numbers n = {.count = count};
    if (rows->a && rows->a->end != TURNER_RAY_UNFINISHED)
        n.device = (const long double *)((const char *)rows->a + offset);
    if (rows->b)
        n.reference = (const long double *)((const char *)rows->b + offset);
    int bits = TURNER_NO_BITS;
    if (quantity < TURNER_RAY_QUANTITIES)
        bits = c->pairs[rows->pair].bits[quantity];
    else if (n.device && n.reference && quantity == OTHER)
        bits = turner_agreeing_bits(n.device, n.reference, count, 0, c->mantissa);
    bool few = c->parts == rows->pair && c->why == TURNER_RAYS_FEW_BITS &&
               (int)c->quantity == quantity;
    int indented = print_guides(rows->page, rows->depth);
    fputs("  ", rows->page->out);
    print_row(rows->page, indented + 2, label, n, bits, few ? " <" : NULL);
}

#define PUT(rows, label, member, count)                                                            \
    put(rows, label, offsetof(struct turner_ray_record, member), count, OTHER)
#define PUT_AS(rows, label, member, count, quantity)                                         \
    put(rows, label, offsetof(struct turner_ray_record, member), count, quantity)

/* Only of sides that came to the end that the rows are about. */
static struct rows those_that_end(const struct rows *rows, enum turner_ray_end end)
{
    struct rows some = *rows;
    some.a = rows->a && rows->a->end == end ? rows->a : NULL;
    some.b = rows->b && rows->b->end == end ? rows->b : NULL;
    return some;
}

static void put_surface(const struct rows *all)
{
    const struct turner_ray_record *any = all->any;
    const struct rows some = those_that_end(all, TURNER_RAY_SURFACE), *rows = &some;
    PUT_AS(all, "t", t, 1, TURNER_RAY_T);
    PUT_AS(rows, "point", point, 3, TURNER_RAY_POINT);
    PUT(rows, "normal", ns, 3);
    PUT_AS(all, "weight", weight, 3, TURNER_RAY_WEIGHT);
    if (!unit(any->through))
        PUT(rows, "let through", through, 3);
    if (any->secondary) {
        PUT(rows, "N·V", cosine, 1);
        if (any->n1 != any->n2)
            PUT(rows, "n1, n2", n1, 2);
        if (any->has_fresnel)
            PUT(rows, "Fresnel", fresnel, 3);
    }
    if (!zero(any->radiance))
        PUT(rows, "k_e + k_a·I_a", radiance, 3);
    PUT_AS(all, "contribution", contribution, 3, TURNER_RAY_CONTRIBUTION);
}

static void put_light(const struct rows *rows)
{
    const struct rows arrived = those_that_end(rows, TURNER_RAY_LIGHT);
    PUT_AS(&arrived, "t", t, 1, TURNER_RAY_T);
    PUT_AS(rows, "weight", weight, 3, TURNER_RAY_WEIGHT);
    PUT(rows, "N·L, R·V", n_l, 2);
    PUT(rows, "irradiance", irradiance, 3);
    PUT(rows, "diffuse", diffuse, 3);
    PUT(rows, "specular", specular, 3);
    if (!unit(rows->any->through))
        PUT(&arrived, "let through", through, 3);
    PUT_AS(rows, "contribution", contribution, 3, TURNER_RAY_CONTRIBUTION);
}

static void print_with_rays(const struct rows *rows)
{
    const struct turner_ray_comparison *c = rows->page->comparison;
    const struct turner_ray_pair *pair = &c->pairs[rows->pair];
    long double device[3], reference[3];
    struct numbers n = {.count = 3};
    if (rows->a) {
        turner_ray_tree_sum(device, c->device, pair->device);
        n.device = device;
    }
    if (rows->b) {
        turner_ray_tree_sum(reference, c->reference, pair->reference);
        n.reference = reference;
    }
    int bits = rows->a && rows->b ? turner_agreeing_bits(device, reference, 3, 0, c->mantissa)
                                  : TURNER_NO_BITS;
    int indented = print_guides(rows->page, rows->depth);
    fputs("  ", rows->page->out);
    print_row(rows->page, indented + 2, "with all below", n, bits, NULL);
}

static void print_ray(const struct page *page, size_t index)
{
    const struct turner_ray_comparison *c = page->comparison;
    const struct turner_ray_pair *pair = &c->pairs[index];
    struct rows rows = {.page = page, .pair = index};
    rows.a = record(c->device, pair->device);
    rows.b = record(c->reference, pair->reference);
    rows.any = rows.b ? rows.b : rows.a;
    rows.depth = rows.any->depth;
    print_header(page, index);
    enum turner_ray_end end = rows.any->end;
    if (end == TURNER_RAY_OUT_OF_REACH || end == TURNER_RAY_FACES_AWAY)
        return;
    if (rows.any->kind != TURNER_RAY_SHADOW)
        PUT_AS(&rows, "origin", origin, 3, WITHOUT_BITS);
    PUT_AS(&rows, "direction", direction, 3, TURNER_RAY_DIRECTION);
    if (end == TURNER_RAY_SURFACE) {
        put_surface(&rows);
    } else if (end == TURNER_RAY_LIGHT) {
        put_light(&rows);
    } else if (end == TURNER_RAY_BLOCKED || end == TURNER_RAY_GIVEN_UP) {
        PUT(&rows, "N·L, R·V", n_l, 2);
    } else {
        PUT_AS(&rows, "weight", weight, 3, TURNER_RAY_WEIGHT);
        if (end == TURNER_RAY_BACKGROUND) {
            if (!unit(rows.any->through))
                PUT(&rows, "let through", through, 3);
            PUT(&rows, "radiance", radiance, 3);
            PUT_AS(&rows, "contribution", contribution, 3, TURNER_RAY_CONTRIBUTION);
        }
    }
    bool parent = index + 1 < c->count;
    if (parent) {
        const struct turner_ray_pair *next = &c->pairs[index + 1];
        const struct turner_ray_record *ray = record(c->reference, next->reference);
        parent = (ray ? ray : record(c->device, next->device))->depth > rows.depth;
    }
    if (parent)
        print_with_rays(&rows);
}

/* ---- what stands above the tree ---- */

static void print_verdict(const struct page *page)
{
    const struct turner_ray_comparison *c = page->comparison;
    static const char *const reasons[] = {"", "they end differently", "one side alone has it", ""};
    if (c->parts == TURNER_NONE) {
        fprintf(page->out, "The trees agree: %zu ray%s", c->count, c->count == 1 ? "" : "s");
        if (c->worst != TURNER_NONE)
            fprintf(page->out, ", the fewest bits are the %d of #%" PRIu32 "'s %s",
                    c->pairs[c->worst].bits[c->worst_quantity], c->worst,
                    turner_ray_quantity_names[c->worst_quantity]);
        fputs(".\n", page->out);
        return;
    }
    fprintf(page->out, "They part first at #%" PRIu32 ": ", c->parts);
    if (c->why == TURNER_RAYS_FEW_BITS)
        fprintf(page->out, "its %s agrees in %d bits, fewer than %d.\n",
                turner_ray_quantity_names[c->quantity], c->pairs[c->parts].bits[c->quantity],
                c->least_bits);
    else
        fprintf(page->out, "%s.\n", reasons[c->why]);
}

static void print_nonfinite(const struct page *page, const struct turner_ray_tree *tree,
                            bool device)
{
    const char *quantity;
    uint32_t ray = tree ? turner_ray_tree_nonfinite(tree, &quantity) : TURNER_NONE;
    if (ray == TURNER_NONE)
        return;
    const long double *radiance = tree->radiance;
    bool finite = isfinite(radiance[0]) && isfinite(radiance[1]) && isfinite(radiance[2]);
    fprintf(page->out, "%s by the %s: first the %s of #%" PRIu32 " (",
            finite ? "Beyond floats" : "Not finite", device ? "device" : "reference", quantity,
            turner_rays_find(page->comparison, device, ray));
    print_kind(page, &tree->rays[ray]);
    fputs(").\n", page->out);
}

static void print_truncated(const struct page *page, const struct turner_ray_tree *tree,
                            const char *whose)
{
    if (tree && tree->truncated)
        fprintf(page->out, "The %s's tree is cut off after %zu rays; lower --depth.\n", whose,
                tree->count);
}

static void print_top(const struct page *page)
{
    const struct turner_explanation *e = page->explanation;
    const struct turner_ray_comparison *c = page->comparison;
    const struct turner_settings *settings = &e->scene->settings;
    fprintf(page->out, "%s: pixel %d,%d of %dx%d, ray through %g,%g\n",
            e->scene->path ? e->scene->path : "scene", e->x, e->y, settings->width,
            settings->height, e->x + e->sample_x, e->y + e->sample_y);
    if (page->both)
        fprintf(page->out, "device     %s, %s, %s: mantissa of %d bits\n", e->device, e->traversal,
                e->precision, c->device->mantissa);
    fprintf(page->out, "reference  extended precision: mantissa of %d bits\n\n",
            c->reference->mantissa);
    if (page->both)
        print_verdict(page);
    print_nonfinite(page, c->device, true);
    print_nonfinite(page, c->reference, false);
    print_truncated(page, c->device, "device");
    print_truncated(page, c->reference, "reference");

    if (page->both)
        fprintf(page->out, "\n%*s%-29s   %-29s   %s\n", LEFT, "", "device", "reference", "bits");
    else
        fputc('\n', page->out);
    struct numbers radiance = {page->both ? c->device->radiance : NULL, c->reference->radiance, 3};
    struct numbers pruned = {page->both ? &c->device->pruned : NULL, &c->reference->pruned, 1};
    int bits[2] = {TURNER_NO_BITS, TURNER_NO_BITS};
    if (page->both) {
        bits[0] = turner_agreeing_bits(radiance.device, radiance.reference, 3, 0, c->mantissa);
        bits[1] = turner_agreeing_bits(pruned.device, pruned.reference, 1, 0, c->mantissa);
    }
    print_row(page, 0, "pixel", radiance, bits[0], NULL);
    print_row(page, 0, "weight cut", pruned, bits[1], NULL);
    fputc('\n', page->out);
}

void turner_explain_text(FILE *out, const struct turner_explanation *explanation)
{
    struct page page = {.out = out,
                        .explanation = explanation,
                        .comparison = &explanation->comparison,
                        .both = explanation->comparison.device != NULL};
    print_top(&page);
    for (size_t i = 0; i < page.comparison->count; i++)
        print_ray(&page, i);
}
