// SPDX-License-Identifier: AGPL-3.0-or-later
// A point light 100,000 units away, as most scenes have their sun; some casters are as thin as 0.005.
// Look at the thin rods' shadows: they stay, and the picture is the one from 50 units away.
// Truth: ray-traced, at either distance: those rays start at the receiver. Rays that start at the light miss thin things.
//
// Declare=Distance=1e5   distance of the light. From 50 units the shadows' ends are up to 0.01 units elsewhere: about one
//                        image pixel at 320x240, so compare with the RMSE, not with the maximum.
// Declare=White=0        1: everything matte white, so that the picture shows the shadows alone
#version 3.7;
global_settings { assumed_gamma 1 }

#ifndef (Distance) #declare Distance = 1e5; #end
#ifndef (White)    #declare White = 0; #end

camera {
  location <0, 1.9, -2.6>
  right x*image_width/image_height
  look_at <0, 0.06, 0.02>
  angle 38
}

light_source {
  vnormalize(<-3, 5, -2>)*Distance, rgb 1
  deep_shadow { resolution 1024 samples 16 }
}

background { rgb <0.25, 0.32, 0.42> }

#macro Paint(Colour)
  pigment { rgb #if (White) 1 #else Colour #end }
  finish { #if (White) ambient 0 diffuse 1 #else ambient 0.07 diffuse 0.88 #end }
#end

box { <-1.3, -0.05, -1.0>, <1.3, 0, 1.2> Paint(<0.85, 0.82, 0.76>) }
sphere { <-0.55, 0.2, 0.1>, 0.2 Paint(<0.85, 0.35, 0.25>) }
box { <-0.1, 0, -0.1>, <0.1, 0.35, 0.1> rotate 25*y translate <0.02, 0, 0.3> Paint(<0.30, 0.50, 0.80>) }
sphere { <0.05, 0.12, -0.3>, 0.1 pigment { rgbf <0.3, 0.9, 0.4, 0.9> } finish { ambient 0 diffuse 0.1 specular 0.5 } }
// Thin: a rack of rods, a grid of beads, a lid.
#for (I, 0, 8)
  cylinder { <0.35 + 0.06*I, 0, -0.25>, <0.35 + 0.06*I, 0.4, -0.15>, 0.005 Paint(<0.9, 0.7, 0.3>) }
#end
cylinder { <0.3, 0.4, -0.15>, <0.88, 0.4, -0.15>, 0.008 Paint(<0.9, 0.7, 0.3>) }
#for (I, 0, 24)
  sphere { <-0.75 + 0.06*mod(I, 5), 0.12, -0.45 + 0.06*div(I, 5)>, 0.006 Paint(<0.6, 0.3, 0.7>) }
#end
box { <0.4, 0.2, 0.25>, <0.8, 0.205, 0.6> Paint(<0.5, 0.6, 0.4>) }
