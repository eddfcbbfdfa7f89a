// SPDX-License-Identifier: AGPL-3.0-or-later
// Things behind a spotlight, beside its cone, and half within it.
// What stands behind casts nothing; half-lit things have their shadow up to the rim of the cone.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-1.5, 2.5, -0.5>, rgb 1
  spotlight point_at <0.5, 0, 0.2> radius 30 falloff 34
  deep_shadow { resolution 512 }
}
sphere { <-2.6, 3.6, -1>, 0.4 texture { WhiteMatte } }
sphere { <0.4, 0.5, 0.2>, 0.4 texture { WhiteMatte } }
sphere { <1.8, 0.6, 0.3>, 0.5 texture { WhiteMatte } }
box { <-1.5, 0.7, -1.6>, <0.1, 0.75, -0.9> texture { WhiteMatte } }
sphere { <-1.0, 0.6, 1.2>, 0.5 pigment { Red } finish { Clear } }
