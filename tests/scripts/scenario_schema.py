#!/usr/bin/python3
"""scenario_schema.py MOTE SCHEMA DATASETS: the schema of scenarios and the program accept the same files.

Each value of the scenarios below is replaced by values of every type of JSON and left out; the built-in
scenarios are read as they are. What the schema refuses the program refuses with exit status 4 and the line. What
the schema accepts the program accepts, unless the fault lies in what a schema cannot say (BEYOND): other numbers
of the file, other files, kinds of fields.
"""
import concurrent.futures
import copy
import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile

import jsonschema

MOTE, SCHEMA, DATASETS = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
VALUES = [None, True, "x", "", "1", 1.0, 0, -1, 0.5, 1e300, [], {}, [None], [0.1, 0.2, 0.3]]
BEYOND = [
    r"is out of range; give 1 to \d+$", r"is empty; give first and last frame", "give the shorter first",
    "below the tolerance", r"has length .*; give w, x, y, z", "has no direction", "give ascending frames",
    "No such file", "no clip", "unknown kind", "unknown key", "apart at frame 1", "does not turn within the box",
    "is smaller than a body", "near pairs each", r"is an array of \d+; give an array of \d+$",
    "different positions", "rotations too far apart", "one frame alone",
    "neither OBJ nor PLY",
]
BEYOND_LIKE = ["is missing", "needs exactly one of", "needs either", "an object, which a scenario is"]


def body(**keys):
    return {"file": "box.obj", **keys}


def away(**keys):
    return body(motion=[{"frame": 1, "position": [2, 0, 0]}], **keys)


def pair(first, second, **keys):
    return {"purpose": "x", "frames": 3, "ask": "distance", "bodies": [first, second], **keys}


def several(*shapes, **keys):
    return {"purpose": "x", "frames": 3, "ask": "contact",
            "bodies": {"count": 2, "box": 9, "shapes": list(shapes), **keys}}


RANDOM = {"random": {"seed": 3, "amplitude": 0.01, "periods": [250, 600], "terms": 2}}
SCENARIOS = {
    "times": pair(body(), away(velocity=[0, 0, 0], spin=[0, 0, 0]), start=1, pace=0.5, warmup=[1, 1], active=[2, 3],
                  tolerance=0),
    "impact": pair(body(), away(), ask="impact", step=1),
    "letter": pair({"letter": "V", "triangles": 400, "scale": 1}, away(scale=[1, 1, 1])),
    "path": pair(body(motion=[{"frame": 1, "axis": [0, 1, 0], "degrees": 0},
                              {"frame": 2, "quaternion": [1, 0, 0, 0]}]), away()),
    "random": pair(body(field={"count": 2, "support": 0.5, "displacement": RANDOM}), away()),
    "sines": pair(body(field={"centres": [[0, 0, 0]], "support": 0.5, "displacement": {
        "sines": [{"control": 1, "amplitude": [0, 0, 0.01], "period": 300, "phase": 0.25}]}}), away()),
    "keyframes": pair(body(field={"kind": "csrbf", "count": 1, "support": 0.5, "displacement": {
        "keyframes": [{"frame": 1, "vectors": [[0, 0, 0]]}]}}), away()),
    "stretch": pair(body(field={"kind": "stretch", "displacement": RANDOM}), away()),
    "character": pair({"character": "cube.gltf", "clip": 1, "start": 0.5, "speed": 1, "loop": True, "subdivide": 0},
                      away()),
    "numbered": pair({"positions": "p1.obj", "scale": 1}, away()),
    "cache": pair({"file": "box.obj", "positions": "box.pc2"}, away()),
    "places": several(body(), seed=1, near=0.1, speed=0.004, spin=0.5, places=[[-1, 0, 0], [1, 0, 0]]),
    "pairs": {**several(body(field={"count": 1, "support": 0.5, "displacement": RANDOM}), count=8, box=None,
                        near_pairs=1, near=0.3)},
    "shapes": several({"letter": "V", "triangles": 400}, {"character": "cube.gltf"}, {"positions": "p1.obj"}),
    "like": {"purpose": "y", "like": "base.json", "frames": 3, "warmup": [1, 1], "tolerance": None, "bodies": [
        {"field": {"displacement": {"random": None, "sines": [
            {"control": 1, "amplitude": [0, 0, 0.01], "period": 300}]}}}, {"motion": None}]},
    "alike": {"like": "places.json", "bodies": {"places": None, "box": None, "near_pairs": 0.5, "near": 0.4,
                                                "count": 8}},
}
del SCENARIOS["pairs"]["bodies"]["box"]
# Keys that do not go together, or that others need.
EXTRA = {
    "times": {"step": 1, "bodies.0.letter": "V", "bodies.0.triangles": 400, "bodies.0.clip": 1,
              "bodies.0.character": "cube.gltf", "bodies.0.positions": "p1.obj", "speed": 1, "purpose|ask": 1},
    "impact": {"bodies.1.positions": "p1.obj"},
    "path": {"bodies.0.motion.0.quaternion": [1, 0, 0, 0], "bodies.0.motion.1.axis": [1, 0, 0],
             "bodies.1.motion.0.degrees": 1},
    "random": {"bodies.0.field.centres": [[0, 0, 0]], "bodies.0.field.mass": 1,
               "bodies.0.field.displacement.sines": []},
    "stretch": {"bodies.0.field.count": 1, "bodies.0.field.support": "x"},
    "character": {"bodies.0.triangles": 400, "bodies.0.field": {}, "bodies.0.file": "box.obj"},
    "numbered": {"bodies.0.file": "box.obj", "bodies.0.letter": "V", "bodies.0.field": {}, "bodies.0.loop": True},
    "cache": {"bodies.0.letter": "V", "bodies.0.clip": 1},
    "places": {"bodies.near_pairs": 1, "start": 1, "active": [1, 2], "bodies.poses": "none.csv"},
    "pairs": {"bodies.places": [[0, 0, 0]] * 8, "bodies.box": 9, "bodies.poses": "none.csv"},
    "like": {"bodies.0.letter": None, "bodies.1.field": None, "step": None, "active": None},
    "alike": {"bodies.box": 7, "like": "list.json"},
}


def paths(value, path=()):
    if path:
        yield path
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        yield from paths(inner, path + (key,))


def changed(scenario, path, value=None, leave_out=False):
    made = copy.deepcopy(scenario)
    at = made
    for key in path[:-1]:
        at = at[key]
    if leave_out:
        del at[path[-1]]
    else:
        at[path[-1]] = value
    return made


def all_cases():
    """Names of cases with their scenarios. What several scenarios have is changed in the first of them."""
    seen = set()
    for name, scenario in SCENARIOS.items():
        yield f"{name}: as it is", scenario
        for path in paths(scenario):
            where = ".".join(map(str, path))
            kind = ("like" in scenario, isinstance(scenario["bodies"], dict), re.sub(r"\d+", "", where))
            if kind in seen:
                continue
            seen.add(kind)
            yield f"{name}: without {where}", changed(scenario, path, leave_out=True)
            for value in VALUES:
                yield f"{name}: {where} {json.dumps(value)}", changed(scenario, path, value)
        for where, value in EXTRA.get(name, {}).items():
            path = tuple(int(key) if key.isdigit() else key for key in where.split("."))
            yield f"{name}: with {where} {json.dumps(value)}", changed(scenario, path, value)
    yield "an array", []


def accepts(folder, number, scenario):
    """Whether the program reads a scenario; what it says otherwise."""
    file = folder / f"case{number}.json"
    file.write_text(json.dumps(scenario))
    done = subprocess.run([MOTE, "export", file.name, "--frame", "1", "--out", f"out{number}"], cwd=folder,
                          capture_output=True, text=True, timeout=60)
    shutil.rmtree(folder / f"out{number}", ignore_errors=True)
    file.unlink()
    if done.returncode not in (0, 4):
        raise SystemExit(f"exit status {done.returncode}: {json.dumps(scenario)}\n{done.stderr}")
    return done.returncode == 0, done.stderr.strip(), file.name


def fault_of(what, schema, folder, case):
    number, (name, scenario) = case
    is_valid = schema.is_valid(scenario)
    is_read, said, file = accepts(folder, number, scenario)
    beyond = BEYOND + BEYOND_LIKE if "like" in scenario else BEYOND
    if is_read != is_valid and not (is_valid and any(re.search(text, said) for text in beyond)):
        return f"{name}: the schema {'accepts' if is_valid else 'refuses'} it, the program says: {said or 'nothing'}"
    if not is_read and not re.match(rf"mote: {re.escape(file)}:\d+: ", said):
        return f"{name}: refused without its line: {said}"
    what[is_read] += 1
    return None


def prepare(folder):
    for source in ("meshes/box.obj", "characters/cube.gltf", "characters/cube.bin"):
        shutil.copy(DATASETS / source, folder)
    for frame in range(1, 4):
        shutil.copy(DATASETS / "meshes/box.obj", folder / f"p{frame}.obj")
    corners = [float(x) for line in (folder / "box.obj").read_text().splitlines() if line.startswith("v ")
               for x in line.split()[1:]]
    head = struct.pack("<12siiffi", b"POINTCACHE2", 1, len(corners) // 3, 1, 1, 3)
    (folder / "box.pc2").write_bytes(head + 3 * struct.pack(f"<{len(corners)}f", *corners))
    (folder / "base.json").write_text(json.dumps(SCENARIOS["random"]))
    (folder / "list.json").write_text("[]")
    (folder / "places.json").write_text(json.dumps(SCENARIOS["places"]))


def main():
    contents = json.loads(SCHEMA.read_text())
    jsonschema.Draft202012Validator.check_schema(contents)
    schema = jsonschema.Draft202012Validator(contents)
    for path in sorted((DATASETS / "scenarios").rglob("*.json")):
        schema.validate(json.loads(path.read_text()))
    what = {False: 0, True: 0}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        prepare(folder)
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            faults = [fault for fault in pool.map(lambda case: fault_of(what, schema, folder, case),
                                                  enumerate(all_cases())) if fault]
    if faults:
        sys.exit("\n".join(faults))
    print(f"{what[True]} scenarios that schema and program accept, {what[False]} that the program refuses")


main()
