"""The closed loop of `make dynamics`: approaches that pass through, contacts that are missed or late."""
import functools

from tables.impacts import DYNAMICS
from tables.number_text import percent, span
from tables.records import by_method, csv_rows, figure

PAPER_SCENES = ("tt", "mv", "ww")


@functools.cache
def dynamics(root):
    """Rows of the closed loop in which a step is a frame, by scenario and method."""
    return by_method(row for row in csv_rows(root, DYNAMICS) if not row.get("within"))


def loops(root, methods, others=False):
    """Rows of the closed loop of some methods: those of the paper's scenes, or of all other scenes."""
    return [row for (scene, method), row in dynamics(root).items()
            if method in methods and (scene in PAPER_SCENES) != others]


def paper(n, law="log"):
    return f"particle-paper:n={n},law={law}"


def particles(*counts):
    return [paper(n) for n in counts]


def dynamics_table(root):
    rows = dynamics(root)
    yield "| scene | n = 1 | 2 | 3 | 4 | 5 | 8 | 16 | tracked, n = 8 | certified |"
    yield "| --- " * 10 + "|"
    for scene in ("tt", "mv", "ww", "twist", "comb"):
        cells = []
        for method in particles(1, 2, 3, 4, 5, 8, 16) + ["particle:n=8", "certified"]:
            row = rows[scene, method]
            share, low, high = (float(row[key]) for key in ("share", "low", "high"))
            cells.append(f"{percent(share)} ({percent(low)}-{percent(high)})" if share else f"0 (< {percent(high)})")
        tried = int(rows[scene, "certified"]["approaches"])
        name = scene if tried == 1000 else f"{scene} ({tried})"
        yield f"| {name} | " + " | ".join(cells) + " |"
    yield ""
    yield figure(root, "dynamics/dynamics.svg", "Share of approaches with a pass through over the number of particles")


def pass_through(root, scene, n, law="log"):
    return percent(float(dynamics(root)[scene, paper(n, law)]["share"]))


def missed_steps(root, method, *scenes):
    rows = [dynamics(root)[scene, method] for scene in scenes]
    missed, touching = (sum(int(row[key]) for row in rows) for key in ("missed_steps", "contact_steps"))
    return f"{missed} of {touching:,}"


def missed_shares(root, counts, others=False):
    """Of the frames in contact, which share the paper's particles miss, scene by scene."""
    return [int(row["missed_steps"]) / int(row["contact_steps"]) for row in loops(root, particles(*counts), others)]


def worst_reports(root, others=False):
    """The longest delay, in frames, and the deepest penetration of 3 to 5 particles."""
    rows = loops(root, particles(3, 4, 5), others)
    return (max(int(row["delay_max"]) for row in rows), max(float(row["max_penetration_unreported"]) for row in rows))


def query_times(root, *methods):
    """The least and the largest time of a frame of the paper's scenes, in microseconds."""
    return span([float(row["query_ns"]) / 1e3 for row in loops(root, methods)])
