"""Meshes and motions that the tests of the module for Python share."""

import numpy as np

import mote

CORNERS = np.array(
    [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], dtype=np.float64
)
FACES = np.array(
    [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
)


def octahedron():
    return mote.Mesh(CORNERS, FACES)


def torus(across=12, around=24):
    """Vertices and faces of a torus with radii 1 and 0.4."""
    u, v = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    a, b = 2 * np.pi * u / around, 2 * np.pi * v / across
    r = 1 + 0.4 * np.cos(b)
    vertices = np.stack([r * np.cos(a), r * np.sin(a), 0.4 * np.sin(b)], -1).reshape(-1, 3)
    number = lambda i, j: (i % around) * across + j % across
    p, q, s, t = number(u, v), number(u + 1, v), number(u + 1, v + 1), number(u, v + 1)
    faces = np.concatenate([np.stack([p, q, s], -1), np.stack([p, s, t], -1)]).reshape(-1, 3)
    return vertices, faces


def poses(frames=None, apart=5.0):
    """Two bodies, one above the other."""
    pose = np.zeros((2, 3, 4))
    pose[:, :, :3] = np.eye(3)
    pose[1, 2, 3] = apart
    return pose if frames is None else np.repeat(pose[None], frames, axis=0)


def rotation(axis, angle):
    x, y, z = np.asarray(axis) / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k
