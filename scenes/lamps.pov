// SPDX-License-Identifier: AGPL-3.0-or-later
// Two desk lamps, a large one and a small one, and a ball between them: three lights with a shadow_map each, one in either lamp.
// Look at the shadows of the lamps on the table, soft at their edges, and inside the shades, where the bulbs' light ends.
// Truth: ray-traced, with hard shadows (Shadow_Method=raytraced).
//
// In the manner of figure 12 of Reeves, Salesin & Cook. Declare=Resolution=1024, Declare=NumSamples=16, Declare=ResFactor=3
// Declare=Pcf=0 Declare=Samples=16: a deep_shadow instead, of so many light rays a map pixel
// Declare=File=1: the maps are saved as lamps1.exr, ...; 2: they are loaded from there
#version 3.7;
global_settings { assumed_gamma 1 }

#ifndef (Resolution) #declare Resolution = 1024; #end
#ifndef (NumSamples) #declare NumSamples = 16; #end
#ifndef (ResFactor)  #declare ResFactor = 3; #end
#ifndef (Pcf)        #declare Pcf = 1; #end
#ifndef (Samples)    #declare Samples = 16; #end
#ifndef (File)       #declare File = 0; #end

camera {
  location <1, 9, -30>
  right x*image_width/image_height
  look_at <0.3, 4.4, 0>
  angle 40
}

// The light's maps in files, numbered in their order.
#declare Maps = 0;
#macro Kept()
  #declare Maps = Maps + 1;
  #if (File = 1) save_file concat("lamps", str(Maps, 0, 0), ".exr") #end
  #if (File = 2) load_file concat("lamps", str(Maps, 0, 0), ".exr") #end
#end

#macro Shadows() #if (Pcf) shadow_map { resolution Resolution samples NumSamples size_factor ResFactor Kept() } #else deep_shadow { resolution Resolution samples Samples Kept() } #end #end

// The ceiling light.
light_source { <-14, 34, -16>, rgb <0.52, 0.56, 0.68> spotlight point_at <0, 2, 0> radius 26 falloff 44 Shadows() }

#declare Enamel = finish { ambient 0.05 diffuse 0.8 specular 0.45 roughness 0.02 }
#declare Steel = texture { pigment { rgb <0.42, 0.43, 0.46> } finish { ambient 0.05 diffuse 0.6 specular 0.7 roughness 0.01 } }

#macro Rod(A, B, R) cylinder { A, B, R texture { Steel } } sphere { A, R*1.6 texture { Steel } } sphere { B, R*1.6 texture { Steel } } #end

// A lamp of this size, on the table at Place: base, two arms, and a shade that looks at Target.
#macro Lamp(Place, Size, Elbow, Head, Target, Colour, Brightness)
  #local Foot = Place + 0.5*Size*y;
  #local E = Place + Size*Elbow;
  #local H = Place + Size*Head;
  #local Axis = vnormalize(Target - H);
  #local Side = vnormalize(vcross(Axis, y));
  union {
    cylinder { Place, Place + 0.28*Size*y, 1.6*Size }
    torus { 1.6*Size, 0.14*Size translate Place + 0.14*Size*y }
    cone { Place + 0.28*Size*y, 0.55*Size, Foot, 0.25*Size }
    pigment { rgb Colour } finish { Enamel }
  }
  #for (I, -1, 1, 2)   // a pair of rods for each arm
    Rod(Foot + 0.16*I*Size*z, E + 0.16*I*Size*z, 0.07*Size)
    Rod(E + 0.16*I*Size*z, H + 0.16*I*Size*z, 0.07*Size)
  #end
  cylinder { E - 0.32*Size*z, E + 0.32*Size*z, 0.16*Size texture { Steel } }
  // The shade is open at both ends of its thickness, and hollow.
  difference {
    union {
      cylinder { H - 0.5*Size*Axis, H + 0.35*Size*Axis, 0.48*Size }
      cone { H + 0.3*Size*Axis, 0.5*Size, H + 1.75*Size*Axis, 1.35*Size }
    }
    union {
      cylinder { H - 0.38*Size*Axis, H + 0.4*Size*Axis, 0.4*Size }
      cone { H + 0.28*Size*Axis, 0.4*Size, H + 1.8*Size*Axis, 1.3*Size }
    }
    pigment { rgb Colour } finish { Enamel }
  }
  sphere { H + 0.85*Size*Axis, 0.42*Size pigment { rgb <1, 0.96, 0.84> } finish { ambient 1.1 diffuse 0 } no_shadow }
  light_source {
    H + 0.85*Size*Axis, rgb <1.0, 0.9, 0.72>*Brightness
    spotlight point_at Target radius 38 falloff 52 tightness 0 fade_distance 6 fade_power 1
    Shadows()
  }
#end

Lamp(<6.6, 0, 3.2>, 1.5, <1.9, 4.6, 0>, <-1.1, 6.7, 0>, <-0.4, 0.6, -0.8>, <0.62, 0.64, 0.68>, 2.2)
Lamp(<-7.4, 0, -0.6>, 0.85, <-1.1, 3.0, 0>, <1.3, 4.4, 0>, <-1.2, 0.5, -1.6>, <0.72, 0.2, 0.14>, 1.5)

// The ball: bands and a star, as balls have.
sphere {
  0, 1.7
  texture {
    pigment {
      gradient y
      color_map { [0.40 rgb <0.95, 0.76, 0.12>] [0.40 rgb <0.1, 0.24, 0.62>] [0.60 rgb <0.1, 0.24, 0.62>] [0.60 rgb <0.95, 0.76, 0.12>] }
      translate -0.5*y scale 3.4
    }
    finish { ambient 0.05 diffuse 0.8 specular 0.6 roughness 0.008 }
  }
  rotate <24, 0, -32> translate <-1.0, 1.7, -2.4>
}

// The table, of planks, and the wall.
box {
  <-30, -1, -24>, <30, 0, 17>
  pigment { wood turbulence 0.03 color_map { [0 rgb <0.50, 0.31, 0.17>] [0.7 rgb <0.40, 0.23, 0.12>] [1 rgb <0.33, 0.18, 0.09>] } scale 0.9 rotate <2, 90, 0> translate <0, 3.3, 7> }
  finish { ambient 0.05 diffuse 0.8 specular 0.12 roughness 0.05 }
}
box { <-40, -8, 17>, <40, 40, 18> pigment { rgb <0.50, 0.54, 0.50> } finish { ambient 0.05 diffuse 0.8 } }
