# Speed against error of the tracked particles on one scenario: a line varies one parameter. Blocks of
# BASE.dat are such lines: value, median total in us and its interval, percent of frames not exact, and
# where the value stands.
high = 400
load plots."/style.gp"
stats data using 2 nooutput
blocks = STATS_blocks

# Shares below this stand at "none".
least = 0.02
at_least(value) = value > least ? value : least

set logscale xy
set yrange [least/3:150]
set ytics ("none" least, "0.1" 0.1, "1" 1, "10" 10, "100" 100)
set xrange [STATS_min/1.5:STATS_max*1.5]
set xtics (1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096)
set xlabel "median total time of a query, µs"
set ylabel "frames not exact, %"
set grid x y lc rgb "#d5d5d5" lw 1
set lmargin at screen 0.15
set rmargin at screen 0.97
set bmargin at screen 0.28
set tmargin at screen 0.91
set bars 0.4
set key at screen 0.55,0.1 center center vertical maxrows 1 samplen 2.5 width 3
array mark[3] = [7, 5, 9]
array size[3] = [1.1, 0.8, 0.9]
array shade[3] = [dark, orange, blue]

plot for [i=0:blocks-1] data index i using 2:(at_least($5)):3:4 with xerrorbars pt 0 lw 0.8 \
         lc rgb shade[i+1] notitle, \
     for [i=0:blocks-1] data index i using 2:(at_least($5)) with linespoints pt mark[i+1] \
         ps size[i+1] lw 1.5 dt i+1 lc rgb shade[i+1] title columnheader(1), \
     for [i=0:blocks-1] data index i using 6:7:1 with labels font ",10" textcolor rgb shade[i+1] notitle
