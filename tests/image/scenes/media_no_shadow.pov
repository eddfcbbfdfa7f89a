// SPDX-License-Identifier: AGPL-3.0-or-later
// Fog in a no_shadow container, fog below a no_shadow ball, and fog that holds a no_shadow ball.
// A no_shadow container neither dims light nor opens or closes others.
// Truth: ray-traced with many samples.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
#macro Fog(P, R, K) sphere { P, R hollow pigment { rgbt 1 } interior { media { method 2 intervals 1 samples MS absorption rgb K } } #end
Fog(<-1.7, 0.8, 0>, 0.6, <1, 1, 0.5>) no_shadow }
Fog(<-0.1, 0.7, 0>, 0.6, <1, 0.5, 1>) }
sphere { <-0.4, 1.8, -0.2>, 0.3 texture { WhiteMatte } no_shadow }
Fog(<1.6, 0.8, 0>, 0.7, <0.5, 1, 1>) }
sphere { <1.6, 0.8, 0>, 0.35 texture { WhiteMatte } no_shadow }
