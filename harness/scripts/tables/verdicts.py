"""Tables of docs/peers.md: the wrong verdicts of each engine, from runs of `make verdicts`, and where it is wrong."""
import functools
import re

from tables.records import file_of

VERDICTS = "verdicts/verdicts.txt"
LARGE_VERDICTS = "verdicts-large/verdicts.txt"
WRONG = re.compile(r"(\S+) on (\S+): missed (\d+) of (\d+) contacts, invented (\d+) in \d+ frames")


def rows_of(root, source):
    """{method, scenarios, frames, contacts, missed, invented} of the first table, as words; an empty line ends it."""
    return [line.split() for line in file_of(root, source).read_text().split("\n\n")[0].splitlines()[1:]]


def verdicts_table(root, source=VERDICTS):
    yield "| | scenarios | frames | contacts | missed / invented |"
    yield "| --- | ---: | ---: | ---: | ---: |"
    for label, scenarios, frames, contacts, missed, invented in rows_of(root, source):
        yield f"| `{label}` | {scenarios} | {int(frames):,} | {int(contacts):,} | {int(missed):,} / {int(invented):,} |"


@functools.cache
def wrong(root, label):
    """The scenarios in which a method is wrong: contacts missed, contacts in all, contacts invented."""
    found = WRONG.findall(file_of(root, VERDICTS).read_text())
    return {scenario: tuple(map(int, counts)) for method, scenario, *counts in found if method == label}


def invented(root, label, *scenarios):
    """How many contacts a method invents in each of these scenarios, which must be all in which it invents any."""
    found = {scenario: count for scenario, (_, _, count) in wrong(root, label).items() if count}
    if found.keys() != set(scenarios):
        raise ValueError(f"{label} invents contacts on {', '.join(found)}; docs/peers.md says on {', '.join(scenarios)}")
    return [found[scenario] for scenario in scenarios]


def oriented_bottom_up(root):
    """What oriented volumes that are refitted bottom-up invent on `spider`; what RSS invents there and misses elsewhere, of how
    many contacts in how many scenarios; what it misses there, of how many."""
    fcl = [f"fcl-{volume}:update=refit-bottom-up" for volume in ("kios", "obb", "obbrss", "rss")]
    most, *same, of_rss = (invented(root, label, "spider")[0] for label in fcl)
    if same != [most, most]:
        raise ValueError("FCL's oriented volumes do not invent equally many contacts on spider; docs/peers.md says so")
    elsewhere = dict(wrong(root, fcl[-1]))
    missed, contacts, _ = elsewhere.pop("spider")
    return (most, of_rss, *(sum(counts[k] for counts in elsewhere.values()) for k in (0, 1)), len(elsewhere), missed, contacts)


def convex(root):
    """In how many scenarios the hulls of convex parts are wrong, and of how many; what they invent on `shell`, and in all."""
    scenarios, invented_in_all = next((int(row[1]), int(row[5])) for row in rows_of(root, VERDICTS) if row[0] == "ccd-convex")
    found = wrong(root, "ccd-convex")
    return (len(found), scenarios, found["shell"][2], invented_in_all)
