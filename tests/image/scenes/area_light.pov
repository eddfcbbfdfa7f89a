// SPDX-License-Identifier: AGPL-3.0-or-later
// Area lights with deep_shadow, one with area_illumination.
// A warning for each, and soft shadows as ever.
// Truth: ray-traced, exactly.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 0.6
  area_light 1.2*x, 1.2*z, 5, 5
  deep_shadow { resolution 512 }
}
light_source {
  <3, 6, -1.5>, rgb 0.4
  area_light x, z, 3, 3 adaptive 1 area_illumination on
  deep_shadow { resolution 512 }
}
sphere { <-0.8, 0.8, 0>, 0.5 texture { WhiteMatte } }
sphere { <0.9, 0.7, 0.3>, 0.5 pigment { Red } finish { Clear } }
