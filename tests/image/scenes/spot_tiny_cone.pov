// SPDX-License-Identifier: AGPL-3.0-or-later
// A spotlight with a cone of 2 degrees, far away, and one of nearly 90 degrees close by.
// Frames fit both; no grain in the small one, no gap at the rim of the wide one.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-30, 60, -15>, rgb 0.7
  spotlight point_at 0 radius 1.5 falloff 2
  deep_shadow { resolution 512 }
}
light_source {
  <1.5, 1.2, -0.5>, rgb 0.5
  spotlight point_at <1.5, 0, -0.5> radius 80 falloff 88 tightness 0
  deep_shadow { resolution 1024 }
}
sphere { <-0.9, 0.6, 0>, 0.5 texture { WhiteMatte } }
box { <0.3, 0, -1.4>, <0.8, 0.3, -1.0> texture { WhiteMatte } }
cylinder { <2.2, 0, 0>, <2.2, 0.8, 0>, 0.1 texture { WhiteMatte } }
