// SPDX-License-Identifier: AGPL-3.0-or-later
// A transparent parametric surface.
// A shell with an open side: light is filtered once or twice.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 128 samples 4 }
}
parametric {
  function { 0.8*cos(u)*cos(v) }
  function { 0.8*sin(v) }
  function { 0.8*sin(u)*cos(v) }
  <0, -1.2>, <4.5, 1.2>
  contained_by { box { -0.85, 0.85 } }
  accuracy 0.00002 max_gradient 1.2 precompute 14 x, y, z
  pigment { rgbf <0.5, 0.7, 0.8, 1> } finish { Clear }
  translate <0, 1.1, 0>
}
