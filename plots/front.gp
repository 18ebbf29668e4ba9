# Speed against error on one scenario: a point is a configuration, with its n where it has one; blocks
# of BASE.dat are the configurations that differ in n only: n, median total in us and its interval,
# 99th percentile and median of the error in L, missed contacts.
load ARG1."/style.gp"
data = ARG2.".dat"
stats data using 2 nooutput
blocks = STATS_blocks

# Errors at or below this are drawn on it: exact for every purpose of ours.
floor_error = 1e-5
shown(e) = e > floor_error ? e : floor_error

set logscale xy
set format x "10^{%L}"
set format y "10^{%L}"
set ytics add ("exact" floor_error)
set grid x y lc rgb "#d5d5d5" lw 1
set xlabel "median total time of a query, {/Symbol m}s" offset 0,0.4
set ylabel "99th percentile of the error, L"
set yrange [floor_error / 3 : 2]
set key outside below center maxcols 3 samplen 1.5 font ",11"

array colour[4] = [dark, blue, orange, grey]
array shape[8] = [7, 5, 9, 13, 6, 4, 8, 12]

do for [format in "svg png"] {
    eval "set terminal ".value(format."_terminal")
    set output ARG2.".".format
    plot for [i=0:blocks-1] data index i using 2:(shown($5)):3:4 with xerrorbars \
             pt shape[i % 8 + 1] ps 1 lw 1.5 lc rgb colour[i % 4 + 1] title columnheader(1), \
         for [i=0:blocks-1] data index i using 2:(shown($5)):1 with labels offset 1,0.7 \
             textcolor rgb colour[i % 4 + 1] notitle
    unset output
}
