"""Distances and contacts of deforming triangle meshes, by libmote.

A Mesh is a triangle mesh at rest, a Field says how it deforms. Ask with

- Pair: two bodies whose fields are known; the exact distance with a proof of it,
- Stream: two bodies of which only the positions of all vertices are known in each frame,
- Scene: many bodies, and those of them that are near each other.

Vertices are float64 arrays of shape (n, 3), poses float64 matrices of shape (3, 4), rotation beside
translation, or (4, 4). Lengths are in whatever unit the vertices have. Distances are from surface
to surface, and 0 where the surfaces touch or intersect; one body wholly inside the other is at a
positive distance. An array that has the type that the library reads is not copied.

Objects are for one thread at a time: a second one gets RuntimeError. Different objects may be used
by different threads at once, and share meshes and fields; the library runs without the interpreter's
lock. A wrong argument raises TypeError or ValueError, whose text names the argument.
"""

from ._library import VERSION as __version__
from ._library import library_version
from ._mesh import Field, Mesh
from ._pair import Pair
from ._results import Contact, Contacts, Distance, Distances, Near
from ._scene import Scene
from ._stream import Stream

__all__ = [
    "Contact",
    "Contacts",
    "Distance",
    "Distances",
    "Field",
    "Mesh",
    "Near",
    "Pair",
    "Scene",
    "Stream",
    "library_version",
]
