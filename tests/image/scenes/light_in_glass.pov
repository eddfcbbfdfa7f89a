// SPDX-License-Identifier: AGPL-3.0-or-later
// Point lights inside a clear coloured ball, and inside an opaque one.
// The first light is filtered once at the ball's wall; the second lights the inside of its ball only.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-1, 1.2, 0>, rgb 0.8
  deep_shadow { resolution 256 }
}
light_source {
  <1.2, 1.2, 0>, rgb 0.8
  deep_shadow { resolution 256 }
}
sphere { <-1, 1.2, 0>, 0.5 pigment { Red } finish { Clear } interior { ior 1 } }
sphere { <1.2, 1.2, 0>, 0.3 texture { WhiteMatte } }
sphere { <-0.1, 0.4, -0.2>, 0.3 texture { WhiteMatte } }
box { <-2, 0.4, -1>, <-1.4, 0.45, -0.4> pigment { Green } finish { Clear } }
