"""Where results are stored: in the newest record of a study of `make record`, or in the accepted reference."""
import csv
import functools
import json
import os
import subprocess
from pathlib import Path


def study_of(record):
    return json.loads((record / "study.json").read_text())


def newest(root, studies, files, rank=lambda record: 0):
    """By name, the record of each study that has such files and the highest rank, of several the newest; studies and
    files are patterns."""
    found = {}
    for file in sorted(root.glob(f"results/records/*/{studies}/{files}")):
        record = file.parent
        other = found.get(record.name, record)
        found[record.name] = max(record, other, key=lambda folder: (rank(folder), study_of(folder)["ended"]))
    return dict(sorted(found.items()))


def record_of(root, source):
    """The newest record of a source's study: its folder, or None."""
    study, file = Path(source).parent.name, Path(source).name
    return newest(root, study, file).get(study)


def file_of(root, source):
    if source.startswith("reference/"):
        return root / "results" / source
    record = record_of(root, source)
    if not record:
        raise FileNotFoundError(f"no record in results/records has {source}; make record makes one")
    return record / Path(source).name


@functools.cache
def changed_studies(root):
    """The recorded studies whose sources have changed since; None without the repository that tells."""
    listed = subprocess.run(
        ["bash", "harness/scripts/studies.sh", "harness/scripts/studies.tsv", "results/records", "results/record",
         "list"], cwd=root, env={**os.environ, "ONLY": ""}, capture_output=True, text=True, check=False)
    if listed.returncode > 1:
        return None
    return {line.split()[0] for line in listed.stdout.splitlines()
            if " changed since " in line or " other sources than " in line}


def has_changed(root, record):
    """Whether the sources of a record have changed since; None if nothing tells. A study is begun anew only where they
    have, so that what a newer record does not replace yet is of other sources."""
    if newest(root, record.name, "study.json")[record.name] != record:
        return True
    changed = changed_studies(root)
    return changed if changed is None else record.name in changed


def reference_origin(root):
    """The commit and the day of the accepted reference."""
    manifest = json.loads(file_of(root, "reference/manifest.json").read_text())
    return manifest["commit"][:10], manifest["sessions"][0]["started"][:10]


def reference_has_changed(root, commit):
    """Whether what the accepted reference measured has changed since; None without the repository that tells."""
    status = subprocess.run(["git", "diff", "--quiet", commit, "--", "core", "baselines", "datasets", "harness"],
                            cwd=root, capture_output=True, check=False).returncode
    return {0: False, 1: True}.get(status)


@functools.cache
def csv_rows(root, source):
    with open(file_of(root, source), newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def by_method(rows, name="method"):
    """Rows by scenario and method, or by scenario and label."""
    return {(row["scenario"], row[name]): row for row in rows}


def wrong_verdicts(row):
    """How many contacts were missed or false."""
    return float(row["missed"] or 0) + float(row["false_contacts"] or 0)


def is_right(row):
    """Whether no verdict was wrong, and each distance, where distances were asked for, is exact."""
    return not wrong_verdicts(row) and not float(row["exact_rate"] or 1) < 1


def result_link(root, source, text):
    """Names the file from the root; documents.py has it start at the folder of the document."""
    return f"[{text}]({file_of(root, source).relative_to(root)})"


def figure(root, source, what):
    return "!" + result_link(root, source, what)
