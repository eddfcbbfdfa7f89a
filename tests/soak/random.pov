// SPDX-License-Identifier: AGPL-3.0-or-later
// A scene by chance: objects, textures, media, lights and settings of their maps, all from Declare=Seed=N.
// Look at nothing: run.sh renders it ray-traced and with deep maps, and compares.
// Truth: ray tracing, up to the bound that the scene prints ("Bound 0.031"), the largest RMSE that it allows.
//
// The bound adds up, for each light, what the reference documentation says a map may change:
//   edges      An edge becomes a ramp as wide as the filters of bake, look-up and camera ray together. Ramp and step differ by
//              width/12 for each unit of edge (the integral of their difference squared), and less where an image pixel covers both.
//              The length of all edges is counted as the objects are made: outlines, those of holes, and those of patterns.
//   noise      a map pixel over an edge is the mean of n rays: 1/(12 n) there
//   tolerance  of the block, at edges and in media; an automatic one is half of what noise makes uncertain
//   media      what sampling of the shadow rays errs: 0.6/MS of the light that is lost
//   steps      half precision of the picture
#version 3.7;
#ifndef (Seed) #declare Seed = 1; #end
#ifndef (MS)   #declare MS = 40; #end   // media samples
#declare Dice = seed(Seed);
#macro Between(A, B) (A + (B - A)*rand(Dice)) #end
#macro Chance(P) (rand(Dice) < P) #end
#macro Pick(N) int(rand(Dice)*N) #end
#macro Spot(R) (<rand(Dice), rand(Dice), rand(Dice)>*2*R - R) #end
#macro Direction() vnormalize(Spot(1) + <0, 0, 1e-3>) #end

global_settings {
  assumed_gamma 1 max_trace_level 12
  #if (Chance(0.2)) adc_bailout 1/512 #end
}

// ---- What is counted for the bound ----
#declare Edge = 0;        // scene units
#declare Dimmed = 0;      // 1: some media are there
#macro Outline(Length, Copies) #declare Edge = Edge + (Length)*(Copies); #end

// ---- Camera ----
#declare Elevation = Between(25, 70);
#declare Distance = Between(9, 13);
#declare Angle = 45;
#declare Eye = vrotate(vrotate(-z*Distance, x*Elevation), y*Between(0, 360));
#declare Frame = 2*Distance*tan(radians(Angle/2));   // scene units across the image
camera { location Eye right x*image_width/image_height look_at 0 angle Angle }

// ---- Textures ----
#declare Matte = finish { ambient 0 diffuse 1 }
#declare Clear = finish { ambient 0 diffuse 0.1 }

#macro Pane()
  #switch (Pick(4))
    #case (0) rgbf <rand(Dice), rand(Dice), rand(Dice), Between(0.3, 1)> #break
    #case (1) rgbt <rand(Dice), rand(Dice), rand(Dice), Between(0.3, 1)> #break
    #case (2) rgbft <1, rand(Dice), rand(Dice), Between(0, 0.5), Between(0, 0.5)> #break
    #else rgbf <0.5, 0.5, 0.5, 1>
  #end
#end

// Size: of the object, scene units. A pattern draws edges all over it, sharp ones or soft ones.
#macro Look(Size)
  #switch (Pick(8))
    #case (0) #case (1) #case (2)
      texture { pigment { rgb <Between(0.3, 1), Between(0.3, 1), Between(0.3, 1)> } finish { Matte } } #break
    #case (3) #case (4)
      texture { pigment { Pane() } finish { Clear } } #break
    #case (5)
      texture { pigment { checker rgb 0.8, Pane() scale Size/2 } finish { Matte } }
      Outline(Size, 8) #break
    #case (6)
      texture { pigment { bozo color_map { [0.4 rgb 0.9] [0.6 Pane()] } scale Size/2 } finish { Matte phong 0.3 } }
      Outline(Size, 8) #break
    #else
      texture { pigment { gradient y color_map { [0 rgbt 1] [1 rgb 0.5] } scale Size } finish { Matte reflection 0.2 } }
  #end
#end

#macro Inside()
  #switch (Pick(12))
    #case (0) interior { ior 1.3 } #break
    #case (1) interior { ior 1.2 fade_distance Between(0.5, 2) fade_power 2 } #break
    #case (2) interior { caustics 0.5 ior 1.4 } #break
  #end
#end

// ---- Surfaces, each about Size across and around the origin ----
#macro Solid(Kind, Size)
  #local R = Size/2;
  #switch (Kind)
    #case (0) sphere { 0, R Outline(pi*Size, 1) #break
    #case (1) box { -R*<rand(Dice), 1, 1>, R Outline(6*Size, 1) #break
    #case (2) cylinder { -R*y, R*y, R*Between(0.1, 1) Outline(5*Size, 1) #break
    #case (3) cone { -R*y, R, R*y, R*rand(Dice) Outline(5*Size, 1) #break
    #case (4) torus { R*0.75, R*Between(0.05, 0.25) Outline(2*pi*Size, 1) #break
    #case (5) superellipsoid { <Between(0.3, 1.5), Between(0.3, 1.5)> scale R Outline(5*Size, 1) #break
    #case (6) blob { threshold 0.4 sphere { 0.4*R*x, R, 1 } sphere { -0.4*R*x, R, 1 } cylinder { -R*y, R*y, R/2, 0.8 } Outline(6*Size, 1) #break
    #case (7) lathe { linear_spline 5, <0, -R>, <R*0.8, -R/2>, <R/3, 0>, <R/2, R>, <0, R> Outline(6*Size, 1) #break
    #case (8) prism { linear_spline -R, R, 6, <-R, -R>, <R, -R>, <0, 0>, <R, R>, <-R, R>, <-R, -R> Outline(10*Size, 1) #break
    #case (9) difference { box { -R, R } sphere { R*y, R*0.9 } cylinder { -Size*z, Size*z, R/2 } Outline(12*Size, 1) #break
    #case (10) intersection { sphere { 0, R } box { -R*0.8, R } plane { Direction(), R/3 } Outline(6*Size, 1) #break
    #case (11) merge { sphere { -R/2*x, R/2 } cylinder { -R*y, R*y, R/3 } Outline(8*Size, 1) #break
    #case (12) union { sphere { -R/2*x, R/2 } box { 0, R } sphere { -R/2*y, R/4 inverse hollow } Outline(9*Size, 1) #break
    #case (13) sphere_sweep { cubic_spline 5, -R*x, R/6, -R*x, R/6, R/2*y, R/4, R*x, R/6, R*x, R/6 tolerance 0.0001 Outline(4*Size, 1) #break
    #case (14) isosurface { function { x*x + y*y + z*z - R*R*(0.6 + 0.2*sin(6*x/R)) } contained_by { box { -R, R } } max_gradient 20*Size accuracy 0.0005 all_intersections Outline(6*Size, 1) #break
    #case (15) julia_fractal { <-0.08, 0, -0.8, -0.03> quaternion sqr max_iteration 5 precision 100 scale R*0.7 Outline(8*Size, 1) #break
    #case (16) sor { 4, <R/2, -R>, <R/2, -R/2>, <R/4, R/2>, <R/3, R> Outline(5*Size, 1) #break
    #case (17) quadric { <1, 2, 1>, <0, 0, 0>, <0, 0, 0>, -R*R clipped_by { sphere { 0, Size } } bounded_by { clipped_by } Outline(pi*Size, 1) #break
    #case (18) poly { 4, <1,0,0,0,0,0,0,0,0,0, 0,0,0,0,0,0,0,0,0,0, 1,0,0,0,0,0,0,0,0,0, 0,1,0,0,-0.6> scale R Outline(5*Size, 1) #break
    #case (19) sphere { 0, R clipped_by { plane { Direction(), Between(-R/2, R/2) } } Outline(6*Size, 1) #break
  #end
#end
#declare Solids = 20;

#macro Sheet(Kind, Size)
  #local R = Size/2;
  #switch (Kind)
    #case (0) disc { 0, Direction(), R, R*Between(0, 0.8) Outline(6*Size, 1) #break
    #case (1) triangle { -R*x, R*x, Spot(R) Outline(3*Size, 1) #break
    #case (2) mesh { #for (I, 1, 12) triangle { Spot(R), Spot(R), Spot(R) } #end Outline(12*2.5*Size, 1) #break
    #case (3) polygon { 6, <-R, -R>, <R, -R>, <R/3, 0>, <R, R>, <-R, R>, <-R, -R> Outline(5*Size, 1) #break
    #case (4) bicubic_patch { type 1 flatness 0.01 u_steps 3 v_steps 3
        #for (I, 0, 3) #for (J, 0, 3) <I - 1.5, rand(Dice), J - 1.5>*Size/3 #if (I + J < 6) , #end #end #end Outline(5*Size, 1) #break
    #case (5) height_field { function 20, 20 { 0.5 + 0.5*sin(9*x)*sin(7*y) } smooth translate -0.5 scale Size Outline(8*Size, 1) #break
    #case (6) mesh { #for (I, 1, 6) smooth_triangle { Spot(R), Direction(), Spot(R), Direction(), Spot(R), Direction() } #end
        inside_vector Direction() Outline(6*2.5*Size, 1) #break
    #case (7) cylinder { -R*y, R*y, R*0.7 open Outline(7*Size, 1) #break
    #case (8) union { #for (I, 1, 40) cylinder { -R*y + Spot(R/2)*<1, 0, 1>, R*y + Spot(R/2)*<1, 0, 1>, 0.02 } #end Outline(40*2*Size, 1) #break
  #end
#end
#declare Sheets = 9;

#macro Placed()
  #if (Chance(0.3)) scale <Between(0.5, 1), 1, Between(0.5, 1)> #end
  rotate Spot(180)
  #if (Chance(0.1)) matrix <1, Between(-0.3, 0.3), 0, 0, 1, Between(-0.3, 0.3), 0, 0, 1, 0, 0, 0> #end
  translate <Between(-2.5, 2.5), Between(0.4, 2.5), Between(-2.5, 2.5)>
#end

#macro Density()
  #switch (Pick(4))
    #case (1) density { spherical color_map { [0 rgb 0] [1 rgb 1] } } #break
    #case (2) density { bozo color_map { [0.3 rgb 0.2] [0.7 rgb 1] } scale 0.5 } #break
    #case (3) density { gradient y color_map { [0 rgb 0] [1 rgb <1, 0.5, 0.2>] } scale 2 translate -y } #break
  #end
#end

#macro Media()
  media {
    #switch (Pick(3))
      #case (0) absorption Between(0.2, 1.5) #break
      #case (1) absorption <rand(Dice), rand(Dice), rand(Dice)> emission 0.1*rand(Dice) #break
      #case (2) scattering { 1 + Pick(4), Between(0.1, 0.8) } #break
    #end
    Density()
    method 3 intervals 1 samples MS
  }
#end

#macro Cloud()
  #switch (Pick(3))
    #case (0) sphere { 0, 1 #break
    #case (1) box { -0.8, 0.8 #break
    #case (2) difference { sphere { 0, 1 } sphere { 0.5*x, 0.5 } #break
  #end
    hollow pigment { rgbt 1 } finish { Clear }
    interior { Media() #if (Chance(0.3)) Media() #end }
    scale Between(0.4, 1.2) Placed()
  }
  #declare Dimmed = 1;
#end

// ---- The scene ----
#switch (Pick(3))
  #case (0) plane { y, 0 texture { pigment { rgb 1 } finish { Matte } } } #break
  #else box { <-4, -0.2, -4>, <4, 0, 4> texture { pigment { rgb 1 } finish { Matte } } } Outline(8, 4)
#end
#for (I, 1, 3 + Pick(8))
  #declare Size = Between(0.4, 1.6);
  #if (Chance(0.65)) Solid(Pick(Solids), Size) #else Sheet(Pick(Sheets), Size) #end
    Look(Size)
    Inside()
    #if (Chance(0.08)) no_shadow #end
    #if (Chance(0.2)) hollow #end
    Placed()
  }
#end
#if (Chance(0.35)) #for (I, 1, 1 + Pick(3)) Cloud() #end #end
#if (Chance(0.05)) fog { fog_type 1 distance 60 color rgb 0.3 } #end

// ---- Lights ----
#declare Lights = 1 + (Chance(0.35) ? 1 : 0) + (Chance(0.15) ? 1 : 0);
#declare Reach = 6;                        // all finite objects are within so much of the middle
#declare Pixel = Frame/image_width;        // scene units
#declare Area = Frame*Frame*image_height/image_width;
#declare Contrast = 1/4;                   // squared: of glass and of slanted ground, half of the light is at stake
#declare Bound = 0.001;

#for (L, 1, Lights)
  #declare Strength = Between(0.6, 1)/Lights;
  #declare Way = vrotate(vrotate(-z, x*Between(35, 85)), y*Between(0, 360));
  #declare Far = Between(7, 20);
  #declare Pixels = 128 + Pick(256);
  #declare Samples = pow(1 + Pick(4), 2);
  #declare Tolerance = (Chance(0.7) ? max(0.25/sqrt(Samples), 0.002) : Between(0, 0.1));
  #declare Automatic = ((Tolerance > 0.1) | Chance(0.5));
  #declare Filter = 1;
  light_source {
    #switch (Pick(6))
      #case (0)
        Way*Far, rgb Strength*<1, Between(0.5, 1), Between(0.5, 1)> spotlight point_at <Between(-1, 1), 0, Between(-1, 1)>
        #declare Half = Between(12, 40);
        radius Half*Between(0.5, 0.99) falloff Half tightness Pick(3)
        #declare Wide = 2*tan(radians(Half))*(Far + Reach); #break
      #case (1)
        Way*Far, rgb Strength parallel point_at 0
        #declare Wide = 2*Reach; #break
      #case (2)
        Way*Far, rgb Strength*<Between(0.5, 1), 1, Between(0.5, 1)>
        #declare Wide = 2*min(Reach/sqrt(Far*Far - Reach*Reach), 1.8)*(Far + Reach); #break
      #case (3)
        <Between(-2, 2), Between(2.8, 4), Between(-2, 2)>, rgb Strength #if (Chance(0.5)) fade_distance 6 fade_power 2 #end
        #declare Wide = 2*1.1*(Reach + 2); #break
      #case (4)
        #declare Half = Between(2, 5);
        Way*Far, rgb Strength*<1, 1, Between(0.5, 1)> cylinder point_at 0 radius Half*0.9 falloff Half tightness 0
        #declare Wide = 2*Half; #break
      #case (5)
        Way*pow(10, Between(1, 6)), rgb Strength
        #declare Wide = 2*Reach*1.2*2; #break
    #end
    deep_shadow {
      #if (Chance(0.3)) #declare Across = Pixels + Pick(60); resolution <Pixels, Across> #else resolution Pixels #end
      samples Samples
      #if (!Automatic) tolerance Tolerance #end
      #switch (Pick(5))
        #case (0) #declare Filter = Between(0.5, 2); filter "box", Filter #break
        #case (1) #declare Filter = Between(1, 3); filter "triangle", Filter #break
        #case (2) #declare Filter = Between(1, 3); filter "gaussian", Filter #break
      #end
      #declare Blur = (Chance(0.15) ? Between(0, 0.02) : 0);
      #if (Blur > 0) blur Blur #end
      #if (Chance(0.2)) cache Between(2, 6) #end
      #if (Chance(0.1)) bounds <-3, -0.3, -3>, <3, 3, 3> #end
    }
    #if (Chance(0.1)) media_interaction off #end
  }
  // a map pixel on slanted ground; and the box that varies as much as the filters of bake, look-up and camera ray one after another
  #declare MapPixel = 1.4*Wide/Pixels;
  #declare Ramp = sqrt((pow(Filter, 2) + 2)*pow(MapPixel, 2) + pow(Blur*Wide, 2) + pow(Pixel, 2));
  #declare Share = min(1, Edge*Ramp/Area);
  #declare Edges = min(min(Ramp/12, pow(Ramp, 3)/(64*Pixel*Pixel))*Edge/Area, 0.25);
  #declare Noise = Share/(12*Samples)*min(1, pow(MapPixel/Pixel, 2));
  #declare Merged = (Automatic ? Noise/4 + 4e-6 : pow(Tolerance, 2)/3*(Dimmed ? 1 : Share));
  #declare Bound = Bound + Strength*sqrt(Contrast*(Edges + Noise + Merged)) + (Dimmed ? 0.6/MS*Strength : 0);
#end
#debug concat("\nBound ", str(Bound, 0, 4), "\n")
