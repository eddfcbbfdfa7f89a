// SPDX-License-Identifier: AGPL-3.0-or-later
// The light stands inside a container with a density file; beside it is a block of another, turned, with holes.
// Stock puts no extinction between the light and the first hit; the block throws the shadow of its single voxels.
// Truth: ray-traced with many samples.
#version 3.7;
global_settings { assumed_gamma 1 }
#include "stage.inc"
#include "df3.inc"
light_source {
  <-0.5, 3, -0.3>, rgb 1
  deep_shadow { resolution 512 }
}
#declare Checks = function (x, y, z) { 255*mod(x + y + z, 2)*select(x - 1, 0, 1)*select(6 - y, 0, 1) }
Write_df3("volume_light_inside.df3", 7, Checks)
#declare Density = density { density_file df3 "volume_light_inside.df3" interpolate 1 translate -0.5 color_map { [0.3 rgb 0] [0.3 rgb 1] [1 rgb 1] } }
sphere {
  0, 0.5 hollow pigment { rgbt 1 }
  interior { media { method 2 intervals 1 samples MS absorption 3 density { Density } } }
  scale 2 translate <-0.5, 3, -0.3>
}
box {
  -0.5, 0.5 hollow pigment { rgbt 1 }
  interior { media { method 2 intervals 1 samples MS absorption <2, 3, 4> density { Density } } }
  scale <1.6, 1, 1.4> rotate <20, 40, 10> translate <0.6, 1, 0.4>
}
