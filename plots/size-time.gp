# Time over triangles. Blocks of BASE.dat are methods, their fitted exponent in the title: triangles
# a body, median total in us, its interval.
high = 480
load plots."/style.gp"
stats data using 2 nooutput
blocks = STATS_blocks

set logscale xy
set format x "10^{%L}"
set format y "10^{%L}"
set xlabel "triangles a body, t"
set ylabel "median total time of a query, µs"
set grid x y lc rgb "#d5d5d5" lw 1
set xrange [*:*]
set yrange [STATS_min / 4:STATS_max * 4]

set lmargin at screen 0.15
set rmargin at screen 0.95
set bmargin at screen 0.44
set tmargin at screen 0.92
set key at screen 0.5,0.19 center center vertical maxrows 8

plot for [i=0:blocks-1] data index i using 1:2:3:4 with yerrorlines pt shape[i+1] ps 0.9 lw 1.5 \
         dt dashes[i+1] lc rgb colour[i+1] title columnheader(1)
