// SPDX-License-Identifier: AGPL-3.0-or-later
// A lens that is a photon target, beside an ordinary ball, over a receiver of photons.
// The target's shadow holds the photons' light only; look-ups there are ray-traced.
// Truth: ray-traced; photons are shot by the same seed in both pictures.
#version 3.7;
global_settings { assumed_gamma 1 photons { spacing 0.04 jitter 0 } }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  photons { refraction on reflection off }
  deep_shadow { resolution 512 }
}
sphere { <-0.9, 0.8, 0>, 0.5 pigment { rgbf 1 } finish { Clear } interior { ior 1.5 } photons { target refraction on collect off } }
sphere { <0.9, 0.7, 0.3>, 0.5 pigment { Red } finish { Clear } interior { ior 1.5 } }
sphere { <0.6, 0.5, -1>, 0.3 texture { WhiteMatte } }
