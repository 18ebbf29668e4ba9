"""Distances compared with CGAL's, from the log of `make oracle`."""
import re

from tables.records import file_of

ORACLE = "oracle/log.txt"
PAIRS = re.compile(r"^pairs +(\d+) asked, .* worst (\S+) of the extent", re.MULTILINE)
FRAMES = re.compile(r"^\S+ +(\d+) frames, .* worst (\S+) L; ", re.MULTILINE)


def against_cgal(root):
    """How many pairs of triangles were compared, and the largest error over their extent; how many whole frames, and the
    largest error over L."""
    log = file_of(root, ORACLE).read_text()
    pairs, worst_of_pairs = PAIRS.search(log).groups()
    frames, worst = zip(*FRAMES.findall(log))
    return (int(pairs), worst_of_pairs, sum(map(int, frames)), max(worst, key=float))
