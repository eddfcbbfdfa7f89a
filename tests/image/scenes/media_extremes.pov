// SPDX-License-Identifier: AGPL-3.0-or-later
// Slabs of optical depth 1e-9 and 10,000, one below the other, straight under the light; the dense one covers the right half.
// The left half is white, the right half black, and no colour between but at the border.
// Truth: closed form.
#version 3.7;
global_settings { assumed_gamma 1 }
#declare NoFloor = 1; #declare Eye = <0, 3, -3>; #declare At = <0, 0, 0>;
#include "stage.inc"
light_source {
  <0, 20, 0>, rgb 1
  parallel point_at 0
  deep_shadow { resolution 4096 }
}
box { <-9, -0.2, -9>, <9, 0, 9>
  pigment { #if (Truth) gradient x color_map { [0.5 rgb 1] [0.5 rgb 0] } scale 18 translate -9*x #else rgb 1 #end } finish { ambient 0 diffuse 1 } }
#macro Slab(Left, Low, High, Depth)
  box {
    <Left, Low, -8>, <8, High, 8> hollow pigment { rgbt 1 }
    interior { media { method 2 intervals 1 samples MS absorption rgb Depth/(High - Low) } }
  }
#end
#if (!Truth)
  Slab(-8, 6, 7, 1e-9)
  Slab(0, 4, 4.001, 1e4)
#end
