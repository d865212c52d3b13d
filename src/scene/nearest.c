#include "scene/nearest.h"

#include <stdint.h>
#include <string.h>

#define LONGEST 255
#define MOST_WORDS 4096 /* a suggestion is not worth more time than this */

static char lower(char letter)
{
    return letter >= 'A' && letter <= 'Z' ? (char)(letter - 'A' + 'a') : letter;
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

size_t turner_edit_distance(const char *a, const char *b, size_t limit)
{
    size_t rows = strlen(a), columns = strlen(b);
    size_t difference = rows > columns ? rows - columns : columns - rows;
    if (difference > limit || rows > LONGEST || columns > LONGEST)
        return limit + 1;
    /* three rows of the table, as swaps look back two */
    uint16_t table[3][LONGEST + 1];
    for (size_t j = 0; j <= columns; j++)
        table[0][j] = (uint16_t)j;
    for (size_t i = 1; i <= rows; i++) {
        uint16_t *row = table[i % 3], *above = table[(i - 1) % 3], *two_above = table[(i + 1) % 3];
        row[0] = (uint16_t)i;
        for (size_t j = 1; j <= columns; j++) {
            char x = lower(a[i - 1]), y = lower(b[j - 1]);
            size_t best = least(above[j - 1] + (x != y), least(above[j], row[j - 1]) + 1u);
            if (i > 1 && j > 1 && x == lower(b[j - 2]) && y == lower(a[i - 2]))
                best = least(best, two_above[j - 2] + 1u);
            row[j] = (uint16_t)best;
        }
    }
    size_t distance = table[rows % 3][columns];
    return distance <= limit ? distance : limit + 1;
}

const char *turner_nearest(const char *text, size_t count,
                           const char *(*word)(const void *user, size_t i), const void *user)
{
    size_t length = strlen(text);
    if (length < 2)
        return NULL;
    size_t limit = length < 6 ? 1 : length / 3;
    const char *nearest = NULL;
    for (size_t i = 0; i < least(count, MOST_WORDS); i++) {
        size_t distance = turner_edit_distance(text, word(user, i), limit);
        if (distance > limit)
            continue;
        nearest = word(user, i);
        if (distance == 0)
            break;
        limit = distance - 1;
    }
    return nearest;
}
