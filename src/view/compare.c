/* The picture beside the reference in extended precision. That takes its time, so both are small. */
#include <math.h>
#include <stdio.h>

#include "reference/reference.h"
#include "view/painter.h"

#define WIDTH 200 /* of the pictures compared, at most */

static enum turner_result draw_both(struct turner_painter *painter, struct turner_image *picture,
                                    struct turner_image *truth, const struct turner_scene *scene,
                                    const struct turner_wish *wish,
                                    const struct turner_render_options *options)
{
    struct turner_statistics unused = {0};
    TURNER_TRY(turner_image_create(picture, scene->settings.width, scene->settings.height));
    TURNER_TRY(turner_renderer_look(&painter->renderer, scene));
    double start = turner_seconds();
    TURNER_TRY(turner_renderer_draw(&painter->renderer, picture, options, &unused));
    double drawn = turner_seconds();
    struct turner_scene given = *scene; /* the reference takes no error to keep to */
    if (wish->measure)
        given.settings = wish->truth;
    given.settings.width = scene->settings.width;
    given.settings.height = scene->settings.height;
    if (given.settings.error > 0) {
        given.settings.error = 0;
        given.settings.spp = 64;
    }
    TURNER_TRY(turner_reference_render(truth, &given, options->threads, NULL, options->progress,
                                       options->user));
    painter->own.compared_seconds = drawn - start;
    painter->own.reference_seconds = turner_seconds() - drawn;
    return TURNER_OK;
}

enum turner_result turner_painter_compare(struct turner_painter *painter,
                                          const struct turner_wish *wish,
                                          const struct turner_render_options *options,
                                          struct turner_image *heat)
{
    struct turner_scene scene = painter->scene;
    struct turner_settings *settings = &scene.settings;
    struct turner_sight *own = &painter->own;
    struct turner_image picture = {0}, truth = {0};
    struct turner_render_options plain = *options;
    plain.layers = NULL;
    if (settings->width > WIDTH) {
        settings->height = (int)fmax(1, (double)settings->height * WIDTH / settings->width + 0.5);
        settings->width = WIDTH;
    }
    if (settings->spd_grid && settings->height < 3)
        settings->height = 3;
    enum turner_result result;
    TURNER_TRY_DONE(draw_both(painter, &picture, &truth, &scene, wish, &plain));
    TURNER_TRY_DONE(turner_image_compare(&own->comparison, &picture, &truth, 1.0 / 255, 0));
    own->compared = true;
    if (!heat)
        goto done;
    double full = own->comparison.largest > 0 ? own->comparison.largest : 1;
    turner_image_destroy(heat);
    TURNER_TRY_DONE(turner_image_heatmap(heat, &picture, &truth, full));
    snprintf(own->legend, sizeof own->legend,
             "at %dx%d: white %.3g, rmse %.3g; %llu of %llu pixels off by more than 1/255",
             settings->width, settings->height, own->comparison.largest, own->comparison.rmse,
             (unsigned long long)own->comparison.pixels_over,
             (unsigned long long)own->comparison.pixels);
done:
    turner_image_destroy(&picture);
    turner_image_destroy(&truth);
    return result;
}
