# Animation of a simulation: gnuplot -c simulation.gp FOLDER FILE.gif PICTURES BOX TITLE. FOLDER/NNN.dat
# holds the blocks: triangles of either body that face the viewer, particles of either, the closest pair,
# and a line "contact said, contact in truth, step"; x right, y up, z to the viewer. BOX: low and high
# x, low and high y of all pictures.
folder = ARG1
pictures = int(ARG3)
low_x = real(word(ARG4, 1))
high_x = real(word(ARG4, 2))
low_y = real(word(ARG4, 3))
high_y = real(word(ARG4, 4))
by_x = 1.45 / (high_x - low_x)
by_y = 1.2 / (high_y - low_y)
scale = by_x < by_y ? by_x : by_y
x(p) = (p - (low_x + high_x) / 2) * scale
y(p) = (p - (low_y + high_y) / 2) * scale
z(p) = p * scale

set terminal gif animate delay 8 loop 0 size 640,480 font "DejaVu Sans,11"
set output ARG2
set view equal xyz
set view 0,0,3.5
unset border
unset tics
unset colorbox
unset key
set pm3d depthorder
set pm3d lighting primary 0.4 specular 0.1
set pm3d border retrace

do for [k=0:pictures-1] {
    file = sprintf("%s/%03d.dat", folder, k)
    # Before there are ranges, which it would keep to.
    set autoscale
    stats file index 5 using 1 nooutput
    said = int(STATS_max)
    stats file index 5 using 2 nooutput
    met = int(STATS_max)
    stats file index 5 using 3 nooutput
    step = int(STATS_max)
    set xrange [-1:1]
    set yrange [-0.75:0.75]
    set zrange [-3:3]
    # A contact that is reported stands still for a moment.
    do for [again=1:(said ? 5 : 1)] {
        set multiplot
        set label 1 sprintf("%s    step %d", ARG5, step) at screen 0.02,0.96 noenhanced
        set label 2 (said ? "contact" : met ? "contact, not reported" : "") at screen 0.98,0.96 right \
            textcolor rgb "#a01010" font "DejaVu Sans Bold,12"
        splot file index 0 using (x($1)):(y($2)):(z($3)) with polygons fc rgb "#9db7d5", \
              file index 1 using (x($1)):(y($2)):(z($3)) with polygons fc rgb "#f0c890"
        unset label
        # Particles and the pair stand out, also where a surface is before them.
        splot file index 4 using (x($1)):(y($2)):(z($3)) with lines lw 2.5 lc rgb "#a01010", \
              for [b=2:3] file index b using (x($1)):(y($2)):(z($3)) with points pt 7 ps 1.3 \
                  lc rgb "white", \
              for [b=2:3] file index b using (x($1)):(y($2)):(z($3)) with points pt 7 ps 0.9 \
                  lc rgb (b == 2 ? "#14142e" : "#b05000"), \
              file index 4 using (x($1)):(y($2)):(z($3)) with points pt 6 ps (said || met ? 4 : 1.5) \
                  lw 2.5 lc rgb "#a01010"
        unset multiplot
    }
}
unset output
