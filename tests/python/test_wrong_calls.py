"""10,000 wrong calls of the module for Python: each raises an error that names an argument, none
ends the interpreter. First every argument of every function with every bad value, then several
at a time, drawn from a seed: test_wrong_calls.py [SEED]."""

import faulthandler
import gc
import re
import sys

import numpy as np
from numpy.lib.stride_tricks import as_strided

import mote
from shapes import CORNERS, FACES, octahedron, poses

faulthandler.enable()
WANTED = 10_000
ALLOWED = (TypeError, ValueError, MemoryError, RuntimeError)


class Raises:
    def __array__(self, *args, **kwargs):
        raise ValueError("no array today")


class Lies:
    """An array that names memory which is not there."""

    __array_interface__ = {"shape": (2, 3), "typestr": "<f8", "data": None, "version": 3}


class Garbage:
    def __array__(self, *args, **kwargs):
        return "not an array"


class Sub(np.ndarray):
    pass


def cyclic():
    value = [1.0]
    value.append(value)
    return value


def shared():
    """2^60 numbers in 60 lists."""
    value = [0.0]
    for _ in range(7):
        value = [value] * 1000
    return value


def closed(thing):
    thing.close()
    return thing


def bad_values():
    nan, inf = float("nan"), float("inf")
    zeros = np.zeros
    return [
        None, True, False, -1, 0, 1, 3, 2**31, 2**63, 2**70, -(2**70), 1.5, -0.5, nan, inf, -inf,
        1e300, 5e-324, 1j, "abc", "", b"\0\0", bytearray(24), object(), type, len, ..., Ellipsis,
        [], [[]], [[], []], [1], [1, 2], (1, 2), (None, None), (None,), [None, None], {}, {1: 2},
        set(), frozenset([1]), range(10**12), iter([1, 2]), (i for i in range(3)), lambda: 0,
        [range(10**12)], ["a", "b"], [[1, 2], [3]], [1j], [object()], cyclic(), shared(),
        zeros(0), zeros((0, 3)), zeros((3, 0)), zeros(()), zeros(3), zeros((1, 3)), zeros((6, 2)),
        zeros((6, 3)), zeros((6, 3, 1)), zeros((2, 3, 4)), zeros((2, 4, 4)), zeros((3, 4)),
        zeros((5, 2, 3, 4)), zeros((1,) * 32), np.full((6, 3), nan), np.full((6, 3), inf),
        np.full((2, 3, 4), nan), np.full((1, 3), nan), np.full((1, 3), 1e300), np.full((8, 3), -1),
        np.full((8, 3), 6), np.full((8, 3), 2**40), np.ones((8, 3), bool), np.full((8, 3), 0),
        FACES.astype(float), FACES.astype(">i8"), FACES.astype(np.int8), FACES.astype("U3"),
        CORNERS.astype(">f4"), CORNERS.astype(complex), CORNERS.astype(object),
        CORNERS.astype("S8"), CORNERS.astype("M8[s]"), CORNERS * 1e300, CORNERS * 1e-320,
        np.asfortranarray(CORNERS), CORNERS[::-1], CORNERS[:, ::-1], CORNERS.view(Sub),
        np.matrix(CORNERS), np.ma.masked_array(CORNERS, CORNERS > 0), CORNERS.astype(np.longdouble),
        np.frombuffer(bytes(1 + 18 * 8), np.uint8)[1:].view(np.float64).reshape(6, 3),
        np.zeros((6, 3), [("x", "f8")]), np.recarray((6, 3), [("x", "f8")]), memoryview(b"123"),
        as_strided(zeros(1), (2**40, 3), (0, 0)), as_strided(zeros(1), (2**36, 2, 3, 4), (0, 0, 0, 0)),
        as_strided(np.zeros(1, int), (2**40, 3), (0, 0)), np.broadcast_to(zeros(3), (2**33, 6, 3)),
        as_strided(zeros(8), (4, 3), (1, 3)), Raises(), Lies(), Garbage(), Raises, np.float64, np,
        np.float64(nan), np.int64(-5), np.array(3), np.array(nan), octahedron(),
        closed(octahedron()), mote.Field.csrbf([[0, 0, 1]], 1), mote.Field.morph(octahedron(), zeros((1, 6, 3)) + 1),
        closed(mote.Field.csrbf([[0, 0, 1]], 1)), closed(mote.Pair(octahedron(), octahedron())),
        mote.Field.modes(mote.Mesh(CORNERS[:3], [[0, 1, 2]]), zeros((2, 3, 3))), mote.Mesh, mote.Field,
        [octahedron()], [(octahedron(), None)], [(octahedron(), octahedron())], [octahedron()] * 3,
        (np.full((1, 3), nan), None), (zeros((1, 3)), zeros((2, 3))), (zeros((1, 3)), None, None),
        (None, zeros((9, 1, 3))), (zeros((4, 1, 3)), zeros((5, 1, 3))), 10**400,
    ]


def skin_with_a_target(mesh):
    return mote.Field.skin(mesh, np.eye(2)[[0, 0, 0, 0, 1, 0]], targets=np.ones((1, 6, 3)))


def functions():
    """Name, callable and arguments that are right."""
    mesh = octahedron()
    field = mote.Field.csrbf([[0, 0, 1]], 1.9)
    skin = skin_with_a_target(mesh)
    pair, stream = mote.Pair(mesh, mesh, field, field), mote.Stream(mesh, mesh)
    skinned, scene = mote.Pair(mesh, mesh, skin), mote.Scene([(mesh, field)], 3)
    two = mote.Scene([mesh, (mesh, field)], [0, 1, 1])
    w, above = np.zeros((1, 3)), CORNERS + [0, 0, 5]
    many = {"poses": poses(4), "weights": (w, w), "threads": 1, "stretch": 2, "tolerance": 0.5}
    still = np.repeat(poses()[:1], 3, 0) + np.pad(np.arange(3.0) * 3, 0)[:, None, None] * np.eye(3, 4, 3)
    both = {"slack": 0.0, "budget": 9}
    return [
        ("Mesh", mote.Mesh, {"vertices": CORNERS, "faces": FACES}),
        ("csrbf", mote.Field.csrbf, {"centres": CORNERS, "support": 1.0}),
        ("modes", mote.Field.modes, {"mesh": mesh, "modes": np.ones((2, 6, 3))}),
        ("skin", mote.Field.skin, {"mesh": mesh, "weights": np.ones((6, 2)), "bones": None,
                                   "bone_count": None, "targets": None}),
        ("bones", mote.Field.skin, {"mesh": mesh, "weights": np.ones((6, 2)),
                                    "bones": np.zeros((6, 2), int), "bone_count": 3}),
        ("morph", mote.Field.morph, {"mesh": mesh, "targets": np.ones((2, 6, 3))}),
        ("Pair", mote.Pair, {"a": mesh, "b": mesh, "field_a": field, "field_b": None,
                             "samples_a": np.zeros((2, 1, 3)), "samples_b": None, **both}),
        ("distance", pair.distance, {"poses": poses(), "weights": (w, w)}),
        ("contact", pair.contact, {"poses": poses(), "weights": (w, w), "tolerance": 0.1}),
        ("many", pair.many, many),
        ("skinned", skinned.distance, {"poses": poses(), "weights": ((None, np.ones(1)), None)}),
        ("skinned parts", lambda matrices, amounts: skinned.distance(poses(), ((matrices, amounts), None)),
         {"matrices": np.zeros((2, 3, 4)), "amounts": np.ones(1)}),
        ("one weight", lambda weights: pair.distance(poses(), (weights, None)), {"weights": w}),
        ("one pose", lambda poses: pair.distance((poses, None), None), {"poses": np.eye(4)}),
        ("Stream", mote.Stream, {"a": mesh, "b": mesh, **both}),
        ("stream distance", stream.distance, {"positions_a": CORNERS, "positions_b": above}),
        ("stream contact", stream.contact, {"positions_a": CORNERS, "positions_b": above,
                                            "tolerance": 0.1}),
        ("stream many", stream.many, {"positions_a": CORNERS[None], "positions_b": above,
                                      "threads": 2, "stretch": 1, "tolerance": None}),
        ("Scene", mote.Scene, {"shapes": [mesh, (mesh, field)], "bodies": [0, 1, 0],
                               "tolerance": 0.0, "threads": 1}),
        ("one shape", mote.Scene, {"shapes": mesh, "bodies": 4}),
        ("step", scene.step, {"poses": still, "weights": np.zeros((3, 1, 3)), "within": 0.5}),
        ("two shapes", two.step, {"poses": still, "weights": [None, np.zeros((2, 1, 3))],
                                  "within": 0.5}),
        ("members", scene.members, {"shape": 0}),
    ]


NAMES = re.compile(
    r"(vertices|faces|vertex|face|mesh|modes|centres|support|weights|weight|bones|bone_count|targets|"
    r"amounts|pose|poses|slack|budget|samples_[ab]|sample|tolerance|threads|stretch|positions_[ab]|body|"
    r"shapes|shape|bodies|within|field_[ab]|field|[ab]:|frame|array|closed|edge|L |memory|a scene|a skin|"
    r"allocate|no array)"
)


class Tally:
    def __init__(self):
        self.calls = self.wrong = 0

    def call(self, name, function, arguments):
        self.calls += 1
        try:
            made = function(**arguments)
        except ALLOWED as error:
            self.wrong += 1
            if not NAMES.search(str(error)):
                raise AssertionError(f"{name}: the error names no argument: {error}") from error
            return
        except BaseException as error:
            raise AssertionError(f"{name}: {type(error).__name__}: {error}; {arguments}") from error
        if isinstance(made, mote.Distance) and not np.isfinite(made.distance):
            raise AssertionError(f"{name}: a distance of {made.distance}; {arguments}")


def endless(name, argument, value):
    """Calls that are right, and would take hours or the whole memory."""
    if isinstance(value, np.ndarray) and value.size > 10**7:
        return name in ("many", "stream many")
    huge = isinstance(value, (int, np.integer)) and value > 10**6
    return (name, argument) == ("one shape", "bodies") and huge


def frames_of_parts():
    """The matrices and the amounts of a skin with targets have as many frames, or none."""
    mesh = octahedron()
    skinned = mote.Pair(mesh, mesh, skin_with_a_target(mesh))
    whole = np.repeat(np.eye(3, 4)[None], 2, 0)
    right = skinned.many(None, ((np.repeat(whole[None], 5, 0), np.ones(1)), None))
    if len(right.distance) != 5 or np.ptp(right.distance) > 0:
        raise AssertionError(f"frames of the matrices alone: {right.distance}")
    for matrices, amounts, poses in ((5, 10, None), (5, 10, 10), (10, 5, None), (5, None, 10)):
        weights = (np.repeat(whole[None], matrices, 0), np.ones(1) if amounts is None else np.ones((amounts, 1)))
        moved = None if poses is None else np.repeat(np.eye(3, 4)[None, None], poses, 0).repeat(2, 1)
        try:
            skinned.many(moved, (weights, None))
        except ValueError as error:
            if "frames" not in str(error):
                raise AssertionError(f"frames of parts: {error}") from error
            continue
        raise AssertionError(f"{matrices} frames of matrices beside {amounts} of amounts were taken")
    for samples, says in (((np.repeat(whole[None], 5, 0), np.ones((4, 1))),
                           "amounts in samples_a: it has 4 samples, and samples_a has 5"),
                          ((np.repeat(whole[None], 5, 0), np.ones(1)), "samples_a: expected (k, "),
                          ((None, None), "samples_a: expected (k, ")):
        try:
            mote.Pair(mesh, mesh, skin_with_a_target(mesh), samples_a=samples)
        except ValueError as error:
            if says not in str(error):
                raise AssertionError(f"samples of parts: {error}, not {says}") from error
            continue
        raise AssertionError(f"samples of parts: taken, not {says}")


def main():
    faulthandler.dump_traceback_later(100, exit=True)
    seed = int(sys.argv[1]) if len(sys.argv) > 1 else 1
    random = np.random.default_rng(seed)
    tally = Tally()
    every, values = functions(), bad_values()
    for name, function, right in every:
        function(**right)
    for name, function, right in every:
        for argument in right:
            for value in values:
                if not endless(name, argument, value):
                    tally.call(name, function, {**right, argument: value})
    systematic = tally.wrong
    while tally.wrong < WANTED:
        name, function, right = every[random.integers(len(every))]
        arguments = dict(right)
        for argument in random.choice(list(right), size=random.integers(1, len(right) + 1)):
            value = values[random.integers(len(values))]
            if not endless(name, argument, value):
                arguments[argument] = value
        tally.call(name, function, arguments)
    for name, function, right in every:  # what was right before still is
        function(**right)
    gc.collect()
    frames_of_parts()
    print(f"{tally.wrong} wrong calls of {tally.calls}, {systematic} of them one argument at a time, "
          f"seed {seed}: each raised an error that names an argument")


if __name__ == "__main__":
    main()
