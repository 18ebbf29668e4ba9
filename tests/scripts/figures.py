"""The stored figures can be shown: figures.py ROOT

Each SVG file below docs, results/reference and results/records is well-formed, has no character that a font called
Symbol would have to draw, and no text that leaves the canvas. (A text is taken for 0.58 of its size a letter, since
its font is not known here; 4 units beyond the canvas pass.)
"""
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

SVG = "{http://www.w3.org/2000/svg}"
FOLDERS = ("docs", "results/reference", "results/records")
LETTER, ROOM = 0.58, 4
BEFORE = {"start": 0.0, "middle": 0.5, "end": 1.0}  # the share of a text that stands before its place


def texts(tree):
    """Each horizontal text with the place and size that gnuplot gives it: x, size, anchor, text."""
    for group in tree.iter(f"{SVG}g"):
        place, text = group.get("transform", ""), group.find(f"{SVG}text")
        if text is not None and place.startswith("translate(") and "rotate" not in place:
            x = float(place[len("translate("):].split(",")[0])
            yield x, float(group.get("font-size")), group.get("text-anchor"), "".join(text.itertext())


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
    for x, size, anchor, text in texts(tree):
        left = x - BEFORE[anchor] * LETTER * size * len(text)
        right = left + LETTER * size * len(text)
        if left < -ROOM or right > wide + ROOM:
            yield f"'{text}' stands from {left:.0f} to {right:.0f} on a canvas of 0 to {wide:.0f}"


def main():
    root = Path(sys.argv[1])
    paths = [path for folder in FOLDERS for path in sorted((root / folder).rglob("*.svg"))]
    found = [f"{path.relative_to(root)}: {fault}" for path in paths for fault in faults(path)]
    print("\n".join(found or [f"{len(paths)} figures can be shown"]))
    return 1 if found or not paths else 0


sys.exit(main())
