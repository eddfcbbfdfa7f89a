// SPDX-License-Identifier: AGPL-3.0-or-later
// A glass ball that is not hollow inside fog, and one that is.
// Within the solid ball all fog stops counting; within the hollow one it goes on.
// Truth: ray-traced with many samples.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
#for (I, 0, 1)
  sphere { <-1.2 + 2.4*I, 1.0, 0>, 0.9 hollow pigment { rgbt 1 } interior { media { method 2 intervals 1 samples MS absorption <0.8, 0.9, 1.0> } } }
  sphere { <-1.2 + 2.4*I, 1.0, 0>, 0.5 #if (I) hollow #end pigment { rgbf <0.9, 0.95, 0.8, 1> } finish { Clear } interior { ior 1 } }
#end
