/* What double precision could show of a scene that single precision does not: an estimate.
 *
 * A float keeps a coordinate to u = 2^-24 of its size, and by the time a hit is found up to some
 * eight roundings have added up: with S the largest coordinate among the eye's and the object's, a
 * point is off by up to δ = 8·u·S. Seen from the distance d that is
 *     pixels = δ / (d·s),   s = 2·tan(vfov/2)/height the pixel's size at distance 1,
 * so an edge, and all that is painted on the object, moves by so many pixels; and an object of
 * radius r (half the diagonal of the box around a mesh or a cone) is misshapen by
 *     shape = δ / r.
 * An edge that moves by e of a pixel changes an anti-aliased pixel by e of the contrast across it.
 * So the larger of the two is compared with half a step of the picture's format: where it is less
 * the format's rounding hides it. (In the darkest tenth of the sRGB curve steps are up to 12.92
 * times finer, and a pixel of one sample may still fall on the other side of an edge: in a share
 * `pixels` of those an edge goes through.)
 * It speaks of what the eye sees directly: each curved mirror or lens on the way enlarges the
 * error, so nothing is concluded for scenes with secondary rays. */
#ifndef TURNER_RENDER_PRECISION_H
#define TURNER_RENDER_PRECISION_H

#include "render/needs.h"

struct turner_f32_error {
    double pixels, shape;    /* of the object for which the larger of them is largest */
    struct turner_why object; /* that object; count 0 in an empty scene */
};

struct turner_f32_error turner_f32_error_of(const struct turner_scene *scene);

/* Half a step of a format with that many bits a channel (8, 16; 32: floats), of full white. */
double turner_half_step(int bits);

/* Whether a picture of that many bits can show what double precision adds: false only when nothing
 * reflects or transmits and the error is below half a step. */
bool turner_f64_can_show(const struct turner_scene *scene, int bits);

#endif
