"""Checks of arguments. Every error begins with the argument's name."""

from __future__ import annotations

import math
import operator
from typing import Any, Iterable, Sequence

import numpy as np

#: A dimension that may have any length.
ANY = -1

#: A list or tuple of more numbers than this has to be an array.
LISTED = 1_000_000

#: An array of more numbers than this that lie in less memory is not copied.
REPEATED = 10_000_000

DOUBLE = np.dtype(np.float64)
SINGLE = np.dtype(np.float32)


def _listed(name: str, value: Sequence[Any], depth: int, room: int) -> int:
    """How many numbers are in nested lists; refuses whatever is not lists of numbers. Lists may
    contain themselves or others many times, so depth and number are limited."""
    if depth > 8:
        raise TypeError(f"{name}: lists are nested too deep")
    claimed, inner = len(value), value
    while isinstance(inner, (list, tuple)) and inner and claimed <= room:
        inner = inner[0]
        claimed *= len(inner) if isinstance(inner, (list, tuple)) and inner else 1
        if inner is value:
            raise TypeError(f"{name}: a list contains itself")
    if claimed > room:
        raise TypeError(f"{name}: more than {LISTED} numbers in lists; pass a numpy array")
    total = 0
    kinds = set(map(type, value))
    for kind in kinds:
        if issubclass(kind, (list, tuple, np.ndarray)):
            continue
        if issubclass(kind, bool) or not issubclass(kind, (int, float, np.number)):
            raise TypeError(f"{name}: a list holds {kind.__name__}, not numbers")
    if not any(issubclass(kind, (list, tuple, np.ndarray)) for kind in kinds):
        return len(value)
    for item in value:
        if isinstance(item, (list, tuple)):
            total += _listed(name, item, depth + 1, room - total)
        else:
            total += item.size if isinstance(item, np.ndarray) else 1
        if total > room:
            raise TypeError(f"{name}: more than {LISTED} numbers in lists; pass a numpy array")
    return total


def array_of(name: str, value: object) -> np.ndarray:
    """An array of real numbers, not copied where it is one."""
    if isinstance(value, np.ma.MaskedArray):
        raise TypeError(f"{name}: masked arrays are not supported; fill in what is masked")
    if isinstance(value, (list, tuple)):
        _listed(name, value, 1, LISTED)
    elif isinstance(value, (str, bytes, bytearray)) or not (
        isinstance(value, (np.ndarray, np.generic, memoryview, int, float))
        or hasattr(type(value), "__array__")
        or hasattr(type(value), "__array_interface__")
    ):
        raise TypeError(f"{name}: expected an array of numbers, not {type(value).__name__}")
    try:
        array = np.asarray(value)
    except (TypeError, ValueError, OverflowError, RecursionError) as error:
        raise TypeError(f"{name}: not an array of numbers: {error}") from None
    if type(array) is not np.ndarray:
        array = np.asarray(array).view(np.ndarray)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name}: expected real numbers, not dtype {array.dtype}")
    return array


def shape_text(shape: Iterable[int]) -> str:
    return "(" + ", ".join("n" if n == ANY else str(n) for n in shape) + ")"


def fits(shape: tuple[int, ...], wanted: tuple[int, ...]) -> bool:
    return len(shape) == len(wanted) and all(
        b in (ANY, a) for a, b in zip(shape, wanted)
    )


def wrong_shape(name: str, array: np.ndarray, *wanted: tuple[int, ...]) -> ValueError:
    right = " or ".join(shape_text(shape) for shape in wanted)
    return ValueError(f"{name}: the shape is {array.shape}; it must be {right}")


def _refuse_repeated(name: str, array: np.ndarray) -> None:
    """Strides can make an array of terabytes out of one number; a copy would fill the memory."""
    extent = array.itemsize
    for length, stride in zip(array.shape, array.strides):
        extent += (length - 1) * abs(stride)
    if array.size > REPEATED and array.size * array.itemsize > extent:
        raise ValueError(
            f"{name}: its strides repeat the same memory, and a copy would have {array.size} "
            "numbers; pass a contiguous array"
        )


def contiguous(name: str, array: np.ndarray, dtype: np.dtype) -> np.ndarray:
    """The array itself where it is of this type, aligned and contiguous, else a copy."""
    if array.dtype == dtype and array.flags.c_contiguous and array.flags.aligned:
        return array
    _refuse_repeated(name, array)
    with np.errstate(over="ignore", invalid="ignore"):
        return np.require(array, dtype, ["C", "A"])


def numbers(name: str, value: object, shape: tuple[int, ...]) -> np.ndarray:
    """A contiguous array of doubles of this shape."""
    array = array_of(name, value)
    if not fits(array.shape, shape):
        raise wrong_shape(name, array, shape)
    return contiguous(name, array, DOUBLE)


def indices(name: str, value: object, shape: tuple[int, ...], below: int,
            dtype: type[np.unsignedinteger[Any]]) -> np.ndarray:
    """A new contiguous array of integers 0 .. below - 1, which no other thread can change."""
    array = array_of(name, value)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name}: expected integers, not dtype {array.dtype}")
    if not fits(array.shape, shape):
        raise wrong_shape(name, array, shape)
    _refuse_repeated(name, array)
    if array.size and not (0 <= int(array.min()) and int(array.max()) < below):
        raise ValueError(
            f"{name}: its numbers are {array.min()} to {array.max()}; they must be 0 to {below - 1}"
        )
    return np.array(array, dtype=dtype, order="C", copy=True)


def integer(name: str, value: object, least: int, most: int) -> int:
    if isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name}: expected an integer, not bool")
    try:
        number = operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        raise TypeError(f"{name}: expected an integer, not {type(value).__name__}") from None
    if not least <= number <= most:
        raise ValueError(f"{name}: {number}; it must be {least} to {most}")
    return number


def real(name: str, value: object, *, infinite: bool = False) -> float:
    """A number >= 0."""
    if isinstance(value, (bool, np.bool_)) or not isinstance(
        value, (int, float, np.integer, np.floating)
    ):
        raise TypeError(f"{name}: expected a number, not {type(value).__name__}")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not number >= 0 or (math.isinf(number) and not infinite):
        raise ValueError(f"{name}: {number}; it must be {'' if infinite else 'finite and '}at least 0")
    return number


def address(array: np.ndarray) -> int:
    return int(array.__array_interface__["data"][0])
