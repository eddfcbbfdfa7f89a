// SPDX-License-Identifier: AGPL-3.0-or-later
// Two lights at once, one with a map and one without, and a third with its own settings.
// Every shadow has its own light's colour; the green one is ray-traced under Shadow_Method=scene.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb <0.6, 0.1, 0.1>
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
light_source { <3, 6, -1.5>, rgb <0.1, 0.5, 0.1> }
light_source {
  <0, 5, 4>, rgb <0.1, 0.1, 0.6>
  deep_shadow { resolution 700 samples 9 tolerance 0.01 }
}
sphere { <-1.0, 0.9, -0.2>, 0.5 texture { WhiteMatte } }
sphere { <0.8, 0.9, 0.2>, 0.5 pigment { Grey } finish { Clear } }
cylinder { <-0.4, 0.5, 1.2>, <1.2, 0.9, 1.2>, 0.15 texture { WhiteMatte } }
