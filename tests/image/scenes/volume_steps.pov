// SPDX-License-Identifier: AGPL-3.0-or-later
// A density file that grows upward, and a map that lets a thin part of its range through: a sheet a sixth of a voxel high.
// The floor is one grey, darker than white by that sheet, and by its thinner twin where the last voxel falls to the first.
// Truth: closed form.
#version 3.7;
global_settings { assumed_gamma 1 }
#declare NoFloor = 1; #declare Eye = <0, 3, -3>; #declare At = <0, 0, 0>;
#include "stage.inc"
#include "df3.inc"
light_source {
  <0, 20, 0>, rgb 1
  parallel point_at 0
  deep_shadow { resolution 64 }
}
#declare Layer = function (x, y, z) { 32*y }
#declare K = 10;
#declare Thickness = 0.02/(32/255*8/2) + 0.02/(224/255*8/2);  // the box is 2 high, in 8 layers
box { <-9, -0.2, -9>, <9, 0, 9> pigment { rgb #if (Truth) exp(-K*Thickness) #else 1 #end } finish { ambient 0 diffuse 1 } }
#if (!Truth)
  Write_df3("volume_steps.df3", 8, Layer)
  box {
    <-8, 4, -8>, <8, 6, 8> hollow pigment { rgbt 1 }
    interior { media { method 2 intervals 1 samples MS absorption rgb K
      density { density_file df3 "volume_steps.df3" interpolate 1 translate -0.5 scale <16, 2, 16> translate y*5
        density_map { [0.40 rgb 0] [0.40 rgb 1] [0.42 rgb 1] [0.42 rgb 0] } } } }
  }
#end
