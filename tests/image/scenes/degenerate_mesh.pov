// SPDX-License-Identifier: AGPL-3.0-or-later
// Triangles without area, slivers, the same triangle twice, and triangles that share an edge, loose and in meshes.
// POV-Ray leaves out those without area; all others cast their shadow once.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
#macro Sheets()
  triangle { <0, 0.5, 0>, <0.8, 0.5, 0>, <0, 0.7, 0.7> }
  triangle { <0, 0.5, 0>, <0.8, 0.5, 0>, <0, 0.7, 0.7> }
  triangle { <0.8, 0.5, 0>, <0, 0.7, 0.7>, <0.9, 0.8, 0.8> }
  triangle { <0, 0.9, 0>, <0, 0.9, 0>, <0.5, 0.9, 0> }
  triangle { <0, 0.9, 0>, <0.3, 0.9, 0>, <0.6, 0.9, 0> }
  triangle { <0.2, 1, 0.2>, <0.2, 1, 0.2>, <0.2, 1, 0.2> }
  triangle { <-0.3, 0.6, -0.5>, <1.2, 0.6, -0.5>, <0.4, 0.6, -0.499> }
  smooth_triangle { <0, 0.6, -0.3>, y, <0.4, 0.6, -0.3>, y, <0.2, 0.8, -0.1>, y }
  smooth_triangle { <0, 0.6, -0.3>, y, <0.2, 0.6, -0.3>, y, <0.4, 0.6, -0.3>, y }
#end
mesh { Sheets() texture { WhiteMatte } translate -1.6*x }
union { Sheets() texture { WhiteMatte } translate <0.5, 0, 0.2> }
mesh2 {
  vertex_vectors { 5, <0, 0.6, 0>, <0.5, 0.6, 0>, <0, 0.6, 0.5>, <1, 0.6, 0>, <0.5, 0.6, 0.5> }
  face_indices { 4, <0, 1, 2>, <1, 4, 2>, <1, 1, 4>, <0, 1, 3> }
  pigment { Grey } finish { Clear } translate <-0.4, 0, -1.3>
}
