"""Answers of the module for Python against closed forms, numpy, and each other."""

import unittest

import numpy as np

import mote
from shapes import CORNERS, FACES, octahedron, poses, rotation, torus


def support_function(points, direction):
    return (points @ direction).max()


class Answers(unittest.TestCase):
    def test_control_points_pull_corners_towards_each_other(self):
        mesh = octahedron()
        fields = [mote.Field.csrbf([[0, 0, z]], 1.9) for z in (1, -1)]
        with mote.Pair(mesh, mesh, *fields) as pair:
            for k in range(9):
                move = np.array([[0, 0, 0.15 * k]])
                found = pair.distance(poses(), (move, -move))
                self.assertAlmostEqual(found.distance, 3 - 0.3 * k, 12)
                self.assertLessEqual(found.lower, found.distance)
                self.assertGreater(found.lower, found.distance - 1e-9)
                np.testing.assert_allclose(
                    found.witness, [[0, 0, 1 + 0.15 * k], [0, 0, 4 - 0.15 * k]], atol=1e-12
                )

    def test_every_kind_of_field_moves_vertices_as_documented(self):
        """A stream of the positions that numpy computes gives the same distances."""
        random = np.random.default_rng(1)
        vertices, faces = torus()
        mesh = mote.Mesh(vertices, faces)
        n = len(vertices)
        centres = vertices[::40]
        modes = random.normal(size=(3, n, 3)) * 0.05
        table = random.random((n, 4))
        targets = random.normal(size=(2, n, 3)) * 0.1
        whole = table / table.sum(1, keepdims=True)
        turn = rotation([1, 2, 3], 0.7)

        def csrbf(w):
            r = np.linalg.norm(vertices[:, None] - centres[None], axis=-1) / 1.5
            phi = np.where(r < 1, (1 - r) ** 4 * (4 * r + 1), 0)
            return vertices + phi @ w

        def bones(matrices, x=vertices):
            posed = np.einsum("brc,vc->vbr", matrices[:, :, :3], x) + matrices[None, :, :, 3]
            return np.einsum("vb,vbr->vr", whole, posed)

        matrices = np.repeat(np.eye(4)[None, :3], 4, 0) + random.normal(size=(4, 3, 4)) * 0.1
        square = np.concatenate([matrices, np.broadcast_to([0, 0, 0, 1.0], (4, 1, 4))], 1)
        w, s, amounts = random.normal(size=(len(centres), 3)) * 0.1, random.normal(size=3), [0.5, -1]
        moved = vertices + np.tensordot(amounts, targets, 1)
        skin = mote.Field.skin(mesh, table, targets=targets)
        cases = [
            (None, None, vertices),
            (mote.Field.csrbf(centres, 1.5), w, csrbf(w)),
            (mote.Field.modes(mesh, modes), s, vertices + np.tensordot(s, modes, 1)),
            (mote.Field.skin(mesh, table), matrices, bones(matrices)),
            (mote.Field.skin(mesh, table), square, bones(matrices)),
            (mote.Field.skin(mesh, table), None, vertices),
            (mote.Field.skin(mesh, table, np.tile(np.arange(4), (n, 1))), matrices, bones(matrices)),
            (mote.Field.morph(mesh, targets), np.array(amounts), moved),
            (skin, (matrices, np.array(amounts)), bones(matrices, moved)),
            (skin, (None, np.array(amounts)), moved),
        ]
        pose = poses(apart=1.6)
        pose[0, :, :3] = turn
        stream = mote.Stream(mesh, mesh)
        for field, weights, positions in cases:
            with self.subTest(field=field):
                world = positions @ turn.T
                expected = stream.distance(world, vertices + [0, 0, 1.6])
                pair = mote.Pair(mesh, mesh, field)
                found = pair.distance(pose, (weights, None))
                # bones' weights are rounded to multiples of 2^-24, displacements to floats
                self.assertAlmostEqual(found.distance, expected.distance, 6)
                again = mote.Scene([(mesh, field), mesh], [0, 1]).step(
                    pose, None if field is None else [_rows(weights), None], within=9
                )
                self.assertAlmostEqual(again.distance[0], found.distance, 12)

    def test_many_is_single_calls_one_after_the_other(self):
        vertices, faces = torus()
        mesh = mote.Mesh(vertices, faces)
        field = mote.Field.csrbf(vertices[::40], 1.5)
        n, count = 600, len(vertices[::40])
        time = np.linspace(0, 9, n)[:, None, None]
        weights = 0.2 * np.sin(time + np.arange(count)[None, :, None] + np.arange(3))
        pose = poses(n, 1.9)
        for k in range(n):
            pose[k, 1, :, :3] = rotation([1, 1, 0], 0.01 * k)
        pair = mote.Pair(mesh, mesh, field, field)
        single = [pair.distance(p, (w, -w)) for p, w in zip(pose, weights)]
        steady = mote.Pair(mesh, mesh, field, field).many(pose, (weights, -weights), stretch=0)
        for name in mote.Distance._fields:
            np.testing.assert_array_equal(
                np.array([getattr(s, name) for s in single]), getattr(steady, name)
            )
        one = pair.many(pose, (weights, -weights))
        np.testing.assert_allclose(one.distance, steady.distance, rtol=0, atol=1e-12)
        for threads in (2, 3):
            several = pair.many(pose, (weights, -weights), threads=threads)
            for a, b in zip(one, several):
                np.testing.assert_array_equal(a, b)
        middle = float(np.median(one.distance)) + 1e-9
        contacts = pair.many(pose, (weights, -weights), tolerance=middle)
        np.testing.assert_array_equal(contacts.contact, one.distance <= middle)
        for k in (0, 100, n - 1):
            answer = pair.contact(pose[k], (weights[k], -weights[k]), middle)
            self.assertEqual(answer.contact, bool(one.distance[k] <= middle))

    def test_arrays_of_other_types_and_layouts_give_the_same(self):
        vertices, faces = torus()
        mesh = mote.Mesh(vertices, faces)
        modes = np.random.default_rng(3).normal(size=(2, len(vertices), 3)) * 0.05
        pair = mote.Pair(mesh, mesh, mote.Field.modes(mesh, modes))
        n = 50
        pose, w = poses(n, 2.0), np.linspace(-1, 1, 2 * n).reshape(n, 2)
        expected = pair.many(pose, (w, None))
        locked = w.copy()
        locked.flags.writeable = False
        four = np.concatenate([pose, np.broadcast_to([0, 0, 0, 1.0], (n, 2, 1, 4))], axis=2)
        backwards = np.ascontiguousarray(w[::-1])[::-1]
        spread = np.repeat(np.repeat(w, 3, 0), 2, 1)[::3, ::2]
        for p, v in [
            (pose.astype(">f8"), w), (pose, w.astype(">f8")), (pose, np.asfortranarray(w)),
            (pose, locked), (four, w), ((pose[:, 0], pose[:, 1]), w), ((None, pose[0, 1]), w),
            (pose[0], w), (pose, backwards), (pose, spread), (pose, w.tolist()),
            (np.broadcast_to(pose[0], pose.shape), w), (pose, memoryview(w)),
        ]:
            for a, b in zip(expected, pair.many(p, (v, None))):
                np.testing.assert_array_equal(a, b)
        integers = mote.Pair(mesh, mesh).many(pose.astype(int))
        np.testing.assert_array_equal(integers.distance, mote.Pair(mesh, mesh).many(pose).distance)
        for kind in (np.uint32, np.int64, np.uint64, ">i4"):
            self.assertEqual(mote.Mesh(vertices, faces.astype(kind)).face_count, len(faces))

    def test_positions_are_read_where_they_are(self):
        vertices, faces = torus()
        mesh = mote.Mesh(vertices, faces)
        n = 40
        time = np.linspace(0, 1, n)[:, None, None]
        a = vertices * (1 + 0.1 * time)
        b = vertices + [0, 0, 2.0]
        stream = mote.Stream(mesh, mesh)
        expected = stream.many(a, b)
        single = [mote.Stream(mesh, mesh).distance(x, b).distance for x in a]
        np.testing.assert_allclose(expected.distance, single, rtol=0, atol=1e-12)
        records = np.zeros((n, len(vertices), 8))
        records[..., :3] = a
        for value in (records[..., :3], a.astype(">f8"), np.asfortranarray(a), a[::-1][::-1]):
            for x, y in zip(expected, stream.many(value, b)):
                np.testing.assert_array_equal(x, y)
        single = stream.many(a.astype(np.float32), b, threads=2)
        np.testing.assert_allclose(single.distance, expected.distance, rtol=0, atol=1e-6)
        contact = stream.contact(a[0], b, tolerance=float(expected.distance[0]) + 1e-9)
        self.assertIs(contact.contact, True)

    def test_a_scene_finds_the_pairs_that_are_near(self):
        mesh = octahedron()
        side = 6
        grid = np.stack(np.meshgrid(*[np.arange(side)] * 3, indexing="ij"), -1).reshape(-1, 3)
        pose = np.zeros((side**3, 4, 4))
        pose[:] = np.eye(4)
        pose[:, :3, 3] = 2.1 * grid
        for threads in (1, 2):
            with mote.Scene(mesh, side**3, threads=threads) as scene:
                near = scene.step(pose, within=0.11)
                apart = np.abs(grid[near.pairs[:, 0]] - grid[near.pairs[:, 1]]).sum(1)
                # corners of neighbours along an axis face each other, 0.1 apart
                self.assertEqual((apart == 1).sum(), 3 * side * side * (side - 1))
                np.testing.assert_allclose(near.distance[apart == 1], 0.1, atol=1e-12)
                self.assertFalse(near.contact.any())
                self.assertTrue((near.pairs[:, 0] < near.pairs[:, 1]).all())
                box = scene.boxes()
                np.testing.assert_allclose(box[:, 1] - box[:, 0], 2, atol=1e-4)
                self.assertEqual(len(scene.members(0)), side**3)
        contacts = mote.Scene(mesh, side**3, tolerance=0.2, contacts_only=True)
        self.assertEqual(contacts.step(pose, within=0.3).contact.sum(), 3 * side * side * (side - 1))

    def test_slack_and_budget_leave_a_bracket(self):
        vertices, faces = torus(40, 80)
        mesh = mote.Mesh(vertices, faces)
        pose = poses(apart=1.7)
        pose[1, :, :3] = rotation([1, 1, 0.3], 1.0)
        exact = mote.Pair(mesh, mesh).distance(pose)
        for options in ({"slack": 0.2}, {"budget": 3}):
            pair = mote.Pair(mesh, mesh, **options)
            found = pair.distance(pose)
            self.assertLessEqual(found.lower, exact.distance)
            self.assertGreaterEqual(found.distance, exact.distance - 1e-12)
            self.assertIsNone(mote.Pair(mesh, mesh, **options).contact(
                pose, tolerance=(found.lower + exact.distance) / 2).contact)
        self.assertGreater(mote.Pair(mesh, mesh).nbytes, 1000)

    def test_what_a_mesh_is(self):
        mesh = mote.Mesh(CORNERS, FACES)
        self.assertEqual((mesh.vertex_count, mesh.face_count), (6, 8))
        self.assertEqual((mesh.components, mesh.open_edges), (1, 0))
        self.assertAlmostEqual(mesh.length, 12**0.5, 12)
        self.assertEqual(mote.Mesh(CORNERS[:3], [[0, 1, 2]]).open_edges, 3)
        self.assertEqual(mote.Field.csrbf([[0, 0, 1]], 1).weights_shape, (1, 3))


def _rows(weights):
    if weights is None:
        return None
    if isinstance(weights, tuple):
        return tuple(None if w is None else np.asarray(w)[None] for w in weights)
    return np.asarray(weights)[None]


if __name__ == "__main__":
    unittest.main()
