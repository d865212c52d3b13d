/* What mouse and keys do to a camera. Angles are radians, distances metres, all of the world. */
#ifndef TURNER_VIEW_CAMERA_H
#define TURNER_VIEW_CAMERA_H

#include "scene/scene.h"

/* The eye around `at`: to its right, and up. Stops half a degree short of the poles of camera->up. */
void turner_camera_orbit(struct turner_camera *camera, double right, double up);

/* Turns the head, to the right and up: `from` stays. */
void turner_camera_turn(struct turner_camera *camera, double right, double up);

/* Moves with the picture's plane: what lies at the distance of `at` moves by so many pixels of a
 * picture `height` pixels high, to the right and down. */
void turner_camera_pan(struct turner_camera *camera, double right, double down, int height);

/* Towards `at`, which stays; the distance is multiplied by `factor` > 0. */
void turner_camera_dolly(struct turner_camera *camera, double factor);

/* Moves eye and `at`. */
void turner_camera_fly(struct turner_camera *camera, double right, double up, double forward);

/* Looks at a point, from where it is. False, and nothing is changed, where that has no direction. */
bool turner_camera_look_at(struct turner_camera *camera, struct turner_vec3 point);

double turner_camera_distance(const struct turner_camera *camera); /* from eye to `at` */

/* Rounds to about six digits of the distance, so that what is shown is what is printed. */
void turner_camera_round(struct turner_camera *camera);

#endif
