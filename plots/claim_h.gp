# Claim h: what caching distant influence gains. Blocks of BASE.dat: kinds of moves and parts; n, times
# faster and its interval, change of the error's 95th percentile.
wide = 760
high = 480
load plots."/style.gp"
stats data using 2 nooutput
blocks = STATS_blocks

set logscale x 2
set xrange [6:170]
set xlabel "particles n"
set ylabel "time without the cache / time with it"
set yrange [0:*]
set arrow 1 from 6,1 to 170,1 nohead dt 2 lc rgb ink

array colour[4] = [dark, blue, orange, grey]
array shape[4] = [7, 5, 9, 13]

plot for [i=0:blocks-1] data index i using 1:2:3:4 with yerrorlines pt shape[i+1] ps 1 lw 1.5 \
         lc rgb colour[i+1] title columnheader(1)
