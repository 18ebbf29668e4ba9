#!/bin/sh
# docs/impact.sh MOTE FOLDER: the pictures of docs/impact.md, one throw with sampled and with continuous steps, as
# FOLDER/impact-sampled.gif and impact-continuous.gif. Needs gnuplot.
set -eu
mote=$1 folder=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cat >"$work/throw.json" <<'END'
{
  "purpose": "A deforming V is thrown at a T that stands still.",
  "frames": 37,
  "ask": "distance",
  "bodies": [
    {"letter": "T", "triangles": 600, "velocity": [0, 0, 0], "spin": [0, 0, 0]},
    {"letter": "V", "triangles": 600,
     "field": {"count": 6, "support": 0.5, "displacement":
       {"random": {"seed": 5, "amplitude": 0.05, "periods": [40, 90]}}},
     "motion": [{"frame": 1, "position": [0.1, 0.2, 0.8], "axis": [1, 0, 0], "degrees": 60}],
     "velocity": [0, 0, -0.045], "spin": [1, 0.5, 0]}
  ]
}
END
"$mote" simulate "$work/throw.json" --method certified --step 36 --sampled --film "$folder/impact-sampled.gif"
"$mote" simulate "$work/throw.json" --method certified --step 36 --film "$folder/impact-continuous.gif"
