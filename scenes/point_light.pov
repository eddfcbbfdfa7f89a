// SPDX-License-Identifier: AGPL-3.0-or-later
// A point light in the middle of a room: a lattice all round it, furniture, and rods across the corners (six map faces).
// Look for seams along the lines where faces meet (x, y, z equal in size, from the lamp), and for acne on the walls.
// Truth: ray-traced.
//
// Declare=Resolution=512 Declare=Samples=16: map pixels of a face, light rays a pixel; Declare=Accuracy=0.01 in place of these two
// Declare=White=0   1: everything matte white, so that the picture shows the shadows alone
#version 3.7;
global_settings { assumed_gamma 1 }

#ifndef (White) #declare White = 0; #end
#ifndef (Resolution) #declare Resolution = 512; #end
#ifndef (Samples) #declare Samples = 16; #end

camera {
  location <2.6, 1.2, -2.75>
  right x*image_width/image_height
  look_at <-0.25, -0.30, 0.4>
  angle 88
}

light_source {
  0, rgb <1.0, 0.94, 0.85>*1.2
  deep_shadow { #ifdef (Accuracy) accuracy Accuracy #else resolution Resolution samples Samples #end }
}

#macro Paint(Colour)
  pigment { rgb #if (White) 1 #else Colour #end }
  finish { #if (White) ambient 0 diffuse 1 #else ambient 0.07 diffuse 0.88 #end }
#end

// The room, of six walls 0.1 thick.
box { <-3.1, -2.1, -3.1>, <3.1, -2.0, 3.1> Paint(<0.80, 0.74, 0.66>) }
box { <-3.1, 2.0, -3.1>, <3.1, 2.1, 3.1> Paint(<0.90, 0.90, 0.90>) }
box { <-3.1, -2.0, -3.1>, <-3.0, 2.0, 3.1> Paint(<0.82, 0.62, 0.52>) }
box { <3.0, -2.0, -3.1>, <3.1, 2.0, 3.1> Paint(<0.55, 0.68, 0.80>) }
box { <-3.0, -2.0, -3.1>, <3.0, 2.0, -3.0> Paint(<0.85, 0.85, 0.80>) }
box { <-3.0, -2.0, 3.0>, <3.0, 2.0, 3.1> Paint(<0.70, 0.78, 0.66>) }

// The lamp: edges of an icosahedron.
#declare G = (1 + sqrt(5))/2;
#declare V = array[12] {
  <0,1,G>, <0,1,-G>, <0,-1,G>, <0,-1,-G>, <1,G,0>, <1,-G,0>, <-1,G,0>, <-1,-G,0>, <G,0,1>, <-G,0,1>, <G,0,-1>, <-G,0,-1>
}
union {
  #for (I, 0, 10)
    #for (J, I + 1, 11)
      #if (vlength(V[I] - V[J]) < 2.1) cylinder { V[I]*0.22, V[J]*0.22, 0.006 } #end
    #end
    sphere { V[I]*0.22, 0.014 }
  #end
  Paint(<0.9, 0.7, 0.3>)
}
cylinder { <0, 0.4, 0>, <0, 2, 0>, 0.01 Paint(<0.9, 0.7, 0.3>) }

// Rods through the corners of the six faces, and things in the room.
cylinder { <-1.7, -2, 1.2>, <-1.2, 2, 1.7>, 0.03 Paint(<0.3, 0.4, 0.6>) }
cylinder { <-3, -1.3, -1.4>, <0.5, -1.4, -3>, 0.03 Paint(<0.3, 0.4, 0.6>) }
cylinder { <1.5, -2, 1.7>, <1.3, 2, 1.2>, 0.03 Paint(<0.3, 0.4, 0.6>) }
box { <-0.9, -0.02, -0.5>, <0.9, 0.02, 0.5> translate <-0.6, -1.2, 0.4> Paint(<0.7, 0.5, 0.35>) }
#for (I, 0, 3)
  cylinder { <-1.4 + 1.6*mod(I, 2), -2, 0.8*div(I, 2)>, <-1.4 + 1.6*mod(I, 2), -1.2, 0.8*div(I, 2)>, 0.04 Paint(<0.7, 0.5, 0.35>) }
#end
sphere { <-0.9, -0.98, 0.3>, 0.2 Paint(<0.85, 0.3, 0.25>) }
cone { <-0.2, -1.18, 0.5>, 0.18, <-0.2, -0.7, 0.5>, 0 Paint(<0.3, 0.65, 0.4>) }
sphere { <1.7, -1.6, 1.3>, 0.4 Paint(<0.35, 0.45, 0.8>) }
torus { 0.5, 0.1 rotate 70*x translate <-2.2, -1.4, -0.6> Paint(<0.85, 0.75, 0.3>) }
box { -0.35, 0.35 rotate <0, 30, 0> translate <1.2, -1.65, -0.8> Paint(<0.75, 0.35, 0.55>) }
