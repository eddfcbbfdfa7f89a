// SPDX-License-Identifier: AGPL-3.0-or-later
// Mirrors and refracting glass: look-ups at every level of the ray tree.
// Shadows seen in the mirror and through the ball agree with ray tracing.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
box { <-2, 0, 1.5>, <2, 1.8, 1.6> pigment { rgb 0 } finish { ambient 0 diffuse 0 reflection 0.9 } }
sphere { <0.8, 0.7, -0.8>, 0.6 pigment { rgbf <0.9, 1, 0.9, 0.95> } finish { ambient 0 diffuse 0 reflection 0.1 } interior { ior 1.4 } }
sphere { <-0.9, 0.5, 0.2>, 0.4 texture { WhiteMatte } }
cylinder { <-0.2, 0, 0.8>, <-0.2, 1, 0.8>, 0.08 texture { WhiteMatte } }
