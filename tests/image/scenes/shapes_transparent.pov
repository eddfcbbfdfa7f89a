// SPDX-License-Identifier: AGPL-3.0-or-later
// Transparent casters of the shapes that report their nearest hit only, and of others.
// Every shadow is filtered at each surface: twice for a closed shape, four times through the lathe's wall.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
light_source {
  <-3, 6, -1.5>, rgb 1
  spotlight point_at 0 radius 26 falloff 32
  deep_shadow { resolution 512 }
}
#declare Glass = texture { pigment { rgbf <0.7, 0.6, 0.8, 1> } finish { Clear } }
blob { threshold 0.5 sphere { 0, 0.6, 1 } sphere { <0.6, 0, 0>, 0.5, 1 } texture { Glass } translate <-2.2, 0.6, -1.2> }
lathe { linear_spline 5, <0.25, 0>, <0.5, 0.3>, <0.4, 0.8>, <0.3, 0.8>, <0.25, 0> texture { Glass } translate <-0.8, 0.2, -1.2> }
sor { 5, <0, -0.2>, <0.4, 0>, <0.5, 0.4>, <0.2, 0.8>, <0.1, 1.2> texture { Glass } translate <0.5, 0.1, -1.2> }
superellipsoid { <0.3, 0.4> scale 0.45 texture { Glass } translate <1.8, 0.7, -1.2> }
torus { 0.4, 0.15 texture { Glass } rotate 30*x translate <-2.2, 0.6, 0.3> }
prism { 0, 0.6, 4, <-0.4, -0.3>, <0.4, -0.3>, <0, 0.5>, <-0.4, -0.3> texture { Glass } translate <-0.9, 0.3, 0.3> }
bicubic_patch { type 1 u_steps 3 v_steps 3 flatness 0.01
  <-0.5, 0, -0.5>, <-0.2, 0.3, -0.5>, <0.2, -0.3, -0.5>, <0.5, 0, -0.5>, <-0.5, 0.2, -0.2>, <-0.2, 0.8, -0.2>, <0.2, 0.4, -0.2>, <0.5, 0, -0.2>,
  <-0.5, 0.2, 0.2>, <-0.2, 0.8, 0.2>, <0.2, 0.4, 0.2>, <0.5, 0, 0.2>, <-0.5, 0, 0.5>, <-0.2, 0.3, 0.5>, <0.2, -0.3, 0.5>, <0.5, 0, 0.5>
  texture { Glass } translate <0.5, 0.6, 0.3> }
sphere_sweep { b_spline 5, <-0.8, 0, 0>, 0.1, <-0.3, 0.2, 0>, 0.2, <0, 0.6, 0.2>, 0.2, <0.4, 0.2, 0>, 0.15, <0.8, 0, 0>, 0.1 texture { Glass } translate <1.8, 0.5, 0.3> }
cone { <-2.2, 0.2, 1.5>, 0.4, <-2.2, 1.0, 1.5>, 0.1 texture { Glass } }
quartic { <1,0,0,0,2,0,0,2,0,-0.4,0,0,0,0,0,0,0,0,0,0,1,0,0,2,0,0.2,0,0,0,0,1,0,-0.4,0,0.03> sturm texture { Glass } bounded_by { sphere { 0, 1 } } translate <-0.9, 0.6, 1.6> }
text { ttf "timrom.ttf" "B8" 0.2, 0 texture { Glass } rotate 60*x translate <0.1, 0.6, 1.3> }
quadric { <1, 2, 1>, <0, 0, 0>, <0, 0, 0>, -0.25 texture { Glass } translate <1.9, 0.6, 1.6> bounded_by { sphere { <1.9, 0.6, 1.6>, 0.6 } } }
