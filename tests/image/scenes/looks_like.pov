// SPDX-License-Identifier: AGPL-3.0-or-later
// A light with a looks_like ball, inside a lamp shade with an open bottom.
// The ball does not shadow its own light; the shade does.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-0.4, 2.2, 0>, rgb 1
  looks_like { sphere { 0, 0.15 pigment { rgb 1 } finish { ambient 1 diffuse 0 } } }
  deep_shadow { resolution 512 }
}
cone { <-0.4, 1.9, 0>, 0.9, <-0.4, 2.6, 0>, 0.4 open texture { WhiteMatte } }
sphere { <0.6, 0.5, 0.2>, 0.4 texture { WhiteMatte } }
box { <-1.4, 0.5, -0.7>, <-0.7, 0.55, 0> pigment { Blue } finish { Clear } }
