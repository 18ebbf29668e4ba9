"""How many mesh files mote reads, and whether assimp agrees."""
from tables.number_text import numbers_of
from tables.records import file_of

READERS = "readers/readers.md"
ANIMATED = "readers/characters.txt"


def readers_table(root):
    """The table of make readers, but its last two columns."""
    for line in file_of(root, READERS).read_text().split("\n\n")[0].splitlines():
        yield "|".join(line.split("|")[:-3]) + "|"


def readers_total(root):
    """How many files there are, how many mote reads as meshes, and how many it refuses."""
    return numbers_of(file_of(root, READERS).read_text().split("\n\n")[1])[:3]


def animated_files(root):
    """How many files have clips, how many are read, and how many of these have no edge of more than two faces."""
    return numbers_of(file_of(root, ANIMATED).read_text())[:3]
