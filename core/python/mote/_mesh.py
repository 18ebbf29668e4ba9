"""Meshes, and how they deform."""

from __future__ import annotations

import ctypes
from typing import Any, Optional

import numpy as np

from . import _library as lib
from ._arrays import (
    ANY,
    address,
    array_of,
    indices,
    integer,
    numbers,
    real,
    wrong_shape,
)


class _Shared:
    """Something that pairs, streams and scenes borrow. Closing it is safe at any time: the
    library's memory is freed when nothing uses it any more."""

    _memory: Optional[lib.Memory]

    def _need(self, name: str) -> lib.Memory:
        memory = self._memory
        if memory is None or not memory.cell:
            raise ValueError(f"{name}: this {type(self).__name__} is closed")
        return memory

    def close(self) -> None:
        """Gives it up; what was made with it keeps working. Closing twice is allowed."""
        self._memory = None

    @property
    def closed(self) -> bool:
        return self._memory is None

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def __reduce__(self) -> Any:
        raise TypeError(f"a {type(self).__name__} belongs to its process and cannot be pickled")


class Mesh(_Shared):
    """A triangle mesh at rest.

    vertices: float64 (n, 3), any unit of length. faces: integers (m, 3), numbers of vertices from 0.
    Both are copied by the library. Open meshes, several components and faces of zero area are
    allowed.

    TypeError, ValueError: not arrays of numbers of these shapes, a coordinate that is not finite, an
    index out of range, a face with a vertex twice, an edge of more than two faces, a vertex in no
    face, no extent at all. Cost: about 0.3 s a million faces.
    """

    def __init__(self, vertices: object, faces: object) -> None:
        self._memory = None
        xyz = numbers("vertices", vertices, (ANY, 3))
        triangles = indices("faces", faces, (ANY, 3), max(len(xyz), 1), np.uint32)
        self._memory = lib.create(
            "vertices, faces", lib.mesh_create, lib.mesh_destroy, (), address(xyz), len(xyz),
            address(triangles), len(triangles),
        )
        data = lib.MeshData.from_address(self._memory.address)
        self._vertex_count = int(data.vertex_count)
        self._face_count = int(data.triangle_count)
        self._components = int(data.component_count)
        self._open_edges = int(data.open_edge_count)
        self._length = float(data.diagonal)

    @property
    def vertex_count(self) -> int:
        return self._vertex_count

    @property
    def face_count(self) -> int:
        return self._face_count

    @property
    def components(self) -> int:
        """How many connected parts there are."""
        return self._components

    @property
    def open_edges(self) -> int:
        """Edges with one face; 0 where the surface is closed."""
        return self._open_edges

    @property
    def length(self) -> float:
        """L: the length of the diagonal of the bounding box at rest."""
        return self._length

    @property
    def nbytes(self) -> int:
        """Bytes that the library holds."""
        held = self._need("mesh")  # another thread may close the mesh
        return int(lib.mesh_bytes(held.address))

    def __repr__(self) -> str:
        return f"Mesh({self._vertex_count} vertices, {self._face_count} faces)"


def mesh_of(name: str, value: object) -> Mesh:
    if not isinstance(value, Mesh):
        raise TypeError(f"{name}: expected a Mesh, not {type(value).__name__}")
    value._need(name)
    return value


class Field(_Shared):
    """How a mesh deforms: made by csrbf, modes, skin or morph, for any number of bodies.

    weights_shape is the shape of the weights of one frame: what the queries take.
    """

    _vertices: Optional[int]  # of the only meshes that it fits; None: any
    _weights: Optional[tuple[int, ...]]  # shape of the library's weights; None: there are none
    _amounts: int  # of morph targets

    def __init__(self) -> None:
        raise TypeError("make a Field by Field.csrbf, modes, skin or morph")

    @classmethod
    def _make(cls, kind: str, memory: lib.Memory, vertices: Optional[int],
              weights: Optional[tuple[int, ...]], amounts: int) -> "Field":
        field = cls.__new__(cls)
        field._memory = memory
        field._kind = kind
        field._vertices = vertices
        field._weights = weights
        field._amounts = amounts
        return field

    _kind: str

    @property
    def kind(self) -> str:
        """"csrbf", "modes", "skin" or "morph"."""
        return self._kind

    @property
    def weights_shape(self) -> Any:
        """The shape of one frame's weights: (centres, 3) of csrbf, (modes,), (bones, 3, 4) of a
        skin, (targets,) of morph targets, and the last two in a tuple of a skin with targets."""
        if self._weights is None:
            return (self._amounts,)
        return (self._weights, (self._amounts,)) if self._amounts else self._weights

    def __repr__(self) -> str:
        return f"Field.{self._kind}(weights {self.weights_shape})"

    @classmethod
    def csrbf(cls, centres: object, support: float) -> "Field":
        """Moves space around control points: vertex x by the sum over centres c of
        phi(|x - c| / support) w_c, where phi(r) = (1 - r)^4 (4 r + 1) for r < 1, else 0.

        centres: float64 (n, 3), 1 to 65,528 of them, in the mesh's axes at rest. support: a
        length, above 5.6e-309. Fits any mesh. A frame's weights: float64 (n, 3), lengths, in the
        mesh's axes, so that they turn with the body's pose.
        """
        points = numbers("centres", centres, (ANY, 3))
        radius = real("support", support)
        memory = lib.create(
            "centres, support", lib.field_csrbf, lib.field_destroy, (), address(points), len(points),
            radius,
        )
        return cls._make("csrbf", memory, None, (len(points), 3), 0)

    @classmethod
    def modes(cls, mesh: Mesh, modes: object) -> "Field":
        """Adds displacements: vertex i moves by the sum over modes m of w_m modes[m, i].

        modes: float64 (m, vertices, 3), lengths, in the mesh's axes. A frame's weights: float64
        (m,), pure numbers; each times the largest coordinate of its mode is at most 2^50 L.
        """
        owner = mesh_of("mesh", mesh)
        vectors = numbers("modes", modes, (ANY, owner.vertex_count, 3))
        memory = lib.create(
            "modes", lib.field_modes, lib.field_destroy, (), address(vectors), len(vectors),
            owner.vertex_count,
        )
        return cls._make("modes", memory, owner.vertex_count, (len(vectors),), 0)

    @classmethod
    def skin(cls, mesh: Mesh, weights: object, bones: object = None, *,
             bone_count: Optional[int] = None, targets: object = None) -> "Field":
        """Linear blend skinning: vertex i is the sum over bones b of weights[i, b] M_b x_i.

        weights: float64 (vertices, bones), >= 0; each vertex has one that is not 0, and they are
        divided by their sum. Or bones: integers (vertices, k), and weights (vertices, k) for the
        bones named there; bone_count is how many bones there are, by default one more than the
        largest number in bones. targets: as of morph, moved before the bones.

        A frame's weights: float64 (bones, 3, 4), or (bones, 4, 4): matrices that take rest
        coordinates to posed ones, before the body's pose; scale and shear are allowed. With
        targets, a tuple of that and an array (targets,); either may be None, for rest.

        The body is the one with the weights that are kept: multiples of 2^-24 that add up to 1 at
        each vertex. Distances are exact, and bounds proven, for that body. By the formula a vertex
        of k bones is elsewhere, by less than k 2^-24 of the largest distance between its images
        M_b x_i.
        """
        owner = mesh_of("mesh", mesh)
        start, bone, weight, count = _influences(owner.vertex_count, weights, bones, bone_count)
        held = owner._need("mesh")
        arrays = (count, address(start), address(bone), address(weight))
        if targets is None:
            memory = lib.create(
                "weights", lib.field_skin, lib.field_destroy, (), held.address, *arrays
            )
            return cls._make("skin", memory, owner.vertex_count, (count, 3, 4), 0)
        given = _targets(owner.vertex_count, targets)
        memory = lib.create(
            "weights, targets", lib.field_morphs, lib.field_destroy, (), held.address, *arrays,
            ctypes.addressof(given.struct),
        )
        return cls._make("skin", memory, owner.vertex_count, (count, 3, 4), given.count)

    @classmethod
    def morph(cls, mesh: Mesh, targets: object) -> "Field":
        """Morph targets (blend shapes): vertex i moves by the sum over k of a_k targets[k, i].

        targets: float64 (k, vertices, 3), displacements in the mesh's axes; zeros cost nothing. A
        frame's weights: the amounts, float64 (k,), pure numbers; each is at most 2^50, and
        times the largest coordinate of its target at most 2^50 L.

        The body is the one with the displacements that are kept: each coordinate to within 2^-24 of
        the largest of its target. Distances are exact, and bounds proven, for that body.
        """
        owner = mesh_of("mesh", mesh)
        given = _targets(owner.vertex_count, targets)
        held = owner._need("mesh")  # another thread may close the mesh
        memory = lib.create(
            "targets", lib.field_morphs, lib.field_destroy, (), held.address, 0, None, None, None,
            ctypes.addressof(given.struct),
        )
        return cls._make("morph", memory, owner.vertex_count, None, given.count)


def _influences(vertices: int, weights: object, bones: object,
                bone_count: Optional[int]) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
    """The bones of each vertex, as mote_field_create_skin takes them."""
    if bones is None:
        table = numbers("weights", weights, (vertices, ANY))
        if not 1 <= table.shape[1] <= 65535:
            raise ValueError(f"weights: a skin has 1 to 65535 bones, not {table.shape[1]}")
        if bone_count is not None:
            raise TypeError("bone_count: it is for skins that are given by bones")
        used = table != 0
        start = np.zeros(vertices + 1, np.uint32)
        np.cumsum(used.sum(axis=1), out=start[1:])
        bone = np.nonzero(used)[1].astype(np.uint16)
        return start, bone, np.ascontiguousarray(table[used]), table.shape[1]
    names = indices("bones", bones, (vertices, ANY), 65535, np.uint16)
    table = numbers("weights", weights, (vertices, names.shape[1]))
    if names.size == 0:
        raise ValueError("bones: each vertex needs at least one bone")
    largest = int(names.max())
    count = largest + 1 if bone_count is None else integer("bone_count", bone_count, 1, 65535)
    if largest >= count:
        raise ValueError(f"bones: bone {largest} of {count}, counted from 0")
    if names.size >= 2**32:
        raise ValueError("bones: there are 2^32 weights or more")
    start = np.arange(0, names.size + 1, names.shape[1], dtype=np.uint32)
    return start, names.reshape(-1), np.array(table, copy=True).reshape(-1), count


class _Targets:
    """Morph targets as the library takes them, and the arrays that they lie in."""

    def __init__(self, count: int, start: np.ndarray, vertex: np.ndarray, move: np.ndarray):
        self.count = count
        self.arrays = (start, vertex, move)
        self.struct = lib.MorphTargets(count, address(start), address(vertex), address(move))


def _targets(vertices: int, targets: object) -> _Targets:
    dense = array_of("targets", targets)
    if dense.ndim != 3 or dense.shape[1:] != (vertices, 3):
        raise wrong_shape("targets", dense, (ANY, vertices, 3))
    if not 1 <= len(dense) <= 65535:
        raise ValueError(f"targets: there must be 1 to 65535, not {len(dense)}")
    dense = numbers("targets", dense, dense.shape)
    moved = (dense != 0).any(axis=2)
    start = np.zeros(len(dense) + 1, np.uint64)
    np.cumsum(moved.sum(axis=1), out=start[1:])
    if start[-1] >= 2**32:
        raise ValueError("targets: they move 2^32 vertices or more")
    vertex = np.nonzero(moved)[1].astype(np.uint32)
    return _Targets(len(dense), start.astype(np.uint32), vertex, np.ascontiguousarray(dense[moved]))


def field_of(name: str, value: object, mesh: Mesh) -> Optional[Field]:
    """A field that fits a mesh, or None."""
    if value is None:
        return None
    if not isinstance(value, Field):
        raise TypeError(f"{name}: expected a Field or None, not {type(value).__name__}")
    value._need(name)
    if value._vertices not in (None, mesh.vertex_count):
        raise ValueError(
            f"{name}: it is of a mesh with {value._vertices} vertices, and this one has "
            f"{mesh.vertex_count}"
        )
    return value
