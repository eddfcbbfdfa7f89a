// SPDX-License-Identifier: AGPL-3.0-or-later
// The floor is an infinite plane, the caster a quadric without bounds beside finite ones.
// Maps are framed to the finite casters; outside the frame the floor is lit but for the quadric's shadow.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#declare NoFloor = 1;
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
plane { y, 0 texture { WhiteMatte } }
quadric { <1, 0, 1>, <0, 0, 0>, <0, 0, 0>, -0.04 texture { WhiteMatte } translate <-1.2, 0, 0> }
sphere { <0.6, 0.6, 0.2>, 0.5 texture { WhiteMatte } }
box { <1.2, 0.7, -1>, <1.9, 0.75, -0.3> pigment { Red } finish { Clear } }
