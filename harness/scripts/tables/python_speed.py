"""Queries from Python against a loop in C."""
from tables.number_text import numbers_of
from tables.records import file_of

PYTHON = "python-speed/python-speed.txt"


def python_table(root):
    yield "| scenario | loop in C | batch | its ratio to C | single calls | more than C |"
    yield "| --- | ---: | ---: | ---: | ---: | ---: |"
    for line in file_of(root, PYTHON).read_text().splitlines():
        scenario, _, text = line.partition(":")
        in_c, call, more, batch, ratio, _ = numbers_of(text)
        yield f"| {scenario} | {in_c} | {batch} | {ratio} | {call} | {more} |"
