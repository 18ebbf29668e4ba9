# What each ingredient of the tracked particles adds. Blocks of BASE.dat: the ingredients' names by
# line, then a scenario each: line, percent not exact, percent of contacts missed, time over that of
# the whole method and its interval.
high = 520
load plots."/style.gp"
stats data using 1 nooutput
scenarios = STATS_blocks - 1
stats data index 0 using 1 nooutput
lines = STATS_records

# Shares below this stand at "none".
least = 0.02
at_least(value) = value > least ? value : least
array shift[5] = [-0.3, -0.15, 0, 0.15, 0.3]
array panel[3] = ["not exact, %", "contacts missed, %", "time, ratio"]
array mark[5] = [7, 4, 9, 6, 2]
array shade[5] = [dark, blue, orange, grey, "#8a2f1c"]

set yrange [lines-0.4:-0.6]
unset ylabel
unset grid
set grid x lc rgb "#dddddd" lw 0.8
set ytics scale 0 noenhanced font ",11" offset 0.6,0
set xtics font ",11" offset 0,0.3
set bars 0
set logscale x
unset key
eval panels
do for [k=0:lines-2] {
    set arrow 10+k from graph 0,first k+0.5 to graph 1,first k+0.5 nohead lw 0.6 lc rgb "#e4e4e4" back
}
set tmargin at screen 1 - 62.0 / high
set bmargin at screen 84.0 / high

set multiplot
do for [k=0:2] {
    left = 0.285 + 0.24 * k
    set lmargin at screen left
    set rmargin at screen left + 0.21
    set label 1 panel[k+1] at graph 0.5,1.028 center font ",11"
    if (k < 2) {
        set xrange [least/2:220]
        set xtics ("0" least, "0.1" 0.1, "1" 1, "10" 10, "100" 100)
    } else {
        set xrange [*:*]
        set autoscale x
        set xtics ("1/16" 1.0/16, "1/4" 0.25, 1, 4, 16, 64)
        set arrow 1 from first 1,graph 0 to first 1,graph 1 nohead lw 1.2 lc rgb "#bbbbbb" back
    }
    if (k == 0) {
        plot for [i=1:scenarios] data index i using (at_least($2)):($1+shift[i]) with points \
                 pt mark[i] ps 0.75 lw 1.3 lc rgb shade[i] notitle, \
             data index 0 using (least/100):1:ytic(2) with dots lc rgb "white" notitle
        set format y ""
    }
    if (k == 1) {
        plot for [i=1:scenarios] data index i using (at_least($3)):($1+shift[i]) with points \
                 pt mark[i] ps 0.75 lw 1.3 lc rgb shade[i] notitle, \
             data index 0 using (least/100):1:ytic("") with dots lc rgb "white" notitle
    }
    if (k == 2) {
        eval show_footer
        eval show_heading
        set key at screen 0.5,34.0/high center center vertical maxrows 1 samplen 1 width -1 font ",11"
        plot for [i=1:scenarios] data index i using 4:($1+shift[i]):5:6 with xerrorbars \
                 pt mark[i] ps 0.75 lw 1.3 lc rgb shade[i] title columnheader(1), \
             data index 0 using (1):1:ytic("") with dots lc rgb "white" notitle
    }
}
unset multiplot
