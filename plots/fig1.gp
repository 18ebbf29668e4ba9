# The paper's Figure 1: two letters T, lit, and their particles. Blocks of BASE.dat: the triangles of
# either body that face the viewer (x right, y up, z towards the viewer), the particles of either
# (1 behind: hidden), the closest pair.
high = 370
load plots."/style.gp"
load plots."/solid.gp"

eval panels
set size 1,0.8
set origin 0,0.12
set xrange [-1:1]
set yrange [-0.62:0.62]
set zrange [-2:2]
set view 0,0,3.4
set multiplot
eval show_heading
eval show_footer
splot data index 0 using 1:2:3 with polygons fc rgb first_body, \
      data index 1 using 1:2:3 with polygons fc rgb second_body

# Over the surfaces: polygons are drawn last within a plot.
unset label
red = "#c01818"
violet = "#1030b0"
hidden(flag, value) = flag == 1 ? value : NaN
shown(flag, value) = flag == 0 ? value : NaN
set key at screen 0.5,0.1 center center vertical maxrows 1 samplen 0.5 width -2
splot data index 2 using 1:2:(shown($4, $3)) with points pt 7 ps 1.6 lc rgb "white" notitle, \
      data index 2 using 1:2:(shown($4, $3)) with points pt 7 ps 1.2 lc rgb red notitle, \
      data index 2 using 1:2:(hidden($4, $3)) with points pt 6 ps 1.1 lw 2 lc rgb red notitle, \
      data index 3 using 1:2:(shown($4, $3)) with points pt 5 ps 1.5 lc rgb "white" notitle, \
      data index 3 using 1:2:(shown($4, $3)) with points pt 5 ps 1.1 lc rgb violet notitle, \
      data index 3 using 1:2:(hidden($4, $3)) with points pt 4 ps 1 lw 2 lc rgb violet notitle, \
      data index 4 using 1:2:3 with lines lw 3 lc rgb "white" notitle, \
      data index 4 using 1:2:3 with lines lw 1.5 lc rgb "black" notitle, \
      keyentry with points pt 7 ps 1.2 lc rgb red title "on the first T", \
      keyentry with points pt 5 ps 1.1 lc rgb violet title "on the second T", \
      keyentry with points pt 6 ps 1.1 lw 2 lc rgb ink title "hidden"
unset multiplot
