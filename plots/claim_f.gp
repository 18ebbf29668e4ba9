# Claim f: share of queries on which two random starts agree, along the scenario. Blocks of BASE.dat:
# middle query of a block of queries, share.
wide = 760
high = 480
load plots."/style.gp"
stats data using 2 nooutput
blocks = STATS_blocks

set yrange [0:1.02]
set xrange [0:1984]
set xlabel "query number"
set ylabel "share of queries on which two starts agree"

array colour[5] = [dark, blue, orange, grey, "#c05030"]
array width[5] = [2.5, 2, 2, 2, 2]

plot for [i=0:blocks-1] data index i using 1:2 with linespoints pt i+4 ps 0.6 lw width[i+1] \
         lc rgb colour[i+1] title columnheader(1)
