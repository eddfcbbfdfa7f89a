// SPDX-License-Identifier: AGPL-3.0-or-later
// Textures near adc_bailout: filters of 0.003 and 0.005, and thin light left by several layers.
// What falls below adc_bailout is cut off, at the same texture as in the ray tracer.
// Truth: ray-traced, bright light.
#version 3.7;
global_settings { assumed_gamma 1 adc_bailout 0.1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 6
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
#macro Sheet(X, Y, Z, F) box { <X, Y, Z>, <X + 0.7, Y + 0.01, Z + 0.7> pigment { rgbt <1, 1, 1, F> } finish { Clear } } #end
Sheet(-1.9, 0.8, -0.9, 0.05)
Sheet(-0.8, 0.8, -0.9, 0.12)
Sheet(0.3, 0.8, -0.9, 0.35)
Sheet(1.3, 0.8, -0.9, 0.35) Sheet(1.4, 0.5, -0.9, 0.6)
box { <-1.9, 0.8, 0.5>, <-1.2, 0.81, 1.2> texture { pigment { rgbf <0.3, 0.3, 0.9, 1> } finish { Clear } } texture { pigment { rgbf <0.2, 0.9, 0.2, 1> } finish { Clear } } }
box { <-0.6, 0.8, 0.5>, <0.1, 0.81, 1.2> texture { pigment { rgbt <1, 1, 1, 0.3> } finish { Clear } } texture { pigment { rgbf <0.25, 0.9, 0.9, 1> } finish { Clear } } }
