"""`stream` against trees that are refitted, from `make ratios`, and `auto` against both of its methods, from `make auto`."""
import functools
import math

from tables.number_text import digits
from tables.records import file_of

RATIOS = "ratios/ratios.txt"
AUTO = "auto/auto.txt"


def numbers(words):
    return [math.nan if word == "failed" else float(word) for word in words]


def cells(values, text=digits):
    return " | ".join("failed" if math.isnan(value) else text(value) for value in values)


@functools.cache
def ratios(root):
    """What `make ratios` printed, by case: microseconds of stream, aabb-tree and FCL, and their ratios to stream."""
    lines = file_of(root, RATIOS).read_text().splitlines()[1:]
    return {case: numbers(words) for case, *words in map(str.split, lines)}


def ratios_table(root):
    yield "| case | stream, µs a frame | aabb-tree | best FCL | to the tree | to FCL |"
    yield "| --- | ---: | ---: | ---: | ---: | ---: |"
    for case, values in ratios(root).items():
        yield f"| {case} | {cells(values)} |"


def stream_and_tree(root, *cases):
    """Microseconds of stream and of aabb-tree, case by case."""
    return [digits(time) for case in cases for time in ratios(root)[case][:2]]


def share_of_tree(root, case):
    stream, tree, *_ = ratios(root)[case]
    return stream / tree


def largest_share_of_tree(root):
    """The case in which stream gains least, and its time to that of aabb-tree."""
    return max((share_of_tree(root, case), case) for case in ratios(root))


@functools.cache
def autos(root):
    """What `make auto` printed, by scenario: microseconds of certified, stream and auto, and auto's two ratios."""
    lines = file_of(root, AUTO).read_text().splitlines()[1:-1]
    return {name: numbers(words[:5]) for name, *words in map(str.split, lines)}


def auto_table(root):
    yield "| scenario | certified, µs a frame | stream | auto | auto to the better, median | sum from frame 50 on |"
    yield "| --- | ---: | ---: | ---: | ---: | ---: |"
    for name, (*times, median, total) in autos(root).items():
        yield f"| {name} | {cells(times)} | {cells((median, total), '{:.2f}'.format)} |"
