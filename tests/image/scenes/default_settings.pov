// SPDX-License-Identifier: AGPL-3.0-or-later
// Thin walls, things that touch the floor and each other, curved hair and round bodies under a block without any word.
// Look at the feet of walls and balls, at the sides that are turned away, and for specks on what is lit.
// Truth: ray-traced.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
#ifndef (Kind) #declare Kind = 0; #end
#ifndef (Hairs) #declare Hairs = 40; #end
light_source {
  <-3, 6, -1.5>, rgb 1
  #switch (Kind)
    #case (0) spotlight point_at 0 radius 26 falloff 32 #break
    #case (1) parallel point_at 0 #break
    #case (2) #break
    #case (3) translate <3.5, -2.5, 1.3> #break   // among its casters: a cube
  #end
  deep_shadow { }
}
#declare Dice = seed(3);
union {
  box { <-2.2, 0, -1>, <-2.19, 0.8, 1> }                       // a wall on the floor
  box { <-1.9, 0, 0.99>, <-0.7, 0.6, 1> }
  box { <-1.9, 0.595, 0>, <-0.7, 0.6, 1> }                     // and a roof on it
  sphere { <0.2, 0.4, 0.6>, 0.4 }                              // touches the floor at one point
  sphere { <0.9, 0.3, 0.5>, 0.3 }
  torus { 0.35, 0.08 translate <0.4, 0.08, -0.8> }
  cylinder { <1.4, 0, -0.6>, <1.4, 0.7, -0.6>, 0.25 }
  cone { <2.1, 0, 0.3>, 0.35, <2.1, 0.9, 0.3>, 0 }
  #for (I, 1, Hairs)
    #local Root = <-1.5 + 1.2*rand(Dice), 0, -0.3 - 0.8*rand(Dice)>;
    #local Bend = <rand(Dice) - 0.5, 0.6, rand(Dice) - 0.5>;
    sphere_sweep { b_spline 6, Root - 0.3*y, 0.008, Root, 0.008, Root + 0.25*y, 0.008, Root + Bend, 0.006,
                   Root + Bend*<2, 0.9, 2>, 0.004, Root + Bend*<3, 0.6, 3>, 0.003 tolerance 1e-5 }
  #end
  texture { WhiteMatte }
}
