"""Verdicts on each method in the numerical extremes."""
import json

from tables.records import figure, file_of

EXTREMES = "extremes/extremes.json"


def extremes_table(root):
    """How many extremes each method answers rightly, and the figure that shows which not."""
    methods = json.loads(file_of(root, EXTREMES).read_text())["methods"]
    verdicts = list(methods[0]["verdicts"])
    yield "| method | " + " | ".join(verdicts) + " |"
    yield "| --- " + "| ---: " * len(verdicts) + "|"
    for method in methods:
        yield f"| `{method['name']}` | " + " | ".join(str(method["verdicts"][key]) for key in verdicts) + " |"
    yield ""
    yield figure(root, "extremes/extremes.svg", "Verdict on each method in each numerical extreme")
