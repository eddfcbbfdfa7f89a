// SPDX-License-Identifier: AGPL-3.0-or-later
// A ball that flies past a white plane while the shutter is open (Lokovic & Veach 2000, figure 12): motion blur.
// Look at the shadow: a soft streak, full in the middle and thin at its ends, without the rungs of single instants.
// Truth: the mean of many ray-traced frames; each of them has a sharp shadow.
//
// povray motion.ini bakes motion_01.exr to motion_32.exr, and dsmtool merge -o motion.exr motion_??.exr averages them.
// Declare=Merged=1 then uses motion.exr; the clock must be one of those that were baked (+K0.515625 is near the middle).
// scenes/motion.sh does all of it, and puts pictures with and without side by side.
//
// Declare=Bake=0     1: write this frame's map
// Declare=Merged=0   1: read the merged map
// Declare=Frozen=0   1: the shadow of the middle of the flight, whatever the clock: what motion blur without blurred
//                    shadows looks like
// Declare=Alone=0    1: the ball is not seen, only its shadow
#version 3.7;
global_settings { assumed_gamma 1 }

#ifndef (Bake)   #declare Bake = 0; #end
#ifndef (Merged) #declare Merged = 0; #end
#ifndef (Frozen) #declare Frozen = 0; #end
#ifndef (Alone)  #declare Alone = 0; #end

camera {
  location <0.2, 4.2, -8>
  right x*image_width/image_height
  look_at <0.2, 0.5, 0>
  angle 32
}

// The box holds the ball at all times: so all maps have one frame.
#macro Lamp(Deep)
  light_source {
    <-2.5, 9, -1>, rgb 1
    spotlight point_at <0, 0.6, 0> radius 40 falloff 50
    #if (Deep)
      deep_shadow {
        resolution 256 samples 16
        bounds <-1.8, 0.6, -0.8>, <1.8, 1.9, 0.8>
        #if (Bake) save_file concat("motion_", str(frame_number, -2, 0), ".exr") #end
        #if (Merged) load_file "motion.exr" #end
      }
    #else
      shadowless
    #end
  }
#end

Lamp(1)

plane { y, 0 pigment { rgb 1 } finish { ambient 0.05 diffuse 0.9 } }

#macro Ball(Clock) sphere { <-1.2 + 2.4*Clock, 1.25, -0.2 + 0.4*Clock>, 0.55 } #end

// A blurred map would shadow the ball where the ball was at other times. So the ball that is seen has a lamp of its own,
// which its own shape does not shadow, and the one that casts the shadow is not seen.
light_group {
  Lamp(0)
  object { Ball(clock) no_shadow #if (Alone) no_image #end pigment { rgb <0.9, 0.35, 0.15> } finish { ambient 0.05 diffuse 0.85 } }
  global_lights off
}
object { Ball((Frozen ? 0.5 : clock)) no_image no_reflection }
