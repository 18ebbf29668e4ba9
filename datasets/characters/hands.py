#!/usr/bin/env python3
"""Writes hand.glb and hand-shapes.glb beside this file, from a hand of npm's @webxr-input-profiles/assets
(dist/profiles/generic-hand/left.glb: a skinned mesh of 25 joints without a clip).

    hands.py left.glb

hand.glb: the joints as chains, and the clip Grab of ours, in which the fingers close one after another.
hand-shapes.glb: no bones; the poses Fist and Point of the same hand as morph targets, and the clip
Shapes, whose keys are cubic. Vertices at one place are written once, materials not at all.
"""
import json
import math
import os
import struct
import sys

FLOAT, BYTE, SHORT = 5126, 5121, 5123
FINGERS = ["thumb", "index-finger", "middle-finger", "ring-finger", "pinky-finger"]
SECONDS = 4
KEYS = 17
# Degrees of the joints of a closed hand, from the palm to the tip.
CLOSED = {"thumb": {"phalanx-proximal": 25, "phalanx-distal": 45}}
FINGER = {"phalanx-proximal": 65, "phalanx-intermediate": 80, "phalanx-distal": 45}


def multiply(a, b):
    return [[sum(a[r][k] * b[k][c] for k in range(4)) for c in range(4)] for r in range(4)]


def apply(m, p):
    return [sum(m[r][k] * p[k] for k in range(3)) + m[r][3] for r in range(3)]


def from_parts(t, q):
    x, y, z, w = q
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), t[0]],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), t[1]],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), t[2]],
            [0, 0, 0, 1]]


def product(p, q):
    (a, b, c, d), (e, f, g, h) = p, q
    return [d * e + a * h + b * g - c * f, d * f - a * g + b * h + c * e,
            d * g + a * f - b * e + c * h, d * h - a * e - b * f - c * g]


def unit(q):
    length = math.sqrt(sum(x * x for x in q))
    return [x / length for x in q]


def bend(degrees):
    """About the joint's x axis, towards the palm (its -y): the fingers point along -z."""
    return [-math.sin(math.radians(degrees) / 2), 0, 0, math.cos(math.radians(degrees) / 2)]


class Hand:
    def __init__(self, path):
        data = open(path, "rb").read()
        size = struct.unpack("<I", data[12:16])[0]
        self.file, self.bin = json.loads(data[20:20 + size]), data[28 + size:]
        primitive = self.file["meshes"][0]["primitives"][0]
        get = primitive["attributes"]
        places, joints, weights = (self.read(get[k]) for k in ("POSITION", "JOINTS_0", "WEIGHTS_0"))
        self.binds = [[[m[4 * c + r] for c in range(4)] for r in range(4)]
                      for m in self.read(self.file["skins"][0]["inverseBindMatrices"])]
        first, number = {}, []
        for vertex in zip(places, joints, weights):
            number.append(first.setdefault(vertex, len(first)))
        self.vertices = list(first)
        self.faces = [number[i] for (i,) in self.read(primitive["indices"])]
        self.joints = [self.file["nodes"][n] for n in self.file["skins"][0]["joints"]]
        self.parents = [self.parent(j["name"]) for j in self.joints]

    def read(self, accessor):
        a = self.file["accessors"][accessor]
        kind = {FLOAT: "f", BYTE: "B", SHORT: "H"}[a["componentType"]]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}[a["type"]]
        at = self.file["bufferViews"][a["bufferView"]]["byteOffset"]
        return list(struct.iter_unpack("<%d%s" % (width, kind),
                                       self.bin[at:at + a["count"] * struct.calcsize("<%d%s" % (width, kind))]))

    def named(self, name):
        return next((i for i, j in enumerate(self.joints) if j["name"] == name), None)

    def parent(self, name):
        chain = ["wrist", "metacarpal", "phalanx-proximal", "phalanx-intermediate", "phalanx-distal", "tip"]
        for finger in FINGERS:
            if name.startswith(finger + "-"):
                for step in reversed(chain[:chain.index(name[len(finger) + 1:])]):
                    found = self.named(step if step == "wrist" else finger + "-" + step)
                    if found is not None:
                        return found
        return None

    def local(self, joint):
        """Translation and rotation in the parent's axes; the file has all joints in those of the hand."""
        own = self.joints[joint]
        turn, place = unit(own["rotation"]), own["translation"]
        if self.parents[joint] is None:
            return place, turn
        above = self.joints[self.parents[joint]]
        back = unit(above["rotation"])
        back = [-back[0], -back[1], -back[2], back[3]]
        moved = [a - b for a, b in zip(place, above["translation"])]
        return apply(from_parts([0, 0, 0], back), moved), product(back, turn)

    def bent(self, joint, amounts):
        """The local rotation with each finger closed by an amount of 0 to 1."""
        for finger, amount in zip(FINGERS, amounts):
            degrees = CLOSED.get(finger, FINGER).get(self.joints[joint]["name"][len(finger) + 1:])
            if self.joints[joint]["name"].startswith(finger + "-") and degrees:
                return product(self.local(joint)[1], bend(amount * degrees))
        return self.local(joint)[1]

    def world(self, joint, amounts):
        own = from_parts(self.local(joint)[0], self.bent(joint, amounts))
        return own if self.parents[joint] is None else multiply(self.world(self.parents[joint], amounts), own)

    def posed(self, amounts):
        maps = [multiply(self.world(j, amounts), b) for j, b in enumerate(self.binds)]
        return [[sum(w * x for w, x in zip(weights, column))
                 for column in zip(*[apply(maps[j], place) for j in joints])]
                for place, joints, weights in self.vertices]


class Writer:
    def __init__(self):
        self.bin, self.views, self.accessors = b"", [], []

    def add(self, rows, component, kind, box=False):
        code = {FLOAT: "f", BYTE: "B", SHORT: "H"}[component]
        flat = [x for row in rows for x in row]
        data = struct.pack("<%d%s" % (len(flat), code), *flat)
        self.views.append({"buffer": 0, "byteOffset": len(self.bin), "byteLength": len(data)})
        accessor = {"bufferView": len(self.views) - 1, "componentType": component, "count": len(rows), "type": kind}
        if box:
            accessor["min"] = [min(c) for c in zip(*rows)]
            accessor["max"] = [max(c) for c in zip(*rows)]
        self.accessors.append(accessor)
        self.bin += data + b"\0" * (-len(data) % 4)
        return len(self.accessors) - 1

    def write(self, path, document):
        document.update(asset={"version": "2.0"}, scene=0, buffers=[{"byteLength": len(self.bin)}],
                        bufferViews=self.views, accessors=self.accessors)
        text = json.dumps(document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as out:
            out.write(struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(self.bin), len(text), 0x4E4F534A) +
                      text + struct.pack("<II", len(self.bin), 0x4E4942) + self.bin)


def closed_at(k):
    """Of each finger at key k: they follow each other by a twentieth of the clip."""
    return [(1 - math.cos(2 * math.pi * (k / (KEYS - 1) - f / 20))) / 2 for f in range(len(FINGERS))]


def write_bones(hand, path):
    w = Writer()
    nodes = []
    for j, joint in enumerate(hand.joints):
        place, turn = hand.local(j)
        children = [k for k, p in enumerate(hand.parents) if p == j]
        nodes.append({"name": joint["name"], "translation": place, "rotation": turn,
                      **({"children": children} if children else {})})
    places, joints, weights = zip(*hand.vertices)
    attributes = {"POSITION": w.add(places, FLOAT, "VEC3", True), "JOINTS_0": w.add(joints, BYTE, "VEC4"),
                  "WEIGHTS_0": w.add(weights, FLOAT, "VEC4")}
    faces = w.add([(i,) for i in hand.faces], SHORT, "SCALAR")
    binds = w.add([[m[r][c] for c in range(4) for r in range(4)] for m in hand.binds], FLOAT, "MAT4")
    times = w.add([(SECONDS * k / (KEYS - 1),) for k in range(KEYS)], FLOAT, "SCALAR", True)
    channels, samplers = [], []
    for j in range(len(nodes)):
        turns = [hand.bent(j, closed_at(k)) for k in range(KEYS)]
        if turns[0] != turns[KEYS // 2]:
            channels.append({"sampler": len(samplers), "target": {"node": j, "path": "rotation"}})
            samplers.append({"input": times, "output": w.add(turns, FLOAT, "VEC4")})
    root = [j for j, p in enumerate(hand.parents) if p is None]
    nodes.append({"name": "hand", "mesh": 0, "skin": 0})
    w.write(path, {"scenes": [{"nodes": root + [len(nodes) - 1]}], "nodes": nodes,
                   "meshes": [{"primitives": [{"attributes": attributes, "indices": faces}]}],
                   "skins": [{"inverseBindMatrices": binds, "joints": list(range(len(hand.joints)))}],
                   "animations": [{"name": "Grab", "channels": channels, "samplers": samplers}]})


def write_shapes(hand, path):
    w = Writer()
    rest = hand.posed([0] * 5)
    shapes = {"Fist": hand.posed([1] * 5), "Point": hand.posed([1, 0, 1, 1, 1])}
    attributes = {"POSITION": w.add(rest, FLOAT, "VEC3", True)}
    targets = []
    for shape in shapes.values():
        moves = [[a - b for a, b in zip(p, q)] for p, q in zip(shape, rest)]
        targets.append({"POSITION": w.add(moves, FLOAT, "VEC3", True)})
    faces = w.add([(i,) for i in hand.faces], SHORT, "SCALAR")
    times = w.add([(k,) for k in range(SECONDS + 1)], FLOAT, "SCALAR", True)
    values = [(0, 0), (1, 0), (0.3, 0.2), (0, 1), (0, 0)]
    # Of each key: arriving tangents, values, leaving tangents.
    keys = [(x,) for value in values for row in ((0, 0), value, (0, 0)) for x in row]
    weights = w.add(keys, FLOAT, "SCALAR")
    w.write(path, {"scenes": [{"nodes": [0]}], "nodes": [{"name": "hand", "mesh": 0}],
                   "meshes": [{"primitives": [{"attributes": attributes, "indices": faces, "targets": targets}],
                               "weights": [0, 0], "extras": {"targetNames": list(shapes)}}],
                   "animations": [{"name": "Shapes", "channels": [
                       {"sampler": 0, "target": {"node": 0, "path": "weights"}}],
                       "samplers": [{"input": times, "output": weights, "interpolation": "CUBICSPLINE"}]}]})


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: hands.py left.glb")
    here = os.path.dirname(os.path.abspath(__file__))
    left = Hand(sys.argv[1])
    write_bones(left, os.path.join(here, "hand.glb"))
    write_shapes(left, os.path.join(here, "hand-shapes.glb"))
