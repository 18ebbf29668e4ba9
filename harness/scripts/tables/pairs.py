"""Every built-in pair of bodies, from the full bench: times and accuracy of exact methods and of particles."""
import functools

from tables.number_text import digits, exact_text, span
from tables.records import csv_rows, figure, is_right

BENCH = "bench/summary.csv"
FIGURE_3 = "bench/fig3.svg"
CURVES_OF_FIGURE_3 = ("particle-paper:n=5", "fcl-aabb", "fcl-aabb:seed=previous", "fcl-aabb:queue=64,seed=previous", "fcl-obbrss")
# Of these, only contact is asked, or no body deforms and nobody has to refit (the table of engines has some); crowd is no pair.
NOT_AMONG_PAIRS = ("tt", "ww-contact", "mv-contact", "tt-distance", "rigid-ww", "rigid-mv", "flat", "sliver-3", "sliver-6",
                   "still", "touch", "crowd")
# Where the paper's method with eight particles answers, too.
LETTER_SCENES = ("mv", "tw", "twist", "vv", "ww", "ww-1k", "ww-10k", "ww-100k", "ww-1m", "ww-10m")
CHARACTER_SCENES = ("hands", "jumper-20k", "jumper-80k", "jumper-330k", "jumper-near-20k", "jumper-near-330k")


@functools.cache
def pairs(root):
    """The finished rows of the full bench, hot and charged for everything, by scenario and label; of rows alike, that
    of the most frames."""
    found = {}
    for row in csv_rows(root, BENCH):
        if (row["status"], row["cache"], row["accounting"]) == ("ok", "hot", "charged"):
            key = (row["scenario"], row["label"])
            if key not in found or frames_of(row) > frames_of(found[key]):
                found[key] = row
    return found


def evicted(root, scenario):
    """The median of the certified query where caches are evicted before each frame, over that where they are hot."""
    row = next(row for row in csv_rows(root, BENCH) if (row["scenario"], row["cache"], row["label"]) == (scenario, "evict", "certified"))
    return float(row["total_ns_median"]) / float(pairs(root)[scenario, "certified"]["total_ns_median"])


def figure_3(root):
    yield figure(root, FIGURE_3, "Time of each query of two deforming letters W, particles against FCL")


def processes_of_figure_3(root):
    """The least and the largest number of processes of a curve."""
    return span([int(pairs(root)["ww", label]["replicates"]) for label in CURVES_OF_FIGURE_3])


def paper_to_exact(root, scenario, n):
    """The median of the paper's method with n particles over that of the certified query, in all frames."""
    return _median(root, scenario, f"particle-paper:n={n}") / _median(root, scenario, "certified")


def _median(root, scenario, label):
    return float(pairs(root)[scenario, label]["total_ns_median"])


def fcl_to_paper(root, scenario, cache):
    """How many times as long FCL takes with its defaults as five of the paper's particles, in all frames."""
    row = next(row for row in csv_rows(root, BENCH)
               if (row["scenario"], row["cache"], row["label"]) == (scenario, cache, "particle-paper:n=5"))
    return float(row["ratio"])


def best_fcl_to_default(root, scenario):
    """The part of the time of FCL with its defaults that the fastest of FCL's settings takes, frame by frame."""
    return 1 / max(float(row["ratio"]) for (name, label), row in pairs(root).items()
                   if name == scenario and label.startswith("fcl-"))


def worst_from_random_starts(root, scenario, n):
    """The largest error of the paper's method with n particles, missed contacts, and all contacts."""
    row = pairs(root)[scenario, f"particle-paper:n={n}"]
    return float(row["error_max"]), float(row["missed"]), float(row["contacts"])


def tail(root, scenario):
    """The 95th percentile of the certified query over its median."""
    row = pairs(root)[scenario, "certified"]
    return float(row["total_ns_p95"]) / float(row["total_ns_median"])


def frames_of(row):
    return int(row["frames"]) * int(row["stride"])


def accuracy(row):
    """The share of exact answers, missed contacts, and all contacts."""
    return tuple(float(row[key]) for key in ("exact_rate", "missed", "contacts"))


def accuracy_text(row):
    exact, missed, contacts = accuracy(row)
    return f"{exact_text(exact)}, {missed:.3g} of {contacts:.3g}"


def pairs_table(root):
    yield ("| scene | processes, frames | `certified`, median in µs | best FCL | `aabb-tree` | `particle:n=8` | exact, missed | "
           "`particle-paper:n=8` | exact, missed |")
    yield "| --- | ---: | ---: | ---: | ---: | ---: | --- | ---: | --- |"
    rows = pairs(root)
    for scenario in sorted({scenario for scenario, _ in rows} - set(NOT_AMONG_PAIRS)):
        ours = rows[scenario, "certified"]
        median = float(ours["total_ns_median"])
        cells = [scenario, f"{ours['replicates']}, {int(ours['frames']):,}", digits(median / 1e3), digits(float(ours["ratio_best"]))]
        for label in ("aabb-tree", "particle:n=8", "particle-paper:n=8"):
            row = rows.get((scenario, label))
            cells.append(digits(float(row["total_ns_median"]) / median) if row else "–")
            if label != "aabb-tree":
                cells.append(accuracy_text(row) if row else "refused")
        yield f"| {' | '.join(cells)} |"
    yield ""
    yield figure(root, "bench/size-time.svg", "Time of a query of two letters W over their number of triangles")


def exactness(root, scenario, label):
    """Frames of the full bench, and per cent of them that are exact."""
    row = pairs(root)[scenario, label]
    return (int(row["frames"]), 100 * accuracy(row)[0])


def tracked(root, scenario):
    """What the tracked particles did in the full bench: per cent of exact frames, missed contacts, and all contacts."""
    exact, missed, contacts = accuracy(pairs(root)[scenario, "particle:n=8"])
    return (100 * exact, missed, contacts)


def tracked_on_letters(root):
    """The least and the largest percentage of exact frames, missed contacts, and all contacts."""
    exact, missed, contacts = zip(*(tracked(root, scenario) for scenario in LETTER_SCENES))
    return (*span(exact), sum(missed), sum(contacts))


def wrong_rows(root):
    """Of the rows of the full bench by exact methods, ours and others': how many, and how many have a wrong answer."""
    rows = [row for row in csv_rows(root, BENCH) if row["status"] == "ok" and not row["method"].startswith("particle")]
    wrong = [row for row in rows if not is_right(row)]
    return (len(rows), len(wrong))


def times_of_eight(root, scenarios):
    """The time of the certified query over that of the paper's method with eight particles."""
    return [float(pairs(root)[scenario, "certified"]["total_ns_median"])
            / float(pairs(root)[scenario, "particle-paper:n=8"]["total_ns_median"]) for scenario in scenarios]


def slower_eights(root):
    """On how many scenes of the table the paper's method takes longer than the exact query, and of how many."""
    scenarios = {scenario for scenario, label in pairs(root) if label == "particle-paper:n=8"} - set(NOT_AMONG_PAIRS)
    return (sum(time < 1 for time in times_of_eight(root, scenarios)), len(scenarios))
