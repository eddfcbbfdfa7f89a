// SPDX-License-Identifier: AGPL-3.0-or-later
// A light projected through a triangle (projected_through).
// Light within the triangle's outline only, and shadows in it; these look-ups are ray-traced.
// Truth: ray-traced, exactly.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
#declare Window = triangle { <-2.6, 3, -1.8>, <0.4, 3, -1.8>, <-1.2, 3, 0.6> }
light_source {
  <-3, 6, -1.5>, rgb 1
  projected_through { Window }
  deep_shadow { resolution 512 }
}
object { Window texture { WhiteMatte } no_shadow no_image }
sphere { <0.2, 0.6, 0.1>, 0.4 texture { WhiteMatte } }
