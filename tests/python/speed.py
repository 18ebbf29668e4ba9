"""What the module for Python costs beside C: one call, and a frame of a batch, interleaved with the same
loop in C. speed.py PYTHON_FRAMES PAIR_LOOP [check]. With check, fails above 3 us a call or 1.1 times a
frame; the smallest of several rounds count, since other programs only add to them."""

import ctypes
import sys
import time

import numpy as np

import mote
from frames import Frames
from mote import _library

FRAMES, ROUNDS = 900, 40


def there_and_back(frames):
    return np.concatenate([frames, frames[::-1], frames])


def loops(given, loop_library):
    """The loop in C over the frames, a loop of single calls, and a batch."""
    fields = (ctypes.c_void_p * 2)(*(f._memory.address for f in given.field))
    meshes = (ctypes.c_void_p * 2)(*(m._memory.address for m in given.mesh))
    bodies = ctypes.create_string_buffer(256)
    library = ctypes.CDLL(loop_library)
    library.pair_loop_create.restype = ctypes.c_void_p
    certificate = ctypes.c_void_p(library.pair_loop_create(meshes, fields, bodies))
    weights = (ctypes.c_void_p * 2)(*(w.ctypes.data for w in given.weights))
    distance = np.empty(FRAMES)

    def in_c():
        assert bodies and fields and meshes  # borrowed by the certificate
        library.pair_loop(certificate, fields, ctypes.c_size_t(FRAMES),
                          ctypes.c_void_p(given.poses.ctypes.data), weights,
                          ctypes.c_void_p(distance.ctypes.data))
        return distance

    pair = mote.Pair(*given.mesh, *given.field)
    frames = [(p, (a, b)) for p, a, b in zip(given.poses, *given.weights)]

    def single():
        ask = pair.distance
        return [ask(poses, weights).distance for poses, weights in frames]

    batch = mote.Pair(*given.mesh, *given.field)
    return in_c, single, lambda: batch.many(given.poses, given.weights, stretch=0).distance


def main(frames_of, loop_library, check=""):
    failed = False
    for scenario in ("ww", "mv"):
        given = Frames(frames_of, scenario, FRAMES // 3)
        given.poses = there_and_back(given.poses)
        given.weights = [there_and_back(w) for w in given.weights]
        work = loops(given, loop_library)
        answers = [np.array(w()) for w in work]
        assert all((a == answers[0]).all() for a in answers), "the loops answer differently"
        times = np.empty((ROUNDS, len(work)))
        for k in range(ROUNDS):
            for j, w in enumerate(work):
                start = time.perf_counter()
                w()
                times[k, j] = (time.perf_counter() - start) / FRAMES * 1e6
        in_c, single, many = times.min(axis=0)
        pairs = np.median(times[:, 2] / times[:, 0])
        print(f"{scenario}: C {in_c:.2f} us a frame; a call {single:.2f}, {single - in_c:+.2f} us; "
              f"a batch {many:.2f}, ratio {many / in_c:.3f} (median of rounds {pairs:.3f})")
        failed |= single - in_c > 3 or many / in_c > 1.1
    if check and failed:
        sys.exit("a call costs over 3 us more than in C, or a batch over 1.1 times as much")


if __name__ == "__main__":
    main(*sys.argv[1:])
