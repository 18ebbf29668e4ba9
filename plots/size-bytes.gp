# Memory over triangles, and over vertices. Blocks of BASE.dat are methods: triangles a body, bytes of
# live heap, the same over the vertices of both bodies.
high = 460
load plots."/style.gp"
stats data using 2 nooutput
blocks = STATS_blocks

eval panels
set logscale xy
set grid x y lc rgb "#d5d5d5" lw 1
set format x "10^{%L}"
set xlabel "triangles a body"
unset key

set multiplot
do for [k=0:1] {
    left = 0.12 + 0.5 * k
    set lmargin at screen left
    set rmargin at screen left + 0.35
    set bmargin at screen 0.41
    set tmargin at screen 0.87
    set format y (k == 0 ? "10^{%L}" : "%g")
    set yrange [*:*]
    set label 1 (k == 0 ? "live heap, bytes" : "bytes a vertex") at graph 0.5,1.05 center font ",12"
    if (k == 1) {
        eval show_footer
        eval show_heading
        set key at screen 0.5,0.16 center center vertical maxrows 8 samplen 2.5
    }
    plot for [i=0:blocks-1] data index i using 1:(column(2 + k)) with linespoints pt shape[i+1] \
             ps 0.8 lw 1.5 dt dashes[i+1] lc rgb colour[i+1] title columnheader(1)
}
unset multiplot
