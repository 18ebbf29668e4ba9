# Share of random approaches in which a body passes through the other one, over n, in the closed loop.
# Blocks of BASE.dat, one a scene: n, share, its interval, approaches. The first three, the paper's,
# on the left, others on the right.
wide = 760
high = 500
load plots."/style.gp"
stats data using 1 nooutput
blocks = STATS_blocks
left = blocks < 3 ? blocks : 3
sides = blocks > 3 ? 2 : 1

none = 2e-4
shown(s) = s > none ? s : none

set logscale y
set xrange [0.5:10]
set yrange [none/1.5:1]
set xtics (1, 2, 3, 4, 5, 6, 7, 8, "16" 9.4)
set xlabel "particles n"
set ytics ("none" none, "0.1 %%" 0.001, "1 %%" 0.01, "10 %%" 0.1, "100 %%" 1)
array colour[7] = [dark, blue, orange, grey, "#c05030", dark, blue]
array shape[7] = [7, 9, 5, 13, 11, 6, 8]
array dashes[7] = [1, 2, 3, 4, 5, 2, 1]
at(n, k) = (n > 8 ? 9.4 : n) + 0.1 * k
set object 1 rectangle from graph 0,0 to graph 1,first none*1.4 behind fc rgb pale fs noborder

set multiplot
eval panels
eval show_heading
eval show_footer
do for [p=1:sides] {
    first = p == 1 ? 0 : left
    last = p == 1 ? left - 1 : blocks - 1
    set lmargin at screen (p == 1 ? 0.11 : 0.58)
    set rmargin at screen (p == sides ? 0.98 : 0.5)
    set tmargin at screen 0.93
    set bmargin at screen (sides == 2 ? 0.34 : 0.24)
    set ylabel (p == 1 ? "approaches with a pass through" : "")
    set key at screen (p == 1 ? (sides == 1 ? 0.54 : 0.3) : 0.78),(sides == 1 ? 0.13 : 0.21) center top horizontal \
        maxcols (p == 1 ? 3 : 4)
    plot for [k=first:last] data index k \
             using (at($1, k - 0.5*(first + last))):(shown($2)):(shown($3)):(shown($4)) \
             with yerrorbars pt shape[k-first+1] ps 0.8 lw 1.2 lc rgb colour[k-first+1] notitle, \
         for [k=first:last] data index k using (at($1, k - 0.5*(first + last))):(shown($2)) \
             with linespoints pt shape[k-first+1] ps 0.8 lw 1.8 dt dashes[k-first+1] \
             lc rgb colour[k-first+1] title columnheader(1)
    unset label
}
unset multiplot
