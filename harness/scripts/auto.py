#!/usr/bin/python3
"""auto.py RUN: from RUN/summary.csv, what `auto` takes beside the two methods that it chooses from, scene by scene.

Writes RUN/auto.txt: microseconds a frame, and the time of auto over that of the better one, by the medians of the least
times of frames and by their sums. Status: 0, 1 where a ratio of medians is above 1.15, 5 where a method failed, 4 where
the rows cannot be read."""
import math
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # no folder beside the sources
from summary_rows import fastest, keep_table, scenes_of, shown, value

METHODS = ("certified", "stream", "auto")
MEDIAN, SUM = "least_ns_median", "least_ns_settled_sum"
CLOCK_NS = 20  # times below that of reading the clock are no times
HIGHEST = 1.15
ABOVE = f"  above {HIGHEST}"


def to_better(certified, stream, auto):
    """The time of auto over that of the better one."""
    better = min(certified, stream)
    if math.isnan(certified + stream + auto):
        return math.nan
    return auto / better if better > CLOCK_NS else 1


def table(run):
    yield "{:<12} {:>10} {:>10} {:>10} {:>8} {:>8}".format("µs a frame", *METHODS, "median", "sum")
    ratios = []
    for scene, rows in scenes_of(run).items():
        best = [fastest(rows, method, MEDIAN) for method in METHODS]
        medians, sums = ([value(row, time) for row in best] for time in (MEDIAN, SUM))
        ratios.append(to_better(*medians))
        cells = [shown(median / 1e3, ".2f") for median in medians]
        yield (f"{scene:<12} {' '.join(f'{cell:>10}' for cell in cells)} {shown(ratios[-1], '.3f'):>8} "
               f"{shown(to_better(*sums), '.3f'):>8}{ABOVE if ratios[-1] > HIGHEST else ''}")
    failures = sum(map(math.isnan, ratios))
    yield (f"{len(ratios)} scenarios, {sum(each > HIGHEST for each in ratios)} above {HIGHEST}"
           f"{f', {failures} failed' if failures else ''}")


def main(arguments):
    if len(arguments) != 1:
        print("usage: auto.py RUN", file=sys.stderr)
        return 2
    run = Path(arguments[0])
    return keep_table(run / "auto.txt", lambda: table(run), [(ABOVE, 1)])


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
