// SPDX-License-Identifier: AGPL-3.0-or-later
// The light stands inside a container of fog; other containers are entered and left on the way.
// Stock puts no extinction between the light and the first hit; the ball of fog below still dims.
// Truth: ray-traced with many samples.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-0.5, 3, -0.3>, rgb 1
  deep_shadow { resolution 256 }
}
sphere {
  <-0.5, 3, -0.3>, 1 hollow pigment { rgbt 1 }
  interior { media { method 2 intervals 1 samples MS absorption 0.5 } }
}
sphere {
  <1.1, 0.8, 0.2>, 0.7 hollow pigment { rgbt 1 }
  interior { media { method 2 intervals 1 samples MS absorption <0.4, 0.8, 1.2> } }
}
sphere { <-1.4, 0.5, -0.4>, 0.4 texture { WhiteMatte } }
box { <-0.4, 0.4, 0.7>, <0.4, 0.45, 1.4> pigment { Green } finish { Clear } }
