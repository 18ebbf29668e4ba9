# Ratio of the best engine's time to a method's over the frames of a scenario. Blocks of BASE.dat are
# methods, the best FCL last if it is not the best engine: middle of a part of the frames, ratio, its interval
# or nan nan.
high = 430
load plots."/style.gp"
stats data using 2 nooutput
blocks = STATS_blocks
stats data using (valid(3) ? $3 : $2) nooutput
lowest = STATS_min

set logscale y
set xlabel "frame"
set ylabel "times as fast as the best engine"
set format y "%g"
set ytics ("0.1" 0.1, "1" 1, "10" 10, "100" 100, "1,000" 1000, "10^4" 1e4, "10^5" 1e5)
set yrange [lowest < 0.5 ? lowest : 0.5:*]
set lmargin at screen 0.15
set rmargin at screen 0.95
set bmargin at screen 0.29
set tmargin at screen 0.91
set arrow 1 from graph 0,first 1 to graph 1,first 1 nohead lw 1.5 dt 2 lc rgb ink front
set key at screen 0.5,0.12 center center vertical maxrows 2 samplen 2 font ",11"
set xrange [0:*]

plot for [i=0:blocks-1] data index i using 1:3:4 with filledcurves fs transparent solid 0.25 noborder \
         lc rgb colour[i+1] notitle, \
     for [i=0:blocks-1] data index i using 1:2 with lines lw 2 dt i + 1 lc rgb colour[i+1] \
         title columnheader(1), \
     keyentry with lines lw 1.5 dt 2 lc rgb ink title "as fast as the best engine"
