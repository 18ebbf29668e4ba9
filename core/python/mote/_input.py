"""Poses and weights as the library takes them: of one frame into memory of their own, of many
frames borrowed from arrays that the library can read."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional

import numpy as np

from ._arrays import (
    ANY,
    DOUBLE,
    address,
    array_of,
    contiguous,
    fits,
    wrong_shape,
)
from ._library import Controls
from ._mesh import Field

IDENTITY = np.eye(4)[:3]


class Framed(NamedTuple):
    """An array of numbers of each frame."""

    array: np.ndarray
    frames: Optional[int]  # None: the same in every frame
    step: int  # numbers from one frame's to the next one's


def _is_borrowable(array: np.ndarray, inner: int) -> bool:
    """Whether the last `inner` dimensions are contiguous doubles."""
    if array.dtype != DOUBLE or not array.flags.aligned or array.size == 0:
        return False
    step = 8
    for axis in range(array.ndim - 1, array.ndim - 1 - inner, -1):
        if array.shape[axis] > 1 and array.strides[axis] != step:
            return False
        step *= array.shape[axis]
    return array.ndim == inner or (array.strides[0] >= 0 and array.strides[0] % 8 == 0)


def framed(name: str, array: np.ndarray, shape: tuple[int, ...]) -> Framed:
    """An array of this shape, or of (frames, *shape)."""
    several = array.ndim == len(shape) + 1
    wanted = (ANY, *shape) if several else shape
    if not fits(array.shape, wanted):
        raise wrong_shape(name, array, shape, (ANY, *shape))
    if not _is_borrowable(array, len(shape)):
        array = contiguous(name, array, DOUBLE)
    if not several:
        return Framed(array, None, 0)
    return Framed(array, len(array), array.strides[0] // 8 if len(array) > 1 else 0)


def _affine(name: str, array: np.ndarray) -> np.ndarray:
    """Matrices (..., 4, 4) without their last rows, which must be 0 0 0 1."""
    if array.shape[-2:] != (4, 4):
        return array
    if not (array[..., 3, :] == (0, 0, 0, 1)).all():
        raise ValueError(f"{name}: the last row of a matrix must be 0 0 0 1")
    return array[..., :3, :]


def pair_of(name: str, value: object) -> tuple[Any, Any]:
    """One value for each body."""
    if value is None:
        return None, None
    if not isinstance(value, (tuple, list)):
        raise TypeError(
            f"{name}: expected a tuple of two, one for each body, not {type(value).__name__}"
        )
    if len(value) != 2:
        raise ValueError(f"{name}: expected a tuple of two, one for each body, not {len(value)}")
    return value[0], value[1]


class BodyWeights:
    """The weights of one body: what its field takes, and checks of it."""

    def __init__(self, field: Optional[Field]) -> None:
        self.shape = field._weights if field else None
        self.amounts = field._amounts if field else 0
        self.rest = np.zeros(self.shape if self.shape else 0)
        if self.shape and len(self.shape) == 3:
            self.rest[...] = IDENTITY
        #: The shape of a single array that is all of a frame; None: there are none or two.
        self.plain: Optional[tuple[int, ...]] = self.shape
        if self.amounts:
            self.plain = None if self.shape else (self.amounts,)

    def parts(self, name: str, value: object) -> tuple[Any, Any]:
        """The library's weights and amounts in what a caller gave."""
        if value is None:
            return None, None
        if not self.shape and not self.amounts:
            raise ValueError(f"{name}: this body has no field; it must be None")
        if self.shape and self.amounts:
            if not isinstance(value, tuple) or len(value) != 2:
                raise TypeError(f"{name}: expected a tuple of matrices and amounts of targets")
            return value[0], value[1]
        return (value, None) if self.shape else (None, value)

    def framed(self, name: str, value: object) -> tuple[Optional[Framed], Optional[Framed]]:
        """Weights and amounts, of one frame or of many."""
        weights, amounts = self.parts(name, value)
        first = second = None
        if weights is not None:
            assert self.shape is not None
            array = array_of(name, weights)
            if len(self.shape) == 3:
                array = _affine(name, array)
            first = framed(name, array, self.shape)
        if amounts is not None:
            second = framed(name, array_of(name, amounts), (self.amounts,))
        return first, second


def pose_framed(name: str, value: object) -> Framed:
    """A pose, or one of each frame."""
    array = array_of(name, value)
    rows = 4 if array.shape[-2:] == (4, 4) else 3
    return framed(name, array, (rows, 4))


def fill(controls: Controls, pose: Optional[Framed], weights: Optional[Framed],
         amounts: Optional[Framed], first: int) -> None:
    """Points the library's struct at arrays, from a frame on."""
    for member, given in (("pose", pose), ("weights", weights), ("amounts", amounts)):
        if given is None:
            setattr(controls, member, None)
            setattr(controls, member + "_step", 0)
        else:
            setattr(controls, member, address(given.array) + 8 * first * given.step)
            setattr(controls, member + "_step", given.step)
    controls.pose_rows = 3 if pose is None else pose.array.shape[-2]


def named_frames(name: str, parts: tuple[Optional[Framed], Optional[Framed]]) -> dict[str, Optional[int]]:
    """The frames of weights and amounts, as BodyWeights.framed gives them, by their names in errors."""
    return {part: given.frames for part, given in zip((name, f"amounts in {name}"), parts)
            if given is not None}


def count_frames(named: dict[str, Optional[int]], what: str = "frames") -> int:
    """The number of frames that arrays agree on; None is of an array without frames."""
    counts = {name: count for name, count in named.items() if count is not None}
    if not counts:
        raise ValueError("no array has a first dimension of frames; use distance for one frame")
    first = next(iter(counts))
    for name, count in counts.items():
        if count != counts[first]:
            raise ValueError(
                f"{name}: it has {count} {what}, and {first} has {counts[first]}"
            )
    return counts[first]
