#!/usr/bin/python3
"""ratios.py OUT CASE...: from OUT/CASE/summary.csv, how much less time `stream` takes than `aabb-tree` and FCL.

Writes OUT/ratios.txt, a line a case: microseconds a frame, by the medians of the least times of frames, of stream, the
box tree and the fastest configuration of FCL, and the ratios of both to stream. Status: 0, 5 where a method failed,
4 where the rows cannot be read."""
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # no folder beside the sources
from summary_rows import fastest, keep_table, ratio, scenes_of, shown, value

METHODS = ("stream", "aabb-tree", "fcl-aabb")
MEDIAN = "least_ns_median"


def case_line(run, case):
    scenes = scenes_of(run / case)
    if len(scenes) != 1:
        raise ValueError(f"{run / case} has {len(scenes)} scenes; a case has one, in a folder of its own")
    (rows,) = scenes.values()
    stream, *others = (value(fastest(rows, method, MEDIAN), MEDIAN) for method in METHODS)
    times = [shown(time / 1e3, ".2f") for time in (stream, *others)]
    to_tree, to_fcl = (ratio(other, stream) for other in others)
    return f"{case:<16} {' '.join(f'{time:>11}' for time in times)} {shown(to_tree, '.2f'):>9} {shown(to_fcl, '.1f'):>9}"


def table(run, cases):
    yield "{:<16} {:>11} {:>11} {:>11} {:>9} {:>9}".format("µs a frame", *METHODS, "to tree", "to FCL")
    for case in cases:
        yield case_line(run, case)


def main(arguments):
    if len(arguments) < 2:
        print("usage: ratios.py OUT CASE...", file=sys.stderr)
        return 2
    run = Path(arguments[0])
    return keep_table(run / "ratios.txt", lambda: table(run, arguments[1:]))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
