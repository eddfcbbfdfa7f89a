// SPDX-License-Identifier: AGPL-3.0-or-later
// Light that grows: `interior { caustics }` brightens the middle of a shadow, and filter colours above 1 amplify.
// Look at the bright cores below the glass spheres, and at the pane that is brighter than the lit floor around it.
// Truth: ray-traced; such map pixels are marked, and their look-ups are ray-traced, so the pictures agree there exactly.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 10 }

camera {
  location <0, 5.5, -7.5>
  right x*image_width/image_height
  look_at <0.2, 0.2, 0>
  angle 44
}

light_source {
  <-3, 9, 3>, rgb 0.55
  spotlight point_at 0 radius 22 falloff 30
  deep_shadow { resolution 512 samples 16 }
}

box { <-6, -0.2, -6>, <6, 0, 8> pigment { rgb 1 } finish { ambient 0 diffuse 0.9 } }

#declare Polish = finish { ambient 0 diffuse 0.05 specular 0.5 roughness 0.005 reflection { 0.02, 0.3 fresnel on } conserve_energy }

// Brighter in the middle.
sphere { <-1.7, 0.8, 0.2>, 0.7 pigment { rgbf <0.95, 0.97, 1, 0.95> } finish { Polish } interior { ior 1.5 caustics 1.0 } }
sphere { <-0.2, 0.6, -1.1>, 0.5 pigment { rgbf <0.4, 0.9, 0.6, 0.95> } finish { Polish } interior { ior 1.5 caustics 1.5 } }
// The same ball without caustics.
sphere { <0.4, 0.8, 0.9>, 0.6 pigment { rgbf <0.95, 0.97, 1, 0.95> } finish { Polish } interior { ior 1.5 } }
// Filters above 1, alone and behind a filter below 1.
box { <1.2, 1.0, -1.6>, <2.3, 1.04, -0.5> pigment { rgbf <1.7, 1.3, 0.8, 1> } finish { ambient 0 diffuse 0 } }
box { <1.5, 1.0, 0.3>, <2.6, 1.04, 1.4> pigment { rgbf <1.5, 1.5, 1.5, 1> } finish { ambient 0 diffuse 0 } }
box { <1.9, 0.5, 0.3>, <3.0, 0.54, 1.4> pigment { rgbf <0.9, 0.3, 0.3, 1> } finish { ambient 0 diffuse 0.1 } }
// An ordinary shadow.
cylinder { <-0.2, 0, 2.2>, <-0.2, 1.6, 2.2>, 0.12 pigment { rgb <0.6, 0.5, 0.4> } finish { ambient 0 diffuse 0.8 } }
