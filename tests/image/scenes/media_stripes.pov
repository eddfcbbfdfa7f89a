// SPDX-License-Identifier: AGPL-3.0-or-later
// Dense sheets in thin media, in stripes far finer than a map pixel: what one light ray has found even is where its neighbours have to look.
// Kind=1: of two neighbours one meets a sheet high and the other one low, in one density that jumps. Kind=2: the same in containers
// side by side within another one, each with its sheet in a density of its own. Kind=3: only one of them meets a sheet, a little
// thicker than two first steps. The floor is one grey. Truth: closed form.
#version 3.7;
global_settings { assumed_gamma 1 }
#ifndef (Kind) #declare Kind = 1; #end
#ifndef (Samples) #declare Samples = 16; #end
#ifndef (Share) #declare Share = 0.5; #end     // of the stripes that have a sheet: Kind=3
#declare NoFloor = 1; #declare Eye = <0, 3, -3>; #declare At = <0, 0, 0>;
#include "stage.inc"
light_source {
  <0, 20, 0>, rgb 1
  parallel point_at 0
  deep_shadow { resolution 96 samples Samples tolerance 0.004 #if (Kind = 3) blur 0.1 #end }   // 100 map pixels to an answer
}
#declare K = 1.5;                 // extinction of a sheet
#declare Thin = 0.01;             // share of it elsewhere
#declare Thickness = 0.6;         // of a sheet; first steps are 0.25 long
#declare Stripes = 12;            // pairs to a unit: two to a map pixel
#declare Sheet = function (y, Middle) { select(abs(y - Middle) - Thickness/2, 1, Thin) }
#declare Place = function (x) { x*Stripes - floor(x*Stripes) }
#declare Depth = K*(Thickness + Thin*(6 - Thickness)) + (Kind = 2)*K*Thin*6.2;
#declare Light = exp(-Depth);
#if (Kind = 3) #declare Light = Share*Light + (1 - Share)*exp(-6*K*Thin); #end
box { <-9, -0.2, -9>, <9, 0, 9> pigment { rgb #if (Truth) Light #else 1 #end } finish { ambient 0 diffuse 1 } }
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
  #switch (Kind)
    #case (1)
      box { Around(5, 11) interior { media { Thick density { function { select(Place(x) - 0.5, Sheet(y, 6.2), Sheet(y, 9.1)) } } } } }
      #break
    #case (2)
      box { Around(4.9, 11.1) interior { media { Thick density { rgb Thin } } } }
      Stripe(0, 6.2) Stripe(1, 9.1)
      #break
    #case (3)
      box { Around(5, 11) interior { media { Thick density { function { select(Place(x) - Share, Sheet(y, 6.5), Thin) } } } } }
  #end
#end
