"""How often the verdicts of races were wrong."""
from math import comb
from statistics import median

from tables.number_text import span
from tables.records import csv_rows, figure, result_link

RACES = "gate/races.csv"
QUIET = ("idle", "compiler")


def races(root, place=QUIET):
    return [row for row in csv_rows(root, RACES) if row["place"] in place]


def races_figure(root):
    yield figure(root, "gate/power.svg", "Share of races that call a planted slowdown slower, over its size")
    yield ""
    yield result_link(root, "gate/power.md", "The figure as a table") + ", with exact binomial intervals."


def unchanged(root, place=QUIET):
    """How many races of unchanged builds called a row faster or slower, and of how many."""
    found = [r for r in races(root, place) if r["plant"] == "none"]
    return (sum(r["slower"] != "0" or r["faster"] != "0" for r in found), len(found))


def planted(root, least, most, place=QUIET, plant=None):
    """How many races with a slowdown of least .. most per cent named the slowed row, and of how many."""
    found = [r for r in races(root, place) if least <= int(r["per_cent"]) <= most
             and (r["plant"] == plant if plant else r["plant"] != "none")]
    return (sum(r["named_alone"] != "0" for r in found), len(found))


def found_slowdowns(root):
    """Of 2 % on the idle machine, and of 2 and 5 % beside a compiler, by what is slowed."""
    return [planted(root, size, size, (place,), plant) for size, place in ((2, "idle"), (2, "compiler"), (5, "compiler"))
            for plant in ("certified query", "particle sweep", "clock path")]


def at_most(found, count):
    """The upper end, in per cent, of the exact binomial interval (Clopper and Pearson) of 95 % for so many of count."""
    low, high = found / count, 1.0
    for _ in range(50):
        share = (low + high) / 2
        tail = sum(comb(count, k) * share ** k * (1 - share) ** (count - k) for k in range(found + 1))
        low, high = (share, high) if tail > 0.025 else (low, share)
    return 100 * high


def at_least(found, count):
    return 100 - at_most(count - found, count)


def seconds(root):
    """Of the median times of races of each kind the least and the greatest."""
    kinds = {}
    for row in races(root):
        kinds.setdefault((row["place"], row["plant"], row["per_cent"]), []).append(float(row["seconds"]))
    return span([median(times) for times in kinds.values()])
