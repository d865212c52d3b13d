// Our own hierarchy walked by the eight lanes of a subgroup together: all visit the nodes that any
// of them meets. Eight lanes load a node of four boxes at once and hand it round. Every lane must
// come along, also one that has no ray: its t_max is −1 and it meets nothing.
//
// The walk is loops within loops, each entered only where there is something to do: nodes until a
// leaf comes up, leaves until a node comes up, and at the top level instances between.
#include "boxes.glsl"

layout(constant_id = TURNER_CONSTANT_SOON) const bool SOON = false;

const uint LANES = 8u;
const uint ASIDE = BVH_STACK / LANES; // registers put aside, at most
const int MISSED = 0x7fffffff; // the key of a box that no lane meets; others are bits of floats
const uint LEAF = TURNER_WIDE_LEAF;

// Nodes and leaves that wait, nearest on top, one in each lane of two registers; what lies deeper is
// put aside, which few walks come to. All lanes hold the same `next`, `height` and `aside`. At the
// bottom lies 0, the end of the walk. (To keep beside them where they are entered, and drop those
// beyond what was found since, saves 2 to 8 % of the visits and costs more.)
struct walk_t {
    uint next;
    uint height; // in the registers
    uint aside;  // where the next register is put aside
    uint lower, upper;
    uint visits;
};

uint put_aside[2u * ASIDE]; // of groups, of the top level

uint lane()
{
    return gl_SubgroupInvocationID;
}

walk_t walk_from(uint root, uint aside)
{
    return walk_t(root, 1u, aside, 0u, 0u, 0u);
}

uint top_of(walk_t walk)
{
    uint place = (walk.height - 1u) % LANES;
    uint a = subgroupShuffle(walk.lower, place), b = subgroupShuffle(walk.upper, place);
    return walk.height > LANES ? b : a;
}

void take_back(inout walk_t walk)
{
    walk.aside--;
    walk.lower = put_aside[walk.aside];
    walk.height = LANES;
}

void make_room(inout walk_t walk)
{
    put_aside[walk.aside] = walk.lower;
    walk.aside++;
    walk.lower = walk.upper;
    walk.height -= LANES;
}

// A packet of rays whose directions have the same signs, taken as one: it meets what any of them
// meets, and perhaps more, for less than half of the work. They start at one point, as the camera's
// do, or end at one and are followed backward from there, as shadow rays from a light that is near
// enough for them to stay together; others would meet far more. Lane 2a has what gives the entry along
// axis a, lane 2a + 1 what gives the exit: the coordinate that rays start from and the reciprocals of
// their directions that are farthest from each other. Lanes 6 and 7 enter and leave at all times.
struct beam_t {
    bool possible;
    int reach;  // of rays followed backward: how far, in bits; of others 0
    uint faces; // where each lane finds its own in a node: entries may be behind
    float start, least, most;
};

const beam_t NO_BEAM = beam_t(false, 0, 0u, 0.0, 0.0, 0.0);

// Of rays that are followed backward: how far apart they may be, as a share of their length.
const float APART = 0.01;

// A packet that has tested as many primitives goes on ray by ray: where they are smaller than the
// distance between rays, most of what lies between is met by none.
const uint FEW = 12u;

float least_of_lanes(float v)
{
    v = min(v, subgroupShuffleXor(v, 1u));
    v = min(v, subgroupShuffleXor(v, 2u));
    return min(v, subgroupShuffleXor(v, 4u));
}

int common_to_lanes(int bits)
{
    bits &= subgroupShuffleXor(bits, 1u);
    bits &= subgroupShuffleXor(bits, 2u);
    return bits & subgroupShuffleXor(bits, 4u);
}

// The axis of which this lane has what belongs to the beam.
uint own_axis()
{
    return min(lane() >> 1, 2u);
}

// The least along this lane's axis of what all lanes have. Halves the lanes twice, and the half that
// is left takes other axes.
float least_along_axis(vec3 v)
{
    bool second = (lane() & 2u) != 0u, upper = (lane() & 4u) != 0u;
    float xy = min(second ? v.y : v.x, subgroupShuffleXor(second ? v.x : v.y, 2u));
    float z = min(v.z, subgroupShuffleXor(v.z, 2u));
    float least = min(upper ? z : xy, subgroupShuffleXor(upper ? xy : z, 4u));
    return min(least, subgroupShuffleXor(least, 1u));
}

float largest_of_axes(float v)
{
    v = max(v, subgroupShuffleXor(v, 2u));
    return max(v, subgroupShuffleXor(v, 4u));
}

// Bounds of what the lanes have that are alive, along this lane's axis.
struct bounds_t {
    float lo, hi;
};

bounds_t bounds_of_lanes(vec3 lo, vec3 hi, bool alive)
{
    const vec3 far = vec3(3e38);
    return bounds_t(least_along_axis(alive ? lo : far), -least_along_axis(alive ? -hi : far));
}

// Where rays that end within t_max come from, seen from their ends; empty bounds where they are too
// far apart.
bounds_t ends_of_lanes(boxes_ray_t ray, vec3 direction, float t_max, bool alive)
{
    vec3 end = 0.5 * (ray.above + ray.below) + t_max * direction;
    bounds_t starts = bounds_of_lanes(ray.below, ray.above, alive);
    bounds_t ends = bounds_of_lanes(end, end, alive);
    float length = least_of_lanes(alive ? t_max * largest(abs(direction)) : 3e38);
    float farthest = max(max(abs(starts.lo), abs(starts.hi)), max(abs(ends.lo), abs(ends.hi)));
    float pad = 2e-6 * largest_of_axes(farthest); // for rounding
    if (largest_of_axes(starts.hi - starts.lo) + largest_of_axes(ends.hi - ends.lo) >
        APART * length)
        return bounds_t(1.0, -1.0);
    return bounds_t(ends.lo - pad, ends.hi + pad);
}

beam_t beam_of(boxes_ray_t ray, vec3 direction, float t_max, bool alive)
{
    beam_t beam;
    uvec3 negative = floatBitsToUint(ray.inverse) >> 31;
    int signs = int(negative.x | negative.y << 1 | negative.z << 2);
    int shared_bits = common_to_lanes(alive ? signs | (~signs & 7) << 3 : 63);
    int all = shared_bits & 7; // negative in every lane; the rest is positive in every lane, if:
    beam.possible = (all ^ shared_bits >> 3) == 7;
    if (beam.possible) {
        uint axis = own_axis();
        vec3 below = vec3(subgroupBroadcast(ray.below.x, 0u), subgroupBroadcast(ray.below.y, 0u),
                          subgroupBroadcast(ray.below.z, 0u));
        vec3 above = vec3(subgroupBroadcast(ray.above.x, 0u), subgroupBroadcast(ray.above.y, 0u),
                          subgroupBroadcast(ray.above.z, 0u));
        bounds_t from = bounds_t(below[axis], above[axis]);
        vec3 inverse = ray.inverse;
        beam.reach = 0;
        if (goes_on(alive && (ray.below != below || ray.above != above))) {
            float reach = -least_of_lanes(alive ? -t_max : 0.0);
            if (reach < 1e30)
                from = ends_of_lanes(ray, direction, t_max, alive);
            beam.possible = reach < 1e30 && from.lo <= from.hi;
            beam.reach = floatBitsToInt(reach * 1.000002);
            inverse = -inverse;
            all = ~all;
        }
        bounds_t spread = bounds_of_lanes(inverse, inverse, alive);
        bool leaving = (lane() & 1u) != 0u, turned = ((uint(all) >> axis) & 1u) != 0u;
        float pad = leaving ? 1.000001 : 1.0; // that of enter_box(), and its rounding
        beam.faces = lane() ^ uint(turned && lane() < 6u);
        beam.start = lane() >= 6u ? 0.0 : leaving != turned ? from.lo : from.hi;
        beam.least = lane() < 6u ? spread.lo * pad : leaving ? 3e38 : 0.0;
        beam.most = lane() < 6u ? spread.hi * pad : leaving ? 3e38 : 0.0;
    }
    return beam;
}

// Entry of the beam into each child: lanes 2i have that of child i. Differences and products are
// rounded in order, so that no ray enters before the beam or leaves after it.
int enter_by_beam(vec4 planes, beam_t beam, int t_most)
{
    int w[4];
    int complement = -int(lane() & 1u); // of exits, so that the greatest is wanted of both
    for (uint i = 0u; i < 4u; i++) {
        float way = (lane() < 6u ? planes[i] : 1.0) - beam.start;
        w[i] = min(floatBitsToInt(way * beam.least) ^ complement,
                   floatBitsToInt(way * beam.most) ^ complement);
    }
    bool second = (lane() & 2u) != 0u, upper = (lane() & 4u) != 0u;
    int a = max(second ? w[1] : w[0], subgroupShuffleXor(second ? w[0] : w[1], 2u));
    int b = max(second ? w[3] : w[2], subgroupShuffleXor(second ? w[2] : w[3], 2u));
    int enter = max(upper ? b : a, subgroupShuffleXor(upper ? a : b, 4u));
    int leave = ~subgroupShuffleXor(enter, 1u);
    return enter <= min(leave, t_most) ? enter & ~3 | int(lane() >> 1) : MISSED;
}

// Entry of any lane into each child of a node: lane i has that of child i % 4.
int enter_children(vec4 planes, boxes_ray_t ray, int t_max)
{
    int key[4];
    for (uint i = 0u; i < 4u; i++) {
        vec3 lo = vec3(subgroupBroadcast(planes[i], 0u), subgroupBroadcast(planes[i], 2u),
                       subgroupBroadcast(planes[i], 4u));
        vec3 hi = vec3(subgroupBroadcast(planes[i], 1u), subgroupBroadcast(planes[i], 3u),
                       subgroupBroadcast(planes[i], 5u));
        int enter = enter_box(ray, lo, hi, t_max);
        key[i] = enter < 0 ? MISSED : int(uint(enter) & ~3u | i);
    }
    // halves the lanes three times; in the first two the half that is left takes other children
    bool odd = (lane() & 1u) != 0u, upper = (lane() & 2u) != 0u;
    int a = min(odd ? key[1] : key[0], subgroupShuffleXor(odd ? key[0] : key[1], 1u));
    int b = min(odd ? key[3] : key[2], subgroupShuffleXor(odd ? key[2] : key[3], 1u));
    int c = min(upper ? b : a, subgroupShuffleXor(upper ? a : b, 2u));
    return min(c, subgroupShuffleXor(c, 4u));
}

void order(inout int a, inout int b)
{
    int most = max(a, b);
    b = min(a, b);
    a = most;
}

// Puts the children of walk.next that a lane meets on the stack, and takes the nearest. `by_beam` is
// a constant: what is not asked for is not there.
void visit(inout walk_t walk, boxes_ray_t ray, int t_max, bool by_beam, beam_t beam)
{
    uvec2 word = unpackUint2x32(word_array(scene.nodes + uint64_t(walk.next) * 64ul).at[lane()]);
    // lanes 0 … 5 hold a side of an axis each, as bytes of a grid, 6 and 7 the children; those are
    // no floats: a processor stumbles over denormal numbers, whatever becomes of them
    float origin = uintBitsToFloat(subgroupShuffle(word.y, min(lane() & 6u, 4u)));
    float spacing = uintBitsToFloat(subgroupShuffle(word.y, min(lane() | 1u, 5u)));
    uint faces = by_beam ? subgroupShuffle(word.x, beam.faces) : word.x;
    vec4 planes = vec4((uvec4(faces) >> uvec4(0u, 8u, 16u, 24u)) & 255u) * spacing + origin;
    // the child that this lane has
    uint apart = by_beam ? 2u : 1u, place = by_beam ? lane() >> 1 : lane() & 3u;
    uint holder = 6u + (place >> 1);
    uint even = subgroupShuffle(word.x, holder), odd = subgroupShuffle(word.y, holder);
    uint child = (place & 1u) != 0u ? odd : even;

    uint top = top_of(walk); // while the boxes are being met
    int key = by_beam ? enter_by_beam(planes, beam, t_max) : enter_children(planes, ray, t_max);
    key = child == 0u ? MISSED : key;
    int k0 = subgroupBroadcast(key, 0u);
    int k1 = by_beam ? subgroupBroadcast(key, 2u) : subgroupBroadcast(key, 1u);
    int k2 = by_beam ? subgroupBroadcast(key, 4u) : subgroupBroadcast(key, 2u);
    int k3 = by_beam ? subgroupBroadcast(key, 6u) : subgroupBroadcast(key, 3u);
    int nearest = min(min(k0, k1), min(k2, k3));
    uint met = uint(k0 != MISSED) + uint(k1 != MISSED) + uint(k2 != MISSED) + uint(k3 != MISSED);
    order(k0, k1);
    order(k2, k3);
    order(k0, k2);
    order(k1, k3);
    order(k1, k2);
    key = lane() == 0u ? k0 : lane() == 1u ? k1 : lane() == 2u ? k2 : k3;

    // those missed come first and would lie below walk.height, where nothing is written
    uint turn = (lane() + 4u - met - walk.height) % LANES;
    uint first = subgroupShuffle(child, (uint(nearest) & 3u) * apart);
    child = subgroupShuffle(child, (uint(subgroupShuffle(key, turn)) & 3u) * apart);
    walk.lower = lane() >= walk.height ? child : walk.lower;
    walk.upper = lane() + LANES >= walk.height ? child : walk.upper;
    walk.height += met - 1u;
    walk.next = nearest != MISSED ? first : top;
}

bool is_node(uint entry) { return int(entry) > 0; }
bool is_leaf(uint entry) { return int(entry) < 0; }

// A visit takes one from the registers at most and adds three at most.
bool has_room(walk_t walk)
{
    return walk.height - 1u < 2u * LANES - 4u;
}

void make_sure_of_room(inout walk_t walk)
{
    if (!has_room(walk)) {
        if (walk.height == 0u)
            take_back(walk);
        else
            make_room(walk);
    }
}

// Down to a leaf, or the end, or until there is no room.
void walk_nodes(inout walk_t walk, boxes_ray_t ray, int t_max, bool by_beam, beam_t beam)
{
    do {
        visit(walk, ray, t_max, by_beam, beam);
        walk.visits++;
    } while (is_node(walk.next) && has_room(walk) && walk.visits < scene.max_visits);
}

// What a lane still looks for lies nearer than this.
int t_max_of(search_t search)
{
    return search.blocked ? floatBitsToInt(-1.0) : bits_of(search.hit.t);
}

// Takes what waits on top, after a leaf; the end, if all lanes are blocked. That is asked only where
// one is, so that the next node need not wait for what the leaf holds.
void take(inout walk_t walk, search_t search)
{
    if (walk.height == 0u)
        take_back(walk);
    walk.next = top_of(walk);
    walk.height--;
    if (goes_on(search.blocked))
        walk.next = goes_on(t_max_of(search) >= 0) ? walk.next : 0u;
}

// The primitive, read by six lanes for all.
turner_gpu_primitive primitive_of_lanes(uint index)
{
    uvec2 word = unpackUint2x32(
        word_array(scene.primitives + uint64_t(index) * 48ul).at[min(lane(), 5u)]);
    uint w[12];
    w[0] = subgroupBroadcast(word.x, 0u);
    w[1] = subgroupBroadcast(word.y, 0u);
    w[2] = subgroupBroadcast(word.x, 1u);
    w[3] = subgroupBroadcast(word.y, 1u);
    w[4] = subgroupBroadcast(word.x, 2u);
    w[5] = subgroupBroadcast(word.y, 2u);
    w[6] = subgroupBroadcast(word.x, 3u);
    w[7] = subgroupBroadcast(word.y, 3u);
    w[8] = subgroupBroadcast(word.x, 4u);
    w[9] = subgroupBroadcast(word.y, 4u);
    w[10] = subgroupBroadcast(word.x, 5u);
    w[11] = subgroupBroadcast(word.y, 5u);
    return turner_gpu_primitive(uintBitsToFloat(uvec3(w[0], w[1], w[2])),
                                uintBitsToFloat(uvec3(w[3], w[4], w[5])),
                                uintBitsToFloat(uvec3(w[6], w[7], w[8])), w[9], w[10], w[11]);
}

void walk_group(inout search_t search, uint root, uint instance, uint override_material,
                real3 origin, real3 direction)
{
    boxes_ray_t boxes = boxes_ray_of(origin, direction);
    shear_t shear = shear_of(direction);
    int t_max = t_max_of(search);
    beam_t beam = NO_BEAM;
    if (!SOON)
        beam = beam_of(boxes, vec3(direction), float(search.hit.t), t_max >= 0);
    walk_t walk = walk_from(root, 0u);
    uint tested = 0u;
    do {
        make_sure_of_room(walk);
        if (!SOON && beam.possible && tested < FEW)
            walk_nodes(walk, boxes, beam.reach != 0 ? beam.reach : ~least_of_lanes(~t_max), true,
                       beam);
        else
            walk_nodes(walk, boxes, t_max, false, beam);
        do {
            if (is_leaf(walk.next)) {
                uint index = walk.next & TURNER_WIDE_FIRST;
                uint end = index + ((walk.next & ~LEAF) >> TURNER_WIDE_COUNT_SHIFT) + 1u;
                tested += end - index;
                do {
                    intersect_primitive(search, primitive_of_lanes(index), index, instance,
                                        override_material, origin, direction, shear);
                    index++;
                } while (index < end);
            }
            t_max = t_max_of(search);
            if (is_leaf(walk.next))
                take(walk, search);
        } while (is_leaf(walk.next));
    } while (walk.next != 0u && walk.visits < scene.max_visits);
}

void traverse(inout search_t search, ray_t ray)
{
    if (!NEEDS_ANY(TURNER_NEEDS_INSTANCES)) {
        walk_group(search, scene.root, 0u, TURNER_NO_INDEX, ray.origin, ray.direction);
        return;
    }
    instance_array instances = instance_array(scene.instances);
    boxes_ray_t boxes = boxes_ray_of(ray.origin, ray.direction);
    int t_max = t_max_of(search);
    walk_t walk = walk_from(scene.root, ASIDE);
    do {
        make_sure_of_room(walk);
        walk_nodes(walk, boxes, t_max, false, NO_BEAM);
        do {
            if (is_leaf(walk.next)) {
                uint instance = walk.next & TURNER_WIDE_FIRST;
                real[12] to_group = to_group_of(instance);
                walk_group(search, instances.at[instance].root, instance,
                           instances.at[instance].material,
                           transform_point(to_group, ray.origin),
                           transform_vector(to_group, ray.direction));
            }
            t_max = t_max_of(search);
            if (is_leaf(walk.next))
                take(walk, search);
        } while (is_leaf(walk.next));
    } while (walk.next != 0u && walk.visits < scene.max_visits);
}
