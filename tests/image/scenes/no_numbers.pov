// SPDX-License-Identifier: AGPL-3.0-or-later
// Casters that no number describes: absorption, densities, colours and shapes that are infinite or not a number; and media that make light.
// Their shadows are those of rays; no picture has a number that is none, and no program falls over.
// Truth: ray-traced. The casters themselves are not seen.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
#ifndef (Kind) #declare Kind = 0; #end
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
#declare Endless = 1e400;
#declare Nothing = Endless - Endless;
#macro Ball(P, Absorbed, Density)
  sphere { P, 0.5 hollow no_image no_reflection pigment { rgbt 1 } interior { media { method 2 intervals 1 samples MS absorption Absorbed density { Density } } } }
#end
#switch (Kind)
#case (0)
  Ball(<-1.2, 1, 0>, Endless, rgb 1)
  Ball(<0, 1, 0.2>, Nothing, rgb 1)
  Ball(<1.2, 1, 0>, <1e300, 0.5, 0>, rgb 1)
#break
#case (1)
  Ball(<-1.2, 1, 0>, 1, rgb Endless)
  Ball(<0, 1, 0.2>, 1e30, rgb 1e30)
  #declare Core = density { spherical translate <1.2, 1, 0> color_map { [0 rgb 1e300] [1 rgb Endless] } }
  Ball(<1.2, 1, 0>, 1, Core)
#break
#case (2)
  sphere { <-1, 1, 0>, 0.5 no_image pigment { rgbt Nothing } }
  sphere { <1, 1, 0>, 0.5 hollow no_image pigment { rgbt 1 } interior { fade_distance 1e-300 fade_power 1e9 } }
#break
#case (3)
  sphere { Nothing*x, 1 }
  sphere { 0, Nothing }
  triangle { x, y, Nothing*z }
  blob { threshold 0.5 sphere { 0, 1, Nothing } }
  cylinder { 0, Endless*y, 0.1 }
  mesh { triangle { -x, y, z } triangle { x, y, Endless*z } }
  sphere { 0, 1 translate 1e200*x pigment { rgbt 1 } }
  sphere { <1, 1, 0>, 0.5 no_image }
#break
#case (4)
  #declare Undefined = density { function { ln(x - 100) } color_map { [0 rgb 1] [1 rgb 3] } }
  Ball(<-1, 1, 0>, 1, Undefined)
  sphere { <1, 1, 0>, 0.5 no_image pigment { function { sqrt(x - 100) } color_map { [0 rgbt 0.5] [1 rgbt 1] } } }
#break
#case (5)
  Ball(<-1.2, 1, 0>, -0.5, rgb 1)
  Ball(<0, 1, 0.2>, 1, rgb <-1e30, -0.1, 0>)
  Ball(<1.2, 1, 0>, -Endless, rgb 1)
#break
#case (6)
  #declare Rim = density { spherical translate <-1.2, 1, 0> color_map { [0.5 rgb -0.8] [0.8 rgb 2] } }
  #declare Halves = density { function { x } color_map { [0 rgb 1] [0 rgb -0.7] } }
  Ball(<-1.2, 1, 0>, 1, Rim)
  Ball(<0, 1, 0.2>, 1, Halves)
  union { Ball(<1.2, 1, 0>, 1, rgb 1) Ball(<1.2, 1.2, 0>, <-1.2, -0.2, 0>, rgb 1) }
#break
#end
