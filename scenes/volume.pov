// SPDX-License-Identifier: AGPL-3.0-or-later
// A sampled volume: a head of nested shells, as a CT scanner would see one, with a piece cut out (Hadwiger et al. 2006, figure 6).
// Look at the shadow that the edge of the skull throws on what lies in it, and at the thin skin: its transfer function has steps.
// Truth: the integral of the density, which ray tracing nears as MS grows (method 2: even samples, nothing random).
//
// Declare=MS=80       media samples of a ray
// Declare=Density=9   extinction of bone, a unit of length
// Declare=White=0     1: black sky, white light and no glow, so that the picture shows the light that shadows leave
// Declare=Resolution=256 Declare=Samples=4   of the map
// Declare=Accuracy=0.01 in place of these two; Declare=Bound=8192: the finest resolution that it may use
// The first render writes the volume, 64 voxels each way, to volume.df3 in the current folder; later ones read it.
#version 3.7;
global_settings { assumed_gamma 1 }

#ifndef (MS)         #declare MS = 80; #end
#ifndef (Density)    #declare Density = 9; #end
#ifndef (White)      #declare White = 0; #end
#ifndef (Resolution) #declare Resolution = 256; #end
#ifndef (Samples)    #declare Samples = 4; #end
#declare Voxels = 64;

#if (!file_exists("volume.df3"))
  // The share of a ball of radius 1, stretched, that a voxel lies in: 0 outside, 1 inside, and between across its edge.
  #declare Ball = function (x, y, z, X, Y, Z, Edge) { min(1, max(0, 0.5 + (1 - sqrt(x*x/(X*X) + y*y/(Y*Y) + z*z/(Z*Z)))/Edge)) }
  #declare Inner = function (x, y, z) {
    0.45 + 0.06*sin(19*x + 3*sin(9*y))*sin(17*y + 2*sin(8*z))*sin(18*z)
    - 0.25*max(Ball(x - 0.17, y - 0.05, z + 0.05, 0.11, 0.2, 0.3, 0.15), Ball(x + 0.17, y - 0.05, z + 0.05, 0.11, 0.2, 0.3, 0.15))
    + 0.3*Ball(x - 0.3, y - 0.32, z + 0.3, 0.15, 0.15, 0.15, 0.2) }
  #declare Head = function (x, y, z) {
    0.28*Ball(x, y, z, 0.80, 0.92, 0.90, 0.05)
    + 0.62*Ball(x, y - 0.01, z, 0.71, 0.83, 0.81, 0.05)
    + (Inner(x, y, z) - 0.9)*Ball(x, y - 0.01, z, 0.62, 0.74, 0.72, 0.05) }
  #fopen File "volume.df3" write
  #write (File, uint16be Voxels, uint16be Voxels, uint16be Voxels)
  #for (K, 0, Voxels - 1)
    #for (J, 0, Voxels - 1)
      #for (I, 0, Voxels - 1)
        #write (File, uint8 int(255*min(1, max(0, Head(2*I/Voxels - 1, 2*J/Voxels - 1, 2*K/Voxels - 1))) + 0.5))
      #end
    #end
  #end
  #fclose File
#end

camera {
  location <-2.6, 2.1, -4.6>
  right x*image_width/image_height
  look_at <0, -0.08, 0>
  angle 31
}

light_source {
  <-5.5, 6, -3.2>, rgb #if (White) 1 #else <1.0, 0.95, 0.88>*1.15 #end
  spotlight point_at 0 radius 14 falloff 20
  deep_shadow {
    #ifdef (Accuracy)
      accuracy Accuracy
      #ifdef (Bound) resolution Bound #end
    #else
      resolution Resolution samples Samples
    #end
  }
}

#if (!White)
  background { rgb <0.05, 0.06, 0.08> }
#end
box {
  <-6, -1.2, -6>, <6, -1.1, 6>
  #if (White)
    pigment { rgb 1 } finish { ambient 0 diffuse 1 }
  #else
    pigment { rgb <0.45, 0.48, 0.52> } finish { ambient 0.02 diffuse 0.9 }
  #end
}

difference {
  box { -1, 1 }
  box { <-1.1, 0.05, -1.1>, <0.12, 1.1, 0.1> }
  hollow
  pigment { rgbt 1 }
  interior {
    media {
      method 2 intervals 1 samples MS
      scattering { 1, rgb Density }
      emission rgb (White ? 0 : 0.03*Density)
      density {
        density_file df3 "volume.df3" interpolate 1
        translate -0.5
        scale 2
        density_map {
          [0.18 rgb 0] [0.18 rgb <0.10, 0.065, 0.05>]                        // skin: a thin veil
          [0.33 rgb <0.10, 0.065, 0.05>] [0.33 rgb <0.05, 0.03, 0.03>]       // what is soft
          [0.47 rgb <0.45, 0.24, 0.22>] [0.60 rgb <0.5, 0.25, 0.22>]
          [0.60 rgb <0.25, 0.55, 0.65>] [0.78 rgb <0.25, 0.55, 0.65>]        // a lump that does not belong there
          [0.78 rgb <1, 0.97, 0.90>]                                         // bone
        }
      }
    }
  }
}
