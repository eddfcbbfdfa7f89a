// SPDX-License-Identifier: AGPL-3.0-or-later
// A small scene of any size (Size), anywhere (Away), with its light at any distance (Distance).
// Shadows as of the same scene at the origin: no gaps, no acne, no steps.
// Truth: the scene ray-traced at the origin and at unit scale (Plain).
#version 3.7;
global_settings { assumed_gamma 1 }
#ifndef (Size) #declare Size = 1; #end
#ifndef (Away) #declare Away = 0; #end
#ifdef (Plain) #declare Size = 1; #declare Away = 0; #end
#ifndef (Distance) #declare Distance = 7; #end
#ifndef (Kind) #declare Kind = 0; #end
#declare Place = Away*<1, 0.5, -1>;
#declare NoFloor = 1; #declare Eye = <0, 6, -6>*Size + Place; #declare At = <0, 0.2, 0>*Size + Place;
#include "stage.inc"
#declare Light = vnormalize(<-3, 6, -1.5>)*Distance*Size + Place;
light_source {
  Light, rgb 1
  #if (Kind = 1) parallel point_at Place #end
  #if (Kind = 2) spotlight point_at Place radius degrees(atan2(2.4, Distance)) falloff degrees(atan2(3, Distance)) #end
  deep_shadow { resolution 512 }
}
union {
  box { <-4, -0.2, -4>, <4, 0, 4> }
  sphere { <-0.9, 0.6, 0>, 0.5 }
  cylinder { <0.8, 0, 0.5>, <0.8, 0.9, 0.5>, 0.1 }
  box { <0.3, 0.5, -1>, <1.1, 0.6, -0.4> }
  texture { WhiteMatte }
  scale Size translate Place
}
