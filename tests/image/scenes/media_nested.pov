// SPDX-License-Identifier: AGPL-3.0-or-later
// Containers of fog, nested and overlapping, of different colours.
// Extinctions add up where they share space, in the shadow as in the view.
// Truth: ray-traced with many samples.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
#macro Fog(P, R, K) sphere { P, R hollow pigment { rgbt 1 } interior { media { method 2 intervals 1 samples MS absorption rgb K } } } #end
Fog(<-1.2, 1.0, -0.2>, 0.8, <0.2, 0.6, 0.9>)
Fog(<-1.2, 1.0, -0.2>, 0.4, <1.5, 0.4, 0.2>)
Fog(<0.8, 0.9, 0.2>, 0.6, <0.9, 0.3, 0.3>)
Fog(<1.4, 0.9, 0.2>, 0.6, <0.3, 0.9, 0.3>)
box { <0.4, 0.3, -0.4>, <1.8, 0.5, 0.8> hollow pigment { rgbt 1 } interior { media { method 2 intervals 1 samples MS absorption <0.3, 0.3, 1.8> } } }
