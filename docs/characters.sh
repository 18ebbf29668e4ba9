#!/bin/sh
# docs/characters.sh MOTE OUT.gif: the picture of docs/characters.md, two bison and their closest points as the
# certified query gives them. Needs gnuplot and a folder that can be written, ./characters.
set -eu
mote=$1 out=$2 work=characters
mkdir -p $work
echo '{"purpose": "The bison as they come.", "like": "bison-15k", "bodies": [{"subdivide": 0}, {"subdivide": 0}]}' \
    >$work/bison.json
"$mote" run $work/bison.json --method certified --replicates 1 --out $work/run >$work/run.txt
# Triangles of an OBJ file as gnuplot's polygons.
polygons() {
    awk '$1 == "v" { x[++n] = $2 " " $3 " " $4 }
        $1 == "f" { print x[$2]; print x[$3]; print x[$4]; print x[$2] "\n" }' "$1"
}
{
    echo 'set terminal gif animate delay 10 size 640,400; set output "'"$work"'/picture.gif"'
    echo 'set pm3d depthorder noborder lighting primary 0.4 specular 0.1; unset border; unset tics; unset key'
    echo 'set view equal xyz; set view 72,60,2.9'
    echo 'set xrange [-1.2:2.2]; set yrange [-2.8:2.8]; set zrange [-0.9:1.2]'
} >$work/picture.gp
for frame in $(seq 1 20 480); do
    "$mote" export $work/bison.json --frame "$frame" --out $work/frame >/dev/null
    polygons $work/frame/A.obj >$work/a$frame.dat
    polygons $work/frame/B.obj >$work/b$frame.dat
    awk -F, -v frame="$frame" 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i }
        $1 == frame { print $at["ax"], $at["ay"], $at["az"]; print $at["bx"], $at["by"], $at["bz"] }' \
        $work/run/cells/*.csv >$work/p$frame.dat
    distance=$(awk -F, -v frame="$frame" 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i }
        $1 == frame { print ($at["distance"] > 0 ? "distance " $at["distance"] : "contact") }' $work/run/cells/*.csv)
    # z of the files points forward, y up.
    echo "set multiplot; set label 1 'frame $frame: $distance' at screen 0.5,0.95 center"
    echo "splot '$work/a$frame.dat' using 1:3:2 with polygons fc rgb '#7f9fbf'," \
        "'$work/b$frame.dat' using 1:3:2 with polygons fc rgb '#bf9f6f'"
    echo "splot '$work/p$frame.dat' using 1:3:2 with linespoints lw 3 pt 7 ps 1.2 lc rgb '#c00000'; unset multiplot"
done >>$work/picture.gp
gnuplot $work/picture.gp
mv $work/picture.gif "$out"
