// SPDX-License-Identifier: AGPL-3.0-or-later
// A constant fog, with media_attenuation on.
// The fog dims the light by the way from the light to the receiver.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
fog { distance 12 rgb <0.3, 0.4, 0.5> }
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32 media_attenuation on
  deep_shadow { resolution 512 }
}
sphere { <-0.9, 0.8, 0>, 0.6 texture { WhiteMatte } }
sphere { <0.9, 0.7, 0.3>, 0.5 pigment { Green } finish { Clear } }
