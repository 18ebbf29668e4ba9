# Several bodies: time of a frame over their number. Blocks of BASE.dat: six methods for each of three
# densities; N, mean in us, MB.
wide = 760
high = 430
load plots."/style.gp"
methods = 6
panel(p) = word("0.1 1 4", p)

set logscale xy
set xrange [5:20000]
set xtics ("10" 10, "100" 100, "1,000" 1000, "10,000" 10000)
stats data using 2 nooutput
set yrange [STATS_min / 3:STATS_max * 3]
set grid x y lc rgb "#d5d5d5" lw 1
array colour[6] = [dark, "#8a2f1c", orange, blue, "#5aa9a0", grey]
array shape[6] = [7, 5, 9, 13, 11, 6]
array dashes[6] = [1, 1, 2, 1, 2, 3]

set multiplot
eval panels
eval show_heading
eval show_footer
set bmargin at screen 0.31
set tmargin at screen 0.86
do for [p=1:3] {
    set lmargin at screen 0.1 + 0.3 * (p - 1)
    set rmargin at screen 0.1 + 0.3 * (p - 1) + 0.27
    set ylabel (p == 1 ? "mean time of a frame, µs" : "")
    set format y (p == 1 ? "10^{%L}" : "")
    set xlabel (p == 2 ? "bodies, N" : "")
    set label 2 panel(p)." near pairs a body" at graph 0.5,1.05 center font ",12"
    plot for [m=0:methods-1] data index (p-1)*methods + m using 1:2 with linespoints \
             pt shape[m+1] ps 0.8 lw 1.6 dt dashes[m+1] lc rgb colour[m+1] notitle
    unset label 1000
    unset label 1001
}
# The key, below all of them.
set lmargin at screen 0.02
set rmargin at screen 0.98
set tmargin at screen 0.2
set bmargin at screen 0.06
unset border
unset tics
unset xlabel
unset label 2
set key inside center center horizontal maxcols 3 width 2
plot for [m=0:methods-1] data index m using (NaN):(NaN) with linespoints pt shape[m+1] ps 0.8 lw 1.6 \
         dt dashes[m+1] lc rgb colour[m+1] title columnheader(1)
unset multiplot
