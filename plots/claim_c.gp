# Claim c: how much of the motion a number of particles tracks, over particles a convex part. Blocks
# of BASE.dat are shapes: n, n / parts, share tracked and its interval, error's 99th percentile.
wide = 760
high = 480
load plots."/style.gp"
stats data using 2 nooutput
blocks = STATS_blocks

set logscale x 2
set xrange [0.02:40]
set yrange [0:1.02]
set xlabel "particles over convex parts, n / parts"
set ylabel "share of frames with error ≤ 0.01 L"
set arrow 1 from 2,0 to 2,1.02 nohead dt 2 lc rgb ink
set label 1 "the paper's 2" at 2.1,0.06 textcolor rgb ink

array colour[5] = [dark, blue, orange, grey, "#c05030"]
array shape[5] = [7, 5, 9, 13, 11]

plot for [i=0:blocks-1] data index i using 2:3:4:5 with yerrorbars pt shape[i+1] ps 1 lw 1.5 \
         lc rgb colour[i+1] title columnheader(1), \
     for [i=0:blocks-1] data index i using 2:3 with lines lw 1.5 lc rgb colour[i+1] notitle
