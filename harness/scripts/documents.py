#!/usr/bin/python3
"""documents.py ROOT [--check]: numbers in documents come from stored results.

A table between the lines "<!-- from SOURCE -->" and "<!-- to here -->" of a document is written again (make
documents). SOURCE is a file of the accepted reference (reference/summary.json), or STUDY/FILE: that of the newest
record of a study of `make record`; what follows a "#" is one of several tables of the same file; checks, fuzz, coverage,
mutation and soak are those of tables/reliability.py. Above the table stands when it was measured, and whether the study's
sources have changed since. A number within a sentence is typed by hand; the sentence stands in sentences.py with its
values, and has to be in the document, rounded as there.
--check writes nothing, and says what disagrees. Status: 0 all agree, 1 something disagrees, 4 a file is missing or cannot be read."""
import functools
import os
import re
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # no folder beside the sources
from sentences import SENTENCES
from tables.ablation import ABLATION, INGREDIENTS, ablation_table, ingredients_figure
from tables.bodies import BODIES, CROWDS, bodies_table, crowd_table
from tables.characters import CHARACTERS, PARTS, characters_table, parts_table
from tables.claims import CLAIMS, claims_table
from tables.counts import RANKED_COUNTS, SIZED_COUNTS, ranked_counts_table, sized_counts_table
from tables.engines import ENGINES, PEERS, engines_table, peers_tables
from tables.extremes import EXTREMES, extremes_table
from tables.impacts import (DYNAMICS, FCL_SPEED, LONG_STEPS, SHORT_STEPS, SPEED, fcl_table, impact_table, long_steps_table,
                            short_steps_table)
from tables.loops import dynamics_table
from tables.pairs import BENCH, FIGURE_3, figure_3, pairs_table
from tables.python_speed import PYTHON, python_table
from tables.races import RACES, races_figure
from tables.readers import READERS, readers_table
from tables.records import file_of, has_changed, reference_has_changed, reference_origin, study_of
from tables.reference import SUMMARY, reference_table
from tables.reliability import GATHERED
from tables.streamed import AUTO, RATIOS, auto_table, ratios_table
from tables.tune import TUNE, tune_table
from tables.verdicts import LARGE_VERDICTS, VERDICTS, verdicts_table

END = "<!-- to here -->"
CHANGED = "its sources have changed since"


def link(text, record, document):
    return f"[{text}]({os.path.relpath(record, document.parent)})"


def heading(root, source, document, old):
    """When a table was measured. old: the block as it stands, which is believed where nothing else tells."""
    source = source.partition("#")[0]
    if source.startswith("reference/"):
        commit, date = reference_origin(root)
        changed = reference_has_changed(root, commit)
        changed = CHANGED in old if changed is None else changed
        return [f"Measured on {date}, commit {commit}{'; ' + CHANGED if changed else ''}.", ""]
    if source in GATHERED:
        return heading_of_gathered(root, GATHERED[source].records(root), document, old)
    record = file_of(root, source).parent
    study = study_of(record)
    changed = has_changed(root, record)
    changed = CHANGED in old if changed is None else changed
    return [f"Recorded on {study['ended'][:10]}, {link(study['commit'], record, document)}"
            f"{'; ' + CHANGED if changed else ''}.", ""]


def heading_of_gathered(root, records, document, old):
    """records: by the names of their studies."""
    links, changed = [], []
    for name, record in records.items():
        links.append(link(name, record, document))
        now = has_changed(root, record)
        if f"`{name}`" in old if now is None else now:
            changed.append(f"`{name}`")
    if not links:
        return []
    sources = f" The sources of {', '.join(changed)} have changed since." if changed else ""
    return [f"Recorded: {', '.join(links)}.{sources}", ""]


TABLES = {SUMMARY: reference_table, BENCH: pairs_table, FIGURE_3: figure_3, BODIES: bodies_table, CROWDS: crowd_table, ENGINES: engines_table,
          PEERS: peers_tables, VERDICTS: verdicts_table,
          LARGE_VERDICTS: functools.partial(verdicts_table, source=LARGE_VERDICTS), DYNAMICS: dynamics_table,
          LONG_STEPS: long_steps_table, SHORT_STEPS: short_steps_table, SPEED: impact_table, FCL_SPEED: fcl_table,
          CHARACTERS: characters_table,
          TUNE: tune_table, PARTS: parts_table, CLAIMS: claims_table, EXTREMES: extremes_table, RATIOS: ratios_table,
          AUTO: auto_table, ABLATION: ablation_table, INGREDIENTS: ingredients_figure, READERS: readers_table, PYTHON: python_table,
          RACES: races_figure, RANKED_COUNTS: ranked_counts_table, SIZED_COUNTS: sized_counts_table,
          **{name: gathered.table for name, gathered in GATHERED.items()}}


def documents(root):
    return [root / "README.md", *sorted((root / "docs").glob("*.md"))]


def blocks(document, text):
    """The tables of a document: source, and where the lines between its marks begin and end."""
    for match in re.finditer(r"^<!-- from (\S+) -->\n", text, re.MULTILINE):
        end = text.find(END + "\n", match.end())
        if end < 0:
            raise ValueError(f"{document}: after the line {match[0].strip()} there is no line {END}")
        if match[1] not in TABLES:
            raise ValueError(f"{document}: no table is made from {match[1]}; there are {', '.join(TABLES)}")
        yield match[1], match.end(), end


def rewritten(root, document):
    """The text of a document, and what it should be."""
    text = new = document.read_text()
    for source, begin, end in reversed(list(blocks(document, text))):
        results = os.path.relpath(root / "results", document.parent)
        table = [line.replace("](results/", f"]({results}/") for line in TABLES[source](root)]
        new = new[:begin] + "\n" + "\n".join(heading(root, source, document, text[begin:end]) + table) + "\n\n" + new[end:]
    return text, new


def disagreements(root):
    for document in documents(root):
        text, new = rewritten(root, document)
        if new != text:
            yield f"{document.relative_to(root)}: a table is not that of its source; `make documents` writes it"
    for document, sentence, values in SENTENCES:
        expected = sentence.format(*values(root))
        if expected not in " ".join((root / document).read_text().split()):
            yield f"{document}: by the stored results it should say: {expected}"


def main(arguments):
    if len(arguments) < 1 or arguments[1:] not in ([], ["--check"]):
        print("usage: documents.py ROOT [--check]", file=sys.stderr)
        return 2
    root = Path(arguments[0])
    try:
        if arguments[1:] == []:
            for document in documents(root):
                text, new = rewritten(root, document)
                if new != text:
                    document.write_text(new)
        wrong = list(disagreements(root))
    except (OSError, KeyError, ValueError) as error:
        print(f"documents: {error}", file=sys.stderr)
        return 4
    for line in wrong:
        print(f"documents: {line}", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
