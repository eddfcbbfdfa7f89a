// SPDX-License-Identifier: AGPL-3.0-or-later
// clipped_by and bounded_by, on simple shapes, on CSG and on infinite ones.
// Light passes where a shape is clipped away; a bound that cuts a shape cuts its shadow as well.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
sphere { <-1.6, 0.8, -0.5>, 0.55 clipped_by { plane { <1, 1, 0>, 0.2 translate <-1.6, 0.8, -0.5> } } texture { WhiteMatte } }
sphere { <-0.2, 0.8, -0.5>, 0.55 clipped_by { box { <-0.5, 0.4, -1>, <0.2, 1.2, 0> } } pigment { Red } finish { Clear } }
plane { <0.3, 1, 0>, 1.0 clipped_by { cylinder { <1.3, -2, -0.3>, <1.3, 4, -0.3>, 0.55 } } texture { WhiteMatte } }
union { sphere { 0, 0.3 } box { <0, -0.2, -0.2>, <0.7, 0.2, 0.2> } bounded_by { box { <-0.31, -0.31, -0.31>, <0.71, 0.31, 0.31> } } texture { WhiteMatte } translate <-1.2, 0.7, 1.2> }
difference { box { -0.4, 0.4 } sphere { 0, 0.5 } clipped_by { plane { y, 0.2 } } bounded_by { clipped_by } pigment { Blue } finish { Clear } translate <0.7, 0.8, 1.2> }
quadric { <1, 0, 1>, <0, 0, 0>, <0, 0, 0>, -0.04 clipped_by { box { <-1, 0, -1>, <1, 1, 1> } } bounded_by { clipped_by } texture { WhiteMatte } translate <1.8, 0, 0.9> }
