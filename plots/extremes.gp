# Every method (a row) on every numerical extreme (a column), from light, right, to black. Blocks of
# BASE.dat: the families' first columns, the methods, and column, row, verdict.
stats data index 1 using 1 nooutput
methods = STATS_records
high = 190 + 20 * methods
load plots."/style.gp"
stats data index 0 using 1 nooutput
columns = STATS_max
families = STATS_records - 1
array start[families + 1]
do for [k=1:families+1] {
    stats data index 0 every ::(k-1)::(k-1) using 1 nooutput
    start[k] = STATS_min - 0.5
}

# By verdict, from 0: none, right, inexact, refused, wrong, no number, hung, crashed.
set palette maxcolors 8 defined (0 "#ffffff", 1 "#e6eef5", 2 "#f4c078", 3 "#6f95b8", 4 "#a02c18", \
    5 "#5c1040", 6 "#2c0630", 7 "#000000")
set cbrange [-0.5:7.5]
unset colorbox
unset key
unset grid
unset border
set tics scale 0
set xrange [-0.5:columns-0.5]
set yrange [methods-0.5:-0.5]
unset xtics
set ytics noenhanced font ",10"
set lmargin at screen 0.36
set rmargin at screen 0.98
set bmargin at screen 150.0 / high
set tmargin at screen 1 - 32.0 / high

array name[7] = ["right", "inexact as allowed", "refused", "wrong", "no number", "hung", "crashed"]
array shade[7] = ["#e6eef5", "#f4c078", "#6f95b8", "#a02c18", "#5c1040", "#2c0630", "#000000"]
do for [k=1:7] {
    x = 0.02 + 0.25 * ((k - 1) % 4)
    y = (k <= 4 ? 52.0 : 32.0) / high
    set object 100+k rectangle from screen x, screen y - 6.0/high to screen x+0.03, screen y + 6.0/high \
        fc rgb shade[k] fs solid border lc rgb ink
    set label 100+k name[k] at screen x+0.04, screen y font ",10"
}
do for [k=2:families] {
    set arrow from start[k], graph 0 to start[k], graph 1 nohead lc rgb "white" lw 2 front
}
do for [k=0:methods-2] {
    set arrow from graph 0, first k+0.5 to graph 1, first k+0.5 nohead lc rgb "white" lw 1.5 front
}

# A family's name stands below the middle of its columns.
plot data index 2 using 1:2:3 with image, \
     data index 1 using (0):1:ytic(2) with dots lc rgb "white", \
     for [k=1:families] data index 0 every ::(k-1)::(k-1) \
         using ((start[k] + start[k+1]) / 2):(methods - 0.5):2 with labels rotate by 40 right \
         offset 0,-0.5 noenhanced font ",11"
