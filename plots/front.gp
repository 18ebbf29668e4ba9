# Speed against error on one scenario: a point is a configuration, a line the configurations of a
# method that differ in n only, with n beside. Blocks of BASE.dat are such lines, the last one may be
# "others": n, median total in us and its interval, 99th percentile of the error in L and its, and
# where n stands.
high = 480
load plots."/style.gp"
stats data using 2 nooutput
blocks = STATS_blocks

# Errors at or below this are drawn on it.
floor_error = 1e-5
shown(e) = e > floor_error ? e : floor_error

set logscale xy
set format x "10^{%L}"
set format y "10^{%L}"
set ytics add ("≤ 10^{-5}" floor_error)
set xlabel "median total time of a query, µs"
set ylabel "error, 99th percentile, L" offset 1,0
set xrange [STATS_min / 3:STATS_max * 3]
set yrange [floor_error / 3:2]
set grid x y lc rgb "#d5d5d5" lw 1
set lmargin at screen 0.17
set rmargin at screen 0.97
set bmargin at screen 0.37
set tmargin at screen 0.93
set bars 0.4
set key at screen 0.5,0.155 center center vertical maxrows 7 samplen 1 font ",11"

array colour[13] = [orange, blue, "#5aa9a0", dark, "#8a2f1c", grey, "#a8a035", "#b58ac4", "#444444", \
    "#c05030", "#2f6f3a", "#7a4fb0", "#aaaaaa"]
array shape[13] = [7, 5, 9, 13, 3, 6, 4, 8, 12, 11, 10, 2, 1]

plot for [i=0:blocks-1] data index i using 2:(shown($5)):3:4:(shown($6)):(shown($7)) with xyerrorbars \
         pt 0 lw 0.6 lc rgb colour[i+1] notitle, \
     for [i=0:blocks-1] data index i using 2:(shown($5)) with linespoints pt shape[i+1] ps 0.9 lw 1.5 \
         lc rgb colour[i+1] title columnheader(1), \
     for [i=0:blocks-1] data index i using 8:9:1 with labels font ",10" \
         textcolor rgb colour[i+1] notitle
