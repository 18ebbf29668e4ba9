"""The stored figures can be shown: figures.py ROOT

Each SVG file below docs, results/reference and results/records is well-formed, has no character that a font called
Symbol would have to draw, no text that leaves the canvas and none that covers another one. (A text is taken for 0.58
of its size a letter and 0.7 high, since its font is not known here; 4 units beyond the canvas pass, and so do texts
that share less than 6 units of width or 2 of height.)
"""
import itertools
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import NamedTuple

SVG = "{http://www.w3.org/2000/svg}"
FOLDERS = ("docs", "results/reference", "results/records")
LETTER, HEIGHT, ROOM = 0.58, 0.7, 4
SHARED_WIDTH, SHARED_HEIGHT = 6, 2
BEFORE = {"start": 0.0, "middle": 0.5, "end": 1.0}  # the share of a text that stands before its place


class Text(NamedTuple):
    left: float
    right: float
    top: float
    bottom: float
    text: str


def texts(tree):
    """Each horizontal text where gnuplot puts it."""
    for group in tree.iter(f"{SVG}g"):
        place, element = group.get("transform", ""), group.find(f"{SVG}text")
        text = "".join(element.itertext()).strip() if element is not None else ""
        if text and place.startswith("translate(") and "rotate" not in place:
            x, y = (float(number) for number in place[len("translate("):].split(")")[0].split(","))
            size = float(group.get("font-size"))
            wide = LETTER * size * len(text)
            left = x - BEFORE[group.get("text-anchor")] * wide
            yield Text(left, left + wide, y - HEIGHT * size, y, text)


def covers(a, b):
    return (min(a.right, b.right) - max(a.left, b.left) > SHARED_WIDTH and
            min(a.bottom, b.bottom) - max(a.top, b.top) > SHARED_HEIGHT)


def faults(path):
    try:
        tree = ElementTree.parse(path).getroot()
    except ElementTree.ParseError as error:
        yield f"no well-formed SVG: {error}"
        return
    if any(part.get("font-family") == "Symbol" for part in tree.iter()):
        yield "needs a font called Symbol; write the character itself"
    if tree.get("viewBox") is None:
        return
    wide = float(tree.get("viewBox").split()[2])
    found = list(texts(tree))
    for t in found:
        if t.left < -ROOM or t.right > wide + ROOM:
            yield f"'{t.text}' stands from {t.left:.0f} to {t.right:.0f} on a canvas of 0 to {wide:.0f}"
    for a, b in itertools.combinations(found, 2):
        if covers(a, b):
            yield f"'{a.text}' and '{b.text}' cover each other"


def main():
    root = Path(sys.argv[1])
    paths = [path for folder in FOLDERS for path in sorted((root / folder).rglob("*.svg"))]
    found = [f"{path.relative_to(root)}: {fault}" for path in paths for fault in faults(path)]
    print("\n".join(found or [f"{len(paths)} figures can be shown"]))
    return 1 if found or not paths else 0


sys.exit(main())
