// SPDX-License-Identifier: AGPL-3.0-or-later
// Transparent isosurfaces, max_trace 1 (the default) and all_intersections.
// Both have the same shadow: a caster that is not opaque is asked again until nothing is left.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 256 samples 4 }
}
#declare Rim = function { pow(sqrt(x*x + z*z) - 0.6, 2) + y*y - 0.05 }
isosurface {
  function { Rim(x, y, z) } contained_by { box { -0.95, 0.95 } } max_gradient 2.2
  pigment { rgbf <0.8, 0.6, 0.4, 1> } finish { Clear } rotate <40, 0, 50> translate <-1.1, 1, 0>
}
isosurface {
  function { Rim(x, y, z) } contained_by { box { -0.95, 0.95 } } max_gradient 2.2 all_intersections
  pigment { rgbf <0.8, 0.6, 0.4, 1> } finish { Clear } rotate <40, 0, 50> translate <1.1, 1, 0>
}
