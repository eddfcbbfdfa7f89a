// SPDX-License-Identifier: AGPL-3.0-or-later
// Hundreds of small primitives of every kind with random transforms, opaque and not.
// Look at nothing: order.tap compares the hits of light rays found object by object with those found ray by ray.
// Truth: the two agree for every ray.
//
// Declare=Seed=1    another set of objects
// Declare=Light=0   0 spot, 1 point outside, 2 point among the objects, 3 parallel, 4 very far point, 5 very far parallel
// Declare=Count=400 number of objects
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 20 }
#ifndef (Seed)  #declare Seed = 1; #end
#ifndef (Light) #declare Light = 0; #end
#ifndef (Count) #declare Count = 400; #end
#declare Dice = seed(Seed);

camera { location <0, 9, -9> right x*image_width/image_height look_at 0 angle 50 }
light_source {
  #switch (Light)
    #case (0) <3, 8, -5>, rgb 1 spotlight point_at 0 radius 30 falloff 35 #break
    #case (1) <3, 8, -5>, rgb 1 #break
    #case (2) <0.2, 0.3, -0.1>, rgb 1 #break
    #case (3) <3, 8, -5>, rgb 1 parallel point_at 0 #break
    #case (4) <3e6, 8e6, -5e6>, rgb 1 #break
    #case (5) <3e6, 8e6, -5e6>, rgb 1 parallel point_at 0 #break
  #end
  deep_shadow { resolution 48 samples 9 }
}

#macro Between(A, B) (A + (B - A)*rand(Dice)) #end
#macro Spot(R) (<rand(Dice), rand(Dice), rand(Dice)>*2*R - R) #end
#macro Primitive(Kind)
  #switch (Kind)
    #case (0) sphere { Spot(1), Between(0.2, 1) #break
    #case (1) cylinder { Spot(1), Spot(1) + 3*x, Between(0.02, 0.2) #break
    #case (2) cylinder { Spot(1), Spot(1) + 2*y, Between(0.1, 1) open #break
    #case (3) cone { Spot(1), Between(0.05, 0.5), Spot(1) + 2*z, Between(0, 0.1) #break
    #case (4) cone { Spot(0.1), Between(0.5, 1), Spot(0.1) + 0.5*y, Between(0, 1) open #break
    #case (5) disc { Spot(1), Spot(1) + 2*y, Between(0.5, 1), Between(0, 0.4) #break
    #case (6) triangle { Spot(1.5), Spot(1.5), Spot(1.5) #break
    #case (7) smooth_triangle { Spot(1.5), y, Spot(1.5), y + 0.3*x, Spot(1.5), y - 0.3*z #break
    #case (8) box { -Between(0.1, 1), <Between(0.1, 1), Between(0.1, 1), Between(0.1, 1)> #break
    #case (9) torus { Between(0.4, 1), Between(0.05, 0.3) #break
    #case (10) superellipsoid { <Between(0.2, 1.5), Between(0.2, 1.5)> scale 0.7 #break
    #case (11) blob { threshold 0.5 sphere { Spot(0.4), 1, 1 } cylinder { Spot(0.5), Spot(0.5) + x, 0.6, 1 } #break
    #case (12) mesh { #for (I, 1, 6) triangle { Spot(1), Spot(1), Spot(1) } #end #break
    #case (13) difference { box { -0.8, 0.8 } sphere { 0.8*y, 0.7 } cylinder { -z, z, 0.3 } #break
    #case (14) intersection { sphere { 0, 1 } cylinder { -x, x, 0.5 inverse } #break
    #case (15) union { sphere { -0.5*x, 0.4 } cone { 0.5*x, 0.4, 0.5*x + y, 0.1 } #break
    #case (16) merge { sphere { -0.3*x, 0.6 } sphere { 0.3*x, 0.6 } #break
    #case (17) sphere { 0, 1 clipped_by { plane { Spot(1) + 2*y, Between(-0.5, 0.5) } } #break
    #case (18) cylinder { -y, y, 0.8 open bounded_by { box { -<0.8, 0.5, 0.8>, <0.8, 1, 0.8> } } clipped_by { bounded_by } #break
    #case (19) lathe { linear_spline 4, <0.2, -0.8>, <0.7, -0.2>, <0.3, 0.3>, <0.5, 0.9> #break
  #end
#end
#declare Kinds = 20;

#for (I, 0, Count - 1)
  #declare Where = Spot(3);
  #if (vlength(Where) < 0.8) #declare Where = Where + 1.5*x; #end
  Primitive(mod(I, Kinds))
    #if (rand(Dice) < 0.5) pigment { rgb 0.5 } #else pigment { rgbf <0.9, 0.8, 0.9, Between(0.5, 1)> } #end
    #if (rand(Dice) < 0.3) inverse #end
    #if (rand(Dice) < 0.5) scale <Between(0.05, 1), Between(0.3, 1), Between(0.3, 1)> #end
    #if (rand(Dice) < 0.5) rotate Spot(180) #end
    #if (rand(Dice) < 0.3) matrix <1, Between(-1, 1), 0, 0, 1, Between(-1, 1), Between(-1, 1), 0, 1, 0, 0, 0> #end
    scale Between(0.1, 0.35) * #if (rand(Dice) < 0.2) -1 #else 1 #end
    translate Where
  }
#end
// the light among the objects stands in some of them
sphere { <0.2, 0.3, -0.1>, 0.3 pigment { rgbf 0.9 } }
box { -0.7, 0.7 pigment { rgbf 0.9 } rotate 30 }
disc { -0.5*y, y, 5, 0.1 pigment { rgbf 0.8 } }
cylinder { <0.2, -4, -0.1>, <0.2, 4, -0.1>, 0.05 pigment { rgbf 0.95 } }
