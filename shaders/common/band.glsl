// Taught by 02_basic.
//
// The pixel that an invocation of a raygen shader traces.

// ANCHOR: band
// A picture is traced in bands of rows. The record of the raygen shader in the shader binding table says
// where the band begins.
layout(shaderRecordEXT, scalar) buffer Band { uvec2 first; } band;

uvec2 pixel_id() {
    return band.first + gl_LaunchIDEXT.xy;
}
// ANCHOR_END: band
