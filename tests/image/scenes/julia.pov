// SPDX-License-Identifier: AGPL-3.0-or-later
// A transparent quaternion Julia fractal.
// Its shadow is filtered at every surface, without grain.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 256 samples 4 }
}
julia_fractal {
  <-0.083, 0.0, -0.83, -0.025> quaternion sqr max_iteration 6 precision 10
  pigment { rgbf <0.6, 0.8, 0.5, 1> } finish { Clear }
  scale 0.8 translate <0, 1.1, 0>
}
