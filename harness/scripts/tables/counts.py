"""What queries of `certified` look at, from `make counts`."""
from tables.number_text import digits
from tables.records import csv_rows

COUNTS = "counts/counts.csv"
RANKED_COUNTS, SIZED_COUNTS = f"{COUNTS}#ranked", f"{COUNTS}#sized"
RANKED_SCENES = ("ww", "mv", "twist")
SIZED_SCENES = ("ww-1k", "ww-10k", "ww-100k", "ww-1m")
COUNTERS = {"positions": "positions", "blocks": "blocks", "rows": "rows", "leaf_pairs": "pairs of leaves",
            "triangle_tests": "faces measured", "refined": "slides"}


def counts(root, scene, group="all"):
    return next(row for row in csv_rows(root, COUNTS) if (row["scenario"], row["group"]) == (scene, group))


def counters(row):
    return " | ".join(digits(float(row[name])) for name in COUNTERS)


def contacts(row):
    return f"{int(row['contacts']):,} of {int(row['frames']):,}"


def ranked_counts_table(root):
    yield f"| scenario, frames | {' | '.join(COUNTERS.values())} | in contact | distance |"
    yield "| --- " + "| ---: " * (len(COUNTERS) + 2) + "|"
    for scene in RANKED_SCENES:
        for row in csv_rows(root, COUNTS):
            if row["scenario"] == scene:
                yield (f"| `{scene}`, {row['group']} | {counters(row)} | {contacts(row)} | "
                       f"{float(row['distance']):.2f} |")


def sized_counts_table(root):
    yield f"| scenario, frames | {' | '.join(COUNTERS.values())} | in contact | no boxes compared |"
    yield "| --- " + "| ---: " * (len(COUNTERS) + 2) + "|"
    for scene in SIZED_SCENES:
        row = counts(root, scene)
        yield (f"| `{scene}`, {row['first']} to {row['last']} | {counters(row)} | {contacts(row)} | "
               f"{row['untested']} |")


def costliest_frames(root):
    """The hundredth of the frames of `ww` with the most pairs of leaves: how many are in contact, of how many, the first
    and the last; and its blocks, rows and pairs of leaves to those of the middle fifth."""
    costliest, middle = (counts(root, "ww", group) for group in ("99 to 100 %", "40 to 60 %"))
    return (*(costliest[name] for name in ("contacts", "frames", "first", "last")),
            *(float(costliest[name]) / float(middle[name]) for name in ("blocks", "rows", "leaf_pairs")))
