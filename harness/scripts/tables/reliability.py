"""Tables of what was checked, fuzzed, covered and planted. Each is gathered from the newest records of some studies."""
import csv
import functools
import json
from collections import defaultdict, namedtuple

from tables.records import newest, study_of


def rows_of(record, files):
    """The lines of the files of all parts, as lists of fields."""
    for file in sorted(record.glob(files)):
        yield from csv.reader(file.read_text().splitlines(), delimiter="\t")


def parts_of(record):
    """How many parts of a study are done, and of how many."""
    study = study_of(record)
    return study.get("parts_done", 1), study.get("parts", 1)


def measured(record):
    study, (done, parts) = study_of(record), parts_of(record)
    return f"{study['ended'][:10]}, {study['commit'][:7]}" + (f", {done} of {parts} samples" if done < parts else "")


def replaces_whole(record):
    """Some parts of a study do not take the place of an older whole record, unless something failed in them."""
    done, parts = parts_of(record)
    return done == parts or any(int(failed) > 0 for _, _, failed in rows_of(record, "checks.tsv"))


def records_of_checks(root):
    return newest(root, "*", "checks.tsv", replaces_whole)


@functools.cache
def checks(root):
    """By name, how many cases were tried, how many failed, and when."""
    return {check: (int(tried), int(failed), study_of(record)["ended"][:10])
            for record in records_of_checks(root).values() for check, tried, failed in rows_of(record, "checks.tsv")}


def failures(root, check, of="random scenarios"):
    """How many of the checks of one kind failed, and of how many."""
    tried, failed, _ = checks(root)[f"{of}: {check}"]
    return (failed, tried)


def checks_table(root):
    yield "| what was checked | tried | failed | measured |"
    yield "| --- | ---: | ---: | --- |"
    for check, (tried, failed, date) in checks(root).items():
        yield f"| {check} | {tried:,} | {failed:,} | {date} |"


def records_of_fuzz(root):
    return newest(root, "fuzz-*", "fuzz*.tsv")


def fuzz_table(root):
    """The hours of the record and those of results/fuzz.csv. Inputs that were found and mended are in the corpus."""
    runs = defaultdict(list)
    with open(root / "results/fuzz.csv", newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            runs[row["target"]].append((int(row["cpu_seconds"]), int(row["executions"]), int(row["findings"]),
                                        f"{row['date']}, {row['commit']}"))
    for record in records_of_fuzz(root).values():
        for target, *counts in rows_of(record, "fuzz*.tsv"):
            runs[target].append((*map(int, counts), measured(record)))
    yield "| target | CPU hours in all | inputs | found and mended | found and open | last |"
    yield "| --- | ---: | ---: | ---: | ---: | --- |"
    for target in sorted(runs):
        seconds, inputs, findings = (sum(run[k] for run in runs[target]) for k in range(3))
        mended = len(list(root.glob(f"tests/corpus/fuzz_{target}/found-*")))
        yield (f"| {target} | {seconds / 3600:.2f} | {inputs:,} | {mended} | {max(0, findings - mended)} | "
               f"{runs[target][-1][3]} |")


def records_of_coverage(root):
    return newest(root, "coverage", "coverage.tsv")


def coverage_table(root):
    yield "| branches of | in all | taken | share | measured |"
    yield "| --- | ---: | ---: | ---: | --- |"
    for record in records_of_coverage(root).values():
        for folder, *counts in rows_of(record, "coverage.tsv"):
            branches, taken = map(int, counts)
            yield f"| {folder} | {branches:,} | {taken:,} | {100 * taken / branches:.2f} % | {measured(record)} |"


def records_of_mutation(root):
    return newest(root, "mutation-*", "mutation*.tsv")


def mutation_table(root):
    """Mutants that change no promised answer count neither way."""
    yield "| mutants of | tried | killed | change nothing | score | measured |"
    yield "| --- | ---: | ---: | ---: | ---: | --- |"
    for record in records_of_mutation(root).values():
        parts = list(rows_of(record, "mutation*.tsv"))
        tried, killed, same = (sum(int(part[k]) for part in parts) for k in (1, 2, 3))
        yield (f"| {parts[0][0]} | {tried:,} | {killed:,} | {same} | {100 * killed / (tried - same):.1f} % | "
               f"{measured(record)} |")


# Of one method: decades[k] counts errors of at most 1e-k L that are above 1e-(k+1) L; [-1]: those above L.
Soak = namedtuple("Soak", "queries missed largest decades")
DECADES = range(16, -2, -1)


def records_of_soak(root):
    return newest(root, "soak", "soak*.json")


@functools.cache
def soaked_methods(root):
    """What each part of the record has of each method."""
    return [method for record in records_of_soak(root).values() for file in record.glob("soak*.json")
            for method in json.loads(file.read_text())["methods"]]


def searched(root):
    """Of the distances of `certified` that were searched to the end: how many were wrong, and how many there are."""
    ends = [part for part in soaked_methods(root)
            if part["method"].startswith("certified") and "budget" not in part["method"]]
    return sum(part["wrong"] for part in ends), sum(part["queries"] for part in ends)


@functools.cache
def soaks(root):
    """By method, the sums over all parts."""
    found = {}
    for part in soaked_methods(root):
        sums = found.get(part["method"], Soak(0, 0, 0.0, dict.fromkeys(DECADES, 0)))
        found[part["method"]] = Soak(
            sums.queries + part["queries"], sums.missed + part["missed"], max(sums.largest, part["largest_error"]),
            {k: sums.decades[k] + count for k, count in zip(DECADES, part["decades"])})
    return found


def furthest_off(root):
    """Over L: the largest error of a distance of certified, and how far its lower bound lay below at most."""
    bounds = (method["loosest_bound"] for method in soaked_methods(root))
    return soaks(root)["certified"].largest, max(bounds, default=0)


def share(soak, decade):
    within = sum(count for k, count in soak.decades.items() if k >= decade)
    return "100 %" if within == soak.queries else f"{100 * within / soak.queries:.2f} %"


def soak_table(root):
    yield "| errors on random scenarios | queries | exact | below 1e-6 L | 1e-3 L | 1e-2 L | 0.1 L | largest / L | contacts missed |"
    yield "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |"
    for method, soak in soaks(root).items():
        shares = " | ".join(share(soak, decade) for decade in (12, 6, 3, 2, 1))
        yield f"| `{method}` | {soak.queries:,} | {shares} | {soak.largest:.2g} | {soak.missed:,} |"


def soaked(root, method):
    """What a method did: per cent that are exact, frames, missed contacts."""
    soak = soaks(root)[method]
    exact = sum(count for k, count in soak.decades.items() if k >= 9)
    return (100 * exact / soak.queries, soak.queries, soak.missed)


# records: by name, the records of the studies that a table is gathered from.
Gathered = namedtuple("Gathered", "table records")
GATHERED = {
    "checks": Gathered(checks_table, records_of_checks),
    "fuzz": Gathered(fuzz_table, records_of_fuzz),
    "coverage": Gathered(coverage_table, records_of_coverage),
    "mutation": Gathered(mutation_table, records_of_mutation),
    "soak": Gathered(soak_table, records_of_soak),
}
