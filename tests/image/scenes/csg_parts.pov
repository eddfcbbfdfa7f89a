// SPDX-License-Identifier: AGPL-3.0-or-later
// Difference, intersection and merge with transparent parts, nested and inverse.
// Surfaces inside other parts do not count in a merge and do in a union.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
#declare Two = array[2] { sphere { 0, 0.45 }, box { <0, -0.3, -0.3>, <0.8, 0.3, 0.3> } }
union { object { Two[0] } object { Two[1] } pigment { Grey } finish { Clear } translate <-1.9, 0.8, -0.6> }
merge { object { Two[0] } object { Two[1] } pigment { Grey } finish { Clear } translate <-0.3, 0.8, -0.6> }
difference {
  object { Two[1] } cylinder { <0.4, -1, 0>, <0.4, 1, 0>, 0.2 } sphere { <0.8, 0.3, 0>, 0.25 }
  pigment { rgbf <0.8, 0.6, 0.3, 1> } finish { Clear } translate <1.2, 0.8, -0.6>
}
intersection {
  sphere { 0, 0.6 pigment { Red } finish { Clear } } sphere { 0.4*x, 0.6 pigment { Blue } finish { Clear } } box { -0.3, 0.7 inverse pigment { Grey } finish { Clear } }
  translate <-1.2, 0.8, 0.9>
}
difference { sphere { 0, 0.55 texture { WhiteMatte } } box { <-0.2, -1, -0.2>, <0.2, 1, 0.2> texture { WhiteMatte } } translate <0.6, 0.8, 1.1> }
