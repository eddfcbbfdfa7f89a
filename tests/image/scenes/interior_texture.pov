// SPDX-License-Identifier: AGPL-3.0-or-later
// Sheets and shells with a red outside and a green inside (interior_texture).
// Each shadow takes the side that faces the receiver: red below the left sheet, green below the right one.
// Truth: ray-traced; stock shades a caster as seen from the receiver.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
#declare Sides = texture { pigment { Red } finish { Clear } }
#declare Inner = texture { pigment { Green } finish { Clear } }
disc { <-1.6, 1, -0.4>, -y, 0.6 texture { Sides } interior_texture { Inner } }
disc { <-0.2, 1, -0.4>, y, 0.6 texture { Sides } interior_texture { Inner } }
sphere { <1.2, 0.8, -0.6>, 0.5 texture { Sides } interior_texture { Inner } }
mesh {
  triangle { <-1.8, 0.8, 0.6>, <-0.8, 0.8, 0.6>, <-1.3, 0.8, 1.6> }
  triangle { <0.2, 0.8, 0.6>, <0.7, 0.8, 1.6>, <1.2, 0.8, 0.6> }
  texture { Sides } interior_texture { Inner }
}
cylinder { <1.8, 0.3, 0.9>, <2.2, 1.0, 1.1>, 0.35 open texture { Sides } interior_texture { Inner } }
