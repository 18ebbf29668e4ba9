# Accepted references, oldest first: the time of each row relative to its first, change points marked.
# Blocks of BASE.dat are rows: reference, relative time, 1 at a change point, commit.
wide = 760
high = 480
load plots."/style.gp"
stats data using 2 nooutput
blocks = STATS_blocks
least = STATS_min < 0.56 ? 0.9 * STATS_min : 0.5
most = STATS_max > 1.8 ? 1.1 * STATS_max : 2
stats data using 1 nooutput

set logscale y
set xlabel "accepted reference"
set ylabel "time against fcl-aabb, relative to the first"
set xtics 1
set yrange [least:most]
set ytics (0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.8, 0.9, 1, 1.1, 1.25, 1.5, 2, 3, 5, 10, 20)
set xrange [0.5:STATS_max + 0.5]

array colour[4] = [dark, blue, orange, grey]

plot for [i=0:blocks-1] data index i using 1:2 with linespoints pt 7 ps 0.6 lw 1.5 \
         dt i / 4 + 1 lc rgb colour[i % 4 + 1] title columnheader(1), \
     for [i=0:blocks-1] data index i using 1:($3 == 1 ? $2 : NaN) with points pt 6 ps 2.5 lw 2 \
         lc rgb "black" notitle
