"""What pairs and streams have in common: the answer of one frame, and runs over many frames."""

from __future__ import annotations

import ctypes
from typing import Any, Callable, Optional, Sequence, Union

import numpy as np

from . import _library as lib
from ._arrays import address, integer, real
from ._mesh import Mesh
from ._results import Contact, Contacts, Distances

THREADS = 256
FRAMES = 2**62

#: After this many stretches of each thread the interpreter looks whether it was interrupted.
STRETCHES = 16


class TwoBodies(lib.Guarded):
    """Two bodies, the memory that a frame's answer is written to, and the run that points to it."""

    def __init__(self, memory: lib.Memory, meshes: Sequence[Mesh],
                 bytes_of: Callable[[int], int]) -> None:
        super().__init__(memory)
        self._length = max(mesh.length for mesh in meshes)
        self._bytes_of = bytes_of
        self._answer = np.zeros(8)
        self._witness = self._answer[2:].reshape(2, 3)
        self._contact = np.zeros(1, np.int8)
        self._run = lib.Run(
            1, 0, 1, -1.0, address(self._answer), address(self._answer) + 8,
            address(self._answer) + 16, address(self._contact),
        )

    @property
    def length(self) -> float:
        """L: the larger of the meshes' lengths."""
        return self._length

    @property
    def nbytes(self) -> int:
        """Bytes that the library holds for queries; meshes and fields are not among them."""
        address_of = self._enter()
        try:
            return int(self._bytes_of(address_of))
        finally:
            self._lock.release()

    def _answered_contact(self) -> Contact:
        distance, lower = self._answer[:2].tolist()
        return Contact(decided(int(self._contact[0])), distance, lower, self._witness.copy())


def options_of(slack: object, budget: Optional[object]) -> lib.BatchOptions:
    options = lib.BatchOptions()
    options.slack = real("slack", slack)
    options.budget = (
        2**64 - 1 if budget is None else integer("budget", budget, 0, 2**64 - 1)
    )
    return options


def tolerance_of(tolerance: object) -> float:
    return real("tolerance", tolerance)


def run_frames(frames: int, threads: object, stretch: object, tolerance: Optional[object],
               ask: Callable[[int, Any], int]) -> Union[Distances, Contacts]:
    """Asks about frames, some at a time, so that an interrupt is noticed. ask(first, run): points
    the library at the frames from the first on, and calls it."""
    run = lib.Run()
    run.threads = integer("threads", threads, 1, THREADS)
    run.stretch = integer("stretch", stretch, 0, FRAMES)
    run.tolerance = -1.0 if tolerance is None else tolerance_of(tolerance)
    distance, lower = np.empty(frames), np.empty(frames)
    witness = np.empty((frames, 2, 3))
    contact = None if tolerance is None else np.empty(frames, np.int8)
    slice_length = min((run.stretch or 256) * run.threads * STRETCHES, FRAMES)
    for first in range(0, frames, slice_length):
        run.frames = min(slice_length, frames - first)
        run.distance = address(distance) + 8 * first
        run.lower = address(lower) + 8 * first
        run.witness = address(witness) + 48 * first
        run.contact = None if contact is None else address(contact) + first
        status = ask(first, ctypes.byref(run))
        if status:
            _raise_from(status, first)
    if contact is not None:
        return Contacts(contact, distance, lower, witness)
    return Distances(distance, lower, witness)


def _raise_from(status: int, first: int) -> None:
    """Raises the library's error, whose frames are counted from the first of a call."""
    try:
        lib.raise_error(status)
    except ValueError as error:
        text = str(error)
        begin, comma, rest = text.partition(",")
        if first == 0 or not begin.startswith("frame ") or not begin[6:].isdigit():
            raise
        raise ValueError(f"frame {int(begin[6:]) + first}{comma}{rest}") from None


def decided(contact: int) -> Optional[bool]:
    return None if contact < 0 else bool(contact)

