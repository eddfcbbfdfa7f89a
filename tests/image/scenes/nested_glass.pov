// SPDX-License-Identifier: AGPL-3.0-or-later
// Glass spheres in glass spheres, textures in layers.
// Each wall filters again: up to six times.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 12 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
#for (I, 1, 3)
  sphere { <-1.0, 1.0, 0>, 0.28*I pigment { rgbf <0.8, 0.9, 1 - 0.15*I, 1> } finish { Clear } interior { ior 1.0 } }
#end
sphere { <1.0, 0.9, -0.3>, 0.6 pigment { Grey } finish { Clear } interior { ior 1.0 } }
sphere { <1.3, 1.0, -0.3>, 0.45 pigment { rgbft <0.9, 0.3, 0.3, 0.5, 0.5> } finish { Clear } interior { ior 1.0 } }
box { <0.2, 0.5, 1.0>, <1.4, 0.55, 1.9>
  texture { pigment { checker rgbf <0.9, 0.9, 0.2, 1> rgbt 0.8 scale 0.3 } finish { Clear } }
  texture { pigment { gradient x color_map { [0 rgbf <1, 1, 1, 1>] [1 rgbf <0.1, 0.5, 0.9, 1>] } } finish { Clear } }
}
