// SPDX-License-Identifier: AGPL-3.0-or-later
// A wall inside fog, edge-on to the camera's fog: fog above the wall's foot, read at every depth.
// The floor's steps rise into the fog: each is exp(-(way through the fog above it)).
// Truth: ray-traced with many samples; the camera looks through the same fog in both pictures.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
box {
  <-2, -0.1, -1.6>, <2, 2, 1.6> hollow pigment { rgbt 1 }
  interior { media { method 2 intervals 1 samples MS absorption <0.4, 0.7, 1.0> } }
}
#for (I, 0, 4)
  box { <-1.8 + 0.72*I, 0, -1>, <-1.2 + 0.72*I, 0.1 + 0.4*I, 1> texture { WhiteMatte } }
#end
