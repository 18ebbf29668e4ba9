# Where the time of a frame goes. A line of BASE.dat is a configuration: its place from the top,
# cumulated shares of deform, update and query, its name, its mean total in us.
stats data using 1 nooutput
rows = int(STATS_max)
high = 105 + 22 * (rows < 3 ? 3 : rows) # with fewer, gnuplot warns of no room for the key
load plots."/style.gp"

set lmargin at screen 0.43
set rmargin at screen 0.87
set bmargin at screen 75.0 / high
set tmargin at screen 1 - 48.0 / high
set xrange [0:1]
set yrange [rows + 0.6:0.4]
set format x "%g"
set xtics ("0" 0, "50 %%" 0.5, "100 %%" 1) scale 0
set ytics noenhanced scale 0 font ",10.5"
unset grid
set border 0
set label 1 "total, µs" at graph 1.02,graph 1 offset 0,0.6 font ",11" textcolor rgb ink
set key at screen 0.5,31.0 / high center center vertical maxrows 1 samplen 1.5 width 2

plot data using (0):1:(0):2:($1 - 0.38):($1 + 0.38) with boxxyerror fs solid noborder lc rgb "#c9c9c9" \
         title "deform", \
     data using 2:1:2:3:($1 - 0.38):($1 + 0.38) with boxxyerror fs solid noborder lc rgb orange \
         title "refit", \
     data using 3:1:3:4:($1 - 0.38):($1 + 0.38):ytic(5) with boxxyerror fs solid noborder lc rgb dark \
         title "query", \
     data using (1):1:6 with labels left offset 0.8,0 font ",11" notitle
