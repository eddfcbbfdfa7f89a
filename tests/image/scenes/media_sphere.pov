// SPDX-License-Identifier: AGPL-3.0-or-later
// A ball of homogeneous fog between a light straight above and the floor.
// The shadow is exp(-2 sqrt(1 - r r)): soft in the middle, steep at the rim.
// Truth: closed form (Truth=1 paints it).
#version 3.7;
global_settings { assumed_gamma 1 }
#declare NoFloor = 1; #declare Eye = <0, 2.8, -2>; #declare At = <0, 0, 0.1>; #declare Angle = 50;
#include "stage.inc"
light_source {
  <0, 20, 0>, rgb 1
  parallel point_at 0
  deep_shadow { resolution 512 }
}
box {
  <-9, -0.2, -9>, <9, 0, 9>
  #if (Truth) pigment { function { exp(-2*sqrt(max(0, 1 - x*x - z*z))) } color_map { [0 rgb 0] [1 rgb 1] } }
  #else pigment { rgb 1 } #end
  finish { ambient 0 diffuse 1 }
}
#if (!Truth)
  sphere { <0, 5, 0>, 1 hollow pigment { rgbt 1 } interior { media { method 2 intervals 1 samples MS absorption rgb 1 } } }
#end
