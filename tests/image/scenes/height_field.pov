// SPDX-License-Identifier: AGPL-3.0-or-later
// A transparent height field (from a function) with folds.
// A light ray crosses several folds and is filtered at each.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-5, 3.5, -1.5>, rgb 1
  spotlight point_at <0.3, 0, 0> radius 26 falloff 32
  deep_shadow { resolution 512 }
}
height_field {
  function 40, 40 { 0.5 + 0.4*sin(x*25)*cos(y*18) }
  pigment { rgbf <0.8, 0.7, 0.5, 1> } finish { Clear }
  translate <-0.5, 0, -0.5> scale <2.6, 0.7, 2.6> translate <-0.6, 0.4, 0>
}
