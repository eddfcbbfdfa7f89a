// SPDX-License-Identifier: AGPL-3.0-or-later
// Radiosity: gather rays look shadows up too.
// Bounced light below the lid; the map's error must not be multiplied by it.
// Truth: ray-traced; radiosity is repeatable at one thread.
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
sphere { <-0.5, 0.4, 0.2>, 0.4 texture { WhiteMatte } }
sphere { <1.3, 0.5, 0>, 0.5 texture { WhiteMatte } }
