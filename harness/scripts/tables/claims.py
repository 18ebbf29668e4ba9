"""The claims of the paper, and what the verdict on each follows from."""
import json

from tables.records import file_of

CLAIMS = "claims/claims.json"


def measured(value):
    """A value of a claim that its verdict follows from: name, value and interval, with three digits."""
    def shown(number):
        return "0" if value["unit"] == "L" and abs(number) < 1e-9 else f"{number:.3g}"
    if value["value"] is None:
        return f"{value['name'].strip()}: not measured"
    low, high = value["interval"] or (None, None)
    ends = "" if low == high else f" ({shown(low)} to {shown(high)})"
    return f"{value['name'].strip()}: {shown(value['value'])}{ends}{' ' * bool(value['unit'])}{value['unit']}"


def claims_table(root):
    yield "| claim | paper | verdict | measured |"
    yield "| --- | --- | --- | --- |"
    for claim in json.loads(file_of(root, CLAIMS).read_text()):
        values = "; ".join(measured(value) for value in claim["values"] if value["threshold"])
        yield f"| {claim['id']}. {claim['claim']} | {claim['section']} | {claim['verdict']} | {values} |"
