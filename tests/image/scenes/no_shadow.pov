// SPDX-License-Identifier: AGPL-3.0-or-later
// no_shadow on an object, on a union, and on a child of a bounded (so unsplit) union.
// The first ball and the first union have no shadow; the child of the last union keeps its own.
// Truth: ray-traced; only the object of the scene's top level is asked.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
sphere { <-1.8, 0.7, -0.6>, 0.4 texture { WhiteMatte } no_shadow }
sphere { <-0.6, 0.7, -0.6>, 0.4 texture { WhiteMatte } }
union { sphere { <0.5, 0.7, -0.6>, 0.3 } box { <0.8, 0.4, -0.8>, <1.3, 0.9, -0.4> } texture { WhiteMatte } no_shadow }
union {
  sphere { <-1, 0.7, 1.2>, 0.4 no_shadow } box { <-0.4, 0.4, 1>, <0.2, 0.9, 1.4> }
  texture { WhiteMatte } split_union off bounded_by { box { <-1.5, 0.2, 0.7>, <0.3, 1.2, 1.7> } }
}
union { sphere { <0.9, 0.7, 1.2>, 0.3 no_shadow } sphere { <1.6, 0.7, 1.2>, 0.3 } texture { WhiteMatte } }
