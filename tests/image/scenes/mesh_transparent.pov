// SPDX-License-Identifier: AGPL-3.0-or-later
// Meshes without inside_vector, transparent, with several sheets along a light ray.
// Four sheets give four filterings: a mesh reports its nearest hit only and has to be asked again.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
mesh {
  #for (I, 0, 3)
    triangle { <-1.8 + 0.2*I, 0.4 + 0.25*I, -0.8>, <-0.4 + 0.2*I, 0.4 + 0.25*I, -0.8>, <-1.1 + 0.2*I, 0.4 + 0.25*I, 0.6> }
  #end
  pigment { rgbf <0.8, 0.7, 0.5, 1> } finish { Clear }
}
#declare V = array[6] { <0.6, 0, 0>, <-0.6, 0, 0>, <0, 0.6, 0>, <0, -0.6, 0>, <0, 0, 0.6>, <0, 0, -0.6> }
#declare Octahedron = mesh {
  #for (I, 0, 1) #for (J, 2, 3) #for (K, 4, 5) triangle { V[I], V[J], V[K] } #end #end #end
  pigment { rgbf <0.5, 0.8, 0.7, 1> } finish { Clear }
}
object { Octahedron translate <1.2, 0.9, -0.2> }
object { Octahedron scale 0.5 translate <1.2, 0.9, -0.2> }
mesh {
  smooth_triangle { <0.2, 0.6, 0.9>, <-0.5, 1, 0>, <1.6, 0.7, 1.0>, <0.5, 1, 0>, <0.9, 0.5, 2.0>, <0, 1, 0.5> }
  smooth_triangle { <0.2, 0.9, 0.9>, <-0.5, 1, 0>, <1.6, 1.0, 1.0>, <0.5, 1, 0>, <0.9, 0.8, 2.0>, <0, 1, 0.5> }
  pigment { rgbf <0.9, 0.6, 0.6, 1> } finish { Clear }
}
