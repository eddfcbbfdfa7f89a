// SPDX-License-Identifier: AGPL-3.0-or-later
// Walls 0.01 thick: a lid on a box room with a window, and a box that stands on the floor.
// The room is dark inside but for the window: nothing leaks through the lid or under the walls.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#declare Eye = <0, 3.2, -7>;
#include "stage.inc"
light_source {
  <-4, 7, -3>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
#macro Wall(A, B) box { A, B texture { WhiteMatte } } #end
// A room open to the camera; its lid has a slot.
Wall(<-1.8, 0, 1>, <0.4, 1.2, 1.01>) Wall(<-1.8, 0, -0.6>, <-1.79, 1.2, 1.01>) Wall(<0.39, 0, -0.6>, <0.4, 1.2, 1.01>)
Wall(<-1.8, 1.2, -0.6>, <0.4, 1.21, 0.2>) Wall(<-1.8, 1.2, 0.4>, <0.4, 1.21, 1.01>)
sphere { <-0.6, 0.3, 0.4>, 0.3 texture { WhiteMatte } }
// Thin boxes: standing, lying, on edge.
box { <1.2, 0, -0.4>, <1.21, 0.9, 0.6> texture { WhiteMatte } }
box { <1.6, 0, -0.9>, <2.3, 0.01, -0.2> texture { WhiteMatte } }
box { <1.5, 0.3, 0.6>, <2.2, 0.31, 1.3> texture { WhiteMatte } }
