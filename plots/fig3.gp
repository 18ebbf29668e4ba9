# The paper's Figure 3 with ours beside it: total time of a query, all deformation included, against
# its number. Blocks of BASE.dat: particles, FCL AABB, FCL AABB tuned, FCL OBBRSS, the best engine of
# others if that is none of these.
load plots."/style.gp"
stats data using 2 nooutput
blocks = STATS_blocks

set logscale y
set ytics ("0.001" 1e-3, "0.01" 1e-2, "0.1" 1e-1, "1" 1, "10" 10, "100" 100)
set xtics 500
set xlabel "query number"
set ylabel "time of a query, ms"
set xrange [1:1984]
set yrange [1e-3:500]

# Queries 950-1984 are the active interval, 1-49 the warm-up.
set object 1 rectangle from 950,graph 0 to 1984,graph 1 fillcolor rgb pale fillstyle solid noborder \
    behind
set object 2 rectangle from 1,graph 0 to 49,graph 1 fillcolor rgb pale fillstyle solid noborder behind
set label 1 "active interval" at 1467,280 center textcolor rgb ink font ",11"
set label 2 "warm-up" at 60,280 left textcolor rgb ink font ",11"

# The paper's own times on both (its Figure 3; Pentium 4, 2.53 GHz).
average(x) = x >= 950 ? 12.67 : x <= 49 ? 12.06 : NaN
maximum(x) = x >= 950 || x <= 49 ? 47 : NaN
set samples 1984

array colour[5] = [dark, blue, orange, grey, "#8a2f1c"]
array width[5] = [1.2, 1.2, 1.2, 2.5, 1.2]
set lmargin at screen 0.14
set rmargin at screen 0.96
set bmargin at screen 0.37
set tmargin at screen 0.91
set key at screen 0.5,0.145 center center vertical maxrows 4 samplen 2 font ",11"

plot for [i=0:blocks-1] data index i using 1:2 with lines lw width[i+1] lc rgb colour[i+1] \
         title columnheader(1), \
     average(x) with lines lw 2 dt 2 lc rgb "black" title "paper's average", \
     maximum(x) with lines lw 2 dt 3 lc rgb "black" title "paper's maximum"
