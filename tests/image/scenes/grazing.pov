// SPDX-License-Identifier: AGPL-3.0-or-later
// A ball on a floor under grazing light, beside a low step and a fine grid of grooves.
// No acne on the lit floor, no gap between the ball's foot and its shadow.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-20, 1.6, -3>, rgb 3
  deep_shadow { resolution 1024 }
}
sphere { <-0.8, 0.4, 0.2>, 0.4 texture { WhiteMatte } }
box { <-2, 0, -1.5>, <-1, 0.03, -1> texture { WhiteMatte } }
#for (I, 0, 5) box { <0.8 + 0.2*I, 0, -0.6>, <0.84 + 0.2*I, 0.02, 1.4> texture { WhiteMatte } } #end
sphere { <1.2, 0.25, -1.3>, 0.25 pigment { Red } finish { Clear } }
