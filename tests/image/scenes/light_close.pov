// SPDX-License-Identifier: AGPL-3.0-or-later
// A light a thousandth of a unit above the floor, and a pane of glass halfway between.
// Half of the light under the pane, all of it beside, the border straight below the light.
// Truth: closed form. POV-Ray itself drops what is so close to a ray's ends.
#version 3.7;
global_settings { assumed_gamma 1 }
#declare NoFloor = 1; #declare Eye = <0, 0.02, -0.02>; #declare At = <0, 0, 0>; #declare Angle = 12;
#include "stage.inc"
#declare Near = 0.001;
light_source {
  Near*y, rgb 1
  spotlight point_at 0 radius 60 falloff 70
  deep_shadow { resolution 512 }
}
box { <-0.02, -0.02, -0.02>, <0.02, 0, 0.02> finish { ambient 0 diffuse 1 }
  pigment { #if (Truth) gradient x color_map { [0.5 rgb 1] [0.5 rgb 0.5] } scale 0.04 translate -0.02*x #else rgb 1 #end } }
#if (!Truth) polygon { 5, 0, 0.01*x, <0.01, 0.01>, 0.01*y, 0 translate -0.005*y rotate 90*x translate Near/2*y
  pigment { rgbf <0.5, 0.5, 0.5, 1> } finish { Clear } no_image } #end
