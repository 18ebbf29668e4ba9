"""What each step of the certified query and each part of the tracked particles brings."""
import functools

from tables.pairs import accuracy
from tables.records import by_method, csv_rows, figure

ABLATION = "ablation/summary.csv"
INGREDIENTS = "ingredients/summary.csv"
ABLATION_SCENES = ("ww", "fast-25", "jump", "comb", "ww-1m")
WITHOUT = ("fits=constant", "seed=none", "seed=pair", "seed=tracked", "plane=off", "directions=off", "restarts=0", "width=4",
           "width=2", "slack=1e-06", "slack=0.001")


def ablation_table(root):
    """Times without a step of the certified query, or with another width or slack, over those with all of them."""
    rows = by_method(csv_rows(root, ABLATION), "label")
    yield f"| | {' | '.join(ABLATION_SCENES)} |"
    yield "| --- " + "| ---: " * len(ABLATION_SCENES) + "|"
    for option in WITHOUT:
        times = [float(rows[scene, f"certified:{option}"]["total_ns_median"]) / float(rows[scene, "certified"]["total_ns_median"])
                 for scene in ABLATION_SCENES]
        yield f"| `{option}` | {' | '.join(f'{time:.2f}' for time in times)} |"


@functools.cache
def ingredients(root, label, scene="comb"):
    """Of tracked particles with some part changed: median time, per cent of exact frames, and missed contacts."""
    row = by_method(csv_rows(root, INGREDIENTS), "label")[scene, label]
    exact, missed, _ = accuracy(row)
    return (float(row["total_ns_median"]), 100 * exact, missed)


def ingredients_figure(root):
    yield figure(root, "ingredients/ingredients.svg", "What each part of the tracked particles brings on five scenes")


def launches(root):
    """With eight launches a query: per cent of exact frames, missed contacts a run, and the time to that of none."""
    time, exact, missed = ingredients(root, "particle:n=8,launch=8")
    return (exact, missed, time / ingredients(root, "particle:n=8")[0])
