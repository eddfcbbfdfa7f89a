// SPDX-License-Identifier: AGPL-3.0-or-later
// Filters above 1 and interior caustics among ordinary shadows.
// Bright spots in the shadows; marked map pixels are ray-traced.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 0.4
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
sphere { <-1.4, 0.8, -0.2>, 0.55 pigment { rgbf 1 } finish { Clear } interior { ior 1.4 caustics 1 } }
box { <-0.5, 0.8, -0.8>, <0.3, 0.82, 0> pigment { rgbf <1.5, 1.2, 0.7, 1> } finish { Clear } }
box { <0, 0.5, -0.5>, <0.8, 0.52, 0.3> pigment { rgbf <0.5, 0.9, 0.9, 1> } finish { Clear } }
sphere { <1.4, 0.7, 0.3>, 0.45 texture { WhiteMatte } }
box { <-0.4, 0.6, 0.8>, <0.6, 0.62, 1.6> pigment { rgbf <1.3, 1.3, 1.3, 1> } finish { Clear } }
box { <-0.2, 0.9, 0.9>, <0.4, 0.92, 1.4> texture { WhiteMatte } }
