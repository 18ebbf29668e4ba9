"""Tables of the engines of others beside ours, from a run of `make engines` in which all are asked about the same
frames."""
import functools

from tables.number_text import digits
from tables.records import csv_rows, is_right, wrong_verdicts

ENGINES = "engines/summary.csv"
PEERS = ENGINES + "#peers"
SINGLE = {"ode": "ODE", "bullet-gimpact": "Bullet", "embree-contact": "Embree"}

QUESTIONS = {"ww": "ww, distance", "mv": "mv, distance", "tt-distance": "tt, distance", "ww-contact": "ww, contact",
             "mv-contact": "mv, contact", "tt": "tt, contact", "rigid-ww": "path of ww, rigid, contact",
             "rigid-mv": "path of mv, rigid, contact"}
STATISTICS = ("median", "mean", "p95", "max")


@functools.cache
def finished(root, scenario):
    return [row for row in csv_rows(root, ENGINES) if row["scenario"] == scenario and row["status"] == "ok"]


def failed(root, scenario):
    return [row for row in csv_rows(root, ENGINES)
            if row["scenario"] == scenario and row["status"] not in ("ok", "unsupported")]


def time_of(row, statistic):
    """Microseconds."""
    return float(row["total_ns_" + statistic]) / 1e3


def fastest(rows, statistic):
    return min(rows, key=lambda row: time_of(row, statistic))


def fastest_right_of(rows, statistic):
    """Of those without a wrong answer."""
    return fastest([row for row in rows if is_right(row)], statistic)


def fastest_right(root, scenario, statistic, wanted):
    """Of the methods that are wanted, the fastest row without a wrong answer."""
    return fastest_right_of([row for row in finished(root, scenario) if wanted(row["method"])], statistic)


def time_of_fastest(root, scenario, statistic, wanted):
    return time_of(fastest_right(root, scenario, statistic, wanted), statistic)


def is_certified(method):
    return method == "certified"


def is_fcl(method):
    return method.startswith("fcl-")


def is_engine(method):
    """Whether it is an engine of others."""
    return is_fcl(method) or method.startswith("coal-") or method in SINGLE


def times(root, scenario, statistic="median", wanted=is_engine):
    """The time of the fastest of the methods that are wanted, over that of certified."""
    return time_of_fastest(root, scenario, statistic, wanted) / time_of_fastest(root, scenario, statistic, is_certified)


def is_tree(method):
    return method == "aabb-tree"


def best_to_fcl(root, scenario):
    """The time of the fastest engine of others over that of the fastest FCL."""
    return times(root, scenario) / times(root, scenario, wanted=is_fcl)


def best_engine(root, scenario):
    """The name of the engine of others that is fastest by the median."""
    method = fastest_right(root, scenario, "median", is_engine)["method"]
    return SINGLE.get(method, "FCL" if is_fcl(method) else "Coal")


def best_engines(root, *scenarios):
    """The names of the engines of others that are fastest in some scenario: "A, B or C"."""
    names = list(dict.fromkeys(best_engine(root, scenario) for scenario in scenarios))
    return " or ".join(filter(None, (", ".join(names[:-1]), names[-1])))


def engines_table(root):
    yield ("| scene, question | `certified`: median, mean in µs | fastest by the median | times | fastest by the mean | times | "
           "FCL, median | `aabb-tree`, median |")
    yield "| --- | ---: | --- | ---: | --- | ---: | ---: | ---: |"
    for scenario, name in QUESTIONS.items():
        ours = [digits(time_of_fastest(root, scenario, key, is_certified)) for key in ("median", "mean")]
        cells = [name, ", ".join(ours)]
        for key in ("median", "mean"):
            cells += [f"`{fastest_right(root, scenario, key, is_engine)['label']}`", digits(times(root, scenario, key))]
        cells += [digits(times(root, scenario, "median", wanted)) for wanted in (is_fcl, is_tree)]
        yield f"| {' | '.join(cells)} |"


def shown_of(rows):
    """Of each method the row with its defaults, and those that are best by the median and by the mean."""
    of_method = {}
    for row in rows:
        of_method.setdefault(row["method"], []).append(row)
    shown = [row for row in rows if row["label"] == row["method"]
             or any(row is fastest(of_method[row["method"]], key) for key in ("median", "mean"))]
    return sorted(shown, key=lambda row: time_of(row, "median"))


def peers_of(root, scenario):
    rows = finished(root, scenario)
    best = {key: fastest_right(root, scenario, key, is_engine) for key in STATISTICS}
    yield f"### {QUESTIONS[scenario]} (`{scenario}`)"
    yield ""
    yield f"{int(rows[0]['frames']):,} frames, {rows[0]['replicates']} processes a row."
    yield ""
    yield "| | median | mean | p95 | worst | wrong |"
    yield "| --- | ---: | ---: | ---: | ---: | ---: |"
    for row in shown_of(rows):
        cells = [digits(time_of(row, key)) + " *" * (row is best[key]) for key in STATISTICS]
        yield f"| `{row['label']}` | {' | '.join(cells)} | {wrong_verdicts(row):.0f} |"
    for row in failed(root, scenario):
        yield f"| `{row['label']}` | {row['status']} | | | | |"


def peers_tables(root):
    """A table a scenario, in microseconds a frame. A star marks, in each column, the fastest engine of others."""
    for number, scenario in enumerate(QUESTIONS):
        if number > 0:
            yield ""
        yield from peers_of(root, scenario)
