// SPDX-License-Identifier: AGPL-3.0-or-later
// Interior fading: fade_power 1, 2 and 1001 (exponential), with fade_color; a shell and nested balls.
// Shadows deepen with the way through the glass.
// Truth: ray-traced; one factor from a light-side surface to the next hit.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
#macro Ball(X, Z, R, P) sphere { <X, 0.8, Z>, R pigment { rgbf 1 } finish { Clear } interior { ior 1 fade_distance 0.4 fade_power P fade_color <0.8, 0.4, 0.1> } } #end
Ball(-1.8, -0.6, 0.5, 1)
Ball(-0.4, -0.6, 0.5, 2)
Ball(1.0, -0.6, 0.5, 1001)
box { <-2.0, 0.4, 0.7>, <-1.2, 1.2, 1.3> pigment { rgbf 1 } finish { Clear } interior { ior 1 fade_distance 0.5 fade_power 2 } }
difference {
  sphere { 0, 0.55 } sphere { 0, 0.4 }
  pigment { rgbf 1 } finish { Clear } interior { ior 1 fade_distance 0.2 fade_power 1001 fade_color <0.2, 0.6, 0.9> } translate <0.0, 0.8, 1.2>
}
Ball(1.5, 1.2, 0.55, 2)
Ball(1.5, 1.2, 0.25, 1001)
