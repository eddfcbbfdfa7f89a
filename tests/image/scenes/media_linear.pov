// SPDX-License-Identifier: AGPL-3.0-or-later
// Linear density: it grows along the light's way (left: downward) and across it, in colours.
// The floor darkens to the right by exp(-tau), tau linear in x.
// Truth: closed form (Truth=1 paints it).
#version 3.7;
global_settings { assumed_gamma 1 }
#declare NoFloor = 1; #declare Eye = <0, 3, -3>; #declare At = <0, 0, 0>;
#include "stage.inc"
light_source {
  <0, 20, 0>, rgb 1
  parallel point_at 0
  deep_shadow { resolution 256 }
}
// Density (y - 4)/2 * (x + 4)/8 in a box 2 high: tau = extinction * (x + 4)/8.
#declare K = <0.8, 1.6, 2.4>;
box {
  <-9, -0.2, -9>, <9, 0, 9>
  #if (Truth)
    pigment { average pigment_map {
      [1 function { exp(-0.8*(x + 4)/8) } color_map { [0 rgb 0] [1 red 3] }]
      [1 function { exp(-1.6*(x + 4)/8) } color_map { [0 rgb 0] [1 green 3] }]
      [1 function { exp(-2.4*(x + 4)/8) } color_map { [0 rgb 0] [1 blue 3] }]
    } }
  #else pigment { rgb 1 } #end
  finish { ambient 0 diffuse 1 }
}
#if (!Truth)
  box {
    <-4, 4, -8>, <4, 6, 8> hollow pigment { rgbt 1 }
    interior { media { method 2 intervals 1 samples MS absorption rgb K
      density { function { (y - 4)/2*(x + 4)/8 } color_map { [0 rgb 0] [1 rgb 1] } } } }
  }
#end
