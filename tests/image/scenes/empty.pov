// SPDX-License-Identifier: AGPL-3.0-or-later
// A floor without an end and nothing that casts a shadow.
// An all-lit map or none; no crash.
// Truth: ray-traced, exactly.
#version 3.7;
global_settings { assumed_gamma 1 }
#declare NoFloor = 1;
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
plane { y, 0 texture { WhiteMatte } }
