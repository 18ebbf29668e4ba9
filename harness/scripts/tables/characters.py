"""Tables of docs/characters.md."""
import functools
import re

from tables.number_text import digits, span
from tables.records import by_method, csv_rows, file_of

CHARACTERS = "character-speed/characters.md"
PARTS = "rigid-parts/summary.csv"


@functools.cache
def characters(root):
    """Median and 95th percentile of certified in microseconds, by scenario."""
    rows = (re.findall(r"[^|]+", line) for line in file_of(root, CHARACTERS).read_text().splitlines()[2:])
    return {name.strip(): [time.split()[0] for time in (median, p95)] for name, median, p95, *_ in rows}


def characters_table(root):
    yield from file_of(root, CHARACTERS).read_text().splitlines()


def parts_rows(root):
    """By scenario, the rows of the exact query and of rigid parts by either search, whose answers are the same."""
    rows = by_method(csv_rows(root, PARTS), "label")
    labels = ("certified", "posed-parts:search=certified", "posed-parts")
    return {scenario: [rows[scenario, label] for label in labels] for scenario, _ in rows}


def exact_to_parts(root):
    """Where no body has morph targets: the least and the largest time of the exact query, over that of rigid parts by
    the same search."""
    found = [parts_rows(root)[scenario] for scenario in ("bison-15k", "jumper-20k", "hands")]
    return span([float(exact["total_ns_median"]) / float(parts["total_ns_median"]) for exact, parts, _ in found])


def parts_table(root):
    yield "| scenario | `certified`, µs | parts by `certified` | parts by FCL | error over L of the parts, p99 | missed, false |"
    yield "| --- | ---: | ---: | ---: | ---: | --- |"
    for scenario, found in parts_rows(root).items():
        parts = found[-1]
        wrong = (f"{float(parts['missed']):.0f} of {float(parts['contacts']):.0f}, "
                 f"{float(parts['false_contacts']):.0f} of {int(parts['frames']) - float(parts['contacts']):.0f}")
        times = " | ".join(digits(float(row["total_ns_median"]) / 1e3) for row in found)
        yield f"| {scenario} | {times} | {digits(float(parts['error_p99']))} | {wrong} |"
