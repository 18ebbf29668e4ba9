"""Many bodies."""

from __future__ import annotations

import ctypes
import os
import weakref
from ctypes import c_size_t, c_void_p
from typing import Any, Optional

import numpy as np

from . import _library as lib
from ._arrays import ANY, address, array_of, indices, integer, numbers, real, wrong_shape
from ._batch import THREADS
from ._input import BodyWeights, Framed
from ._mesh import Field, Mesh, field_of, mesh_of
from ._results import Near

_BODIES = 2**31 - 1
_WORDS = ctypes.sizeof(lib.Controls) // 8


def _shape_of(name: str, value: object) -> tuple[Mesh, Optional[Field]]:
    if isinstance(value, (tuple, list)):
        if len(value) != 2:
            raise ValueError(f"{name}: expected a Mesh, or a tuple of a Mesh and a Field")
        mesh = mesh_of(name, value[0])
        return mesh, field_of(name, value[1], mesh)
    return mesh_of(name, value), None


class Scene(lib.Guarded):
    """Many bodies, and those of them that are near each other.

    shapes: a list of meshes, or of tuples (mesh, field); a body costs next to no memory beside its
    shape. bodies: integers (n,), the shape of each body; or how many bodies there are, where there
    is one shape. tolerance: contact is distance <= tolerance. contacts_only: a step answers contact
    alone, which takes less time. threads: 1 to 256 share the work; a scene with more than one
    cannot be used in a process that was forked after it was made.

    One thread at a time may use a scene: RuntimeError. Cost: about 0.5 s a million faces of shapes.
    """

    def __init__(self, shapes: object, bodies: object, *, tolerance: float = 0.0,
                 contacts_only: bool = False, threads: int = 1) -> None:
        if isinstance(shapes, Mesh):
            shapes = [shapes]
        if not isinstance(shapes, (list, tuple)) or not shapes:
            raise TypeError("shapes: expected a list of meshes, or of tuples (mesh, field)")
        made = [_shape_of(f"shapes[{k}]", shape) for k, shape in enumerate(shapes)]
        if isinstance(bodies, (int, np.integer)) and not isinstance(bodies, bool):
            if len(made) != 1:
                raise TypeError("bodies: with several shapes, expected the shape of each body")
            shape_of = np.zeros(integer("bodies", bodies, 1, _BODIES), np.uint32)
        else:
            shape_of = indices("bodies", bodies, (ANY,), len(made), np.uint32)
        options = lib.CrowdOptions(
            real("tolerance", tolerance), bool(contacts_only), integer("threads", threads, 1, THREADS)
        )
        held = tuple(mesh._need("shapes") for mesh, _ in made)
        used = tuple(field._need("shapes") if field else None for _, field in made)
        memory = lib.create(
            "shapes, bodies", lib.crowd_create, lib.crowd_destroy, held + used,
            (c_void_p * len(held))(*(m.address for m in held)),
            (c_void_p * len(used))(*(m.address if m else None for m in used)),
            len(made), address(shape_of), len(shape_of), ctypes.byref(options),
        )
        super().__init__(memory)
        self._threads = options.threads
        self._forked = False
        self._shape_of = shape_of
        self._weights = [BodyWeights(field) for _, field in made]
        self._members = [np.flatnonzero(shape_of == k) for k in range(len(made))]
        self._controls = np.zeros((len(shape_of), _WORDS), np.uint64)
        self._length = float(lib.crowd_length(memory.address))
        if self._threads > 1:
            _threaded.add(self)

    @property
    def bodies(self) -> int:
        """How many there are."""
        return len(self._shape_of)

    @property
    def length(self) -> float:
        """L: the largest length of the shapes' meshes."""
        return self._length

    def members(self, shape: int) -> np.ndarray:
        """The bodies of a shape, ascending."""
        return self._members[integer("shape", shape, 0, len(self._members) - 1)].copy()

    def step(self, poses: object, weights: object = None, *, within: float = 0.0) -> Near:
        """Moves all bodies and asks about the pairs that boxes around them and their parts do not show to be
        more than `within` apart. All pairs at most that far apart are among them, and some others. Pairs that were also
        near in the last step continue from their answers, which is faster.

        poses: float64 (bodies, 3, 4) or (bodies, 4, 4). weights: None; where there is one shape,
        (bodies, *weights_shape); else a list of such an array or None for each shape, with a row for
        each of its members. A ValueError names the first bad body.
        """
        limit = real("within", within, infinite=True)
        count = c_size_t()
        address_of = self._enter()
        try:
            if self._forked:
                raise RuntimeError(
                    "this Scene has threads of the process that was forked; make one in this process"
                )
            kept = self._point_at(poses, weights)
            status = lib.crowd_step(
                address_of, address(self._controls), limit, ctypes.byref(count)
            )
            if status:
                lib.raise_error(status)
            del kept
            return self._near(address_of, count.value)
        finally:
            self._lock.release()

    def boxes(self) -> np.ndarray:
        """float64 (bodies, 2, 3): the lowest and the highest corner of a box around each body in
        the last step, in the world's axes; zeros before the first."""
        bounds = np.empty((self.bodies, 2, 3))
        address_of = self._enter()
        try:
            lib.crowd_bounds(address_of, address(bounds))
        finally:
            self._lock.release()
        return bounds

    def _point_at(self, poses: object, weights: object) -> list[Any]:
        """Fills the library's structs; returns the arrays that they point to."""
        array = array_of("poses", poses)
        rows = 4 if array.shape[-2:] == (4, 4) else 3
        if array.shape != (self.bodies, rows, 4):
            raise wrong_shape("poses", array, (self.bodies, 3, 4), (self.bodies, 4, 4))
        pose = numbers("poses", array, array.shape)
        every = np.arange(self.bodies, dtype=np.uint64)
        self._controls[:] = 0
        self._controls[:, 0] = address(pose) + every * np.uint64(32 * rows)
        self._controls[:, 6] = rows
        kept: list[Any] = [pose]
        for k, given in enumerate(self._weights_by_shape(weights)):
            members = self._members[k]
            for column, part in enumerate(given, 1):
                if part is None:
                    continue
                steps = every[: len(members)] * np.uint64(8 * part.step)
                self._controls[members, column] = np.uint64(address(part.array)) + steps
                kept.append(part)
        return kept

    def _weights_by_shape(self, weights: object) -> list[tuple[Optional[Framed], ...]]:
        shapes = len(self._weights)
        if weights is None:
            return [(None, None)] * shapes
        if shapes == 1 and not isinstance(weights, list):
            weights = [weights]
        if not isinstance(weights, (list, tuple)) or len(weights) != shapes:
            raise TypeError(f"weights: expected a list of {shapes}, one for each shape")
        result: list[tuple[Optional[Framed], ...]] = []
        for k, value in enumerate(weights):
            name = f"weights[{k}]"
            given = self._weights[k].framed(name, value)
            for part in given:
                if part is not None and part.frames != len(self._members[k]):
                    raise ValueError(
                        f"{name}: it has the shape {part.array.shape}; its first dimension must be "
                        f"the {len(self._members[k])} bodies of this shape"
                    )
            result.append(given)
        return result

    def _near(self, address_of: int, count: int) -> Near:
        pairs = np.empty((count, 2), np.uint32)
        distance, lower = np.empty(count), np.empty(count)
        witness = np.empty((count, 2, 3))
        contact = np.empty(count, np.int8)
        lib.crowd_pairs(
            address_of, address(pairs), address(distance), address(lower), address(witness),
            address(contact),
        )
        return Near(pairs, contact != 0, distance, lower, witness)

    def _after_fork(self) -> None:
        """The threads are not in the child process, and must not be waited for."""
        self._forked = True
        if self._memory is not None:
            self._memory.abandon()


_threaded: "weakref.WeakSet[Scene]" = weakref.WeakSet()


def _after_fork() -> None:
    for scene in list(_threaded):
        scene._after_fork()


os.register_at_fork(after_in_child=_after_fork)
