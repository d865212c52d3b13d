/* The checks on the reference tracer. */
#include "analytic/analytic.h"
#include "reference/reference.h"

static enum turner_result render(struct turner_image *image, const struct turner_scene *scene)
{
    return turner_reference_render(image, scene, 0, NULL, NULL, NULL);
}

int main(int argc, char **argv)
{
    return analytic_run(render, ANALYTIC_EXTENDED, argc > 1 ? argv[1] : NULL) ? 1 : 0;
}
