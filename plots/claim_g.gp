# Claim g: time of a query over the number of particles and over triangles. Blocks of BASE.dat: four
# speeds over n, then the same four over triangles; x, median in us, its interval.
wide = 760
high = 480
load plots."/style.gp"
half = 4

set logscale xy
set key inside top left vertical

array colour[4] = [dark, blue, orange, grey]
array shape[4] = [7, 5, 9, 13]

eval panels
eval show_footer
set multiplot layout 1,2 margins 0.09,0.98,0.15,0.97 spacing 0.12
set ylabel "median time of a query, µs"
set format x "%g"
set format y "10^{%L}"
set yrange [0.5:1e6]
set xlabel "particles n, W-W of 11,920 triangles"
set logscale x 2
plot for [i=0:half-1] data index i using 1:2:3:4 with yerrorlines pt shape[i+1] ps 0.8 lw 1.5 \
         lc rgb colour[i+1] title columnheader(1), \
     (x >= 16 ? 0.02*x**2 : NaN) with lines dt 2 lw 1.5 lc rgb ink title "n^2"
unset label 1000
set xlabel "triangles, n = 5"
set yrange [0.5:1e5]
set logscale x 10
set format x "10^{%L}"
plot for [i=0:half-1] data index half+i using 1:2:3:4 with yerrorlines pt shape[i+1] ps 0.8 \
         lw 1.5 lc rgb colour[i+1] title columnheader(1), \
     (x >= 500 ? 0.8*sqrt(x) : NaN) with lines dt 2 lw 1.5 lc rgb ink title "square root"
unset multiplot
