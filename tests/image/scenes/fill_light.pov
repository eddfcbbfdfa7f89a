// SPDX-License-Identifier: AGPL-3.0-or-later
// A fill light (shadowless) with deep_shadow, beside one with shadows.
// A warning; the fill light stays without shadows.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
light_source {
  <3, 6, -1.5>, rgb <0.2, 0.2, 0.3> shadowless
  deep_shadow { resolution 512 }
}
sphere { <-0.8, 0.8, 0>, 0.5 texture { WhiteMatte } }
sphere { <0.9, 0.7, 0.3>, 0.5 pigment { Red } finish { Clear } }
