// SPDX-License-Identifier: AGPL-3.0-or-later
// A ball with 50,000 hairs combed into tufts and curls, under three spotlights (Lokovic & Veach 2000, figure 6).
// Look at the dark roots between the tufts, at the lit tips, and at the soft fringe of the three shadows on the floor.
// Truth: ray-traced with enough image samples; a hair is a quarter of a map pixel wide at 512x512.
//
// Declare=Hairs=50000   number of hairs
// Declare=Curl=1        0: straight hairs of one cylinder each
// Declare=Resolution=512 Declare=Samples=4   of the three maps
// Declare=Accuracy=0.01 in place of these two; Declare=Bound=8192: the finest resolution that it may use
// Declare=White=0       1: everything matte white, so that the picture shows the shadows alone
// Declare=Close=0       1: the first light alone, and its shadow on the floor from nearby (their figure 7)
// Declare=Tolerance=-1 Declare=Blur=0 Declare=Cache=1024   as in deep_shadow; -1: automatic
// Declare=File=0        1: the maps are saved as hairball1.exr, ...; 2: they are loaded from there
// Declare=Pcf=0         1: shadow_map (percentage closer filtering) in place of deep_shadow; then NumSamples in place of
//                       Samples, and MinSamples, ResFactor, MinSize, Bias0 and Bias1: words of shadow_map, as its paper calls them
#version 3.7;
global_settings { assumed_gamma 1 }

#ifndef (Hairs) #declare Hairs = 50000; #end
#ifndef (Curl)  #declare Curl = 1; #end
#ifndef (White) #declare White = 0; #end
#ifndef (Resolution) #declare Resolution = 512; #end
#ifndef (Samples)    #declare Samples = 4; #end
#ifndef (Tolerance)  #declare Tolerance = -1; #end
#ifndef (Blur)       #declare Blur = 0; #end
#ifndef (Cache)      #declare Cache = 1024; #end
#ifndef (Close)      #declare Close = 0; #end
#ifndef (File)       #declare File = 0; #end
#ifndef (Pcf)        #declare Pcf = 0; #end
#ifndef (NumSamples) #declare NumSamples = 16; #end

#declare HairRadius = 0.001;
#declare Segments = 12;       // cylinders a curled hair
#declare PerTuft = 200;        // hairs a tuft, on average
#declare Kinds = 50;          // tufts modelled; the others are turned copies
#declare Dice = seed(2000);

camera {
  location #if (Close) <6.4, 3.4, 6.8> #else <0, 3.6, -10.2> #end
  right x*image_width/image_height
  look_at #if (Close) <2.5, -1.8, 2.7> #else <0.2, -0.28, 0> #end
  angle #if (Close) 22 #else 36 #end
}

// What stands in a light's block: the same words for both kinds of map, but for those that only one has.
#macro Words(Number)
  #ifdef (Accuracy)
    accuracy Accuracy
    #ifdef (Bound) resolution Bound #end
  #else
    resolution Resolution samples (Pcf ? NumSamples : Samples)
  #end
  cache Cache
  #if (File = 1) save_file concat("hairball", str(Number, 0, 0), ".exr") #end
  #if (File = 2) load_file concat("hairball", str(Number, 0, 0), ".exr") #end
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

#if (White) // a third each, so that full light is 1
  #declare Key = rgb (Close ? 1 : 1/3);
  #declare Fill = rgb 1/3;
  #declare Rim = rgb 1/3;
#else
  #declare Key = rgb <1.30, 1.12, 0.90>;
  #declare Fill = rgb <0.16, 0.23, 0.36>;
  #declare Rim = rgb <0.75, 0.72, 0.80>;
#end

light_source {
  <-5.0, 8.0, -5.5>, Key
  spotlight point_at <0.1, -0.2, 0> radius 12 falloff 46
  #if (Pcf) shadow_map { Words(1) } #else deep_shadow { Words(1) } #end
}
#if (!Close)
light_source {
  <7.0, 5.5, -4.5>, Fill
  spotlight point_at <0, -0.2, 0> radius 12 falloff 46
  #if (Pcf) shadow_map { Words(2) } #else deep_shadow { Words(2) } #end
}
light_source {
  <1.5, 8.0, 6.5>, Rim
  spotlight point_at <0, -0.2, 0> radius 12 falloff 46
  #if (Pcf) shadow_map { Words(3) } #else deep_shadow { Words(3) } #end
}
#end

#declare Matte = finish { ambient 0 diffuse 1 }
#macro HairTexture(Colour)
  texture {
    #if (White) pigment { rgb 1 } finish { Matte }
    #else
      // Dark at the root, light at the tip: by the distance from the middle of the ball.
      pigment { spherical color_map { [0.05 rgb Colour*1.15] [0.5 rgb Colour*<0.45, 0.32, 0.25>] } scale 2.1 }
      finish { ambient 0 diffuse 0.9 specular 0.25 roughness 0.05 metallic 0.3 }
    #end
  }
#end

// The floor is infinite, so that the maps are framed to the ball alone; from nearby it is a slab that is in the map, with
// hair in 2/5 of the map's pixels.
#if (Close) box { <-1.8, -1.9, -1.8>, <4.0, -1.8, 4.0>
#else plane { y, -1.8
#end
  #if (White) pigment { rgb 1 } finish { Matte }
  #else pigment { rgb <0.30, 0.36, 0.40> } finish { ambient 0 diffuse 0.85 }
  #end
}

// The skin.
sphere {
  0, 1
  #if (White) pigment { rgb 1 } finish { Matte }
  #else pigment { rgb <0.20, 0.09, 0.04> } finish { ambient 0 diffuse 0.8 }
  #end
}

// One tuft stands on the origin of the skin's tangent plane, y outward, combed toward x.
#macro Tuft(Number, Width, Length, Bend, Turns, CurlRadius, Phase)
  union {
    #for (I, 1, Number)
      #local A = 2*pi*rand(Dice);
      #local R = Width*sqrt(rand(Dice));
      #local OX = R*cos(A);
      #local OZ = R*sin(A);
      #local Root = <OX, sqrt(1 - R*R) - 1 - 0.01, OZ>;
      #local Len = Length*(0.75 + 0.35*rand(Dice));
      #if (Curl)
        #local Ph = Phase + 0.35*(rand(Dice) - 0.5);
        #local Stray = vnormalize(<rand(Dice), rand(Dice), rand(Dice)> - 0.5)*0.4*Len*pow(rand(Dice), 6);
        #local From = Root;
        #for (S, 1, Segments)
          #local T = S/Segments;
          #local W = 2*pi*Turns*T + Ph;
          #local C = CurlRadius*(1 - pow(1 - T, 2))*(1.15 - 0.5*T);
          #local K = 1 - 0.88*(1 - pow(1 - T, 3));
          #local To = Stray*T*T + <OX*K + Bend*Len*T*T + C*(cos(W) - cos(Ph)),
            Root.y + Len*T*(1 - 0.35*Bend*T), OZ*K + C*(sin(W) - sin(Ph))>;
          cylinder { From, To, HairRadius*(1.2 - 0.5*T) }
          #local From = To;
        #end
      #else
        cylinder { Root, <OX*0.6 + Bend*Len*0.7, Len*(1 - 0.2*Bend), OZ*0.6>, HairRadius }
      #end
    #end
  }
#end

#declare Tufts = max(1, int(Hairs/PerTuft + 0.5));
#declare Used = min(Kinds, Tufts);
#declare Spread = 1.5*sqrt(4/Tufts);
#declare Model = array[Kinds]
#for (J, 0, Used - 1)
  #declare Model[J] = Tuft(
    max(1, int(Hairs/Tufts*(0.4 + 1.2*(J + 0.5)/Used) + 0.5)),
    min(0.5, Spread*(0.7 + 0.6*rand(Dice))), 0.70 + 0.35*rand(Dice), 0.10 + 0.55*rand(Dice),
    1.2 + 0.9*rand(Dice), 0.08 + 0.08*rand(Dice), 2*pi*rand(Dice))
#end

#declare Deck = array[Kinds]
#for (J, 0, Used - 1) #declare Deck[J] = J; #end
#declare Golden = pi*(3 - sqrt(5));
#for (I, 0, Tufts - 1)
  // Tufts stand on a spiral round the ball, jittered, and lie along a swirling flow that falls from the crown.
  #declare Y = 1 - 2*(I + 0.5)/Tufts + 0.6*(rand(Dice) - 0.5)/sqrt(Tufts);
  #declare Y = max(-0.9999, min(0.9999, Y));
  #declare A = I*Golden + 1.2*(rand(Dice) - 0.5)/sqrt(Tufts);
  #declare N = vnormalize(<sqrt(1 - Y*Y)*cos(A), Y, sqrt(1 - Y*Y)*sin(A)>);
  #declare Flow = <sin(3.1*N.y + 1.7*N.z), -0.9, cos(2.3*N.x - 2.9*N.y)> + 0.5*(<rand(Dice), rand(Dice), rand(Dice)> - 0.5);
  #declare FX = vnormalize(Flow - N*vdot(Flow, N) + <1e-4, 0, 2e-4>);
  #declare FX = vnormalize(FX - N*vdot(FX, N));
  #declare FZ = vcross(FX, N);
  // Kinds are dealt from a shuffled deck: all equally often.
  #declare Top = mod(I, Used);
  #declare Pick = Top + min(int(rand(Dice)*(Used - Top)), Used - Top - 1);
  #declare J = Deck[Pick];
  #declare Deck[Pick] = Deck[Top];
  #declare Deck[Top] = J;
  #declare Shade = rand(Dice);
  object {
    Model[J]
    matrix <FX.x, FX.y, FX.z, N.x, N.y, N.z, FZ.x, FZ.y, FZ.z, N.x, N.y, N.z>
    HairTexture(<1.00, 0.54, 0.20>*(0.75 + 0.35*Shade) + <0.00, 0.12, 0.10>*rand(Dice))
  }
#end
