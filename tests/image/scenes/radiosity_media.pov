// SPDX-License-Identifier: AGPL-3.0-or-later
// Radiosity over a container of fog: by default its gather rays look no media up.
// Look-ups of callers without media are ray-traced where the scene has media.
// Truth: ray-traced with many samples; one thread.
#version 3.7;
global_settings { assumed_gamma 1 radiosity { count 40 nearest_count 4 error_bound 1 recursion_limit 2 pretrace_end 0.04 } }
#declare Eye = <0, 3.2, -7>;
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
box { <-1.5, 1.2, -0.6>, <0.3, 1.3, 1> texture { WhiteMatte } }
box { <-1.5, 0, 0.9>, <0.3, 1.2, 1> pigment { rgb <1, 0.4, 0.3> } finish { ambient 0 diffuse 0.9 } }
sphere { <1.3, 0.8, 0>, 0.6 hollow pigment { rgbt 1 } interior { media { method 2 intervals 1 samples MS absorption <0.5, 1, 1.5> } } }
