// SPDX-License-Identifier: AGPL-3.0-or-later
// A finite ball of radius 1000 as the sky round the scene, light and camera inside it.
// The sky's ball does not stretch the frame, and does not shadow from outside.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-30, 60, -15>, rgb 0.9
  deep_shadow { resolution 1024 }
}
sphere { 0, 1000 hollow inverse pigment { rgb <0.3, 0.4, 0.6> } finish { ambient 1 diffuse 0 } }
sphere { <-0.9, 0.6, 0>, 0.5 texture { WhiteMatte } }
cylinder { <0.2, 0, 0.5>, <0.2, 0.9, 0.5>, 0.05 texture { WhiteMatte } }
box { <0.8, 0.5, -0.6>, <1.5, 0.55, 0.2> pigment { Red } finish { Clear } }
