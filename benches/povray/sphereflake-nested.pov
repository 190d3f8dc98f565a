// The sphereflake as unions of unions, each nine times in the next: Declare=DEPTH=4 -> 7381 spheres, 5 -> 66430 (z up).
// The balls on a ball turn with it, so this is not quite the picture of sphereflake.pov.
#version 3.7;
#ifndef (DEPTH) #declare DEPTH = 4; #end
global_settings { max_trace_level 6 assumed_gamma 1 }
background { rgb <0.078,0.361,0.753> }
camera { perspective location <2.1,1.3,1.7> right -x*4/3 up y sky z angle 57.8 look_at <0,0,0> }
light_source { <4,3,2> rgb 0.57 } light_source { <1,-4,4> rgb 0.57 } light_source { <-3,1,5> rgb 0.57 }
plane { z, -0.5 pigment { rgb <1,0.75,0.33> } finish { ambient 0 diffuse 0.8 } }
#declare Flake = sphere { 0, 0.5 }
#for (Level, 1, DEPTH)
  #declare Flake = union {
    sphere { 0, 0.5 }
    #for (K, 0, 5) object { Flake scale 1/3 translate z*2/3 rotate <0, 90, 60*K> } #end
    #for (K, 0, 2) object { Flake scale 1/3 translate z*2/3 rotate <0, 35.264389682754654, 120*K + 30> } #end
  }
#end
object { Flake texture { pigment { rgb <1,0.9,0.7> } finish { ambient 0 diffuse 0.5 specular 0.3 roughness 0.05 reflection 0.5 } } }
