// Which invocation of a dispatch this is, counted from 0.
//
// A device need take no more than 65535 workgroups in a row, so that a dispatch has some rows of them, and the last
// row reaches beyond what there is to do.
uint invocation() {
    uint workgroup = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    return workgroup * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
}
