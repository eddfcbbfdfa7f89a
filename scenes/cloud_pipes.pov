// SPDX-License-Identifier: AGPL-3.0-or-later
// A cloud with pipes through it: one map shadows media and surfaces, both ways (Lokovic & Veach 2000, figure 11).
// Look at the dark shafts that the pipes throw into the cloud, and at the cloud's soft shadow on pipes, floor and wall.
// Truth: surfaces as ray-traced; media by the integral of the density, which ray tracing nears as MS grows.
//
// Declare=MS=20         media samples of a ray
// Declare=Density=3.2   extinction where the cloud is thickest, a unit of length
// Declare=White=0       1: black background, white light, all surfaces matte white and no glow, so that the picture shows
//                       the light that shadows leave
// Declare=Resolution=512 Declare=Samples=16   of the map
// Declare=Accuracy=0.01 in place of these two; Declare=Bound=8192: the finest resolution that it may use
// Declare=Tolerance=-1 Declare=Blur=0   as in deep_shadow; -1: automatic
// Declare=File=0        1: the map is saved as cloud_pipes1.exr; 2: it is loaded from there
// Declare=Pcf=0         1: shadow_map (percentage closer filtering) in place of deep_shadow; then NumSamples in place of
//                       Samples, and MinSamples, ResFactor, MinSize, Bias0 and Bias1: words of shadow_map, as its paper calls them
#version 3.7;
global_settings { assumed_gamma 1 }

#ifndef (MS)         #declare MS = 20; #end
#ifndef (Density)    #declare Density = 3.2; #end
#ifndef (White)      #declare White = 0; #end
#ifndef (Resolution) #declare Resolution = 512; #end
#ifndef (Samples)    #declare Samples = 16; #end
#ifndef (Tolerance)  #declare Tolerance = -1; #end
#ifndef (Blur)       #declare Blur = 0; #end
#ifndef (File)       #declare File = 0; #end
#ifndef (Pcf)        #declare Pcf = 0; #end
#ifndef (NumSamples) #declare NumSamples = 16; #end

camera {
  location <0.3, 1.9, -7.6>
  right x*image_width/image_height
  look_at <0.1, 0.05, 0>
  angle 40
}

// What stands in a light's block: the same words for both kinds of map, but for those that only one has.
#macro Words(Number)
  #ifdef (Accuracy)
    accuracy Accuracy
    #ifdef (Bound) resolution Bound #end
  #else
    resolution Resolution samples (Pcf ? NumSamples : Samples)
  #end
  #if (File = 1) save_file concat("cloud_pipes", str(Number, 0, 0), ".exr") #end
  #if (File = 2) load_file concat("cloud_pipes", str(Number, 0, 0), ".exr") #end
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
  <-5.5, 6.5, -2.0>, rgb #if (White) 1 #else <1.0, 0.93, 0.82>*3.3 #end
  spotlight point_at <0.2, -0.1, 0> radius 22 falloff 40
  #if (Pcf) shadow_map { Words(1) } #else deep_shadow { Words(1) } #end
}

background { rgb #if (White) 0 #else <0.16, 0.20, 0.28> #end }

#declare Matte = texture { pigment { rgb 1 } finish { ambient 0 diffuse 1 } }
#declare Stone = texture { #if (White) Matte #else pigment { rgb <0.40, 0.46, 0.54> } finish { ambient 0.03 diffuse 0.55 } #end }

// Floor and wall.
box { <-8, -1.9, -6>, <8, -1.8, 3> texture { Stone } }
box { <-8, -1.8, 2.9>, <8, 6, 3> texture { Stone } }

// Pipes, with a flange where they leave the picture's middle.
#declare Copper = texture { #if (White) Matte #else pigment { rgb <0.85, 0.42, 0.22> } finish { ambient 0.04 diffuse 0.5 specular 0.7 roughness 0.02 metallic } #end }
#declare Steel = texture { #if (White) Matte #else pigment { rgb <0.55, 0.60, 0.66> } finish { ambient 0.04 diffuse 0.5 specular 0.7 roughness 0.02 metallic } #end }
#macro Pipe(From, To, R)
  cylinder { From, To, R }
  #local D = vnormalize(To - From);
  #for (I, 0.12, 0.9, 0.38)
    #local P = From + (To - From)*I;
    cylinder { P - 0.06*D, P + 0.06*D, R*1.5 }
  #end
#end
union { Pipe(<-3.2, 1.15, -0.75>, <3.2, 0.75, -0.35>, 0.13) texture { Copper } }
union { Pipe(<-3.2, -0.15, 0.4>, <3.2, -0.5, -0.45>, 0.17) texture { Steel } }
union { Pipe(<-0.9, -1.8, -0.25>, <-0.7, 2.6, -0.65>, 0.11) texture { Copper } }
union { Pipe(<1.0, -1.8, -0.4>, <0.7, 2.6, 0.25>, 0.14) texture { Steel } }

// The cloud.
sphere {
  0, 1
  scale <2.2, 1.6, 1.4>
  hollow
  pigment { rgbt 1 }
  interior {
    media {
      method 2 intervals 1 samples MS
      scattering { 1, rgb Density }
      #if (!White) emission rgb <0.025, 0.032, 0.046>*Density #end
      density {
        spherical
        scale 0.78
        warp { turbulence 0.4 octaves 4 lambda 2.3 omega 0.55 }
        density_map { [0.05 rgb 0] [0.35 rgb 0.8] [1 rgb 1] }
        scale <2.2, 1.6, 1.4>
      }
    }
  }
}
