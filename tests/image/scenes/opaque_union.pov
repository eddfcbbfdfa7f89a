// SPDX-License-Identifier: AGPL-3.0-or-later
// Unions of opaque and transparent parts, split and unsplit.
// Opaque parts stop the light, the others filter it.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
#declare Parts = union {
  sphere { <0, 0.9, 0>, 0.4 pigment { rgb 1 } finish { ambient 0 diffuse 1 } }
  box { <0.2, 0.5, -0.4>, <1, 0.6, 0.4> pigment { Red } finish { Clear } }
  cylinder { <-0.6, 0.3, 0>, <-0.6, 1.2, 0>, 0.1 }
  box { <-0.5, 0.3, -0.3>, <0.5, 0.32, 0.3> pigment { Blue } finish { Clear } }
  texture { WhiteMatte }
}
object { Parts translate <-1.3, 0, -0.5> }
union { object { Parts } split_union off bounded_by { box { <-0.8, 0.2, -0.5>, <1.1, 1.4, 0.5> } } translate <1.2, 0, 0.2> }
union { sphere { 0, 0.3 } sphere { 0.4*x, 0.3 } texture { WhiteMatte } translate <-0.6, 0.8, 1.5> }
merge { sphere { 0, 0.3 } sphere { 0.4*x, 0.3 } pigment { Green } finish { Clear } translate <0.6, 0.8, 1.5> }
