"""libmote, loaded by ctypes: its functions, the structs of plain arrays, and its memory."""

from __future__ import annotations

import ctypes
import os
import threading
import weakref
from ctypes import (
    POINTER,
    Structure,
    byref,
    c_char_p,
    c_double,
    c_int,
    c_size_t,
    c_uint32,
    c_uint64,
    c_void_p,
)
from typing import Any, Callable, NoReturn

from ._place import LIBRARY, SONAME, VERSION


class MeshData(Structure):
    """mote_mesh."""

    _fields_ = [
        ("vertex_count", c_uint32),
        ("triangle_count", c_uint32),
        ("positions", c_void_p),
        ("triangles", c_void_p),
        ("ring_start", c_void_p),
        ("ring", c_void_p),
        ("component", c_void_p),
        ("component_count", c_uint32),
        ("edge_count", c_uint32),
        ("open_edge_count", c_uint32),
        ("low", c_double * 3),
        ("high", c_double * 3),
        ("diagonal", c_double),
        ("mean_edge", c_double),
    ]


class MorphTargets(Structure):
    """mote_morph_targets."""

    _fields_ = [
        ("count", c_uint32),
        ("start", c_void_p),
        ("vertex", c_void_p),
        ("move", c_void_p),
    ]


class Controls(Structure):
    """mote_controls."""

    _fields_ = [
        ("pose", c_void_p),
        ("weights", c_void_p),
        ("amounts", c_void_p),
        ("pose_step", c_size_t),
        ("weights_step", c_size_t),
        ("amounts_step", c_size_t),
        ("pose_rows", c_size_t),
    ]


class Positions(Structure):
    """mote_batch_positions."""

    _fields_ = [
        ("data", c_void_p),
        ("stride", c_size_t),
        ("single", c_size_t),
        ("frame_step", c_size_t),
    ]


class Run(Structure):
    """mote_batch_run."""

    _fields_ = [
        ("frames", c_size_t),
        ("stretch", c_size_t),
        ("threads", c_size_t),
        ("tolerance", c_double),
        ("distance", c_void_p),
        ("lower", c_void_p),
        ("witness", c_void_p),
        ("contact", c_void_p),
    ]


class BatchOptions(Structure):
    """mote_batch_options."""

    _fields_ = [
        ("slack", c_double),
        ("budget", c_uint64),
        ("sample_count", c_size_t * 2),
        ("samples", Controls * 2),
    ]


class CrowdOptions(Structure):
    """mote_crowd_options."""

    _fields_ = [("tolerance", c_double), ("contact", c_uint64), ("threads", c_size_t)]


def _load() -> ctypes.CDLL:
    """The library named by MOTE_LIBRARY, else the one installed with this module, else the
    loader's."""
    named = os.environ.get("MOTE_LIBRARY")
    beside = os.path.join(os.path.dirname(os.path.abspath(__file__)), LIBRARY)
    place = named if named else beside if os.path.exists(beside) else SONAME
    try:
        return ctypes.CDLL(place)
    except OSError as error:
        raise ImportError(
            f"mote: the library cannot be loaded ({error}); install libmote, or name its file in "
            "MOTE_LIBRARY"
        ) from None


def _version(loaded: ctypes.CDLL) -> str:
    """The version of a library; refuses one that this module was not made for."""
    try:
        function = loaded.mote_version
    except AttributeError:
        raise ImportError(
            f"mote: this module is version {VERSION}; the library is older than 1.0 and does not "
            "tell its version"
        ) from None
    function.restype = c_char_p
    function.argtypes = []
    found = str(function().decode("ascii", "replace"))
    if found.split(".")[0] != VERSION.split(".")[0]:
        raise ImportError(
            f"mote: this module is version {VERSION}, and the library is version {found}; both "
            "must have the same first number"
        )
    return found


_loaded = _load()

#: The version of libmote that is in use.
library_version = _version(_loaded)


def _function(name: str, *arguments: Any) -> Any:
    function = getattr(_loaded, name)
    function.argtypes = list(arguments)
    function.restype = c_int
    return function


def _destroyer(name: str) -> Any:
    function = getattr(_loaded, name)
    function.argtypes = [c_void_p]
    function.restype = None
    return function


def _size(name: str) -> Any:
    function = getattr(_loaded, name)
    function.argtypes = [c_void_p]
    function.restype = c_size_t
    return function


_error_text = _loaded.mote_error_text
_error_text.argtypes = []
_error_text.restype = c_char_p

_new = POINTER(c_void_p)
mesh_create = _function("mote_mesh_create", c_void_p, c_size_t, c_void_p, c_size_t, _new)
field_csrbf = _function("mote_field_create_csrbf", c_void_p, c_uint32, c_double, _new)
field_modes = _function("mote_field_create_modes", c_void_p, c_uint32, c_uint32, _new)
field_morphs = _function(
    "mote_field_create_morphs", c_void_p, c_uint32, c_void_p, c_void_p, c_void_p, c_void_p, _new
)
field_skin = _function(
    "mote_field_create_skin", c_void_p, c_uint32, c_void_p, c_void_p, c_void_p, _new
)
batch_create = _function("mote_batch_create", c_void_p, c_void_p, c_void_p, _new)
stream_create = _function("mote_stream_batch_create", c_void_p, c_void_p, _new)
stream_query = _function("mote_stream_batch_query", c_void_p, c_void_p, c_void_p)
crowd_create = _function(
    "mote_crowd_create", c_void_p, c_void_p, c_size_t, c_void_p, c_size_t, c_void_p, _new
)
crowd_step = _function("mote_crowd_step", c_void_p, c_void_p, c_double, POINTER(c_size_t))
crowd_pairs = _function(
    "mote_crowd_pairs", c_void_p, c_void_p, c_void_p, c_void_p, c_void_p, c_void_p
)
crowd_pairs.restype = None
crowd_bounds = _function("mote_crowd_bounds", c_void_p, c_void_p)
crowd_bounds.restype = None
crowd_length = _function("mote_crowd_length", c_void_p)
crowd_length.restype = c_double
mesh_destroy = _destroyer("mote_mesh_destroy")
field_destroy = _destroyer("mote_field_destroy")
batch_destroy = _destroyer("mote_batch_destroy")
stream_destroy = _destroyer("mote_stream_batch_destroy")
crowd_destroy = _destroyer("mote_crowd_destroy")
mesh_bytes = _size("mote_mesh_bytes")
batch_bytes = _size("mote_batch_bytes")
stream_bytes = _size("mote_stream_batch_bytes")

#: Called with prepared pointers, which ctypes passes on without looking for a type.
batch_query = _loaded.mote_batch_query
batch_query.restype = c_int

_ERRORS: dict[int, type[Exception]] = {
    1: ValueError,
    2: MemoryError,
    3: OSError,
    4: NotImplementedError,
    5: ArithmeticError,
}


def raise_error(status: int, arguments: str = "") -> NoReturn:
    """Raises what a status of this thread's last call means; arguments: what it was made from."""
    text = _error_text().decode("utf-8", "replace")
    raise _ERRORS.get(status, RuntimeError)(f"{arguments}: {text}" if arguments else text)


def _free(cell: list[int], destroy: Callable[[int], None]) -> None:
    destroy(cell.pop())


class Memory:
    """Something that the library allocated, and everything in Python that it borrows from.

    It is freed once nothing refers to it any more, in whatever order that happens: the library's
    destroy functions do not look at what was borrowed. Of objects that are collected together, all
    are freed before any method __del__ of theirs runs; the cell is empty then, and what such a
    method calls raises ValueError. Nothing is freed at the end of the interpreter, where a thread
    may still be in a call.
    """

    __slots__ = ("__weakref__", "cell", "borrowed", "_finalizer")

    def __init__(self, address: int, destroy: Callable[[int], None], *borrowed: object) -> None:
        self.cell = [address]
        self.borrowed = borrowed
        self._finalizer = weakref.finalize(self, _free, self.cell, destroy)
        self._finalizer.atexit = False

    @property
    def address(self) -> int:
        return self.cell[0]

    def abandon(self) -> None:
        """Never frees it."""
        self._finalizer.detach()


def create(names: str, function: Any, destroy: Callable[[int], None],
           borrowed: tuple[object, ...], *arguments: Any) -> Memory:
    """Calls a function whose last argument receives what it made. names: of the arguments that
    its errors are about."""
    made = c_void_p()
    status = function(*arguments, byref(made))
    if status:
        raise_error(status, names)
    assert made.value is not None
    return Memory(made.value, destroy, *borrowed)


class Guarded:
    """An object of the library that one thread at a time may use, and that can be closed."""

    def __init__(self, memory: Memory) -> None:
        self._lock = threading.Lock()
        self._memory: Memory | None = memory
        #: Empty when it is closed or freed.
        self._cell = memory.cell

    def _enter(self) -> int:
        """Takes the object for this thread; returns its address."""
        if not self._lock.acquire(False):
            raise RuntimeError(
                f"this {type(self).__name__} is in use; make one for each thread"
            )
        if not self._cell:
            self._lock.release()
            raise ValueError(f"this {type(self).__name__} is closed")
        return self._cell[0]

    def close(self) -> None:
        """Frees the library's memory; further calls raise ValueError. Closing twice is allowed."""
        if not self._lock.acquire(False):
            raise RuntimeError(
                f"this {type(self).__name__} is in use; close it when the call has returned"
            )
        try:
            self._cell = []
            self._memory = None
        finally:
            self._lock.release()

    @property
    def closed(self) -> bool:
        return not self._cell

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def __reduce__(self) -> NoReturn:
        raise TypeError(f"a {type(self).__name__} belongs to its process and cannot be pickled")

