#!/usr/bin/python3
"""counts.py RUN: what queries of `certified` look at, from the cells of a run by that method alone.

Writes RUN/counts.csv, a row a group of frames: all of a scenario, and of a scenario of some length those between two
shares of the frames ranked by their pairs of leaves (ties by rows, then by frame). `frames`, `contacts` (frames in
contact) and `untested` (frames in which no two boxes were compared) are counts, `first` and `last` are the numbers of
the group's first and last frame, and the rest are means of the columns of cells/*.csv."""
import csv
import re
import statistics
import sys
from pathlib import Path

MEANS = ("distance", "positions", "blocks", "rows", "leaf_pairs", "triangle_tests", "refined")
GROUPS = ((40, 60), (90, 95), (95, 99), (99, 100))  # per cent of the ranked frames
LEAST_FRAMES = 600


def frames_of(cell):
    with open(cell, newline="", encoding="utf-8") as file:
        return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]


def group(scenario, name, frames):
    numbers = [int(frame["frame"]) for frame in frames]
    return {"scenario": scenario, "group": name, "frames": len(frames), "first": min(numbers), "last": max(numbers),
            "contacts": sum(frame["contact"] > 0 for frame in frames),
            "untested": sum(frame["box_tests"] == 0 for frame in frames),
            **{mean: f"{statistics.fmean(frame[mean] for frame in frames):.6g}" for mean in MEANS}}


def groups(scenario, frames):
    yield group(scenario, "all", frames)
    if len(frames) >= LEAST_FRAMES:
        ranked = sorted(frames, key=lambda frame: (frame["leaf_pairs"], frame["rows"], frame["frame"]))
        for shares in GROUPS:
            begin, end = (share * len(frames) // 100 for share in shares)
            yield group(scenario, "{} to {} %".format(*shares), ranked[begin:end])


def main(arguments):
    if len(arguments) != 1:
        print("usage: counts.py RUN", file=sys.stderr)
        return 2
    run = Path(arguments[0])
    rows = []
    for cell in sorted(run.glob("cells/*.csv")):
        name = re.fullmatch(r"(.+)-certified-r1-[0-9a-f]+", cell.stem)
        if not name:
            print(f"counts: {cell}: a run of one replicate of certified alone has no such cell", file=sys.stderr)
            return 4
        rows += groups(name[1], frames_of(cell))
    if not rows:
        print(f"counts: {run}/cells has no frames; `make counts` measures them", file=sys.stderr)
        return 4
    with open(run / "counts.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, rows[0], lineterminator="\n")
        table.writeheader()
        table.writerows(rows)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
