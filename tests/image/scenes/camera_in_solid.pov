// SPDX-License-Identifier: AGPL-3.0-or-later
// Camera, light and things stand inside a solid glass ball (not hollow), with a container of fog.
// Within the solid ball no media count, seen or as shadows; such look-ups are ray-traced.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
sphere { 0, 15 pigment { rgbf 1 } finish { Clear } interior { ior 1 } }
sphere { <-0.9, 0.8, 0>, 0.6 hollow pigment { rgbt 1 } interior { media { method 2 intervals 1 samples MS absorption <0.5, 1, 1.5> } } }
sphere { <0.9, 0.7, 0.3>, 0.5 texture { WhiteMatte } }
