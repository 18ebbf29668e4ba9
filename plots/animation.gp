# All of a scenario, a frame of geometry a picture: frames/NNN.dat as the blocks of plots/fig2.gp for
# one frame and its label; BASE.dat has a line a frame.
high = 440
load plots."/style.gp"
# Before any ranges are set, since it would keep to them.
stats data using 1 nooutput
load plots."/solid.gp"
set xrange [-1:1]
set yrange [-0.8:0.8]
set zrange [-3:3]
set view 0,0,3.5
eval panels
set size 1,0.9
set origin 0,0.05

do for [k=0:int(STATS_max)] {
    file = sprintf("frames/%03d.dat", k)
    set multiplot
    eval show_footer
    eval show_heading
    splot file index 0 using 1:2:3 with polygons fc rgb first_body, \
          file index 1 using 1:2:3 with polygons fc rgb second_body
    unset label
    splot file index 2 using 1:2:3:4:5:6 with vectors head size 0.03,25 filled lc rgb "#101028", \
          file index 3 using 1:2:3:4:5:6 with vectors head size 0.03,25 filled lc rgb "#7a1010", \
          file index 4 using (0):(-0.78):(0):1 with labels noenhanced
    unset multiplot
}
