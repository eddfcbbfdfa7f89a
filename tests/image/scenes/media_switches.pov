// SPDX-License-Identifier: AGPL-3.0-or-later
// Lights with media_interaction and media_attenuation on and off above the same ball of fog.
// Container media dim light whatever the two words say: four equal shadows.
// Truth: ray-traced with many samples.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
#macro Lamp(X, Z, I, A)
  light_source {
    <X, 5, Z>, rgb 0.25
    spotlight point_at <0, 1, 0> radius 12 falloff 30 media_interaction I media_attenuation A
    deep_shadow { resolution 256 }
  }
#end
Lamp(-5, -3, on, on) Lamp(5, -3, on, off) Lamp(-5, 4, off, on) Lamp(5, 4, off, off)
sphere {
  <0, 1.4, 0>, 0.6 hollow pigment { rgbt 1 }
  interior { media { method 2 intervals 1 samples MS absorption 0.8 } }
}
