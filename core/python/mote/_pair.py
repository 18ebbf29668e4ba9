"""Two bodies whose fields are known."""

from __future__ import annotations

import ctypes
import struct
from ctypes import c_void_p
from typing import Any, Callable, Optional, Union

import numpy as np

from . import _library as lib
from ._arrays import DOUBLE, array_of, fits, wrong_shape
from ._batch import TwoBodies, options_of, run_frames, tolerance_of
from ._input import (
    IDENTITY,
    BodyWeights,
    Framed,
    count_frames,
    fill,
    framed,
    named_frames,
    pair_of,
    pose_framed,
)
from ._mesh import Field, Mesh, field_of, mesh_of
from ._results import Contact, Contacts, Distance, Distances

_ndarray = np.ndarray
_POSES = (2, 3, 4)
_numbers: Callable[[Any], tuple[Any, ...]] = struct.Struct("2d").unpack_from
_batch_query = lib.batch_query
_make = tuple.__new__


class Pair(TwoBodies):
    """The exact distance of two deforming bodies, with a proof of it.

    a, b: meshes, which may be the same. field_a, field_b: how they deform; None: not at all.

    slack: a query may stop when the distance is proven to be within slack * L, L being the larger of
    the meshes' lengths; 0: exact. budget: how many pairs of boxes a query may test before it stops;
    None: any number. The bracket lower <= distance holds in any case. samples_a, samples_b: weights of
    a few likely frames, (k, *weights_shape), at most 64: trees are built for them too, which makes
    queries of skins faster and changes no answer.

    Poses of a frame are float64 (2, 3, 4): of each body the rotation beside the translation; or
    (2, 4, 4), whose last row is 0 0 0 1; or a tuple (pose of a, pose of b), in which None leaves the
    body where its mesh is. Weights are a tuple (weights of a, weights of b), each of its field's
    weights_shape or None for rest.

    One thread at a time may use a pair: RuntimeError. ValueError where a number is not finite, a pose
    is no rotation, or something is beyond 2^50 L. Cost: about 0.5 s a million faces to make.
    """

    def __init__(self, a: Mesh, b: Mesh, field_a: Optional[Field] = None,
                 field_b: Optional[Field] = None, *, slack: float = 0.0,
                 budget: Optional[int] = None, samples_a: object = None,
                 samples_b: object = None) -> None:
        meshes = mesh_of("a", a), mesh_of("b", b)
        fields = field_of("field_a", field_a, meshes[0]), field_of("field_b", field_b, meshes[1])
        self._bodies = tuple(BodyWeights(field) for field in fields)
        options = options_of(slack, budget)
        kept = [self._set_samples(options, k, name, value)
                for k, (name, value) in enumerate((("samples_a", samples_a),
                                                   ("samples_b", samples_b)))]
        held = tuple(mesh._need(name) for mesh, name in zip(meshes, "ab"))
        used = tuple(f._need("field") if f else None for f in fields)
        memory = lib.create(
            "a, b", lib.batch_create, lib.batch_destroy, held + used,
            (c_void_p * 2)(*(m.address for m in held)),
            (c_void_p * 2)(*(m.address if m else None for m in used)),
            ctypes.byref(options),
        )
        del kept
        super().__init__(memory, meshes, lib.batch_bytes)
        self._prepare(memory)

    def _set_samples(self, options: lib.BatchOptions, k: int, name: str, value: object) -> Any:
        parts = self._bodies[k].framed(name, value)
        if value is not None:
            counts = named_frames(name, parts)
            if not counts or None in counts.values():
                raise ValueError(f"{name}: expected (k, *weights_shape), k weights of one frame each")
            options.sample_count[k] = count_frames(counts, "samples")
        fill(options.samples[k], None, *parts, 0)
        return parts

    def _prepare(self, memory: lib.Memory) -> None:
        """Memory for the numbers of one frame, and the library's structs that point to it."""
        sizes = [(body.rest.size, body.amounts) for body in self._bodies]
        self._buffer = np.zeros(24 + sum(rest + amounts for rest, amounts in sizes))
        self._poses = self._buffer[:24].reshape(_POSES)
        self._parts: list[tuple[np.ndarray, np.ndarray]] = []
        self._controls = (lib.Controls * 2)()
        at = 24
        for k, (body, (count, amounts)) in enumerate(zip(self._bodies, sizes)):
            weights = self._buffer[at : at + count].reshape(body.rest.shape)
            targets = self._buffer[at + count : at + count + amounts]
            at += count + amounts
            self._parts.append((weights, targets))
            fill(self._controls[k], Framed(self._poses[k], None, 0),
                 Framed(weights, None, 0) if count else None,
                 Framed(targets, None, 0) if amounts else None, 0)
        #: Where the weights of a frame go that are a single array.
        self._views = [p[0] if b.shape else p[1] for b, p in zip(self._bodies, self._parts)]
        self._shape_a, self._shape_b = (body.plain for body in self._bodies)
        self._view_a, self._view_b = self._views
        self._handle = c_void_p(memory.address)
        self._controls_at = c_void_p(ctypes.addressof(self._controls))
        self._run_at = c_void_p(ctypes.addressof(self._run))
        self._acquire = self._lock.acquire
        self._release = self._lock.release

    def distance(self, poses: object = None, weights: object = None) -> Distance:
        """The distance in one frame. A query starts from the last one's answer, so frames that
        follow one another take least time."""
        if not self._acquire(False):
            self._enter()
        try:
            if not self._cell:
                raise ValueError("this Pair is closed")
            if type(poses) is _ndarray and poses.dtype is DOUBLE and poses.shape == _POSES:
                self._poses[...] = poses
            else:
                self._set_poses(poses)
            if type(weights) is tuple and len(weights) == 2:
                a, b = weights
                if type(a) is _ndarray and a.dtype is DOUBLE and a.shape == self._shape_a:
                    self._view_a[...] = a
                else:
                    self._set_weights(0, a)
                if type(b) is _ndarray and b.dtype is DOUBLE and b.shape == self._shape_b:
                    self._view_b[...] = b
                else:
                    self._set_weights(1, b)
            else:
                self._set_both(weights)
            status = _batch_query(self._handle, self._controls_at, self._run_at)
            if status:
                lib.raise_error(status)
            distance, lower = _numbers(self._answer)
            return _make(Distance, (distance, lower, self._witness.copy()))
        finally:
            self._release()

    def contact(self, poses: object = None, weights: object = None,
                tolerance: float = 0.0) -> Contact:
        """Whether distance <= tolerance in one frame. The query ends when that is known."""
        within = tolerance_of(tolerance)
        self._enter()
        try:
            self._set_poses(poses)
            self._set_both(weights)
            self._run.tolerance = within
            try:
                status = _batch_query(self._handle, self._controls_at, self._run_at)
            finally:
                self._run.tolerance = -1.0
            if status:
                lib.raise_error(status)
            return self._answered_contact()
        finally:
            self._lock.release()

    def many(self, poses: object = None, weights: object = None, *, threads: int = 1,
             stretch: int = 256, tolerance: Optional[float] = None) -> Union[Distances, Contacts]:
        """Distances of many frames, or contacts where a tolerance is given.

        poses: (frames, 2, 3, 4) or (frames, 2, 4, 4), or a tuple of (frames, 3, 4) of each body.
        weights: a tuple of (frames, *weights_shape) of each body. An array without the first
        dimension, and None, hold in every frame. Arrays of float64 are borrowed while the call
        runs, if each frame's numbers lie one after the other, and must not be written to by others.

        Frames are cut into stretches. The first query of each starts from nothing, the others
        from the one before; threads share the stretches. So the answers are the same bits for any
        number of threads, and do not depend on earlier calls. With stretch=0 all frames follow
        the last query instead, as calls of distance would, on one thread.

        A ValueError names the first bad frame, counted from 0.
        """
        pose = self._poses_framed(poses)
        first = [self._bodies[k].framed(f"weights[{k}]", value)
                 for k, value in enumerate(pair_of("weights", weights))]
        frames = count_frames(
            {f"poses[{k}]": p.frames for k, p in enumerate(pose) if p is not None}
            | named_frames("weights[0]", first[0]) | named_frames("weights[1]", first[1])
        )
        controls = (lib.Controls * 2)()
        self._enter()
        try:
            def ask(start: int, run: Any) -> int:
                for k in range(2):
                    fill(controls[k], pose[k], *first[k], start)
                return int(_batch_query(self._handle, controls, run))

            return run_frames(frames, threads, stretch, tolerance, ask)
        finally:
            self._lock.release()

    def _poses_framed(self, poses: object) -> list[Optional[Framed]]:
        if poses is None or isinstance(poses, tuple):
            return [None if p is None else pose_framed(f"poses[{k}]", p)
                    for k, p in enumerate(pair_of("poses", poses))]
        array = array_of("poses", poses)
        rows = 4 if array.shape[-2:] == (4, 4) else 3
        if not fits(array.shape[-3:], (2, rows, 4)) or array.ndim not in (3, 4):
            raise wrong_shape("poses", array, (2, rows, 4), (-1, 2, rows, 4))
        return [framed("poses", array[..., k, :, :], (rows, 4)) for k in range(2)]

    def _set_poses(self, poses: object) -> None:
        for k, given in enumerate(self._poses_framed(poses)):
            if given is None:
                self._poses[k] = IDENTITY
                continue
            if given.frames is not None:
                raise ValueError(
                    f"poses[{k}]: the shape is {given.array.shape}, which is many frames; use many"
                )
            if given.array.shape == (4, 4) and (given.array[3] != (0, 0, 0, 1)).any():
                raise ValueError(f"poses[{k}]: the last row must be 0 0 0 1")
            self._poses[k] = given.array[:3]

    def _set_both(self, weights: object) -> None:
        for k, value in enumerate(pair_of("weights", weights)):
            self._set_weights(k, value)

    def _set_weights(self, k: int, value: object) -> None:
        name = f"weights[{k}]"
        given = self._bodies[k].framed(name, value)
        for part, to, rest in zip(given, self._parts[k], (self._bodies[k].rest, 0.0)):
            if part is None:
                to[...] = rest
            elif part.frames is not None:
                raise ValueError(
                    f"{name}: the shape is {part.array.shape}, which is many frames; use many"
                )
            else:
                to[...] = part.array
