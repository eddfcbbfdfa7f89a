// SPDX-License-Identifier: AGPL-3.0-or-later
// A layered density file as a slab between a light straight above and the floor; Tilt turns and stretches it.
// The floor is one grey: every interpolation (Mode 0, 1, 2) keeps the mean of the layers.
// Truth: closed form.
#version 3.7;
global_settings { assumed_gamma 1 }
#ifndef (Mode) #declare Mode = 0; #end
#ifndef (Tilt) #declare Tilt = 0; #end
#declare NoFloor = 1; #declare Eye = <0, 3, -3>; #declare At = <0, 0, 0>;
#include "stage.inc"
#include "df3.inc"
light_source {
  <0, 20, 0>, rgb 1
  parallel point_at 0
  deep_shadow { resolution 64 }
}
#declare Layer = function (x, y, z) { int(128 + 90*sin(2*pi*y/9) + 0.5) }
#declare Sum = 0;
#for (J, 0, 8) #declare Sum = Sum + Layer(0, J, 0)/255; #end
#declare K = 0.9;  // a unit of length; the slab is 2 high, in 9 layers
box { <-9, -0.2, -9>, <9, 0, 9> pigment { rgb #if (Truth) exp(-K*2*Sum/9/cos(radians(Tilt))) #else 1 #end } finish { ambient 0 diffuse 1 } }
#if (!Truth)
  #declare Name = concat("volume_slab_", str(Mode, 0, 0), "_", str(Tilt, 0, 0), ".df3");
  Write_df3(Name, 9, Layer)
  box {
    <-16, -1, -8>, <16, 1, 8> hollow pigment { rgbt 1 }
    interior { media { method 2 intervals 1 samples MS absorption rgb K
      density { density_file df3 Name interpolate Mode translate -0.5 scale <32, 2, 16> color_map { [0 rgb 0] [1 rgb 1] } } } }
    rotate z*Tilt
    translate y*12
  }
#end
