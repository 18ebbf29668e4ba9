"""The claims of the paper, and what the verdict on each follows from."""
import json

from tables.records import file_of

CLAIMS = "claims/claims.json"
REQUIREMENTS = "claims/requirements.json"


def unit_of(value):
    """The unit of a value as it follows a number."""
    unit = "µs" if value["unit"] == "us" else value["unit"]
    return f" {unit}" if unit else ""


def bound(value):
    """The thresholds of a value: for "holds", for "holds within limits", or one for both."""
    unit = unit_of(value)
    holds, limits = value["threshold"]["holds"], value["threshold"]["limits"]
    levels = [f"{number:.4g}{unit}{level}" for number, level in
              ([(holds, "")] if holds == limits else [(holds, " to hold"), (limits, " within limits")])
              if number is not None]
    return f"{value['threshold']['bound']} {', '.join(levels)}"


def measured(value):
    """A value of a claim that its verdict follows from: name, value and interval, with three digits, and its bound."""
    def shown(number):
        return "0" if value["unit"] == "L" and abs(number) < 1e-9 else f"{number:.3g}"
    name = value["name"].strip()
    if value["value"] is None:
        return f"{name}: not measured, {bound(value)}"
    low, high = value["interval"] or (None, None)
    ends = "" if low == high else f" ({shown(low)} to {shown(high)})"
    return f"{name}: {shown(value['value'])}{ends}{unit_of(value)}, {bound(value)}"


def claims_table(root):
    yield "| claim | section | verdict | measured |"
    yield "| --- | --- | --- | --- |"
    for claim in json.loads(file_of(root, CLAIMS).read_text()):
        values = "; ".join(measured(value) for value in claim["values"] if value["threshold"])
        yield f"| {claim['id']}. {claim['claim']} | {claim['section']} | {claim['verdict']} | {values} |"


def near_contact(root, requirement, scenario):
    """The median of the best engine of others over that of the certified query, in the frames near contact of
    requirement r6 (distances) or r7 (contacts)."""
    asked = next(claim for claim in json.loads(file_of(root, REQUIREMENTS).read_text()) if claim["id"] == requirement)
    return next(value["value"] for value in asked["values"] if value["name"].strip().startswith(f"{scenario}, median: "))
