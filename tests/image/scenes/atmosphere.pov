// SPDX-License-Identifier: AGPL-3.0-or-later
// Absorbing media everywhere (global media), with media_attenuation on for one light and off for the other.
// The atmosphere has no end: it is multiplied in at the look-up, and only where media_attenuation says so.
// Truth: ray-traced with many samples.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
media { method 2 intervals 1 samples MS absorption <0.03, 0.06, 0.10> }
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32 media_attenuation on
  deep_shadow { resolution 512 }
}
light_source {
  <4, 6, -1>, rgb 0.5
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
sphere { <-0.9, 0.6, 0>, 0.5 texture { WhiteMatte } }
sphere { <0.9, 0.7, 0.3>, 0.5 pigment { Green } finish { Clear } }
