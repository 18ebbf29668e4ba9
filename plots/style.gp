# Shared by all figures: readable at the width of a paper's page, and in grey. Lines differ in
# lightness, width and dashes, points in shape.
# A figure's script is called as: gnuplot -c NAME.gp PLOTS BASE; it reads BASE.dat and writes BASE.svg
# and BASE.png.
svg_terminal = "svg size 760,480 dynamic enhanced font 'DejaVu Sans,13' background rgb 'white'"
png_terminal = "pngcairo size 1520,960 enhanced font 'DejaVu Sans,20' lw 1.6"

# From dark to light: also in grey.
dark = "#14142e"
blue = "#2a78b8"
orange = "#f0a04b"
grey = "#777777"
ink = "#444444"
pale = "#ececec"

set border 3 lc rgb ink
set tics nomirror textcolor rgb "#222222"
set grid y lc rgb "#d5d5d5" lw 1
set key outside bottom center horizontal Left reverse samplen 3 spacing 1.2
