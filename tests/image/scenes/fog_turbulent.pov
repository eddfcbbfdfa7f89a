// SPDX-License-Identifier: AGPL-3.0-or-later
// A fog with turbulence and one with a transmit floor, with media_attenuation on.
// Neither has a simple closed form: these look-ups are ray-traced.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
fog { distance 8 rgbt <0.3, 0.4, 0.5, 0.2> }
fog { fog_type 2 distance 4 rgb <0.3, 0.4, 0.5> fog_offset 0.5 fog_alt 0.4 turbulence 0.4 turb_depth 0.3 }
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32 media_attenuation on
  deep_shadow { resolution 512 }
}
sphere { <-0.9, 0.8, 0>, 0.6 texture { WhiteMatte } }
sphere { <0.9, 0.7, 0.3>, 0.5 pigment { Green } finish { Clear } }
