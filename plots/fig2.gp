# The paper's Figure 2: four frames of two deforming letters. BASE.dat: for each frame four blocks
# (the triangles of either body that face the viewer, the control vectors of either), then labels.
high = 460
load plots."/style.gp"
load plots."/solid.gp"
eval panels
set xrange [-1:1]
set yrange [-0.8:0.8]
set zrange [-3:3]
set view 0,0,3.5

set multiplot
do for [k=0:3] {
    left = 0.5 * (k % 2)
    low = k < 2 ? 0.52 : 0.06
    set size 0.5,0.42
    set origin left,low
    first = 4 * k
    set label 1 sprintf("(%c)", 97 + k) at screen left + 0.01,low + 0.38 font ",12"
    if (k == 0) {
        eval show_footer
        eval show_heading
    }
    splot data index first using 1:2:3 with polygons fc rgb first_body, \
          data index first + 1 using 1:2:3 with polygons fc rgb second_body
    unset label
    splot data index first + 2 using 1:2:3:4:5:6 with vectors head size 0.04,25 filled lw 1.2 \
              lc rgb "#101028", \
          data index first + 3 using 1:2:3:4:5:6 with vectors head size 0.04,25 filled lw 1.2 \
              lc rgb "#7a1010", \
          data index 16 every ::k::k using (0):(-0.78):(0):1 with labels font ",12" noenhanced
}
unset multiplot
