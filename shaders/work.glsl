// How the work of a dispatch, so many samples or rays in groups, is shared out. A GPU gives each lane
// the one of its number. A CPU device would give each of its threads a consecutive piece of all,
// perhaps one of nothing but sky, and wait for the last; so its subgroups take groups one by one, until
// none is left.
const uint GROUP = TURNER_WORKGROUP * TURNER_WORKGROUP;

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer counter_block
{
    turner_gpu_counters the;
};

// Whether there is work for this subgroup, or work once more, and which item is this lane's: it may
// lie behind the last.
bool take_work(bool first, inout uint item)
{
    if (dispatch.groups == 0u) {
        uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
        item = group * GROUP + gl_LocalInvocationIndex;
        return first;
    }
    item += gl_SubgroupSize;
    if (first || item % GROUP < gl_SubgroupSize) {
        uint group = 0u;
        if (gl_SubgroupInvocationID == 0u)
            group = atomicAdd(counter_block(dispatch.counters).the.group, 1u);
        item = subgroupBroadcast(group, 0u) * GROUP + gl_SubgroupInvocationID;
    }
    return item / GROUP < dispatch.groups;
}
