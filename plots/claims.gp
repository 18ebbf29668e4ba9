# The claims table. BASE.dat: a block of texts (column, line, text), a block of claims (first line,
# lines, 2 holds, 1 within limits or 0 does not hold, verdict).
stats data index 1 using ($1 + $2) nooutput
lines = int(STATS_max)
step = 16
high = 60 + step * lines
load plots."/style.gp"

unset border
unset tics
unset grid
unset key
set lmargin at screen 0
set rmargin at screen 1
set bmargin at screen 20.0 / high
set tmargin at screen 1 - 30.0 / high
set xrange [0:wide]
set yrange [lines + 0.5:-0.5]
colour_of(rank) = rank == 2 ? 0x1d6b4f : rank == 1 ? 0xc98a2a : 0xa02c10
shape_of(rank) = rank == 2 ? 7 : rank == 1 ? 6 : 2
of_column(c, wanted, value) = c == wanted ? value : NaN

plot data index 1 using (0):($1 - 0.65):(wide):(0) with vectors nohead lw 0.7 lc rgb "#d5d5d5", \
     data index 0 using (of_column($1, 0, 12)):2:3 with labels left noenhanced font ",12", \
     data index 0 using (of_column($1, 1, 30)):2:3 with labels left noenhanced font ",12", \
     data index 0 using (of_column($1, 2, 30)):2:3 with labels left noenhanced font ",11" \
         textcolor rgb "#555555", \
     data index 1 using (440):1:(shape_of($3)):(colour_of($3)) with points pt variable ps 1 lw 2.5 \
         lc rgb variable, \
     data index 1 using (452):1:4:(colour_of($3)) with labels left noenhanced font ",12" \
         textcolor rgb variable
