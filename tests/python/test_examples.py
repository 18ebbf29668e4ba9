"""The examples of docs/python.md, as readers see them, each in a new folder. test_examples.py DOCUMENTED
PYTHON_MD MOTE; a missing matplotlib skips the drawing, unless MOTE_NEED_MATPLOTLIB is set."""

import os
import subprocess
import sys
import tempfile
import unittest

documented, page, program = sys.argv[1:4]


def run(name, folder, *words):
    source = subprocess.run(["sh", documented, name, page], check=True, capture_output=True, text=True)
    with open(os.path.join(folder, name), "w") as file:
        file.write(source.stdout)
    path = os.path.dirname(program) + os.pathsep + os.environ["PATH"]
    return subprocess.run([sys.executable, name, *words], cwd=folder, check=True, text=True,
                          stdout=subprocess.PIPE, env={**os.environ, "PATH": path}).stdout.splitlines()


class Examples(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def test_letters(self):
        said = run("letters.py", self.folder.name)
        distances = [float(line.split()[2].rstrip(",")) for line in said]
        self.assertEqual(len(distances), 5)
        self.assertEqual(distances, sorted(distances, reverse=True))
        self.assertGreater(distances[-1], 0)
        self.assertLess(distances[-1], distances[0])

    def test_bodies(self):
        said = run("bodies.py", self.folder.name)
        self.assertEqual(len(said), 20)
        self.assertTrue(all(int(line.split()[2]) > 0 for line in said), said)

    def test_track(self):
        said = run("track.py", self.folder.name)
        frame, distance = said[0].split()[3].rstrip(":"), float(said[0].split()[4])
        self.assertTrue(0 <= int(frame) < 1000)
        self.assertTrue(0.25 < distance < 0.5, said)

    def test_front(self):
        try:
            import matplotlib  # noqa: F401
        except ImportError:
            if os.environ.get("MOTE_NEED_MATPLOTLIB"):
                raise
            self.skipTest("matplotlib is missing (cmake/packages-exports.txt)")
        results = os.path.join(self.folder.name, "results")
        subprocess.run([program, "run", "mv", "--frames", "1-30", "--method", "certified", "--method",
                        "particle-paper", "--out", results], check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
        said = run("front.py", self.folder.name, results, "front.png")
        self.assertEqual(sorted(line.split(":")[0] for line in said), ["certified", "particle-paper"])
        with open(os.path.join(self.folder.name, "front.png"), "rb") as file:
            self.assertEqual(file.read(8), b"\x89PNG\r\n\x1a\n")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
