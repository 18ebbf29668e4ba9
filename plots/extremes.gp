# Every method (a row) on every numerical extreme (a column), from light, right, to black. Blocks of
# BASE.dat: where families begin, their names, and the end; the methods; and cells as left edge, width,
# row, verdict.
high = 480
load plots."/style.gp"
stats data index 0 using 1 nooutput
columns = STATS_max
families = STATS_records - 1
array start[families + 1]
array name[families + 1]
do for [k=1:families+1] {
    stats data index 0 every ::(k-1)::(k-1) using (name[k] = strcol(2), column(1)) nooutput
    start[k] = STATS_min
}
stats data index 1 using 1 nooutput
methods = STATS_records

# By verdict, from 0: none, right, inexact, refused, wrong, no number, hung, crashed.
array verdict[7] = ["right", "inexact as allowed", "refused", "wrong", "no number", "hung", "crashed"]
array shade[7] = ["#e6eef5", "#f4c078", "#6f95b8", "#a02c18", "#5c1040", "#2c0630", "#000000"]
set palette maxcolors 8 defined (0 "#ffffff", 1 "#e6eef5", 2 "#f4c078", 3 "#6f95b8", 4 "#a02c18", \
    5 "#5c1040", 6 "#2c0630", 7 "#000000")
set cbrange [-0.5:7.5]
unset colorbox
unset key
unset grid
unset border
set tics scale 0
set xrange [0:columns]
set yrange [methods-0.5:-0.5]
set xtics rotate by 60 right noenhanced font ",11" offset 0.3,0.2
set xtics ("" 0)
set ytics offset 0.8,0 noenhanced font ",12"
set lmargin at screen 0.21
set rmargin at screen 0.99
set tmargin at screen 1 - 34.0 / high
set bmargin at screen 0.33

do for [k=1:7] {
    left = 0.03 + 0.25 * ((k - 1) % 4)
    level = k <= 4 ? 0.115 : 0.065
    set object 100+k rectangle from screen left, screen level-0.014 to screen left+0.03, \
        screen level+0.014 fc rgb shade[k] fs solid border lc rgb ink
    set label 100+k verdict[k] at screen left+0.04, screen level font ",11"
}
do for [k=2:families] {
    set arrow from start[k], graph 0 to start[k], graph 1 nohead lc rgb "white" lw 2 front
    set arrow from start[k], graph 0 to start[k], graph -0.015 nohead lc rgb ink lw 0.8
}
do for [k=0:methods-2] {
    set arrow from graph 0, first k+0.5 to graph 1, first k+0.5 nohead lc rgb "white" lw 2 front
}
# Names below the middles of their columns, at least so far apart that they can be read.
apart = columns / 26.0
at = -1e9
do for [k=1:families] {
    middle = (start[k] + start[k + 1]) / 2
    at = middle > at + apart ? middle : at + apart
    set xtics add (name[k] at)
}

plot data index 2 using 1:3:1:($1+$2):($3-0.5):($3+0.5):4 with boxxyerror fs solid noborder \
         fc palette notitle, \
     data index 1 using (0):1:ytic(2) with dots lc rgb "white" notitle
