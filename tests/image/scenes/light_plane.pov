// SPDX-License-Identifier: AGPL-3.0-or-later
// Walls that stand through a light's own plane, and casters on both sides of it: behind a spotlight, behind a cylinder light.
// What is behind the light gets no light from it and casts no shadow; in front of it every shadow is there.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
#ifndef (Kind) #declare Kind = 0; #end
light_source {
  <-0.5, 1, -0.6>, rgb 1
  #if (Kind = 0) spotlight point_at <0.2, 0, 0> radius 80 falloff 89 tightness 0 #end
  #if (Kind = 1) cylinder point_at <0.2, 0, 0> radius 1.5 falloff 1.6 tightness 0 #end
  #if (Kind = 2) parallel point_at <0.2, 0, 0> #end
  deep_shadow { resolution 512 }
}
box { <-1.5, 0, 0.6>, <1.5, 2.2, 0.7> texture { WhiteMatte } }        // through the plane
box { <0.9, 0, -0.6>, <1, 1.8, 0.4> texture { WhiteMatte } }
sphere { <-0.1, 0.6, -0.1>, 0.2 texture { WhiteMatte } }               // in front
sphere { <-0.9, 1.4, -0.9>, 0.2 texture { WhiteMatte } }               // behind
sphere { <-0.5, 1.0, 0.1>, 0.2 pigment { Red } finish { Clear } }      // across
