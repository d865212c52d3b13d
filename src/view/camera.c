#include "view/camera.h"

#include <stdio.h>
#include <stdlib.h>

#define PI 3.14159265358979323846
#define POLE (PI / 360) /* how near the view may come to `up` */
#define LEAST_DISTANCE 1e-6

static struct turner_vec3 add_scaled(struct turner_vec3 a, struct turner_vec3 b, double s)
{
    return turner_vec3_add(a, turner_vec3_scale(b, s));
}

/* `v` turned about the unit vector `axis` (Rodrigues). */
static struct turner_vec3 turned(struct turner_vec3 v, struct turner_vec3 axis, double angle)
{
    double along = turner_vec3_dot(axis, v) * (1 - cos(angle));
    struct turner_vec3 result = turner_vec3_scale(v, cos(angle));
    result = add_scaled(result, turner_vec3_cross(axis, v), sin(angle));
    return add_scaled(result, axis, along);
}

/* The directions of the picture: to its right, its top, and into it. */
struct axes {
    struct turner_vec3 right, up, forward;
};

static struct axes axes_of(const struct turner_camera *camera)
{
    struct axes a;
    a.forward = turner_vec3_normalize(turner_vec3_sub(camera->at, camera->from));
    a.right = turner_vec3_normalize(turner_vec3_cross(a.forward, camera->up));
    a.up = turner_vec3_cross(a.right, a.forward);
    return a;
}

/* `v` turned about `up`, and by `lower` away from it, but not to the pole. */
static struct turner_vec3 swung(const struct turner_camera *camera, struct turner_vec3 v,
                                double around, double lower)
{
    struct turner_vec3 up = turner_vec3_normalize(camera->up);
    double length = turner_vec3_length(v);
    double cosine = turner_vec3_dot(up, v) / length;
    double angle = acos(cosine < -1 ? -1 : cosine > 1 ? 1 : cosine), wanted = angle + lower;
    wanted = wanted < POLE ? POLE : wanted > PI - POLE ? PI - POLE : wanted;
    struct turner_vec3 axis = turner_vec3_normalize(turner_vec3_cross(up, v));
    return turned(turned(v, axis, wanted - angle), up, around);
}

double turner_camera_distance(const struct turner_camera *camera)
{
    return turner_vec3_length(turner_vec3_sub(camera->at, camera->from));
}

void turner_camera_orbit(struct turner_camera *camera, double right, double up)
{
    struct turner_vec3 v = turner_vec3_sub(camera->from, camera->at);
    camera->from = turner_vec3_add(camera->at, swung(camera, v, right, -up));
}

void turner_camera_turn(struct turner_camera *camera, double right, double up)
{
    struct turner_vec3 v = turner_vec3_sub(camera->at, camera->from);
    camera->at = turner_vec3_add(camera->from, swung(camera, v, -right, -up));
}

void turner_camera_fly(struct turner_camera *camera, double right, double up, double forward)
{
    struct axes a = axes_of(camera);
    struct turner_vec3 step = turner_vec3_scale(a.right, right);
    step = add_scaled(add_scaled(step, a.up, up), a.forward, forward);
    camera->from = turner_vec3_add(camera->from, step);
    camera->at = turner_vec3_add(camera->at, step);
}

void turner_camera_pan(struct turner_camera *camera, double right, double down, int height)
{
    double pixel = 2 * tan(camera->vfov / 2) * turner_camera_distance(camera) / height;
    turner_camera_fly(camera, -right * pixel, down * pixel, 0);
}

void turner_camera_dolly(struct turner_camera *camera, double factor)
{
    struct turner_vec3 v = turner_vec3_sub(camera->from, camera->at);
    double distance = turner_vec3_length(v) * factor;
    if (!(distance > LEAST_DISTANCE && distance < 1e15))
        return;
    camera->from = add_scaled(camera->at, v, factor);
}

bool turner_camera_look_at(struct turner_camera *camera, struct turner_vec3 point)
{
    struct turner_camera there = *camera;
    there.at = point;
    struct turner_vec3 v = turner_vec3_sub(point, camera->from);
    double sine = turner_vec3_length(turner_vec3_cross(turner_vec3_normalize(v),
                                                       turner_vec3_normalize(camera->up)));
    if (!(turner_camera_distance(&there) > LEAST_DISTANCE) || !(sine > sin(POLE)))
        return false;
    *camera = there;
    return true;
}

static double rounded(double value, int digits)
{
    char text[400];
    if (digits < 0) {
        double unit = pow(10, -digits);
        return floor(value / unit + 0.5) * unit;
    }
    snprintf(text, sizeof text, "%.*f", digits, value);
    double result = strtod(text, NULL);
    return result == 0 ? 0 : result; /* no −0 */
}

void turner_camera_round(struct turner_camera *camera)
{
    int digits = 6 - (int)ceil(log10(turner_camera_distance(camera)));
    digits = digits > 15 ? 15 : digits;
    struct turner_vec3 *points[] = {&camera->from, &camera->at};
    struct turner_camera before = *camera;
    for (int i = 0; i < 2; i++) {
        points[i]->x = rounded(points[i]->x, digits);
        points[i]->y = rounded(points[i]->y, digits);
        points[i]->z = rounded(points[i]->z, digits);
    }
    if (!(turner_camera_distance(camera) > 0))
        *camera = before;
}
