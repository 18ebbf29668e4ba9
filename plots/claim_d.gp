# Claim d: steps to rest against the longest shortest route between particles. BASE.dat: vertices,
# cold and warm steps (95th percentile), route, longest cold query, square root of the vertices; a
# line a size and start.
wide = 760
high = 480
load plots."/style.gp"

set logscale xy
set format x "10^{%L}"
set xlabel "vertices"
set ylabel "steps, vertices"
set yrange [0.8:*]

plot data using 1:4 with points pt 6 ps 1.2 lw 1.5 lc rgb grey title "longest route between particles", \
     data using 1:6 with lines lw 1.5 dt 2 lc rgb ink title "square root of vertices", \
     data using 1:2 with points pt 7 ps 1 lc rgb dark title "steps, cold, 95th percentile", \
     data using 1:5 with points pt 2 ps 1 lw 1.5 lc rgb blue title "longest cold query", \
     data using 1:($3 < 1 ? 1 : $3) with points pt 9 ps 1.2 lc rgb orange title "steps, warm, 95th percentile"
