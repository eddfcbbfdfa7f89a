// SPDX-License-Identifier: AGPL-3.0-or-later
// A scene of size 0.001 and one light; the same as at size 1.
// Shadows without gaps or acne, as at unit scale (Declare=Size=1).
// Truth: the same scene ray-traced at unit scale; POV-Ray's own constants show at small scales.
#version 3.7;
global_settings { assumed_gamma 1 }
#ifndef (Size) #declare Size = 0.001; #end
#declare NoFloor = 1; #declare Eye = <0, 6, -6>*Size; #declare At = <0, 0.2, 0>*Size;
#include "stage.inc"
light_source {
  <-3, 6, -1.5>*Size, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
union {
  box { <-4, -0.2, -4>, <4, 0, 4> }
  sphere { <-0.9, 0.6, 0>, 0.5 }
  cylinder { <0.8, 0, 0.5>, <0.8, 0.9, 0.5>, 0.1 }
  box { <0.3, 0.5, -1>, <1.1, 0.6, -0.4> }
  texture { WhiteMatte }
  scale Size
}
