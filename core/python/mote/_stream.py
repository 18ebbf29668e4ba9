"""Two bodies of which only positions are known."""

from __future__ import annotations

import ctypes
from typing import Any, NamedTuple, Optional, Union

import numpy as np

from . import _library as lib
from ._arrays import (
    ANY,
    DOUBLE,
    SINGLE,
    address,
    array_of,
    contiguous,
    fits,
    wrong_shape,
)
from ._batch import TwoBodies, options_of, run_frames, tolerance_of
from ._input import count_frames
from ._mesh import Mesh, mesh_of
from ._results import Contact, Contacts, Distance, Distances


class _Given(NamedTuple):
    """Positions of a body's vertices, in one frame or in many."""

    array: np.ndarray
    frames: Optional[int]


def _is_borrowable(array: np.ndarray) -> bool:
    size = array.itemsize
    steps = array.strides
    return (
        array.dtype in (DOUBLE, SINGLE)
        and bool(array.flags.aligned)
        and array.size > 0
        and steps[-1] == size
        and (array.shape[-2] == 1 or (steps[-2] >= 3 * size and steps[-2] % size == 0))
        and (array.ndim == 2 or (steps[0] >= 0 and steps[0] % size == 0))
    )


def _given(name: str, value: object, vertices: int) -> _Given:
    array = array_of(name, value)
    if not (fits(array.shape, (vertices, 3)) or fits(array.shape, (ANY, vertices, 3))):
        raise wrong_shape(name, array, (vertices, 3), (ANY, vertices, 3))
    if not _is_borrowable(array):
        single = array.dtype.kind == "f" and array.itemsize == 4
        array = contiguous(name, array, SINGLE) if single else contiguous(name, array, DOUBLE)
    return _Given(array, len(array) if array.ndim == 3 else None)


def _fill(positions: lib.Positions, given: _Given, first: int) -> None:
    array = given.array
    step = array.strides[0] if given.frames is not None and given.frames > 1 else 0
    positions.data = address(array) + first * step
    positions.stride = array.strides[-2] if array.shape[-2] > 1 else 3 * array.itemsize
    positions.single = array.itemsize == 4
    positions.frame_step = step


class Stream(TwoBodies):
    """The exact distance of two bodies that are known by where their vertices are in each frame:
    cloth, finite elements, captured sequences.

    a, b: meshes; their faces hold in every frame, and their rest positions only decide how fast
    queries are. slack, budget: as of Pair.

    Positions are float64 or float32 (vertices, 3), in the world's axes, borrowed without a copy
    where x, y, z of each vertex lie side by side: a part array[:, :3] of larger records, too. They must
    not be written to by others while a call runs. float32 positions count as exact.

    One thread at a time may use a stream: RuntimeError. ValueError where a position is not finite.
    """

    def __init__(self, a: Mesh, b: Mesh, *, slack: float = 0.0,
                 budget: Optional[int] = None) -> None:
        meshes = mesh_of("a", a), mesh_of("b", b)
        options = options_of(slack, budget)
        held = tuple(mesh._need(name) for mesh, name in zip(meshes, "ab"))
        memory = lib.create(
            "a, b", lib.stream_create, lib.stream_destroy, held,
            (ctypes.c_void_p * 2)(*(m.address for m in held)), ctypes.byref(options),
        )
        self._vertices = tuple(mesh.vertex_count for mesh in meshes)
        super().__init__(memory, meshes, lib.stream_bytes)
        self._positions = (lib.Positions * 2)()

    def _ask(self, positions_a: object, positions_b: object, tolerance: float) -> None:
        """Asks about one frame; the stream is in use by this thread."""
        given = self._both(positions_a, positions_b)
        for k, name in enumerate(("positions_a", "positions_b")):
            if given[k].frames is not None:
                raise ValueError(
                    f"{name}: the shape is {given[k].array.shape}, which is many frames; use many"
                )
            _fill(self._positions[k], given[k], 0)
        self._run.tolerance = tolerance
        status = lib.stream_query(
            self._cell[0], ctypes.byref(self._positions), ctypes.byref(self._run)
        )
        if status:
            lib.raise_error(status)

    def _both(self, positions_a: object, positions_b: object) -> tuple[_Given, _Given]:
        return (_given("positions_a", positions_a, self._vertices[0]),
                _given("positions_b", positions_b, self._vertices[1]))

    def distance(self, positions_a: object, positions_b: object) -> Distance:
        """The distance in one frame. A query starts from the last one's answer."""
        self._enter()
        try:
            self._ask(positions_a, positions_b, -1.0)
            return Distance(float(self._answer[0]), float(self._answer[1]), self._witness.copy())
        finally:
            self._lock.release()

    def contact(self, positions_a: object, positions_b: object,
                tolerance: float = 0.0) -> Contact:
        """Whether distance <= tolerance in one frame. The query ends when that is known."""
        within = tolerance_of(tolerance)
        self._enter()
        try:
            self._ask(positions_a, positions_b, within)
            return self._answered_contact()
        finally:
            self._lock.release()

    def many(self, positions_a: object, positions_b: object, *, threads: int = 1,
             stretch: int = 256, tolerance: Optional[float] = None) -> Union[Distances, Contacts]:
        """Distances of many frames, or contacts where a tolerance is given. Positions are
        (frames, vertices, 3); (vertices, 3) is of a body that never moves, and costs next to
        nothing. threads, stretch and errors: as of Pair.many."""
        given = self._both(positions_a, positions_b)
        frames = count_frames({"positions_a": given[0].frames, "positions_b": given[1].frames})
        positions = (lib.Positions * 2)()
        address_of = self._enter()
        try:
            def ask(first: int, run: Any) -> int:
                for k in range(2):
                    _fill(positions[k], given[k], first)
                return int(lib.stream_query(address_of, ctypes.byref(positions), run))

            return run_frames(frames, threads, stretch, tolerance, ask)
        finally:
            self._lock.release()
