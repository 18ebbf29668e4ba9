# Claim j: error and missed contacts over n on W-W. Blocks of BASE.dat: families (law, moves, exact
# check), three laws each of: vertices, surface, vertices checked, surface checked; n, error's 95th
# percentile and its interval, 99th percentile, share missed and its interval.
wide = 760
high = 480
load plots."/style.gp"

floor_error = 1e-4
shown(e) = e > floor_error ? e : floor_error
floor_share = 1e-4

set logscale x 2
set xrange [0.9:40]
set key outside bottom center horizontal
set xlabel "particles n"
array laws[3] = ["log", "inverse", "inverse-square"]
array kinds[4] = ["vertices", "surface", "vertices, exact check", "surface, exact check"]
array colour[4] = [dark, blue, orange, grey]
array shape[3] = [7, 9, 5]
array dashes[3] = [1, 2, 3]

eval panels
eval show_footer
set multiplot layout 1,2 margins 0.09,0.98,0.34,0.97 spacing 0.1
set logscale y
set format y "10^{%L}"
set ylabel "error, 95th percentile, L"
set yrange [floor_error/2:2]
unset key
plot for [k=0:3] for [l=0:2] data index 3*k+l using 1:(shown($2)) with linespoints \
         pt shape[l+1] ps 0.7 lw 1.5 dt dashes[l+1] lc rgb colour[k+1] notitle
unset label 1000
set ylabel "share of contacts missed"
set yrange [floor_share/2:2]
set key at screen 0.52,0.11 center center vertical maxrows 3 samplen 3 width 1
plot for [k=0:3] for [l=0:2] data index 3*k+l using 1:($6 > floor_share ? $6 : floor_share) \
         with linespoints pt shape[l+1] ps 0.7 lw 1.5 dt dashes[l+1] lc rgb colour[k+1] notitle, \
     for [k=0:1] keyentry with lines lw 3 lc rgb colour[k+1] title kinds[k+1], \
     keyentry with lines lc rgb "white" title " ", \
     for [k=2:3] keyentry with lines lw 3 lc rgb colour[k+1] title kinds[k+1], \
     keyentry with lines lc rgb "white" title " ", \
     for [l=0:2] keyentry with linespoints pt shape[l+1] ps 0.7 lw 1.5 dt dashes[l+1] \
         lc rgb ink title laws[l+1]
unset multiplot
