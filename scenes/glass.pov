// SPDX-License-Identifier: AGPL-3.0-or-later
// Coloured glass: panes in layers, a checkered pane, a marbled pane, spheres and a vase, on a white floor (a finite box).
// Look at the colours where shadows cross: red over blue, checks over green, and twice through the wall of each sphere.
// Truth: ray-traced; filter and transmit only, no photons, no caustics, so light passes straight through.
//
// Declare=White=0      1: the glass is not seen and the floor is white, so that the picture shows the shadows alone
// Declare=Resolution=1024 Declare=Samples=16   of the two maps
// Declare=Accuracy=0.01 in place of these two; Declare=Bound=8192: the finest resolution that it may use
// Declare=Tolerance=-1 Declare=Blur=0   as in deep_shadow; -1: automatic
// Declare=File=0       1: the maps are saved as glass1.exr, ...; 2: they are loaded from there
// Declare=Pcf=0        1: shadow_map (percentage closer filtering) in place of deep_shadow; then NumSamples in place of
//                      Samples, and MinSamples, ResFactor, MinSize, Bias0 and Bias1: words of shadow_map, as its paper calls them
#version 3.7;
#ifndef (Resolution) #declare Resolution = 1024; #end
#ifndef (Samples)    #declare Samples = 16; #end
#ifndef (White)      #declare White = 0; #end
#ifndef (Tolerance)  #declare Tolerance = -1; #end
#ifndef (Blur)       #declare Blur = 0; #end
#ifndef (File)       #declare File = 0; #end
#ifndef (Pcf)        #declare Pcf = 0; #end
#ifndef (NumSamples) #declare NumSamples = 16; #end
global_settings { assumed_gamma 1 max_trace_level 12 }

camera {
  location <0.2, 5.4, -9.8>
  right x*image_width/image_height
  look_at <0.25, 0.2, -0.1>
  angle 42
}

// What stands in a light's block: the same words for both kinds of map, but for those that only one has.
#macro Words(Number)
  #ifdef (Accuracy)
    accuracy Accuracy
    #ifdef (Bound) resolution Bound #end
  #else
    resolution Resolution samples (Pcf ? NumSamples : Samples)
  #end
  #if (File = 1) save_file concat("glass", str(Number, 0, 0), ".exr") #end
  #if (File = 2) load_file concat("glass", str(Number, 0, 0), ".exr") #end
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
  <-3.5, 8.5, 7>, rgb #if (White) 0.8 #else <1.0, 0.97, 0.92>*1.15 #end
  spotlight point_at <0.3, 0, -0.6> radius 30 falloff 38
  #if (Pcf) shadow_map { Words(1) } #else deep_shadow { Words(1) } #end
}
light_source {
  <5, 8, -8>, rgb #if (White) 0.2 #else <0.20, 0.23, 0.28> #end
  spotlight point_at 0 radius 26 falloff 34
  #if (Pcf) shadow_map { Words(2) } #else deep_shadow { Words(2) } #end
}

background { rgb <0.35, 0.40, 0.48> }

#declare Polish = finish { ambient 0 diffuse 0.12 specular 0.6 roughness 0.004 reflection { 0.02, 0.35 fresnel on } conserve_energy }
#declare Solid = interior { ior 1.5 }
#macro Seen() #if (White) no_image no_reflection #end #end

// The floor.
box { <-9, -0.2, -7>, <9, 0, 9> pigment { rgb 1 } finish { ambient 0 diffuse (White ? 1 : 0.9) } }

// A fan of three plain panes: the shadows multiply where they cross.
#declare Pane = box { <-0.9, 0, -0.03>, <0.9, 2.1, 0.03> }
object { Pane pigment { rgbf <0.95, 0.18, 0.12, 0.95> } finish { Polish } interior { Solid } rotate -28*y translate <-2.75, 0.02, 0.7> Seen() }
object { Pane pigment { rgbf <0.15, 0.35, 0.95, 0.95> } finish { Polish } interior { Solid } rotate -8*y translate <-2.0, 0.02, 0.05> Seen() }
object { Pane pigment { rgbf <1.0, 0.85, 0.15, 0.95> } finish { Polish } interior { Solid } rotate 14*y translate <-1.35, 0.02, -0.75> Seen() }

// A pane of checks, and one of marble, filter and transmit mixed.
object {
  Pane
  texture { pigment { checker rgbf <0.15, 0.7, 0.3, 0.9> rgbft <0.9, 0.9, 1.0, 0.3, 0.6> scale 0.3 translate 0.15*z } finish { Polish } }
  interior { Solid }
  Seen()
  rotate -22*y translate <2.35, 0.02, 1.5>
}
box {
  <-0.75, 0, -0.02>, <0.75, 1.5, 0.02>
  texture {
    pigment {
      marble turbulence 0.7
      color_map { [0 rgbf <0.75, 0.2, 0.8, 0.95>] [0.5 rgbft <1, 0.95, 0.9, 0.4, 0.55>] [0.8 rgbf <0.1, 0.6, 0.7, 0.85>] [1 rgb <0.05, 0.1, 0.2>] }
      scale 0.5
    }
    finish { Polish }
  }
  // A second layer: a fine grille, opaque where it is dark.
  texture {
    pigment { brick rgb <0.2, 0.16, 0.1>, rgbt 1 brick_size <0.25, 0.125, 1> mortar 0.012 }
    finish { ambient 0 diffuse 0.6 }
  }
  interior { Solid }
  Seen()
  rotate -30*y translate <3.1, 0.02, -0.2>
}

// Spheres: solid, hollow, and one within another.
sphere { <0.15, 0.62, 0.9>, 0.6 pigment { rgbf <0.2, 0.85, 0.55, 0.92> } finish { Polish } interior { Solid } Seen() }
difference {
  sphere { 0, 0.5 } sphere { 0, 0.46 }
  pigment { rgbf <1.0, 0.5, 0.15, 0.92> } finish { Polish } interior { Solid }
  Seen()
  translate <0.35, 0.52, -1.55>
}
sphere { <1.45, 0.55, -0.85>, 0.53 pigment { rgbf <0.85, 0.9, 1.0, 0.96> } finish { Polish } interior { ior 1.5 } Seen() }
sphere { <1.45, 0.55, -0.85>, 0.28 pigment { rgbf <0.9, 0.15, 0.35, 0.9> } finish { Polish } interior { ior 1.5 } Seen() }
