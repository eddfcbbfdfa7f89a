// SPDX-License-Identifier: AGPL-3.0-or-later
// CSG of differently transparent textures: cutaway_textures and each part's own texture.
// The flat faces and the round ones throw shadows of different colours.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
intersection {
  box { -0.6, 0.6 pigment { Red } finish { Clear } }
  sphere { 0, 0.75 pigment { Blue } finish { Clear } }
  translate <-1.4, 0.9, 0>
}
difference {
  box { -0.6, 0.6 pigment { Green } finish { Clear } }
  cylinder { -z, z, 0.4 }
  cutaway_textures
  rotate 20*y translate <0.3, 0.9, -0.4>
}
difference {
  sphere { 0, 0.6 pigment { Red } finish { Clear } }
  sphere { 0.35*y, 0.45 pigment { Green } finish { Clear } }
  translate <1.7, 0.9, 0.3>
}
merge {
  sphere { 0, 0.4 } box { <0, -0.3, -0.3>, <0.8, 0.3, 0.3> }
  texture { pigment { Blue } finish { Clear } }
  translate <-0.3, 0.7, 1.4>
}
