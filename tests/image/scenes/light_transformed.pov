// SPDX-License-Identifier: AGPL-3.0-or-later
// Lights that are moved and turned after they are made, in a union too.
// Maps follow the light: shadows end where ray tracing has them.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <0, 0, 0>, rgb 0.6
  spotlight point_at -y radius 24 falloff 30
  deep_shadow { resolution 512 }
  rotate 30*z translate <2.6, 5, -0.5>
}
union {
  light_source {
    0, rgb 0.4
    parallel point_at <1, -1, 0.2>
    deep_shadow { resolution 512 }
  }
  sphere { <3.2, -3.4, 0.2>, 0.4 texture { WhiteMatte } }
  rotate 20*y translate <-4, 4, 0.5>
}
sphere { <0.3, 0.7, -0.5>, 0.5 texture { WhiteMatte } }
box { <-1.5, 0.4, -1>, <-0.8, 0.5, 0> pigment { Green } finish { Clear } }
