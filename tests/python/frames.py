"""The frames of a scenario as python_frames writes them."""

import os
import subprocess
import tempfile

import numpy as np

import mote


class Frames:
    """Meshes, fields, poses, weights and positions of the first frames of a scenario."""

    def __init__(self, program, scenario, frames):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([program, scenario, str(frames), folder], check=True)
            parts = [_body(folder, name, frames) for name in "ab"]
        self.mesh, self.field, self.weights, self.positions, pose = zip(*parts)
        self.poses = np.ascontiguousarray(np.stack(pose, axis=1))


def _body(folder, name, frames):
    def read(part, kind=np.float64):
        path = os.path.join(folder, f"{name}.{part}")
        return np.fromfile(path, kind) if os.path.exists(path) else np.zeros(0, kind)

    vertices = read("vertices.f64").reshape(-1, 3)
    mesh = mote.Mesh(vertices, read("faces.u32", np.uint32).reshape(-1, 3))
    field = weights = None
    if read("support.f64").size:
        field = mote.Field.csrbf(read("centres.f64").reshape(-1, 3), read("support.f64")[0])
        weights = read("weights.f64").reshape(frames, -1, 3)
    if read("counts.u64", np.uint64).size:
        field, weights = _skin(read, mesh, frames)
    positions = read("positions.f64").reshape(frames, -1, 3)
    return mesh, field, weights, positions, read("poses.f64").reshape(frames, 3, 4)


def _skin(read, mesh, frames):
    bones, targets = map(int, read("counts.u64", np.uint64))
    n = mesh.vertex_count
    dense = None
    if targets:
        dense = np.zeros((targets, n, 3))
        start = read("shift_start.u32", np.uint32)
        owner = np.repeat(np.arange(n), np.diff(start))
        dense[read("target.u32", np.uint32), owner] = read("shift.f64").reshape(-1, 3)
    amounts = read("amounts.f64").reshape(frames, targets)
    if not bones:
        return mote.Field.morph(mesh, dense), amounts
    table = np.zeros((n, bones))
    owner = np.repeat(np.arange(n), np.diff(read("start.u32", np.uint32)))
    np.add.at(table, (owner, read("bone.u16", np.uint16)), read("weight.f64"))
    matrices = read("matrices.f64").reshape(frames, bones, 3, 4)
    field = mote.Field.skin(mesh, table, targets=dense)
    return field, (matrices, amounts) if targets else matrices
