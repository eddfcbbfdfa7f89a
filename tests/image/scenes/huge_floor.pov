// SPDX-License-Identifier: AGPL-3.0-or-later
// Small things on a floor 10,000 wide, the light near.
// The frame is not stretched over the floor: the shadows are as sharp as on a small one.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#declare NoFloor = 1;
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 0.9
  deep_shadow { resolution 512 }
}
box { <-5000, -1, -5000>, <5000, 0, 5000> texture { WhiteMatte } }
sphere { <-0.9, 0.6, 0>, 0.5 texture { WhiteMatte } }
cylinder { <0.2, 0, 0.5>, <0.2, 0.9, 0.5>, 0.05 texture { WhiteMatte } }
box { <0.8, 0.5, -0.6>, <1.5, 0.55, 0.2> pigment { Red } finish { Clear } }
