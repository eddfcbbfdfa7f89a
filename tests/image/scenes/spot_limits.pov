// SPDX-License-Identifier: AGPL-3.0-or-later
// A spotlight of a thousandth of a degree from 100,000 units away, and one of 179 degrees close by.
// Both pools of light have their shadows, without gaps or grain, up to their rims.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
#ifndef (Which) #declare Which = 0; #end
light_source {
  #if (Which = 0) vnormalize(<-3, 6, -1.5>)*1e5, rgb 1 spotlight point_at <-0.5, 0, 0> radius 0.0005 falloff 0.0005
  #else <0.3, 0.8, -0.5>, rgb 1 spotlight point_at <0.3, 0, -0.5> radius 89.5 falloff 89.5 #end
  deep_shadow { resolution 1024 }
}
sphere { <-0.9, 0.6, 0>, 0.3 texture { WhiteMatte } }
box { <-0.5, 0, -0.3>, <0.1, 0.3, 0.1> texture { WhiteMatte } }
cylinder { <1.2, 0, 0>, <1.2, 0.8, 0>, 0.1 texture { WhiteMatte } }
cylinder { <-0.2, 0.5, 0.5>, <-0.6, 0.1, -0.6>, 0.03 pigment { Red } finish { Clear } }
sphere { <0.8, 1.4, -0.2>, 0.3 texture { WhiteMatte } }
