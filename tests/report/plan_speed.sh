#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# The ladders of speed against error; plan.sh sources it. Costs are in millionths of a second on two cores: none_cost and
# traced_cost of a camera ray, bake_cost of a light ray through each pixel of the map; start is reading the scene, in seconds.

# Rungs of ray tracing: depth of antialiasing, MS. Of deep: also resolution and samples, or the value of accuracy. Of
# PCF: also resolution, samples and size_factor.
ladder() {  # $1: full, $2: short, $3: smoke: prints that of this form
  case $form in full) echo "$1" ;; short) echo "$2" ;; smoke) echo "$3" ;; esac
}

surfaces=$(ladder '1,0,0.04 2,0,0.02 3,0,0.01 5,0,0.005' '1,0,0.04 2,0,0.01' '2,0,0.04')   # of accuracy, where there are no media

# ---- Hair: the ball's shadows on itself and on the floor, three lights ----------------------------------------------
none_cost=5 traced_cost=10 bake_cost=6 start=$(ladder 5.6 0.9 0.3) accuracy=$surfaces
traced=$(ladder '1,0 2,0 3,0 5,0' '1,0 2,0' '1,0 2,0')
deep=$(ladder '1,0,256,4 2,0,512,4 3,0,1024,4' '1,0,128,4 2,0,256,4' '1,0,32,4 2,0,64,4')
map=$(ladder '1,0,512,16,3 2,0,1024,16,3 3,0,2048,16,3' '1,0,256,16,3 2,0,512,16,3' '1,0,64,4,3 2,0,128,16,3')
speed hair scenes/hairball.pov "$(ladder 240:180 160:120 32:24)" "$(ladder 96:60:48:36 64:40:32:24 8:8:16:8)" \
  "$(ladder 4:9:0:0 4:8:0:0 2:2:0:0)" "$(ladder 35 10 0.5)" "Declare=White=1 $hair"

# ---- The shadow of the ball on the floor, from nearby: nothing but hair shadow, one light ----------------------------
none_cost=2 traced_cost=5 bake_cost=2
traced=$(ladder '1,0 2,0 3,0 5,0' '1,0 2,0' '2,0')
deep=$(ladder '1,0,256,16 2,0,512,16 3,0,1024,9' '1,0,256,4 2,0,512,9' '2,0,64,4')
map=$(ladder '1,0,512,16,3 2,0,1024,16,3 3,0,4096,16,2' '1,0,256,16,3 2,0,512,16,3' '2,0,64,4,3')
speed floor scenes/hairball.pov "$(ladder 320:240 160:120 32:24)" "$(ladder 128:160:96:64 64:80:48:32 8:16:16:8)" \
  "$(ladder 4:9:0:0 4:8:0:0 2:2:0:0)" "$(ladder 40 10 0.5)" "Declare=White=1 Declare=Close=1 $hair"

# ---- Cloud: rungs are media samples; one ray an image pixel in all pictures, the same ones ---------------------------
none_cost=6 traced_cost=109 bake_cost=15 start=0.2
traced=$(ladder '1,10 1,20 1,30 1,40' '1,10 1,20 1,30' '1,5')
deep=$(ladder '1,10,64,4 1,20,128,4 1,30,128,4 1,40,256,4' '1,10,64,4 1,20,128,4 1,30,128,4' '1,5,32,1')
map=$(ladder '1,20,256,16,3' '1,20,128,16,3' '1,5,32,4,3')
accuracy=$(ladder '1,10,0.04 1,20,0.02 1,30,0.01 1,40,0.005' '1,10,0.04 1,30,0.01' '1,5,0.04')
speed cloud scenes/cloud.pov "$(ladder 160:120 120:90 24:18)" "$(ladder 48:36:64:48 40:30:32:24 8:6:8:6)" \
  "$(ladder 1:1:0.001:80 1:1:0.004:40 1:1:0.02:10)" "$(ladder 115 8 0.5)" 'Declare=White=1'

# ---- Cloud with pipes ------------------------------------------------------------------------------------------------
none_cost=3 traced_cost=40 bake_cost=2
traced=$(ladder '2,10 2,20 2,30 2,40' '2,10 2,20 2,30' '1,5')
deep=$(ladder '2,10,128,4 2,20,256,4 2,30,512,4 2,40,1024,4' '2,10,128,4 2,20,256,4 2,30,512,4' '1,5,32,1')
map=$(ladder '2,20,512,16,3' '2,20,256,16,3' '1,5,32,4,3')
accuracy=$(ladder '2,10,0.04 2,20,0.02 2,30,0.01 2,40,0.005' '2,10,0.04 2,30,0.01' '1,5,0.04')
speed pipes scenes/cloud_pipes.pov "$(ladder 160:120 120:90 24:18)" "$(ladder 48:36:64:48 40:30:32:24 8:6:8:6)" \
  "$(ladder 2:1:0.0015:80 2:1:0.003:40 1:1:0.05:10)" "$(ladder 165 12 0.5)" 'Declare=White=1'

# ---- Glass: two lights, coloured shadows on a white floor ------------------------------------------------------------
none_cost=1 traced_cost=2.5 bake_cost=0.6 accuracy=$surfaces
traced=$(ladder '1,0 2,0 3,0 5,0 9,0' '1,0 2,0 3,0 5,0' '2,0')
deep=$(ladder '1,0,256,4 2,0,512,4 3,0,1024,4 5,0,2048,4' '1,0,256,4 2,0,512,4' '2,0,64,4')
map=$(ladder '1,0,256,16,3 2,0,512,16,3 3,0,1024,16,3' '1,0,256,16,3 2,0,512,16,3' '2,0,64,4,3')
speed glass scenes/glass.pov "$(ladder 320:240 160:120 32:24)" "$(ladder 96:96:96:72 48:48:48:36 8:8:16:8)" \
  "$(ladder 4:9:0:0 4:8:0:0 2:2:0:0)" "$(ladder 25 8 0.3)" 'Declare=White=1'

# ---- Sphere and plane: where shadow rays are cheapest ----------------------------------------------------------------
none_cost=0.6 traced_cost=1 bake_cost=0.3 accuracy=
traced=$(ladder '1,0 2,0 3,0 5,0 9,0' '1,0 2,0 3,0 5,0' '2,0')
deep=$(ladder '1,0,256,4 2,0,512,4 3,0,1024,4 5,0,2048,4' '1,0,256,4 2,0,512,4' '2,0,64,4')
map=$(ladder '1,0,256,16,3 2,0,512,16,3 3,0,1024,16,3 5,0,2048,16,3' '1,0,256,16,3 2,0,512,16,3 3,0,1024,16,3' '2,0,64,4,3')
speed sphere scenes/sphere_plane.pov "$(ladder 320:240 160:120 32:24)" "$(ladder 96:96:96:72 48:48:48:36 8:8:16:8)" \
  "$(ladder 4:9:0:0 4:8:0:0 2:2:0:0)" "$(ladder 15 5 0.3)" 'Declare=Shadow=1'
