// SPDX-License-Identifier: AGPL-3.0-or-later
// Light at 89.99 degrees to the floor's normal, and 5,700 times as bright as it looks; or, with posts, at any angle (Low, degrees
// above the floor): their shadows are many times longer than they are.
// The floor is lit without acne, and shadows start at the foot of what casts them.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#ifdef (Low) #declare Posts = 1; #else #declare Posts = 0; #declare Low = 0.01; #end
#declare Rise = radians(Low);
#include "stage.inc"
light_source {
  <-cos(Rise), sin(Rise), 0.1*cos(Rise)>*20, rgb 1/sin(Rise)
  #ifdef (Sun) parallel point_at 0 #end
  deep_shadow { resolution 1024 }
}
#if (Posts)
  box { <-1.5, 0, 1>, <-1.4, 0.3, 1.2> pigment { rgb 0 } }
  cylinder { <-1, 0, -0.5>, <-1, 0.05, -0.5>, 0.05 pigment { rgb 0 } }
#end
