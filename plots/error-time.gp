# Distance and error over frames. Blocks of BASE.dat are methods: frame, exact distance, distance as reported, absolute
# error, all in L, and 1 where a contact was missed.
high = 480
load plots."/style.gp"
stats data using 2 nooutput
blocks = STATS_blocks
stats data using 3 nooutput
highest = STATS_max

eval panels
floor_error = 1e-6
missed(flag, value) = flag == 1 ? value : NaN
array line[2] = [orange, dark]
array mark[2] = [2, 1]

set multiplot
set lmargin at screen 0.15
set rmargin at screen 0.95
set bmargin at screen 0.53
set tmargin at screen 0.9
eval show_heading
set ylabel "distance, L" offset 1,0
set yrange [0:highest > 0 ? 1.05 * highest : 0.01]
set format x ""
unset key
plot data index 0 using 1:2 with lines lw 5 lc rgb "#b9cfe6" title "exact", \
     for [i=0:blocks-1] data index i using 1:3 with lines lw 1.2 lc rgb line[i+1] notitle
unset label 1001
set bmargin at screen 0.25
set tmargin at screen 0.5
set format x "%g"
set xlabel "frame"
set ylabel "error, L" offset 1,0
set logscale y
unset mytics
set format y "10^{%L}"
set yrange [floor_error / 12 : 2]
set ytics 100
set ytics add ("≤ 10^{-6}" floor_error)
eval show_footer
set key at screen 0.5,0.09 center center vertical maxrows 2 samplen 2 font ",11"
plot keyentry with lines lw 5 lc rgb "#b9cfe6" title "exact distance", \
     for [i=0:blocks-1] data index i using 1:($4 > floor_error ? $4 : floor_error) with lines lw 1.2 \
         lc rgb line[i+1] title columnheader(1), \
     for [i=0:blocks-1] data index i using 1:(missed($5, floor_error / (3 * (i + 1)))) with points \
         pt mark[i+1] ps 0.6 lw 1.5 lc rgb line[i+1] notitle, \
     keyentry with points pt 2 ps 0.6 lw 1.5 lc rgb ink title "contact missed"
unset multiplot
