// SPDX-License-Identifier: AGPL-3.0-or-later
// Panes whose pigment depends on the slope and on the angle to the ray (slope, aoi).
// The shadow of the tilted panes has the colour of their receiver's side; the ball's shadow has rings.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
#declare Tilt = pigment { slope y color_map { [0.35 rgbf <1, 0.3, 0.1, 1>] [0.65 rgbf <0.1, 0.4, 1, 1>] } }
#declare Ring = pigment { aoi color_map { [0 rgbf <0.1, 0.2, 0.9, 1>] [0.25 rgbf <0.9, 0.9, 0.3, 1>] [0.5 rgbf <0.9, 0.1, 0.2, 1>] [1 rgbf <0.3, 0.9, 0.9, 1>] } }
#for (I, 0, 3)
  disc { 0, y, 0.55 rotate (I*60 - 90)*z translate <-1.9 + 1.2*I, 1.1, -0.6> pigment { Tilt } finish { Clear } }
#end
sphere { <-1.3, 0.8, 1.0>, 0.55 pigment { Ring } finish { Clear } }
sphere { <0.2, 0.8, 1.0>, 0.55 pigment { Tilt } finish { Clear } }
disc { <1.5, 0.9, 1.0>, y, 0.6 pigment { Ring } finish { Clear } }
