// SPDX-License-Identifier: AGPL-3.0-or-later
// An opaque infinite plane stands across the floor and shadows one side.
// Infinite casters stay out of the map: the shadow of the plane is ray-traced, the balls' shadows come from the map.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
plane { <-1, 0.4, 0.3>, -0.7 texture { WhiteMatte } }
sphere { <-0.8, 0.6, 0.2>, 0.5 texture { WhiteMatte } }
sphere { <-0.8, 0.6, -1.2>, 0.4 pigment { Blue } finish { Clear } }
