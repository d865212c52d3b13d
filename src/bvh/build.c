/* The tree's top, by all threads level after level, and its subtrees, each by one. What comes out
 * does not depend on the number of threads: a range's items keep their order when they are divided,
 * bins are summed in that order, and nodes are numbered afterwards. */
#include <stdlib.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "bvh/subtree.h"

#define BLOCK 8192    /* items of a range that one thread takes at once */
#define SUBTREE 16384 /* ranges of at most so many items are built by one thread, */
#define SUBTREES 32   /* or of at most one in so many: threads wait for each other at each level */

struct block {
    uint32_t part;         /* index of the range */
    uint32_t begin, count; /* within it */
    uint32_t left;         /* items that go to the left of the range's split */
    uint32_t left_before;  /* of blocks before it */
    struct turner_bins bins;
    struct turner_box4 centers[2];
};

/* A range of the top. */
struct part {
    struct turner_range range;
    uint32_t level;
    uint32_t children; /* index of the first of two, or 0: it is a subtree's */
    bool halve;
    struct turner_grid grid;
    struct turner_split split;
    size_t place, moved; /* of its node; where it has been counted on, where it ends */
    struct turner_subtree tree;
};

struct top {
    struct turner_builder builder;
    uint32_t subtree;   /* largest range that one thread builds */
    struct part *parts; /* level after level */
    size_t part_count, part_capacity;
    struct block *blocks;
    size_t block_count, block_capacity;
    uint32_t *subtrees; /* parts in depth-first order */
    uint32_t subtree_count;
};

static const struct turner_bvh_item *block_items(const struct top *top, const struct block *block)
{
    const struct part *part = &top->parts[block->part];
    return top->builder.buffer[part->level & 1] + part->range.begin + block->begin;
}

static void bin_block(void *user, uint32_t i)
{
    struct top *top = user;
    struct block *block = &top->blocks[i];
    const struct turner_grid *grid = &top->parts[block->part].grid;
    turner_bins_clear(&block->bins, grid);
    turner_bins_add(&block->bins, block_items(top, block), block->count, grid);
}

static void move_block(void *user, uint32_t i)
{
    struct top *top = user;
    struct block *block = &top->blocks[i];
    const struct part *part = &top->parts[block->part];
    if (part->halve)
        return;
    struct turner_bvh_item *to = top->builder.buffer[~part->level & 1] + part->range.begin;
    turner_split_move(to + block->left_before,
                      to + part->split.left + (block->begin - block->left_before), block->centers,
                      block_items(top, block), block->count, &part->split, &part->grid);
}

/* Cuts the parts first…end−1 that are too large for a subtree into blocks. */
static void make_blocks(struct top *top, size_t first, size_t end)
{
    top->block_count = 0;
    for (size_t i = first; i < end; i++) {
        struct part *part = &top->parts[i];
        uint32_t count = part->range.count;
        if (count <= top->subtree)
            continue;
        part->grid = turner_grid_of(&part->range);
        for (uint32_t k = 0; k < turner_pieces(count, BLOCK); k++) {
            struct block *block = TURNER_PUSH(top->blocks, top->block_count, top->block_capacity);
            block->part = (uint32_t)i;
            block->begin = k * BLOCK;
            block->count = turner_piece_end(count, BLOCK, k) - block->begin;
            block->centers[0] = block->centers[1] = TURNER_BOX4_EMPTY;
        }
    }
}

/* How to divide the part of these blocks, and what of it falls to each of them. */
static void choose_split(struct part *part, struct block *blocks, size_t count)
{
    struct turner_bins bins = blocks[0].bins;
    for (size_t i = 1; i < count; i++)
        turner_bins_join(&bins, &blocks[i].bins, &part->grid);
    part->split = turner_bins_split(&bins, &part->grid);
    part->halve = part->split.axis < 0 || !turner_subtree_may_split(part->range.count, part->level);
    uint32_t before = 0;
    for (size_t i = 0; i < count && !part->halve; i++) {
        uint32_t left = 0;
        for (int bin = 0; bin < part->split.bin; bin++)
            left += blocks[i].bins.count[part->split.axis][bin];
        blocks[i].left_before = before;
        before += left;
    }
}

static void add_children(struct top *top, uint32_t index, const struct block *blocks, size_t count)
{
    struct turner_range children[2];
    const struct part *part = &top->parts[index];
    if (part->halve) {
        turner_subtree_halve(&top->builder, children, &part->range, part->level);
    } else {
        for (uint32_t side = 0; side < 2; side++) {
            struct turner_range *child = &children[side];
            child->begin = part->range.begin + (side ? part->split.left : 0);
            child->count = side ? part->range.count - part->split.left : part->split.left;
            child->box = part->split.box[side];
            child->centers = TURNER_BOX4_EMPTY;
            for (size_t i = 0; i < count; i++)
                turner_box4_grow(&child->centers, blocks[i].centers[side].lo,
                                 blocks[i].centers[side].hi);
        }
    }
    uint32_t level = part->level + 1;
    top->parts[index].children = (uint32_t)top->part_count;
    for (int side = 0; side < 2; side++)
        *TURNER_PUSH(top->parts, top->part_count, top->part_capacity) =
            (struct part){.range = children[side], .level = level};
}

/* The end of the blocks that are of the same part as `begin`. */
static size_t blocks_end(const struct top *top, size_t begin)
{
    size_t end = begin;
    while (end < top->block_count && top->blocks[end].part == top->blocks[begin].part)
        end++;
    return end;
}

static void divide_top(struct top *top)
{
    for (size_t first = 0, end = 1; first < end; first = end, end = top->part_count) {
        make_blocks(top, first, end);
        turner_parallel_for((uint32_t)top->block_count, bin_block, top);
        for (size_t i = 0, next; i < top->block_count; i = next) {
            next = blocks_end(top, i);
            choose_split(&top->parts[top->blocks[i].part], &top->blocks[i], next - i);
        }
        turner_parallel_for((uint32_t)top->block_count, move_block, top);
        for (size_t i = 0, next; i < top->block_count; i = next) {
            next = blocks_end(top, i);
            add_children(top, top->blocks[i].part, &top->blocks[i], next - i);
        }
    }
}

/* Gives every node of the top its place, and every subtree room for the most it may have. */
static size_t number_parts(struct top *top, uint32_t index, size_t place)
{
    struct part *part = &top->parts[index];
    part->place = place;
    if (!part->children) {
        top->subtrees[top->subtree_count++] = index;
        return place + (part->range.count > 1 ? part->range.count - 1 : 0);
    }
    place = number_parts(top, part->children, place + 1);
    return number_parts(top, part->children + 1, place);
}

static void build_subtree(void *user, uint32_t i)
{
    struct top *top = user;
    struct part *part = &top->parts[top->subtrees[i]];
    part->tree = turner_subtree_build(&top->builder, &part->range, part->level, part->place);
}

/* Closes the gaps that subtrees left. Returns where the part's last node ends, and sets the levels
 * of nodes from it down. */
static size_t move_parts(struct top *top, uint32_t index, size_t place)
{
    struct part *part = &top->parts[index];
    part->moved = place;
    if (!part->children)
        return place + part->tree.nodes;
    place = move_parts(top, part->children, place + 1);
    place = move_parts(top, part->children + 1, place);
    const struct part *left = &top->parts[part->children], *right = left + 1;
    uint32_t below =
        left->tree.levels > right->tree.levels ? left->tree.levels : right->tree.levels;
    part->tree.levels = 1 + below;
    return place;
}

static void move_subtree(struct turner_gpu_node *nodes, const struct part *part)
{
    uint32_t distance = (uint32_t)(part->place - part->moved);
    for (size_t i = 0; distance > 0 && i < part->tree.nodes; i++) {
        struct turner_gpu_node *node = &nodes[part->moved + i];
        *node = nodes[part->place + i];
        for (int side = 0; side < 2; side++)
            node->child[side] -= node->count[side] ? 0 : distance;
    }
}

static void write_top(struct top *top)
{
    struct turner_gpu_node *nodes = top->builder.nodes;
    for (uint32_t i = 0; i < top->subtree_count; i++)
        move_subtree(nodes, &top->parts[top->subtrees[i]]);
    for (size_t i = 0; i < top->part_count; i++) {
        const struct part *part = &top->parts[i];
        for (int side = 0; part->children && side < 2; side++) {
            const struct part *child = &top->parts[part->children + (uint32_t)side];
            bool leaf = child->tree.is_leaf;
            turner_node_set(&nodes[part->moved], side, &child->range.box,
                            leaf ? top->builder.first + child->range.begin : (uint32_t)child->moved,
                            leaf ? child->range.count : 0);
        }
    }
}

uint32_t turner_bvh_build(struct turner_gpu_node *nodes, size_t *node_count,
                          struct turner_bvh_item *items, struct turner_bvh_item *spare,
                          uint32_t count, uint32_t leaf, uint32_t first)
{
    struct top top = {.builder = {nodes, {items, spare}, leaf, first},
                      .subtree = count / SUBTREES > SUBTREE ? count / SUBTREES : SUBTREE};
    struct part root = {.range = {.count = count}};
    turner_range_measure(&root.range, items);
    *TURNER_PUSH(top.parts, top.part_count, top.part_capacity) = root;
    divide_top(&top);
    top.subtrees = turner_calloc(top.part_count, sizeof *top.subtrees);
    number_parts(&top, 0, *node_count);
    turner_parallel_for(top.subtree_count, build_subtree, &top);
    *node_count = move_parts(&top, 0, *node_count);
    write_top(&top);
    uint32_t levels = top.parts[0].tree.levels;
    free(top.subtrees);
    free(top.blocks);
    free(top.parts);
    return levels;
}
