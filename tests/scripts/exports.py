#!/usr/bin/python3
"""exports.py MOTE SCHEMAS: two runs, every export of them read by other tools.

jq and json read every file; jsonschema checks those that have a schema; pandas computes the CSV's
medians and quantiles again from the frames; our Google Benchmark JSON is taken apart as that
project's compare.py does, and scipy's Mann-Whitney test, which that calls, takes its samples.
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import warnings

import jsonschema
import pandas
from scipy.stats import mannwhitneyu

warnings.simplefilter("ignore", RuntimeWarning)  # numpy: medians of rows without figures

MOTE, SCHEMAS = sys.argv[1], pathlib.Path(sys.argv[2])
RUN = ["run", "tt", "mv", "--frames", "401-460", "--replicates", "8", "--method", "fcl-aabb",
       "--method", "certified", "--method", "particle-paper", "--particles", "2,4",
       "--method", "fcl-kdop18"]  # has no distance: on mv a row without figures


def mote(*arguments):
    done = subprocess.run([MOTE, *arguments], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"mote {' '.join(arguments)}: exit {done.returncode}\n{done.stderr}")
    return done.stdout


def refuse(name):
    raise ValueError(f"{name} in JSON")


def read(text, what):
    """The value of a JSON text that jq and json agree to read."""
    done = subprocess.run(["jq", "-e", "type"], input=text, capture_output=True, text=True)
    assert done.returncode == 0, (what, done.stderr)
    return json.loads(text, parse_constant=refuse)


def has_null(value):
    if isinstance(value, dict):
        value = list(value.values())
    return value is None or (isinstance(value, list) and any(has_null(v) for v in value))


def near(a, b, share=1e-12):
    return (math.isnan(a) and math.isnan(b)) or abs(a - b) <= share * max(abs(a), abs(b))


def schema(name):
    return jsonschema.Draft202012Validator(json.loads((SCHEMAS / f"{name}.json").read_text()))


def check_files(directory):
    """Every JSON of a run against its schema."""
    validators = {name: schema(name) for name in ("cell", "manifest", "summary")}
    files = 0
    for path in sorted(directory.rglob("*.json")):
        if path.parent.name == "truth":
            continue
        name = "cell" if path.parent.name == "cells" else path.stem
        validators[name].validate(read(path.read_text(), path))
        files += 1
    return files


def frames_of(directory, row):
    """The frames of all replicates of a row of the CSV, with what their cell says of them."""
    frames = []
    for path in sorted((directory / "cells").glob("*.json")):
        cell = json.loads(path.read_text())
        n = cell["parameters"].get("n", math.nan)
        n = n if isinstance(n, int) else math.nan
        if (cell["scenario"], cell["method"], cell["status"]) != (row.scenario, row.method, "ok"):
            continue
        if not near(n, row.n):
            continue
        table = pandas.read_csv(path.with_suffix(".csv"))
        table["replicate"] = cell["replicate"]
        table["active"] = table.frame.between(*cell["active"])
        frames.append(table)
    return pandas.concat(frames) if frames else None


def check_csv(directory):
    """Medians, quantiles and counts of the CSV from the frames, by pandas; returns how many."""
    text = mote("summarize", str(directory), "--format", "csv")
    assert "nan" not in text.lower() and "inf" not in text.lower(), "a value that is none"
    path = directory / "summary.csv"
    path.write_text(text)
    rows = pandas.read_csv(path)
    checked = 0
    for row in rows.itertuples():
        frames = frames_of(directory, row)
        if row.status != "ok":
            assert frames is None and math.isnan(row.total_ns_median), row
            continue
        assert len(frames) == row.frames * row.replicates, row
        total = frames.deform_ns + frames.update_ns + frames.query_ns
        times = {"deform_ns": frames.deform_ns, "update_ns": frames.update_ns,
                 "query_ns": frames.query_ns, "total_ns": total,
                 "given_total_ns": frames.update_ns + frames.query_ns,
                 "active_total_ns": total[frames.active]}
        error = frames.error.abs()
        expected = {"error_median": error.median(), "error_p95": error.quantile(0.95),
                    "error_p99": error.quantile(0.99), "error_max": error.max(),
                    "exact_rate": (error.dropna() <= 1e-9).mean()}
        for name, values in times.items():
            expected |= {f"{name}_median": values.median(), f"{name}_p95": values.quantile(0.95),
                         f"{name}_mean": values.mean(), f"{name}_max": values.max()}
        replicates = row.replicates
        expected["contacts"] = frames.contact_truth.sum() / replicates
        expected["missed"] = (frames.contact_truth > frames.contact).sum() / replicates
        expected["false_contacts"] = (frames.contact_truth < frames.contact).sum() / replicates
        for name, value in expected.items():
            assert near(getattr(row, name), value), (row.label, name, getattr(row, name), value)
            checked += 1
        if row.total_ns_ci_low == row.total_ns_ci_low:
            assert row.total_ns_ci_low <= row.total_ns_ci_high, row
    assert (rows.status == "ok").sum() == 9 and (rows.status != "ok").sum() == 1, rows
    return rows, checked


def check_lists(directory, rows):
    """github-action-benchmark and Bencher: the medians of the CSV, nothing for what has none."""
    good = rows[rows.status == "ok"]
    names = {f"{r.scenario}/{r.label}/{r.cache}": r for r in good.itertuples()}
    actions = read(mote("summarize", str(directory), "--format", "gha"), "gha")
    assert {e["name"] for e in actions} == set(names) and len(actions) == len(names)
    for entry in actions:
        assert entry["unit"] == "ns" and near(entry["value"], names[entry["name"]].total_ns_median)
        assert float(entry.get("range", "0")) >= 0
    bencher = read(mote("summarize", str(directory), "--format", "bencher"), "bencher")
    assert set(bencher) == set(names)
    for name, entry in bencher.items():
        latency = entry["latency"]
        assert near(latency["value"], names[name].total_ns_median)
        assert near(latency["lower_value"], names[name].total_ns_ci_low)
        assert near(latency["upper_value"], names[name].total_ns_ci_high)
    assert not has_null(actions) and not has_null(bencher)


def read_gbench(directory):
    value = read(mote("summarize", str(directory), "--format", "gbench"), "gbench")
    schema("gbench").validate(value)
    assert not has_null(value)
    return value


def check_gbench(first, second):
    """Takes two files apart as compare.py does: entries of one name and unit are repetitions."""
    benchmarks = [read_gbench(d)["benchmarks"] for d in (first, second)]
    names = [list(dict.fromkeys(b["name"] for b in side)) for side in benchmarks]
    assert names[0] == names[1] and len(names[0]) == 9, names
    samples = []
    for name in names[0]:
        unit = next(b["time_unit"] for b in benchmarks[0] if b["name"] == name)
        parts = [[b for b in side if b["name"] == name and b["time_unit"] == unit]
                 for side in benchmarks]
        for part in parts:
            assert [b["repetition_index"] for b in part] == list(range(8))
            assert all(b["repetitions"] == 8 for b in part)
        samples.append([[b["real_time"] for b in part] for part in parts])
    for a, b in samples:  # as compare.py calls it
        assert 0 <= mannwhitneyu(a, b, alternative="two-sided").pvalue <= 1, (a, b)
    return len(samples)


with tempfile.TemporaryDirectory() as work:
    runs = [pathlib.Path(work) / name for name in ("first", "second")]
    for run in runs:
        mote(*RUN, "--out", str(run))
    print(f"jq and jsonschema: {sum(check_files(r) for r in runs)} files of two runs")
    for run in runs:
        table, figures = check_csv(run)
        check_lists(run, table)
        print(f"pandas: {figures} medians, quantiles, means and counts of {len(table)} rows")
    print("github-action-benchmark, Bencher: the same medians, rows without figures left out")
    print(f"scipy: a p for {check_gbench(*runs)} rows of two Google Benchmark files")
