// The media a ray is inside of: a list of at most eight in one 64-bit word, eight bits each, medium
// index + 1 (0 is empty), highest first. Media are sorted by rank (src/scene/scene.h), so the
// lowest byte is the medium the ray travels in. A medium stands there as often as it was entered.

const uint OUTSIDE = 0u;

uint media_slot(uint64_t list, uint place)
{
    return uint(list >> (8u * place)) & 255u;
}

// The medium travelled in (index + 1), or OUTSIDE.
uint media_current(uint64_t list)
{
    return media_slot(list, 0u);
}

// How many of the list are at least `medium`: where it would be put behind its equals.
uint media_place(uint64_t list, uint medium)
{
    uvec2 slots = unpackUint2x32(list);
    uint place = 0u;
    for (uint shift = 0u; shift < 32u; shift += 8u)
        place += uint(((slots.x >> shift) & 255u) >= medium) +
                 uint(((slots.y >> shift) & 255u) >= medium);
    return place;
}

uint64_t media_add(uint64_t list, uint place, uint medium)
{
    if (place == 8u)
        return list; // full of higher ones; otherwise what is last of eight is dropped
    uint64_t before = (1ul << (8u * place)) - 1ul;
    return (list & before) | (uint64_t(medium) << (8u * place)) | ((list & ~before) << 8u);
}

uint64_t media_remove(uint64_t list, uint place)
{
    uint64_t before = (1ul << (8u * place)) - 1ul;
    return (list & before) | ((list >> 8u) & ~before);
}

// Crossing the boundary of a medium: the lists on the side the ray comes from and beyond. The
// surface is none when both travel in the same medium.
struct crossing_t {
    uint64_t before, after;
    bool boundary;
};

crossing_t media_cross(uint64_t list, uint medium, bool entering)
{
    uint place = media_place(list, medium), first = media_place(list, medium + 1u);
    uint64_t added = media_add(list, place, medium);
    crossing_t crossing;
    // leaving what was never entered counts as having been inside
    bool inside = first < place;
    crossing.before = entering || inside ? list : added;
    crossing.after = entering ? added : first < 8u ? media_remove(crossing.before, first) : list;
    crossing.boundary = media_current(crossing.before) != media_current(crossing.after);
    return crossing;
}

// Meeting a surface, which is always a boundary unless it is transmissive.
crossing_t media_meet(uint64_t list, bool transmissive, uint medium, bool entering)
{
    if (NEEDS_ANY(TURNER_NEEDS_MEDIA) && transmissive)
        return media_cross(list, medium, entering);
    return crossing_t(list, list, true);
}

real media_index(uint64_t list)
{
    uint medium = media_current(list);
    if (medium == OUTSIDE)
        return 1.0;
    return EXACT(real, medium_array(scene.media).at[medium - 1u].index,
                 medium_array(scene.media).at[medium - 1u].index_rest);
}

// Beer–Lambert: what is left of light after `distance` (may be INFINITY) in the current medium.
vec3 media_transmittance(uint64_t list, float distance)
{
    uint medium = media_current(list);
    if (!NEEDS_ANY(TURNER_NEEDS_ABSORPTION) || medium == OUTSIDE)
        return vec3(1.0);
    vec3 absorption = medium_array(scene.media).at[medium - 1u].absorption;
    // a channel without absorption stays 1 over any distance, also an infinite one
    return vec3(absorption.r == 0.0 ? 1.0 : exponential(-absorption.r * distance),
                absorption.g == 0.0 ? 1.0 : exponential(-absorption.g * distance),
                absorption.b == 0.0 ? 1.0 : exponential(-absorption.b * distance));
}
