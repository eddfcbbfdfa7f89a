// SPDX-License-Identifier: AGPL-3.0-or-later
// Panes 0.0005 thick beside panes of the same glass 0.01 thick.
// Both surfaces of a thin pane count (stock ignores a hit within 0.001 of the last: a documented deviation).
// Truth: ray-traced with Thickness=0.01.
#version 3.7;
global_settings { assumed_gamma 1 }
#ifndef (Thickness) #declare Thickness = 0.0005; #end
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
#macro Pane(X, Z, T, C) box { <X, 0.8, Z>, <X + 0.9, 0.8 + T, Z + 0.9> pigment { C } finish { Clear } no_image } #end
Pane(-1.5, -0.9, Thickness, Grey)
Pane(0.3, -0.9, 0.01, Grey)
Pane(-1.5, 0.5, Thickness, rgbf <0.9, 0.6, 0.3, 1>)
Pane(0.3, 0.5, 0.01, rgbf <0.9, 0.6, 0.3, 1>)
