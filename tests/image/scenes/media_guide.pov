// SPDX-License-Identifier: AGPL-3.0-or-later
// Every light ray meets one dense sheet in thin media, but of two neighbours one meets it high and the other one low, many times
// within a map pixel. So what one ray has found even is where its neighbours have to look.
// Kind=1: one density that jumps. Kind=2: containers side by side within another one, each with its sheet in a density of its own.
// The floor is one grey. Truth: closed form.
#version 3.7;
global_settings { assumed_gamma 1 }
#ifndef (Kind) #declare Kind = 1; #end
#ifndef (Samples) #declare Samples = 16; #end
#declare NoFloor = 1; #declare Eye = <0, 3, -3>; #declare At = <0, 0, 0>;
#include "stage.inc"
light_source {
  <0, 20, 0>, rgb 1
  parallel point_at 0
  deep_shadow { resolution 96 samples Samples tolerance 0.004 }
}
#declare K = 1.5;                 // extinction of a sheet
#declare Thin = 0.01;             // share of it elsewhere
#declare Thickness = 0.6;         // of a sheet; first steps are 0.25 long
#declare Stripes = 12;            // pairs to a unit, and so to 12 map pixels
#declare Sheet = function (y, Middle) { select(abs(y - Middle) - Thickness/2, 1, Thin) }
#declare Even = function (x) { select(sin(2*pi*Stripes*x), 0, 1) }
#declare Depth = K*(Thickness + Thin*(6 - Thickness)) + (Kind = 2)*K*Thin*6.2;
box { <-9, -0.2, -9>, <9, 0, 9> pigment { rgb #if (Truth) exp(-Depth) #else 1 #end } finish { ambient 0 diffuse 1 } }
#declare Thick = media { method 2 intervals 1 samples MS absorption rgb K }
#macro Stripe(Odd, Middle)           // one object, so that its first steps are those of all of it
  prism {
    linear_spline 5, 11, 5*6*Stripes
    #for (I, -3*Stripes, 3*Stripes - 1)
      #local A = (I + 0.5*Odd)/Stripes; #local B = A + 0.5/Stripes;
      <A, -4>, <B, -4>, <B, 4>, <A, 4>, <A, -4>
    #end
    hollow pigment { rgbt 1 } interior { media { Thick density { function { Sheet(y, Middle) } } } }
  }
#end
#macro Around(Low, High) <-4, Low, -4>, <4, High, 4> hollow pigment { rgbt 1 } #end
#if (!Truth)
  #if (Kind = 1)
    box { Around(5, 11) interior { media { Thick density { function { select(Even(x) - 0.5, Sheet(y, 6.2), Sheet(y, 9.1)) } } } } }
  #else
    box { Around(4.9, 11.1) interior { media { Thick density { rgb Thin } } } }
    Stripe(0, 6.2) Stripe(1, 9.1)
  #end
#end
