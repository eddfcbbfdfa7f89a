// SPDX-License-Identifier: AGPL-3.0-or-later
// Two densities multiply: two layers of a density file, and one that nothing is known of; a second medium adds.
// The floor darkens to the right, in colours.
// Truth: closed form (Truth=1 paints it).
#version 3.7;
global_settings { assumed_gamma 1 }
#declare NoFloor = 1; #declare Eye = <0, 3, -3>; #declare At = <0, 0, 0>;
#include "stage.inc"
#include "df3.inc"
light_source {
  <0, 20, 0>, rgb 1
  parallel point_at 0
  deep_shadow { resolution 256 }
}
#declare Both = function (x, y, z) { 255*select(abs(y - 2.5) - 0.7, 1, 1, 0) }
box {
  <-9, -0.2, -9>, <9, 0, 9>
  #if (Truth)
    pigment { average pigment_map {
      [1 function { exp(-0.2 - 4*0.5*(x + 4)/8) } color_map { [0 rgb 0] [1 red 3] }]
      [1 function { exp(-0.2 - 2*0.5*(x + 4)/8) } color_map { [0 rgb 0] [1 green 3] }]
      [1 function { exp(-0.2 - 1*0.5*(x + 4)/8) } color_map { [0 rgb 0] [1 blue 3] }]
    } }
  #else pigment { rgb 1 } #end
  finish { ambient 0 diffuse 1 }
}
#if (!Truth)
  Write_df3("volume_product.df3", 8, Both)
  box {
    <-4, 4, -8>, <4, 6, 8> hollow pigment { rgbt 1 }
    interior {
      media { method 2 intervals 1 samples MS absorption rgb <4, 2, 1>
        density { density_file df3 "volume_product.df3" translate -0.5 scale <8, 2, 16> translate y*5 color_map { [0 rgb 0] [1 rgb 1] } }
        density { function { (x + 4)/8 } color_map { [0 rgb 0] [1 rgb 1] } }
      }
      media { method 2 intervals 1 samples MS absorption rgb 0.1 }
    }
  }
#end
