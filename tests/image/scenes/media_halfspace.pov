// SPDX-License-Identifier: AGPL-3.0-or-later
// Fog in a container without end: all of space below a plane.
// Shadows and the fog's extinction on the light's way are those of the ray tracer.
// Truth: ray-traced with many samples.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
plane {
  y, 1 hollow pigment { rgbt 1 }
  interior { media { method 2 intervals 1 samples MS absorption <0.2, 0.4, 0.6> } }
}
sphere { <-1.2, 0.6, -0.2>, 0.4 texture { WhiteMatte } }
sphere { <1.0, 0.8, 0.4>, 0.5 pigment { Red } finish { Clear } }
