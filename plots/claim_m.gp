# Claim m: growth of the number of convex parts with deformation. BASE.dat: displacement in L, parts
# deformed / at rest, its interval.
wide = 760
high = 480
load plots."/style.gp"

set xrange [0:0.55]
set yrange [0:*]
set xlabel "displacement of the control points, L"
set ylabel "convex parts, deformed / at rest"
set arrow 1 from 0,1 to 0.55,1 nohead dt 2 lc rgb ink
set arrow 2 from 0,2 to 0.55,2 nohead dt 3 lc rgb ink

plot data using 1:2:3:4 with yerrorbars pt 7 ps 1.2 lw 1.5 lc rgb dark title "T, V, M, W"
