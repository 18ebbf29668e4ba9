# Shared by all figures, loaded by each after it has set `wide` and `high` if it needs another size
# than 560 by 400. A figure is laid out for a paper's column: 560 units are 8.4 cm, so that its text
# of 13 units is 5.5 points high. Readable in grey: lines differ in lightness, width and dashes, points
# in shape.
column = 8.4
if (format eq "svg") {
    set terminal svg size wide,high dynamic enhanced font "DejaVu Sans,13" rounded background rgb "white"
}
if (format eq "png") {
    set terminal pngcairo size 2.5*wide,2.5*high enhanced font "DejaVu Sans,13" fontscale 1.875 \
        linewidth 2.5 pointscale 2.5 rounded background rgb "white"
}
if (format eq "pdf") {
    set terminal pdfcairo size column cm,column*high/wide cm enhanced font "DejaVu Sans,13" \
        fontscale 0.32 linewidth 0.85 pointscale 0.6 rounded background rgb "white"
}
if (format eq "gif") {
    set terminal gif animate delay 8 loop 0 size wide,high font "DejaVu Sans,10"
}
set output base.".".format

# From dark to light: also in grey.
dark = "#14142e"
blue = "#2a78b8"
orange = "#f0a04b"
grey = "#777777"
ink = "#444444"
pale = "#ececec"
array colour[8] = [dark, blue, orange, grey, "#8a2f1c", "#5aa9a0", "#b58ac4", "#a8a035"]
array shape[8] = [7, 5, 9, 13, 11, 6, 4, 8]
array dashes[8] = [1, 1, 1, 1, 2, 2, 2, 2]

set border 3 lc rgb ink
set xlabel offset 0,0.5
set tics nomirror textcolor rgb "#222222" font ",12"
set grid y lc rgb "#d5d5d5" lw 1
set key outside bottom center horizontal Left reverse samplen 2.5 spacing 1.1 height 0.6 noenhanced font ",12"

# The footer has a strip of its own below the figure.
strip = 16.0 / high
show_footer = 'set label 1000 footer at screen 0.99,0.3*strip right noenhanced ' \
    .'textcolor rgb grey font ",9"'
eval show_footer
set size 1,1 - strip
set origin 0,strip
set title heading noenhanced font ",14" offset 0,-0.3

# Of several plots on one canvas: `eval panels` before, then each of these where it is drawn once.
panels = 'unset label 1000; unset title; set size 1,1; set origin 0,0'
show_heading = 'set label 1001 heading at screen 0.5,1 - 14.0/high center noenhanced font ",14"'
