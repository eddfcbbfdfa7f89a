// SPDX-License-Identifier: AGPL-3.0-or-later
// Lights that cannot have a frame: a cone of no width, and one caster that touches the light.
// A warning and ray tracing; no crash.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 0.7
  spotlight point_at 0 radius 0 falloff 0
  deep_shadow { resolution 64 }
}
light_source {
  <1.0, 1.5, 0>, rgb 0.7
  deep_shadow { resolution 512 }
}
sphere { <1.0, 2.0, 0>, 0.5 texture { WhiteMatte } }
sphere { <-0.6, 0.5, 0>, 0.4 texture { WhiteMatte } }
