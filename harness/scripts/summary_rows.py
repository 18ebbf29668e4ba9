"""The rows of a run's summary.csv, and tables of them, for the scripts of studies."""
import csv
import math
import sys

FAILED = "failed"


def scenes_of(run):
    """By scene, the rows over its most frames and replicates. Others have failed in some replicate, or are left from
    other options: the least of fewer replicates is larger, and other frames take other times."""
    with open(run / "summary.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    sizes = {}
    for row in rows:
        size = (int(row["frames"]), int(row["replicates"]))
        sizes.setdefault(row["scene"], {}).setdefault(size, []).append(row)
    return {scene: by_size[max(by_size)] for scene, by_size in sizes.items()}


def value(row, name):
    """A number of a row; not a number without the row or without its number."""
    return float(row[name]) if row and row[name] else math.nan


def fastest(rows, method, time):
    """Of a method's rows the one that takes least by a time; None where none has such a time."""
    timed = [row for row in rows if row["method"] == method and not math.isnan(value(row, time))]
    return min(timed, key=lambda row: value(row, time), default=None)


def ratio(time, base):
    """How many times as long as a base; not a number without either, or where the base takes no time."""
    return time / base if base > 0 else math.nan


def shown(number, form):
    return FAILED if math.isnan(number) else format(number, form)


def keep_table(file, lines, statuses=()):
    """Writes the lines that a function makes. Returns the status that the script ends with: that of the first of some
    texts that the table holds, or 5 where a number failed, 4 where the rows cannot be read."""
    try:
        text = "\n".join(lines()) + "\n"
        file.write_text(text, encoding="utf-8")
    except (OSError, KeyError, ValueError) as error:
        print(f"{file}: {error!r}; it is made from the summary.csv of `mote summarize`", file=sys.stderr)
        return 4
    return next((status for said, status in [*statuses, (FAILED, 5)] if said in text), 0)
