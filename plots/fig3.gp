# The paper's Figure 3 with ours beside it: total time of a query, all deformation included, against
# its number. Blocks of BASE.dat: particles, FCL AABB, FCL AABB tuned, FCL OBBRSS.
load ARG1."/style.gp"
data = ARG2.".dat"
stats data using 2 nooutput
blocks = STATS_blocks

set logscale y
set ytics ("0.001" 1e-3, "0.01" 1e-2, "0.1" 1e-1, "1" 1, "10" 10, "100" 100)
set xlabel "query number"
set ylabel "total time of a query, ms"
set xrange [1:1984]
set yrange [1e-3:500]

# Queries 950-1984 are the active interval.
set object 1 rectangle from 950,graph 0 to 1984,graph 1 fillcolor rgb pale fillstyle solid noborder behind
set label 1 "active interval" at 1467,300 center textcolor rgb ink

# The paper's own times on that interval (its Figure 3; Pentium 4, 2.53 GHz).
paper_average = 12.67
paper_maximum = 47
active(x) = x >= 950 ? 1 : NaN

array colour[4] = [dark, blue, orange, grey]
array width[4] = [1.2, 1.2, 1.2, 2.5]

do for [format in "svg png"] {
    eval "set terminal ".value(format."_terminal")
    set output ARG2.".".format
    plot for [i=0:blocks-1] data index i using 1:2 with lines lw width[i+1] lc rgb colour[i+1] \
             title columnheader(1), \
         active(x)*paper_average with lines lw 2 dt 2 lc rgb "black" \
             title "paper's average, 12.67 ms (Pentium 4, 2.53 GHz)", \
         active(x)*paper_maximum with lines lw 2 dt 3 lc rgb "black" \
             title "paper's maximum, 47 ms (its Figure 3)"
    unset output
}
