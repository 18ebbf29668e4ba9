# Animation of a simulation. film.dat: number of pictures, low and high x, low and high y of them all.
# NNN.dat, a picture: blocks of the triangles of either body that face the viewer, the particles of
# either, the closest pair, and a line "contact said, contact in truth, step"; x right, y up, z to the
# viewer.
wide = 640
high = 480
load plots."/style.gp"
array line[5]
do for [k=1:5] {
    # Before any ranges are set, since it would keep to them.
    stats data using k nooutput
    line[k] = STATS_max
}
load plots."/solid.gp"
set view 0,0,3.5
eval panels
set size 1,0.9
set origin 0,0.02
scale = 1.5 / (line[3] - line[2])
scale = scale < 1.2 / (line[5] - line[4]) ? scale : 1.2 / (line[5] - line[4])
x(p) = (p - (line[2] + line[3]) / 2) * scale
y(p) = (p - (line[4] + line[5]) / 2) * scale
z(p) = p * scale

before = 0
do for [k=0:int(line[1])-1] {
    file = sprintf("%03d.dat", k)
    array now[3]
    set autoscale
    do for [b=1:3] {
        stats file index 5 using b nooutput
        now[b] = int(STATS_max)
    }
    set xrange [-1:1]
    set yrange [-0.75:0.75]
    set zrange [-3:3]
    # The picture at the beginning of a reported contact is shown longer.
    do for [again=1:(now[1] && !before ? 6 : 1)] {
        set multiplot
        eval show_heading
        set label 1 sprintf("step %d", now[3]) at screen 0.02,0.04 font ",11"
        set label 2 (now[1] ? "contact" : now[2] ? "contact, not reported" : "") \
            at screen 0.98,0.04 right font ",13" textcolor rgb "#a01010"
        splot file index 0 using (x($1)):(y($2)):(z($3)) with polygons fc rgb first_body, \
              file index 1 using (x($1)):(y($2)):(z($3)) with polygons fc rgb second_body
        unset label
        # Particles and the pair stand out, also where a surface is before them.
        splot file index 4 using (x($1)):(y($2)):(z($3)) with lines lw 2.5 lc rgb "#a01010", \
              for [b=2:3] file index b using (x($1)):(y($2)):(z($3)) with points pt 7 ps 1.3 \
                  lc rgb "white", \
              for [b=2:3] file index b using (x($1)):(y($2)):(z($3)) with points pt 7 ps 0.9 \
                  lc rgb (b == 2 ? dark : "#b05000"), \
              file index 4 using (x($1)):(y($2)):(z($3)) with points pt 6 \
                  ps (now[1] || now[2] ? 4 : 1.5) lw 2.5 lc rgb "#a01010"
        unset multiplot
    }
    before = now[1]
}
