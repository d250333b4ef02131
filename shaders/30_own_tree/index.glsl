// The shape of most workgroups, and which invocation of a dispatch this is.

const uint WIDTH = 64;
layout(local_size_x = WIDTH) in;

// Counted from 0. A device need take no more than 65535 workgroups in a row, so that a dispatch has some rows of
// them; the last row reaches beyond what there is to do.
uint invocation() {
    uint workgroup = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    return workgroup * WIDTH + gl_LocalInvocationIndex;
}
