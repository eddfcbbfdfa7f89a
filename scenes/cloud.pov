// SPDX-License-Identifier: AGPL-3.0-or-later
// A cumulus of scattering media with turbulence, lit from one side (Lokovic & Veach 2000, figure 10).
// Look at the dark base and at the creases between the lobes: without self-shadowing the cloud is a flat white patch.
// Truth: the integral of the density, which ray tracing nears as MS grows (method 2: even samples, nothing random).
//
// Declare=MS=20       media samples of a ray
// Declare=Density=4   extinction where the cloud is thickest, a unit of length
// Declare=White=0     1: black sky, white light and no glow, so that the picture shows the light that shadows leave
// Declare=Resolution=128 Declare=Samples=4   of the map
// Declare=Accuracy=0.01 in place of these two; Declare=Bound=8192: the finest resolution that it may use
// Declare=Tolerance=-1 Declare=Blur=0   as in deep_shadow; -1: automatic
// Declare=File=0      1: the map is saved as cloud1.exr; 2: it is loaded from there
// Declare=Pcf=0       1: shadow_map (percentage closer filtering) in place of deep_shadow; then NumSamples in place of
//                     Samples, and MinSamples, ResFactor, MinSize, Bias0 and Bias1: words of shadow_map, as its paper calls them
#version 3.7;
global_settings { assumed_gamma 1 }

#ifndef (MS)         #declare MS = 20; #end
#ifndef (Density)    #declare Density = 4; #end
#ifndef (White)      #declare White = 0; #end
#ifndef (Resolution) #declare Resolution = 128; #end
#ifndef (Samples)    #declare Samples = 4; #end
#ifndef (Tolerance)  #declare Tolerance = -1; #end
#ifndef (Blur)       #declare Blur = 0; #end
#ifndef (File)       #declare File = 0; #end
#ifndef (Pcf)        #declare Pcf = 0; #end
#ifndef (NumSamples) #declare NumSamples = 16; #end

camera {
  location <0, -0.3, -8>
  right x*image_width/image_height
  look_at <0, 0.05, 0>
  angle 36
}

// What stands in a light's block: the same words for both kinds of map, but for those that only one has.
#macro Words(Number)
  #ifdef (Accuracy)
    accuracy Accuracy
    #ifdef (Bound) resolution Bound #end
  #else
    resolution Resolution samples (Pcf ? NumSamples : Samples)
  #end
  #if (File = 1) save_file concat("cloud", str(Number, 0, 0), ".exr") #end
  #if (File = 2) load_file concat("cloud", str(Number, 0, 0), ".exr") #end
  #if (Pcf)
    #ifdef (MinSamples) min_samples MinSamples #end
    #ifdef (ResFactor) size_factor ResFactor #end
    #ifdef (MinSize) min_size MinSize #end
    #ifdef (Bias0) bias Bias0, Bias1 #end
  #else
    #if (Tolerance >= 0) tolerance Tolerance #end
    #if (Blur > 0) blur Blur #end
  #end
#end

light_source {
  <9, 10, -5.5>, rgb #if (White) 3.2 #else <1.0, 0.93, 0.82>*3.2 #end
  spotlight point_at 0 radius 16 falloff 20
  #if (Pcf) shadow_map { Words(1) } #else deep_shadow { Words(1) } #end
}

#if (!White)
sky_sphere {
  pigment {
    gradient y
    color_map { [0 rgb <0.55, 0.68, 0.82>] [0.25 rgb <0.22, 0.40, 0.66>] [0.6 rgb <0.08, 0.19, 0.42>] }
    translate -0.25*y
  }
}
#end

// Soft balls on a flat base; the turbulence below makes the cauliflower.
#declare Ball = function (x, y, z, R) { max(0, 1 - (x*x + y*y + z*z)/(R*R)) }
#declare Lobes = function (x, y, z) {
  min(1, Ball(x - 0.1, y + 0.1, z, 1.1) + Ball(x - 1.15, y + 0.35, z + 0.1, 0.9) + Ball(x + 1.1, y + 0.3, z - 0.1, 0.95)
   + Ball(x + 0.4, y - 0.5, z + 0.1, 0.75) + Ball(x - 0.6, y - 0.3, z - 0.25, 0.7)) * min(1, max(0, 2*(y + 0.95)))
}

sphere {
  0, 1
  scale <2.3, 1.4, 1.25>
  hollow
  pigment { rgbt 1 }
  interior {
    media {
      method 2 intervals 1 samples MS
      scattering { 1, rgb Density }
      #if (!White) emission rgb <0.10, 0.13, 0.18>*Density #end
      density {
        function { Lobes(x, y, z) }
        warp { turbulence 0.32 octaves 3 lambda 2.6 omega 0.5 }
        density_map { [0.15 rgb 0] [0.5 rgb 0.75] [0.8 rgb 1] }
      }
    }
  }
}
