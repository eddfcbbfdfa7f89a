// SPDX-License-Identifier: AGPL-3.0-or-later
// A bubble: a spherical density whose map lets only a shell of a twentieth of its radius through.
// The shadow is faint in the middle and dark at the rim; no ring may be missing.
// Truth: closed form (Truth=1 paints it).
#version 3.7;
global_settings { assumed_gamma 1 }
#declare NoFloor = 1; #declare Eye = <0.6, 1.6, -0.6>; #declare At = <0.6, 0, 0>; #declare Angle = 34;
#include "stage.inc"
light_source {
  <0, 20, 0>, rgb 1
  parallel point_at 0
  deep_shadow { resolution 2048 }
}
#declare K = 8;
#declare Chord = function (x, z, R) { 2*sqrt(max(0, R*R - x*x - z*z)) }
box {
  <-9, -0.2, -9>, <9, 0, 9>
  #if (Truth) pigment { function { exp(-K*(Chord(x, z, 0.80) - Chord(x, z, 0.76))) } color_map { [0 rgb 0] [1 rgb 1] } }
  #else pigment { rgb 1 } #end
  finish { ambient 0 diffuse 1 }
}
#if (!Truth)
  sphere {
    <0, 5, 0>, 1.2 hollow pigment { rgbt 1 }
    interior { media { method 2 intervals 1 samples MS absorption rgb K
      density { spherical density_map { [0.20 rgb 0] [0.20 rgb 1] [0.24 rgb 1] [0.24 rgb 0] } translate y*5 } } }
  }
#end
