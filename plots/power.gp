# How often a race calls a planted slowdown slower, over its size, with exact 95 % intervals. Blocks of
# BASE.dat are places and kinds: size in per cent, share of races in per cent, ends of its interval.
wide = 760
high = 480
load plots."/style.gp"
stats data using 1 nooutput
blocks = STATS_blocks
set xlabel "planted slowdown in per cent"
set ylabel "races that call it slower, in per cent"
set logscale x
set xtics (1, 2, 3, 5, 10)
set xrange [0.85:12]
set yrange [0:102]
plot for [i=0:blocks-1] data index i using ($1 * (0.97 + 0.012 * i)):2:3:4 with yerrorlines \
    pt shape[i % 3 + 1] ps 0.8 lw 1.5 dt i / 3 + 1 lc rgb colour[i % 3 + 1] title columnheader(1)
