"""Tables of what was checked, fuzzed, covered and planted. Each is gathered from the newest records of some studies,
and from the reference (tests/scripts/record.sh) where that has what no record has."""
import csv
import functools
import json
from collections import defaultdict, namedtuple

from tables.records import csv_rows, newest, study_of

RELIABILITY = "reference/reliability.csv"
MUTATION = "reference/mutation.csv"
COVERAGE = "reference/coverage.csv"
SOAK = "reference/soak.csv"


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


def stored(row):
    return f"{row['date']}, {row['commit']}"


@functools.cache
def checks_of_reference(root):
    return {row["check"]: (int(row["tried"]), int(row["failed"]), row["date"]) for row in csv_rows(root, RELIABILITY)}


def counts_as_checks(root, record):
    """A record of some parts counts once it has tried as many as the reference, or where something failed."""
    done, parts = parts_of(record)
    rows, before = list(rows_of(record, "checks.tsv")), checks_of_reference(root)
    return (done == parts or any(int(failed) > 0 for _, _, failed in rows)
            or all(int(tried) >= before.get(check, (0,))[0] for check, tried, _ in rows))


def records_of_checks(root):
    return newest(root, "*", "checks.tsv", functools.partial(counts_as_checks, root))


@functools.cache
def checks(root):
    """By name, how many cases were tried, how many failed, and when."""
    found = {check: (int(tried), int(failed), study_of(record)["ended"][:10])
             for record in records_of_checks(root).values() for check, tried, failed in rows_of(record, "checks.tsv")}
    for check, row in checks_of_reference(root).items():
        found.setdefault(check, row)
    return found


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
    """The hours of the record and those of tests/corpus/log.csv. Inputs that were found and mended are in the corpus."""
    runs = defaultdict(list)
    with open(root / "tests/corpus/log.csv", newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            runs[row["target"]].append((int(row["cpu_seconds"]), int(row["executions"]), int(row["findings"]), stored(row)))
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
    rows = {row["folder"]: (int(row["branches"]), int(row["taken"]), stored(row))
            for row in csv_rows(root, COVERAGE)}
    for record in records_of_coverage(root).values():
        for folder, branches, taken in rows_of(record, "coverage.tsv"):
            rows[folder] = (int(branches), int(taken), measured(record))
    yield "| branches of | in all | taken | share | measured |"
    yield "| --- | ---: | ---: | ---: | --- |"
    for folder, (branches, taken, when) in rows.items():
        yield f"| {folder} | {branches:,} | {taken:,} | {100 * taken / branches:.2f} % | {when} |"


def records_of_mutation(root):
    return newest(root, "mutation-*", "mutation*.tsv")


def mutation_table(root):
    """Mutants that change no promised answer count neither way."""
    rows = {row["module"]: (*(int(row[key]) for key in ("mutants", "killed", "equivalent")), stored(row))
            for row in csv_rows(root, MUTATION)}
    for record in records_of_mutation(root).values():
        parts = list(rows_of(record, "mutation*.tsv"))
        rows[parts[0][0]] = (*(sum(int(part[k]) for part in parts) for k in (1, 2, 3)), measured(record))
    yield "| mutants of | tried | killed | change nothing | score | measured |"
    yield "| --- | ---: | ---: | ---: | ---: | --- |"
    for module, (tried, killed, same, when) in rows.items():
        yield f"| {module} | {tried:,} | {killed:,} | {same} | {100 * killed / (tried - same):.1f} % | {when} |"


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


def soak_lines(root):
    """Method and numbers of each run that is stored: of the record, or of the reference while that has more."""
    stored = [[row["method"], row["queries"], row["missed"], row["false_contacts"], row["largest_error"],
               *(row[f"below_1e-{k}"] for k in DECADES[:-1]), row["more"]] for row in csv_rows(root, SOAK)]
    recorded = [[*(method[key] for key in ("method", "queries", "missed", "false_contacts", "largest_error")),
                 *method["decades"]] for method in soaked_methods(root)]
    return max(stored, recorded, key=lambda rows: sum(int(row[1]) for row in rows))


@functools.cache
def soaks(root):
    """By method, the sums over all runs."""
    found = {}
    for method, queries, missed, _, largest, *counts in soak_lines(root):
        sums = found.get(method, Soak(0, 0, 0.0, dict.fromkeys(DECADES, 0)))
        found[method] = Soak(sums.queries + int(queries), sums.missed + int(missed), max(sums.largest, float(largest)),
                             {k: sums.decades[k] + int(count) for k, count in zip(DECADES, counts)})
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
