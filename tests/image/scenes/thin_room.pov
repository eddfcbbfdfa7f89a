// SPDX-License-Identifier: AGPL-3.0-or-later
// A closed room with walls 0.01 thick, the light above it, the camera inside.
// The picture is black: light that leaks through a thin lid would show.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#declare NoFloor = 1; #declare Eye = <0, 0.6, -1.9>; #declare At = <0, 0.5, 0>; #declare Angle = 70;
#include "stage.inc"
light_source {
  <-4, 7, -3>, rgb 5
  deep_shadow { resolution 256 }
}
#macro Wall(A, B) box { A, B texture { WhiteMatte } } #end
Wall(<-2, -0.01, -2>, <2, 0, 2>) Wall(<-2, 1.5, -2>, <2, 1.51, 2>)
Wall(<-2, -0.01, -2>, <-1.99, 1.51, 2>) Wall(<1.99, -0.01, -2>, <2, 1.51, 2>)
Wall(<-2, -0.01, 1.99>, <2, 1.51, 2>) Wall(<-2, -0.01, -2>, <2, 1.51, -1.99>)
box { <-0.8, 0, 0.2>, <0.2, 0.4, 0.8> texture { WhiteMatte } }
