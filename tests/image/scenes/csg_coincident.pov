// SPDX-License-Identifier: AGPL-3.0-or-later
// Parts of constructions whose faces lie upon each other: glass on glass, glass beside glass, a box in its equal, a box on a box.
// The shadows alone (the camera itself cannot tell such faces apart). Panes that touch take as much light as panes a hair apart (Gap): no face is lost and none counts twice.
// Truth: ray-traced with a gap that POV-Ray can see.
#version 3.7;
global_settings { assumed_gamma 1 }
#ifndef (Gap) #declare Gap = 0; #end
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
#declare Pane = texture { pigment { rgbf <0.8, 0.9, 0.7, 1> } finish { Clear } };
union {   // two panes, one on the other
  box { <-1.9, 0.5, -0.8>, <-1.0, 0.6, 0> } box { <-1.9, 0.6 + Gap, -0.8>, <-1.0, 0.7 + Gap, 0> }
  texture { Pane } no_image
}
box { <-0.6, 0.5, -0.8>, <0.2, 0.6, 0> texture { Pane } no_image }    // the same, not in one object
box { <-0.6, 0.6 + Gap, -0.8>, <0.2, 0.7 + Gap, 0> texture { Pane } no_image }
merge {   // side by side: the faces between them are gone
  box { <0.6, 0.5, -0.8>, <1.0, 0.6, 0> } box { <1.0 - Gap, 0.5, -0.8>, <1.5, 0.6, 0> }
  texture { Pane } no_image
}
intersection { box { <0, 0.4, 0.5>, <0.6, 0.7, 1.1> } box { <-Gap, 0.4 - Gap, 0.5 - Gap>, <0.6 + Gap, 0.7 + Gap, 1.1 + Gap> } texture { WhiteMatte } no_image }
union { box { <1, 0, 0.5>, <1.3, 0.4, 1> } box { <1, 0.4 + Gap, 0.5>, <1.3, 0.6, 1> } texture { WhiteMatte } }
