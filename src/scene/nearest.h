/* The known word that a misspelt one may have meant. */
#ifndef TURNER_SCENE_NEAREST_H
#define TURNER_SCENE_NEAREST_H

#include <stddef.h>

/* Letters to insert, delete, replace or swap with their neighbour to turn `a` into `b` (optimal
 * string alignment); `limit` + 1 when more than `limit`. ASCII case is ignored. */
size_t turner_edit_distance(const char *a, const char *b, size_t limit);

/* Of `count` words, `word(user, i)` each, the nearest to `text`, the first of equals; NULL when
 * none is near enough to be worth suggesting. */
const char *turner_nearest(const char *text, size_t count,
                           const char *(*word)(const void *user, size_t i), const void *user);

#endif
