// SPDX-License-Identifier: AGPL-3.0-or-later
// Rods of radius 0.005 under a point light 100,000 units away, and one that is 50 away.
// Both lights' shadows of every rod are there, without gaps.
// Truth: ray-traced: those rays start at the receiver.
#version 3.7;
global_settings { assumed_gamma 1 }
#declare Eye = <0, 1.2, -1.2>; #declare At = <0, 0.05, 0>; #declare Angle = 40;
#include "stage.inc"
light_source {
  vnormalize(<-3, 6, -1.5>)*1e5, rgb 0.5
  deep_shadow { resolution 4096 }
}
light_source {
  vnormalize(<3, 5, -1.5>)*50, rgb 0.5
  deep_shadow { resolution 4096 }
}
#for (I, 0, 6) cylinder { <-0.4 + 0.13*I, 0, 0>, <-0.4 + 0.13*I, 0.3, 0.05>, 0.005 texture { WhiteMatte } } #end
cylinder { <-0.4, 0.3, 0.05>, <0.4, 0.3, 0.05>, 0.005 texture { WhiteMatte } }
