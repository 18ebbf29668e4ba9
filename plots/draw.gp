# Draws one figure in every format: gnuplot -c draw.gp PLOTS SCRIPT BASE HEADING FOOTER "FORMAT..."
# loads PLOTS/SCRIPT.gp, which reads BASE.dat, and writes BASE.FORMAT. Text is drawn as it stands.
plots = ARG1
script = ARG1."/".ARG2.".gp"
base = ARG3
data = ARG3.".dat"
heading = ARG4
footer = ARG5
formats = ARG6
set encoding utf8

do for [format in formats] {
    reset
    wide = 560
    high = 400
    load script
    unset output
}
