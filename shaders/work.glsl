// How the work of a dispatch, so many samples or rays, is shared out. A GPU gives each lane the one of
// its number. A CPU device would give each of its threads a consecutive piece of all, perhaps one of
// nothing but sky, and wait for the last; so its subgroups take packets, one item for each of their
// lanes, until none is left.
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer counter_block
{
    turner_gpu_counters the;
};

// Whether there is work for this subgroup, or work once more, and which item is this lane's: it may
// lie behind the last.
bool take_work(bool first, inout uint item)
{
    if (dispatch.packets == 0u) {
        uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
        item = group * (TURNER_WORKGROUP * TURNER_WORKGROUP) + gl_LocalInvocationIndex;
        return first;
    }
    uint packet = 0u;
    if (subgroupElect())
        packet = atomicAdd(counter_block(dispatch.counters).the.packet, 1u);
    packet = subgroupBroadcastFirst(packet);
    item = packet * gl_SubgroupSize + gl_SubgroupInvocationID;
    return packet < dispatch.packets;
}
