"""Closing, collecting, sharing, threads, forks, the interpreter's end, and other versions."""

import ctypes
import gc
import os
import subprocess
import sys
import tempfile
import threading
import unittest
import unittest.mock
import weakref

import numpy as np

import mote
from shapes import CORNERS, FACES, octahedron, poses, torus


def run(code):
    return subprocess.run([sys.executable, "-X", "faulthandler", "-c", code], capture_output=True,
                          text=True, timeout=120)


START = "import gc, mote, numpy as np, os, threading\nfrom shapes import *\nmesh = octahedron()\n"


class Lifetimes(unittest.TestCase):
    def test_what_is_closed_says_so_and_what_was_made_with_it_goes_on(self):
        mesh, field = octahedron(), mote.Field.csrbf([[0, 0, 1]], 1.9)
        pair, stream = mote.Pair(mesh, mesh, field), mote.Stream(mesh, mesh)
        scene = mote.Scene([(mesh, field)], 2, threads=2)
        mesh.close()
        field.close()
        mesh.close()
        del mesh, field
        gc.collect()
        self.assertAlmostEqual(pair.distance(poses()).distance, 3, 12)
        self.assertAlmostEqual(stream.distance(CORNERS, CORNERS + [0, 0, 5]).distance, 3, 12)
        self.assertAlmostEqual(scene.step(poses(), within=4).distance[0], 3, 12)
        for thing, call in (
            (pair, lambda: pair.distance(poses())), (pair, lambda: pair.contact(poses())),
            (pair, lambda: pair.many(poses(3))), (pair, lambda: pair.nbytes),
            (stream, lambda: stream.distance(CORNERS, CORNERS)),
            (stream, lambda: stream.many(CORNERS[None], CORNERS)),
            (scene, lambda: scene.step(poses())), (scene, scene.boxes),
        ):
            thing.close()
            self.assertTrue(thing.closed)
            with self.assertRaisesRegex(ValueError, "is closed"):
                call()
        with octahedron() as mesh:
            pass
        with self.assertRaisesRegex(ValueError, "a: this Mesh is closed"):
            mote.Pair(mesh, mesh)

    def test_cycles_are_collected_in_any_order(self):
        class Holder:
            def __del__(self):
                # others of this cycle may be gone already
                try:
                    self.pair.distance(poses())
                except ValueError:
                    pass

        for k in range(60):
            holder = Holder()
            holder.mesh = octahedron()
            holder.field = mote.Field.csrbf([[0, 0, 1]], 1.9)
            holder.pair = mote.Pair(holder.mesh, holder.mesh, holder.field)
            holder.mesh.back, holder.pair.back, holder.field.back = holder, holder, holder
            del holder
            gc.collect()

    def test_one_thread_at_a_time(self):
        vertices, faces = torus(60, 90)
        mesh = mote.Mesh(vertices, faces)
        pair = mote.Pair(mesh, mesh)
        pose = poses(4000, 1.5)
        started, busy, answers = threading.Event(), [], []

        def work():
            started.set()
            answers.append(pair.many(pose))

        thread = threading.Thread(target=work)
        thread.start()
        started.wait()
        while thread.is_alive():
            for call in (lambda: pair.distance(pose[0]), pair.close, lambda: pair.many(pose[:1])):
                try:
                    call()
                    if not thread.is_alive() or pair.closed:
                        break
                except RuntimeError as error:
                    busy.append(str(error))
                except ValueError:
                    pass
            if pair.closed:
                break
        thread.join()
        self.assertTrue(answers or pair.closed)

    def test_threads_of_their_own_share_meshes_and_run_at_once(self):
        vertices, faces = torus()
        mesh = mote.Mesh(vertices, faces)
        field = mote.Field.csrbf(vertices[::40], 1.5)
        pose = poses(200, 1.7)
        expected = mote.Pair(mesh, mesh, field).many(pose).distance
        results = [None] * 6

        def work(k):
            pair = mote.Pair(mesh, mesh, field)
            results[k] = pair.many(pose, threads=1 + k % 2).distance

        threads = [threading.Thread(target=work, args=(k,)) for k in range(6)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for result in results:
            np.testing.assert_array_equal(result, expected)

    def test_a_forked_process_goes_on(self):
        said = run(START + """
pair = mote.Pair(mesh, mesh)
scene, quiet = mote.Scene(mesh, 2, threads=3), mote.Scene(mesh, 2)
pair.many(poses(9), threads=2, stretch=2)
child = os.fork()
if child == 0:
    assert abs(pair.distance(poses()).distance - 3) < 1e-12
    assert len(pair.many(poses(9), threads=2, stretch=2).distance) == 9
    assert len(quiet.step(poses(), within=4).pairs) == 1
    try:
        scene.step(poses())
    except RuntimeError as error:
        assert "forked" in str(error)
    else:
        os._exit(3)
    del scene, pair, quiet
    gc.collect()
    os._exit(0)
assert os.waitpid(child, 0)[1] == 0
scene.step(poses())
print("parent and child done")
""")
        self.assertEqual((said.returncode, said.stdout.strip()), (0, "parent and child done"), said)

    def test_the_interpreter_may_end_at_any_time(self):
        for end in (
            "pass", "os._exit(0)", "raise SystemExit(0)", "del mesh", "keep = [pair, mesh]; keep.append(keep)",
            "threading.Thread(target=lambda: pair.many(poses(300000)), daemon=True).start()",
            "import atexit; atexit.register(lambda: pair.distance(poses()))",
        ):
            said = run(START + f"pair = mote.Pair(mesh, mesh)\nscene = mote.Scene(mesh, 2, threads=2)\n{end}\n")
            self.assertEqual(said.returncode, 0, (end, said))

    def test_pickles_and_copies_are_refused(self):
        import copy
        import pickle

        mesh = octahedron()
        for thing in (mesh, mote.Field.csrbf([[0, 0, 1]], 1), mote.Pair(mesh, mesh)):
            for function in (pickle.dumps, copy.copy, copy.deepcopy):
                with self.assertRaisesRegex(TypeError, "cannot be pickled"):
                    function(thing)

    def test_another_major_version_is_refused_with_both_numbers(self):
        with tempfile.TemporaryDirectory() as folder:
            for body, said in (
                ('const char *mote_version(void) { return "99.5.1"; }', "the library is version 99.5.1"),
                ("int mote_other;", "does not tell its version"),
            ):
                source, library = os.path.join(folder, "v.c"), os.path.join(folder, "libother.so")
                with open(source, "w") as file:
                    file.write(body)
                subprocess.run(["cc", "-shared", "-fPIC", source, "-o", library], check=True)
                answer = subprocess.run(
                    [sys.executable, "-c", "import mote"], capture_output=True, text=True,
                    env={**os.environ, "MOTE_LIBRARY": library},
                )
                self.assertEqual(answer.returncode, 1)
                self.assertIn(said, answer.stderr)
                self.assertIn(f"this module is version {mote.__version__}", answer.stderr)
            answer = subprocess.run(
                [sys.executable, "-c", "import mote"], capture_output=True, text=True,
                env={**os.environ, "MOTE_LIBRARY": os.path.join(folder, "none.so")},
            )
            self.assertIn("name its file in MOTE_LIBRARY", answer.stderr)

    def test_a_mesh_that_another_thread_closes_during_a_call_lives_until_it_ends(self):
        from mote._mesh import lib

        for name, call in (
            ("create", lambda mesh: mote.Field.morph(mesh, np.zeros((1, 6, 3)))),
            ("mesh_bytes", lambda mesh: mesh.nbytes),
        ):
            mesh, inside = octahedron(), getattr(lib, name)
            memory = weakref.ref(mesh._memory)

            def closing(*arguments):
                mesh.close()
                self.assertIsNotNone(memory(), name)
                return inside(*arguments)

            with unittest.mock.patch.object(lib, name, closing):
                call(mesh)
            self.assertIsNone(memory(), name)

    def test_the_struct_of_a_mesh_is_the_librarys(self):
        from mote import _library

        mesh = mote.Mesh(CORNERS, FACES)
        data = _library.MeshData.from_address(mesh._memory.address)
        self.assertEqual((data.vertex_count, data.triangle_count, data.edge_count), (6, 8, 12))
        self.assertEqual(list(data.low) + list(data.high), [-1, -1, -1, 1, 1, 1])
        self.assertAlmostEqual(data.mean_edge, 2**0.5)
        self.assertEqual(ctypes.sizeof(_library.Controls), 56)


if __name__ == "__main__":
    unittest.main()
