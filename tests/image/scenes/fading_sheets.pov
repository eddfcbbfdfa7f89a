// SPDX-License-Identifier: AGPL-3.0-or-later
// Interior fading in what has no inside, or does not close it: polygon, disc, mesh, patch, open cylinder, height field.
// Their shadows are those of the textures alone where the camera sees them directly, and darker where it looks through them.
// Truth: ray-traced. How light fades there depends on what the camera's ray has passed.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
#declare Water = interior { fade_distance 0.5 fade_power 2 }
#declare Film = texture { pigment { rgbt <0.5, 0.5, 0.5, 0.7> } finish { ambient 0 diffuse 0.5 } }
polygon { 5, <-0.5, -0.5>, <0.5, -0.5>, <0.5, 0.5>, <-0.5, 0.5>, <-0.5, -0.5> rotate 90*x translate <-1.4, 0.7, 0.8> texture { Film } interior { Water } }
disc { <0, 0.7, 0.8>, y, 0.5 texture { Film } interior { Water } }
mesh { triangle { <0.8, 0.7, 0.4>, <1.8, 0.7, 0.4>, <1.3, 0.7, 1.3> } texture { Film } interior { Water } }
bicubic_patch {
  type 1 flatness 0.01 u_steps 3 v_steps 3
  #for (I, 0, 3) #for (J, 0, 3) <I - 1.5, 0, J - 1.5>/3 #if (I + J < 6) , #end #end #end
  translate <-1.4, 0.7, -0.8> texture { Film } interior { Water }
}
cylinder { <0, 0.2, -0.8>, <0, 0.9, -0.8>, 0.35 open texture { Film } interior { Water } }
height_field { function 20, 20 { 0.5 + 0.5*sin(9*x)*sin(7*y) } smooth translate -0.5 scale <1, 0.2, 1> translate <1.3, 0.7, -0.8> texture { Film } interior { Water } }
