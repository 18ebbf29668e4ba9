# Letters in a box, a picture a file: frames/NNN.dat has blocks of the box's edges, the triangles of
# four shapes and of what is in contact, and a line "near pairs, contacts, frame"; x right, y up, z to
# the viewer, the box within 1 of the middle. BASE.dat has a line a picture.
wide = 640
high = 600
load plots."/style.gp"
# Before any ranges are set, since it would keep to them.
stats data using 1 nooutput
load plots."/solid.gp"
set view 0,0,2.1
eval panels
array tint[5] = ["#9db7d5", "#f0c890", "#a9cfa4", "#c9b3d9", "#8a1f1c"]

do for [k=0:int(STATS_max)] {
    file = sprintf("frames/%03d.dat", k)
    array now[3]
    set autoscale
    do for [b=1:3] {
        stats file index 6 using b name "N" nooutput
        now[b] = int(N_max)
    }
    set xrange [-1:1]
    set yrange [-1:1]
    set zrange [-3:3]
    set multiplot
    eval show_footer
    eval show_heading
    set label 1 sprintf("frame %d: %d near pairs, %d contacts", now[3], now[1], now[2]) \
        at screen 0.02,0.04 font ",11"
    splot file index 0 using 1:2:3:4:5:6 with vectors nohead lw 1 lc rgb "#999999"
    unset label
    splot for [b=1:5] file index b using 1:2:3 with polygons fc rgb tint[b]
    unset multiplot
}
