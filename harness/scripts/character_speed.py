#!/usr/bin/python3
"""character_speed.py RUN: from RUN/summary.csv, `certified` beside the faster tree of either kind, scene by scene.

Writes RUN/characters.md: medians and 95th percentiles over all frames, the medians of the trees as multiples of that of
certified. Status: 0, 5 where a method failed, 4 where the rows cannot be read."""
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # no folder beside the sources
from summary_rows import FAILED, fastest, keep_table, ratio, scenes_of, shown, value

MEDIAN, P95 = "total_ns_median", "total_ns_p95"


def microseconds(row, time, form):
    text = shown(value(row, time) / 1e3, form)
    return text if text == FAILED else f"{text} µs"


def beside(row, own):
    """A tree's median over that of certified, and its 95th percentile."""
    times = ratio(value(row, MEDIAN), value(own, MEDIAN))
    return [shown(times, ".1f" if times < 100 else ".0f"), microseconds(row, P95, ".0f")]


def table(run):
    yield ("| scenario | certified, median | p95 | aabb-tree / certified | its p95 | best FCL / certified | its p95 | "
           "bytes a vertex | largest error over L |")
    yield "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"
    for scene, rows in scenes_of(run).items():
        own, tree, fcl = (fastest(rows, method, MEDIAN) for method in ("certified", "aabb-tree", "fcl-aabb"))
        cells = [scene, microseconds(own, MEDIAN, ".1f"), microseconds(own, P95, ".1f"),
                 *beside(tree, own), *beside(fcl, own),
                 shown(value(own, "heap_bytes_per_vertex"), ".0f"), shown(value(own, "error_max"), ".1e")]
        yield f"| {' | '.join(cells)} |"


def main(arguments):
    if len(arguments) != 1:
        print("usage: character_speed.py RUN", file=sys.stderr)
        return 2
    run = Path(arguments[0])
    return keep_table(run / "characters.md", lambda: table(run))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
