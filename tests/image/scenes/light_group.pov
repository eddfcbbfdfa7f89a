// SPDX-License-Identifier: AGPL-3.0-or-later
// A light that lights one object only (light_group), beside a global light.
// Every object shadows the group's light, also those that it does not light.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <3, 6, -1.5>, rgb <0.3, 0.4, 0.5>
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
light_group {
  light_source {
    <-3, 6, -1.5>, rgb 1
    spotlight point_at 0 radius 26 falloff 32
    deep_shadow { resolution 512 }
  }
  box { <-1.8, 0.1, -0.8>, <1.8, 0.2, 0.8> texture { WhiteMatte } }
  global_lights on
}
sphere { <-1.0, 0.9, -0.2>, 0.5 texture { WhiteMatte } }
sphere { <0.6, 0.9, -0.2>, 0.4 pigment { Green } finish { Clear } }
