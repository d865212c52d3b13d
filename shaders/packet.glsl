// Our own hierarchy walked by the eight lanes of a subgroup together: all visit the nodes that any
// of them meets. Eight lanes load a node of four boxes at once and hand it round. Every lane must
// come along, also one that has no ray: its t_max is −1 and it meets nothing.
//
// The walk is loops within loops, each entered only where there is something to do: nodes until a
// leaf comes up, leaves until a node comes up, and at the top level instances between.
#include "boxes.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer word_array
{
    uint64_t at[];
};

const uint LANES = 8u;
const uint BELOW = BVH_STACK / LANES; // registers put aside, at most
const int MISSED = 0x7fffffff; // the key of a box that no lane meets; others are bits of floats
const uint LEAF = TURNER_WIDE_LEAF;

// Nodes and leaves that wait, nearest on top, one in each lane of two registers; what lies deeper is
// put aside, which few walks come to. All lanes hold the same `next`, `height` and `aside`. At the
// bottom lies 0, the end of the walk. (To keep beside them where they are entered, and drop those
// beyond what was found since, saves 2 to 8 % of the visits and costs more.)
struct walk_t {
    uint next;
    uint height; // in the registers
    uint aside;  // registers put aside
    uint lower, upper;
};

uint lane()
{
    return gl_SubgroupInvocationID;
}

walk_t walk_from(uint root)
{
    return walk_t(root, 1u, 0u, 0u, 0u);
}

uint top_of(walk_t walk)
{
    uint place = (walk.height - 1u) % LANES;
    uint a = subgroupShuffle(walk.lower, place), b = subgroupShuffle(walk.upper, place);
    return walk.height > LANES ? b : a;
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

// Puts the children of walk.next that a lane meets on the stack, and takes the nearest.
void visit(inout walk_t walk, boxes_ray_t ray, int t_max)
{
    uvec2 word = unpackUint2x32(word_array(scene.nodes + uint64_t(walk.next) * 64ul).at[lane()]);
    // lanes 0 … 5 hold a side of an axis each, as bytes of a grid, 6 and 7 the children; those are
    // no floats: a processor stumbles over denormal numbers, whatever becomes of them
    float origin = uintBitsToFloat(subgroupShuffle(word.y, min(lane() & 6u, 4u)));
    float spacing = uintBitsToFloat(subgroupShuffle(word.y, min(lane() | 1u, 5u)));
    vec4 planes = vec4((uvec4(word.x) >> uvec4(0u, 8u, 16u, 24u)) & 255u) * spacing + origin;
    uint holder = 6u + ((lane() >> 1) & 1u);
    uint even = subgroupShuffle(word.x, holder), odd = subgroupShuffle(word.y, holder);
    uint child = (lane() & 1u) != 0u ? odd : even; // of child lane % 4

    uint top = top_of(walk); // while the boxes are being met
    int key = enter_children(planes, ray, t_max);
    key = child == 0u ? MISSED : key;
    int k0 = subgroupBroadcast(key, 0u), k1 = subgroupBroadcast(key, 1u);
    int k2 = subgroupBroadcast(key, 2u), k3 = subgroupBroadcast(key, 3u);
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
    uint next = nearest != MISSED ? subgroupShuffle(child, uint(nearest) & 3u) : top;
    child = subgroupShuffle(child, uint(subgroupShuffle(key, turn)) & 3u);
    walk.lower = lane() >= walk.height ? child : walk.lower;
    walk.upper = lane() + LANES >= walk.height ? child : walk.upper;
    walk.height += met - 1u;
    walk.next = next;
}

bool is_node(uint entry) { return int(entry) > 0; }
bool is_leaf(uint entry) { return int(entry) < 0; }

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

// What a lane still looks for lies nearer than this.
int t_max_of(search_t search)
{
    return search.blocked ? floatBitsToInt(-1.0) : bits_of(search.hit.t);
}

void walk_group(inout search_t search, uint root, uint instance, uint override_material,
                real3 origin, real3 direction)
{
    boxes_ray_t boxes = boxes_ray_of(origin, direction);
    shear_t shear = shear_of(direction);
    int t_max = t_max_of(search);
    uint below[BELOW];
    walk_t walk = walk_from(root);
    uint visits = 0u;
    do {
        do {
            if (walk.height - 1u >= 2u * LANES - 4u) { // no room for four, or nothing there
                if (walk.height == 0u) {
                    walk.aside--;
                    walk.lower = below[walk.aside];
                    walk.height = LANES;
                } else {
                    below[walk.aside] = walk.lower;
                    walk.aside++;
                    walk.lower = walk.upper;
                    walk.height -= LANES;
                }
            }
            visit(walk, boxes, t_max);
        } while (is_node(walk.next) && ++visits < scene.max_visits);
        do {
            if (walk.next != 0u) {
                uint index = walk.next & TURNER_WIDE_FIRST;
                uint end = index + ((walk.next & ~LEAF) >> TURNER_WIDE_COUNT_SHIFT) + 1u;
                do {
                    intersect_primitive(search, primitive_of_lanes(index), index, instance,
                                        override_material, origin, direction, shear);
                    index++;
                } while (index < end);
            }
            t_max = t_max_of(search);
            if (walk.next != 0u) {
                if (walk.height == 0u) {
                    walk.aside--;
                    walk.lower = below[walk.aside];
                    walk.height = LANES;
                }
                walk.next = goes_on(t_max >= 0) ? top_of(walk) : 0u; // all may be blocked
                walk.height--;
            }
        } while (is_leaf(walk.next));
    } while (walk.next != 0u && ++visits < scene.max_visits);
}

void traverse(inout search_t search, ray_t ray)
{
    instance_array instances = instance_array(scene.instances);
    if (!NEEDS_ANY(TURNER_NEEDS_INSTANCES)) {
        walk_group(search, instances.at[0].root, 0u, TURNER_NO_INDEX, ray.origin, ray.direction);
        return;
    }
    boxes_ray_t boxes = boxes_ray_of(ray.origin, ray.direction);
    int t_max = t_max_of(search);
    uint below[BELOW];
    walk_t walk = walk_from(scene.root);
    uint visits = 0u;
    do {
        do {
            if (walk.height - 1u >= 2u * LANES - 4u) { // no room for four, or nothing there
                if (walk.height == 0u) {
                    walk.aside--;
                    walk.lower = below[walk.aside];
                    walk.height = LANES;
                } else {
                    below[walk.aside] = walk.lower;
                    walk.aside++;
                    walk.lower = walk.upper;
                    walk.height -= LANES;
                }
            }
            visit(walk, boxes, t_max);
        } while (is_node(walk.next) && ++visits < scene.max_visits);
        do {
            if (walk.next != 0u) {
                uint instance = walk.next & TURNER_WIDE_FIRST;
                real[12] to_group = to_group_of(instance);
                walk_group(search, instances.at[instance].root, instance,
                           instances.at[instance].material,
                           transform_point(to_group, ray.origin),
                           transform_vector(to_group, ray.direction));
            }
            t_max = t_max_of(search);
            if (walk.next != 0u) {
                if (walk.height == 0u) {
                    walk.aside--;
                    walk.lower = below[walk.aside];
                    walk.height = LANES;
                }
                walk.next = goes_on(t_max >= 0) ? top_of(walk) : 0u; // all may be blocked
                walk.height--;
            }
        } while (is_leaf(walk.next));
    } while (walk.next != 0u && ++visits < scene.max_visits);
}
