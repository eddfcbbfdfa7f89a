// SPDX-License-Identifier: AGPL-3.0-or-later
// A parallel light (Declare=Cylinder=1: a cylinder light) on a colonnade: the map is orthographic.
// Look at the shadows: parallel, the same at both ends of the row, without acne on the flutes or leaks at their feet.
// Truth: ray-traced.
//
// Declare=Cylinder=0   1: a cylinder light, which also ends at its own radius
// Declare=Resolution=1024 Declare=Samples=16: map pixels of a face, light rays a pixel; Declare=Accuracy=0.01 in place of these two
// Declare=White=0      1: everything matte white, so that the picture shows the shadows alone
#version 3.7;
global_settings { assumed_gamma 1 }

#ifndef (Cylinder) #declare Cylinder = 0; #end
#ifndef (White)    #declare White = 0; #end
#ifndef (Resolution) #declare Resolution = 1024; #end
#ifndef (Samples) #declare Samples = 16; #end

camera {
  location <-1.5, 4.2, -10.5>
  right x*image_width/image_height
  look_at <0.1, 1.0, 0.3>
  angle 42
}

light_source {
  <-8, 9, -5>, rgb <1.0, 0.95, 0.88>*1.1
  #if (Cylinder) cylinder radius 2.6 falloff 3.2 tightness 0 #else parallel #end
  point_at <0, 0.5, 0>
  deep_shadow { #ifdef (Accuracy) accuracy Accuracy #else resolution Resolution samples Samples #end }
}

background { rgb <0.42, 0.55, 0.72> }

#macro Paint(Colour)
  pigment { rgb #if (White) 1 #else Colour #end }
  finish { #if (White) ambient 0 diffuse 1 #else ambient 0.07 diffuse 0.88 #end }
#end

box { <-6, -0.2, -4>, <6, 0, 5> Paint(<0.80, 0.76, 0.68>) }
#for (I, 0, 5)
  #declare X = -3.75 + 1.5*I;
  union {
    difference {
      cylinder { <X, 0.15, 0.8>, <X, 2.5, 0.8>, 0.25 }
      #for (J, 0, 11)
        cylinder { 0.1*y, 2.6*y, 0.05 translate <X + 0.27*cos(J*pi/6), 0, 0.8 + 0.27*sin(J*pi/6)> }
      #end
    }
    box { <X - 0.35, 0, 0.45>, <X + 0.35, 0.15, 1.15> }
    box { <X - 0.35, 2.5, 0.45>, <X + 0.35, 2.62, 1.15> }
    Paint(<0.88, 0.84, 0.78>)
  }
#end
box { <-4.3, 2.62, 0.4>, <4.3, 2.95, 1.2> Paint(<0.88, 0.84, 0.78>) }
// A pane, a sphere, a fence of rods.
box { <-2.6, 0, -1.6>, <-1.2, 1.3, -1.57> rotate 12*y pigment { rgbf <0.2, 0.5, 0.95, 0.95> } finish { ambient 0 diffuse 0.1 } }
sphere { <0.4, 0.55, -1.4>, 0.55 Paint(<0.85, 0.35, 0.25>) }
#for (I, 0, 14) cylinder { <1.7 + 0.14*I, 0, -1.6>, <1.7 + 0.14*I, 0.9, -1.6>, 0.015 Paint(<0.35, 0.45, 0.35>) } #end
cylinder { <1.6, 0.8, -1.6>, <3.8, 0.8, -1.6>, 0.015 Paint(<0.35, 0.45, 0.35>) }
