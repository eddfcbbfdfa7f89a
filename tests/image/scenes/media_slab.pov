// SPDX-License-Identifier: AGPL-3.0-or-later
// A homogeneous slab of optical depth 1 between a light straight above and the floor.
// The floor is exp(-1) = 0.367879 everywhere (declare Truth=1: painted so).
// Truth: closed form.
#version 3.7;
global_settings { assumed_gamma 1 }
#declare NoFloor = 1; #declare Eye = <0, 3, -3>; #declare At = <0, 0, 0>;
#include "stage.inc"
light_source {
  <0, 20, 0>, rgb 1
  parallel point_at 0
  deep_shadow { resolution 64 }
}
box { <-9, -0.2, -9>, <9, 0, 9> pigment { rgb #if (Truth) exp(-1) #else 1 #end } finish { ambient 0 diffuse 1 } }
#if (!Truth)
  box {
    <-8, 4, -8>, <8, 6, 8> hollow pigment { rgbt 1 }
    interior { media { method 2 intervals 1 samples MS absorption rgb 0.5 } }
  }
#end
