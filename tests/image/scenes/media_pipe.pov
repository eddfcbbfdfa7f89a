// SPDX-License-Identifier: AGPL-3.0-or-later
// A pipe through a scattering cloud, and glass beside it: surfaces and media in one map.
// A dark shaft below the pipe inside the cloud; the cloud's shadow on the pipe.
// Truth: ray-traced with many samples.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
sphere {
  <0, 1.2, 0>, 1.1 hollow pigment { rgbt 1 }
  interior { media { method 2 intervals 1 samples MS scattering { 1, rgb <0.9, 1, 1.2> } density { spherical color_map { [0 rgb 0] [1 rgb 1] } scale 1.1 translate <0, 1.2, 0> } } }
}
cylinder { <-2, 1.4, -0.2>, <2, 1.2, 0.2>, 0.15 texture { WhiteMatte } }
box { <0.3, 1.9, -0.8>, <1.0, 1.95, 0.1> pigment { Red } finish { Clear } }
