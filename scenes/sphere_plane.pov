// SPDX-License-Identifier: AGPL-3.0-or-later
// A red sphere before an upright green wall (Declare=Colored=1: white, under three coloured lights), with a shadow_map.
// Look at the edge of the shadow, its softness and noise, and at the moiré on sphere and wall where the bias is 0.
// Truth: ray-traced, with hard shadows; a map blurs them over size_factor image pixels, and moves them by the bias.
//
// The world measures 100 units, as that of Reeves, Salesin & Cook, whose figures 5 to 11 these are:
// Declare=Shadow=1                           6   the shadow component alone
// Declare=Shadow=1 Declare=Plain=1           6a  an ordinary z-buffer: one sample of one pixel
// Declare=NumSamples=1, 4, 16                7   noise
// Declare=ResFactor=1, 3, 8                  8   softness
// Declare=Bias0=0 Declare=Bias1=0, or 0.2 and 0.3, or 0.3 and 0.4    9   self-shadowing (the default is automatic)
// Declare=Resolution=256, 512, 1024          10  detail
// Declare=Colored=1                          11  three coloured lights
// Declare=Pcf=0 Declare=Samples=16: a deep_shadow instead, of so many light rays a map pixel
// Declare=File=1: the maps are saved as sphere_plane1.exr, ...; 2: they are loaded from there
// More: Declare=MinSamples=3 Declare=MinSize=2 Declare=Jittered=0 Declare=Pattern="uniform" (quoted twice for the shell)
#version 3.7;
global_settings { assumed_gamma 1 }

#ifndef (NumSamples) #declare NumSamples = 16; #end
#ifndef (MinSamples) #declare MinSamples = 3; #end
#ifndef (ResFactor)  #declare ResFactor = 3; #end
#ifndef (MinSize)    #declare MinSize = 2; #end
#ifndef (Bias0)      #declare Bias0 = -1; #end   // -1: automatic
#ifndef (Bias1)      #declare Bias1 = Bias0; #end
#ifndef (Resolution) #declare Resolution = 1024; #end
#ifndef (Jittered)   #declare Jittered = 0; #end
#ifndef (Pattern)    #declare Pattern = "jittered"; #end
#ifndef (Shadow)     #declare Shadow = 0; #end
#ifndef (Plain)      #declare Plain = 0; #end
#ifndef (Colored)    #declare Colored = 0; #end
#ifndef (Pcf)        #declare Pcf = 1; #end
#ifndef (Samples)    #declare Samples = 16; #end
#ifndef (File)       #declare File = 0; #end

#if (Plain)
  #declare NumSamples = 1;
  #declare ResFactor = 0;
  #declare MinSize = 0;
#end

camera {
  location <-14, 6, -120>
  right x*image_width/image_height
  look_at <4, 0, 20>
  angle 40
}

// The light's maps in files, numbered in their order.
#declare Maps = 0;
#macro Kept()
  #declare Maps = Maps + 1;
  #if (File = 1) save_file concat("sphere_plane", str(Maps, 0, 0), ".exr") #end
  #if (File = 2) load_file concat("sphere_plane", str(Maps, 0, 0), ".exr") #end
#end

#macro Light(Place, Colour)
  light_source {
    Place, Colour
    spotlight point_at <2, 0, 10> radius 24 falloff 26 tightness 0
    #if (Pcf) shadow_map {
      resolution Resolution samples NumSamples min_samples MinSamples size_factor ResFactor min_size MinSize
      #if (Bias0 >= 0) bias Bias0, Bias1 #end
      depth_samples #if (Jittered) "jittered" #else "regular" #end
      pattern Pattern Kept()
    } #else deep_shadow { resolution Resolution samples Samples Kept() } #end
  }
#end

#if (Colored)
  Light(<-110, 48, -90>, <1, 0, 0>)
  Light(<-125, 40, -70>, <0, 1, 0>)
  Light(<-120, 20, -85>, <0, 0, 1>)
#else
  Light(<-120, 40, -80>, rgb 1)
#end

#macro Paint(Colour)
  pigment { rgb #if (Colored | Shadow) 1 #else Colour #end }
  finish {
    #if (Shadow) ambient 0 diffuse 0.5 brilliance 0   // alike at all angles: what is dark is in shadow
    #else ambient 0.06 diffuse 0.9 specular 0.3 roughness 0.03 #end
  }
#end

sphere { <-10, 0, -8>, 16 Paint(<0.85, 0.12, 0.08>) }
box { <-50, -50, 20>, <50, 50, 22> Paint(<0.15, 0.55, 0.22>) }
