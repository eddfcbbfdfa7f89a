// SPDX-License-Identifier: AGPL-3.0-or-later
// A small scattering cloud with turbulence: the look-ups lie inside the medium.
// The cloud is dark on its far side, and so is the floor below.
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
  <0, 1.3, 0>, 1.1 hollow pigment { rgbt 1 }
  interior { media {
    method 2 intervals 1 samples MS scattering { 1, rgb 2.5 }
    density { spherical turbulence 0.4 octaves 3 color_map { [0 rgb 0] [0.5 rgb 1] } scale 1.1 translate <0, 1.3, 0> }
  } }
}
