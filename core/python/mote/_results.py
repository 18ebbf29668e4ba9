"""What queries answer."""

from __future__ import annotations

from typing import NamedTuple, Optional

import numpy as np


class Distance(NamedTuple):
    """The distance of two bodies in a frame."""

    #: From surface to surface, between the witnesses; exact unless slack, budget or coordinates
    #: from 2.8e17 L on ended the query.
    distance: float
    #: A proven bound: no two points of the bodies are nearer.
    lower: float
    #: float64 (2, 3): the points on body a and body b, in the world.
    witness: np.ndarray


class Contact(NamedTuple):
    """Whether two bodies are within the tolerance of each other in a frame."""

    #: None where slack, budget or coordinates from 2.8e17 L on ended the query before it was
    #: decided.
    contact: Optional[bool]
    #: Of the witnesses: an upper bound, since the query ends when contact is decided.
    distance: float
    #: A proven bound: no two points of the bodies are nearer.
    lower: float
    #: float64 (2, 3): the points on body a and body b, in the world.
    witness: np.ndarray


class Distances(NamedTuple):
    """Distance of many frames."""

    #: float64 (frames,)
    distance: np.ndarray
    #: float64 (frames,)
    lower: np.ndarray
    #: float64 (frames, 2, 3)
    witness: np.ndarray


class Contacts(NamedTuple):
    """Contact of many frames."""

    #: int8 (frames,): 1 contact, 0 none, -1 where slack, budget or coordinates from 2.8e17 L on
    #: ended the query before
    contact: np.ndarray
    #: float64 (frames,)
    distance: np.ndarray
    #: float64 (frames,)
    lower: np.ndarray
    #: float64 (frames, 2, 3)
    witness: np.ndarray


class Near(NamedTuple):
    """The pairs of a scene's bodies that are near each other."""

    #: uint32 (n, 2): i < j, ascending
    pairs: np.ndarray
    #: bool (n,): distance <= tolerance. Coordinates from 2.8e17 L on may leave that open: it is
    #: True then, with a distance above the tolerance.
    contact: np.ndarray
    #: float64 (n,): exact; an upper bound in a scene that asks for contacts
    distance: np.ndarray
    #: float64 (n,)
    lower: np.ndarray
    #: float64 (n, 2, 3): the points on body i and body j, in the world
    witness: np.ndarray
