// SPDX-License-Identifier: AGPL-3.0-or-later
// Two transparent infinite planes above the floor, tinted and checkered.
// Their filters multiply with the map's shadows.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
plane { y, 2 pigment { rgbf <1, 0.8, 0.6, 1> } finish { Clear } }
plane { y, 2.5 pigment { checker rgbt 1 rgbf <0.4, 0.7, 0.9, 1> scale 0.6 } finish { Clear } }
sphere { <-0.8, 0.6, 0.2>, 0.5 texture { WhiteMatte } }
sphere { <0.8, 0.6, 0.2>, 0.5 pigment { Green } finish { Clear } }
