# Error over the number of particles. Blocks of BASE.dat are methods: n, then median, 95th and 99th
# percentile of the error in L and share of contacts missed, each with its interval.
high = 520
load plots."/style.gp"
stats data using 2 nooutput
blocks = STATS_blocks
stats data using 1 nooutput
least_n = STATS_min
most_n = STATS_max

# Smaller ones are drawn on these: none missed, or nearly exact.
floor_error = 1e-6
floor_share = 1e-4
at_least(value, low) = value > low ? value : low

array panel[4] = ["median error, L", "95th percentile, L", "99th percentile, L", "contacts missed"]

set logscale x
# Powers of 2; of 4 or more where these would overlap.
step = int(ceil(log(most_n / least_n) / log(2) / 8))
step = step < 1 ? 1 : step
set xtics (1)
do for [k=1:24/step] { set xtics add (2**(k*step)) }
set bars 0.4
set logscale y
unset mytics
set format y "10^{%L}"
set xrange [0.8 * least_n:1.25 * most_n]
eval panels

array mark[4] = [6, 5, 9, 7]
array size[4] = [1.2, 0.7, 0.9, 0.9]

set multiplot
do for [k=0:3] {
    left = 0.13 + 0.5 * (k % 2)
    low = k < 2 ? 0.62 : 0.22
    set lmargin at screen left
    set rmargin at screen left + 0.355
    set bmargin at screen low
    set tmargin at screen low + 0.28
    least = k < 3 ? floor_error : floor_share
    set yrange [least / 2.5 : 2]
    set ytics 100
    set ytics add ((k < 3 ? "≤ 10^{-6}" : "none") least)
    set label 1 panel[k+1] at graph 0.5,1.06 center font ",12"
    set xlabel (k < 2 ? "" : "particles n")
    unset key
    if (k == 3) {
        eval show_footer
        eval show_heading
        set key at screen 0.5,0.085 center center vertical maxrows 2 samplen 2 font ",11"
    }
    plot for [i=0:blocks-1] data index i \
             using ($1*1.05**(i-1.5)):(at_least(column(2+3*k), least)):(at_least(column(3+3*k), least)):\
                   (at_least(column(4+3*k), least)) with yerrorbars \
             pt 0 lw 0.6 lc rgb colour[i+1] notitle, \
         for [i=0:blocks-1] data index i using ($1*1.05**(i-1.5)):(at_least(column(2+3*k), least)) \
             with linespoints pt mark[i+1] ps size[i+1] lw 1.2 lc rgb colour[i+1] title columnheader(1)
}
unset multiplot
