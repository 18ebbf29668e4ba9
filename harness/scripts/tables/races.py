"""How often the verdicts of races were wrong, from the accepted reference."""
from tables.records import csv_rows

RACES = "reference/races.csv"


def races(root):
    return csv_rows(root, RACES)


def unchanged(root, place):
    found = [r for r in races(root) if r["plant"] == "none" and r["place"] in place]
    wrong = sum(r["slower"] != "0" or r["faster"] != "0" for r in found)
    return (wrong, len(found))


def planted(root, least, most, place=("idle", "compiler"), plant=None):
    """How many races with a slowdown of least .. most per cent named the slowed row, and of how many."""
    found = [r for r in races(root) if r["place"] in place and least <= int(r["per_cent"]) <= most
             and (r["plant"] == plant if plant else r["plant"] != "none")]
    return (sum(r["named_alone"] != "0" for r in found), len(found))
