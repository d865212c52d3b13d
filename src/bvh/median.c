#include "bvh/build.h"

void turner_bvh_select(struct turner_bvh_item *items, uint32_t count, uint32_t k, int axis)
{
    int64_t first = 0, last = (int64_t)count - 1;
    uint32_t random = 0x9e3779b9u;
    while (first < last) {
        random = random * 1664525u + 1013904223u;
        uint64_t span = (uint64_t)(last - first + 1);
        int64_t drawn = first + (int64_t)(random * span >> 32);
        float pivot = turner_bvh_center(&items[drawn], axis);
        int64_t i = first, j = last;
        while (i <= j) {
            while (turner_bvh_center(&items[i], axis) < pivot)
                i++;
            while (turner_bvh_center(&items[j], axis) > pivot)
                j--;
            if (i <= j) {
                struct turner_bvh_item item = items[i];
                items[i++] = items[j];
                items[j--] = item;
            }
        }
        /* first…j ≤ pivot ≤ i…last, and what lies between j and i equals it */
        if (k <= j)
            last = j;
        else if (k >= i)
            first = i;
        else
            return;
    }
}

void turner_bvh_median_order(struct turner_bvh_item *items, uint32_t count)
{
    if (count <= 2) /* both orders give the same two leaves */
        return;
    struct turner_bvh_bounds bounds, centers;
    turner_bvh_measure(&bounds, &centers, items, count);
    uint32_t half = count - count / 2;
    turner_bvh_select(items, count, half, turner_bvh_widest(&centers));
    turner_bvh_median_order(items, half);
    turner_bvh_median_order(items + half, count - half);
}
