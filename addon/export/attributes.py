# SPDX-License-Identifier: GPL-3.0-or-later
"""What shader programs ask meshes for by name: UV maps, colours, generated coordinates, tangents and any attribute."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..scene.description import Attribute, Floats
from .translate.surface import ACTIVE_COLOR, ACTIVE_UV, GENERATED, ISLAND, POINTINESS, TANGENT_PREFIX, named

if TYPE_CHECKING:
    import bpy

# The field that holds a value, and how many floats it is, by the kind of an attribute.
FIELDS = {
    "FLOAT": ("value", 1),
    "INT": ("value", 1),
    "INT8": ("value", 1),
    "BOOLEAN": ("value", 1),
    "FLOAT_VECTOR": ("vector", 3),
    "FLOAT2": ("vector", 2),
    "FLOAT_COLOR": ("color", 4),
    "BYTE_COLOR": ("color", 4),
}
BYTES_FROM = (5, 0)  # Cycles 3.4 does not know numbers of 8 bits, that of 5.0 does
WEIGHTS_FROM = (4, 2)  # that of 4.2 knows vertex groups as attributes, that of 3.4 does not
DOMAINS = ("POINT", "EDGE", "CORNER", "FACE")


def has_weights() -> bool:
    """Whether Cycles knows vertex groups as attributes."""
    import bpy

    return bpy.app.version >= WEIGHTS_FROM


def is_known(data_type: str) -> bool:
    """Whether Cycles knows attributes of a kind."""
    import bpy

    return data_type in FIELDS and (data_type != "INT8" or bpy.app.version >= BYTES_FROM)


def numbers(attribute: bpy.types.Attribute) -> Floats:
    """(n, 1 to 4) float32, of an attribute of a kind in FIELDS."""
    field, width = FIELDS[attribute.data_type]
    kind = {"INT": np.int32, "INT8": np.int32, "BOOLEAN": np.bool_}.get(attribute.data_type, np.float32)
    values: NDArray[Any] = np.empty(width * len(attribute.data), kind)
    attribute.data.foreach_get(field, values)
    return values.astype(np.float32, copy=False).reshape(-1, width)


def colors(attribute: bpy.types.Attribute | None) -> NDArray[np.float32] | None:
    """(n, 4), as Blender makes colours of an attribute; None for none, and of kinds which are no colours."""
    if attribute is None or attribute.data_type not in FIELDS:
        return None
    values = numbers(attribute)
    width = values.shape[1]
    result = np.zeros((len(values), 4), np.float32)
    result[:, : 3 if width == 1 else width] = values
    if width < 4:
        result[:, 3] = 1.0
    return result


class AttributeReader:
    """The attributes of a mesh whose triangles were made, by the names that programs have for them."""

    def __init__(
        self,
        mesh: bpy.types.Mesh,
        corners: NDArray[np.int32],
        corner_vertices: NDArray[np.int32],
        vertex_groups: tuple[str, ...] = (),
    ) -> None:
        """vertex_groups: the names of its object's."""
        self._mesh, self._groups = mesh, vertex_groups
        self._corners = corners.reshape(-1)  # of the triangles, one after another
        self._corner_vertices = corner_vertices

    def read(self, names: frozenset[str]) -> tuple[Attribute, ...]:
        found = []
        for name in sorted(names):
            values = self._values(name)
            if values is not None:
                domain, rows = values
                rows = np.ascontiguousarray(np.nan_to_num(rows), np.float32)
                found.append(Attribute(name, domain, rows))
        return tuple(found)

    def _values(self, name: str) -> tuple[str, Floats] | None:
        if name == GENERATED:
            return "corner", self._generated()[self._corner_vertices[self._corners]]
        if name == ACTIVE_UV:
            layer = next((layer for layer in self._mesh.uv_layers if layer.active_render), None)
            return None if layer is None else ("corner", self._uv(layer))
        if name == ACTIVE_COLOR:
            return self._color(self._active_color())
        if name.startswith(TANGENT_PREFIX):
            return self._tangents(name[len(TANGENT_PREFIX) :])
        if name == ISLAND:
            return "face", self._islands()
        if name == POINTINESS:
            return "corner", self._pointiness()[self._corner_vertices[self._corners]]
        if not name.startswith(named("")):
            return None  # of instances
        own = name[len(named("")) :]
        layer = self._mesh.uv_layers.get(own)
        if layer is not None:
            return "corner", self._uv(layer)
        attribute = self._mesh.attributes.get(own)
        if attribute is None and own in self._groups and has_weights():
            return "corner", self._weights(self._groups.index(own))[self._corner_vertices[self._corners]]
        return None if attribute is None else self._color(attribute)

    def _weights(self, number: int) -> Floats:
        """(vertices, 1): of a vertex group."""
        weights = np.zeros((len(self._mesh.vertices), 1), np.float32)
        for index, vertex in enumerate(self._mesh.vertices):
            for element in vertex.groups:
                if element.group == number:
                    weights[index] = element.weight
        return weights

    def _generated(self) -> Floats:
        """(vertices, 3): the place in the mesh's texture space, before modifiers where Blender kept it."""
        vertices = self._mesh.vertices
        rest = np.empty(3 * len(vertices), np.float32)
        vertices.foreach_get("undeformed_co", rest)
        scale, offset = texture_space(self._mesh)
        return rest.reshape(-1, 3) * scale + offset

    def _edges(self) -> NDArray[np.int32]:
        """(edges, 2)."""
        edges = np.empty(2 * len(self._mesh.edges), np.int32)
        self._mesh.edges.foreach_get("vertices", edges)
        return edges.reshape(-1, 2)

    def _pointiness(self) -> Floats:
        """(vertices, 1)."""
        positions, normals = (np.empty(3 * len(self._mesh.vertices), np.float32) for _ in range(2))
        self._mesh.vertices.foreach_get("co", positions)
        self._mesh.vertices.foreach_get("normal", normals)
        return pointiness(positions.reshape(-1, 3), normals.reshape(-1, 3), self._edges()).astype(np.float32)[:, None]

    def _islands(self) -> Floats:
        """(triangles, 1): a number of 0 to 1 that all triangles of a connected part share."""
        roots = np.array(island_roots(len(self._mesh.vertices), self._edges().tolist()), np.uint32)
        first = self._corner_vertices[self._corners.reshape(-1, 3)[:, 0]]
        return (hash_words(roots[first]) / np.float64(0xFFFFFFFF)).astype(np.float32)[:, None]

    def _uv(self, layer: Any) -> Floats:
        values = np.empty(2 * len(layer.data), np.float32)
        layer.data.foreach_get("uv", values)
        return values.reshape(-1, 2)[self._corners]

    def _active_color(self) -> Any:
        colors = self._mesh.color_attributes
        number = getattr(colors, "render_color_index", -1)
        return colors[number] if 0 <= number < len(colors) else colors.active_color

    def _color(self, attribute: Any) -> tuple[str, Floats] | None:
        """Of an attribute of any kind."""
        if attribute is None or not is_known(attribute.data_type) or attribute.domain not in DOMAINS:
            return None
        values = numbers(attribute)
        if attribute.domain == "EDGE":
            values = mean_at_vertices(values, self._edges(), len(self._mesh.vertices))
        if attribute.domain in ("POINT", "EDGE"):
            return "corner", values[self._corner_vertices[self._corners]]
        if attribute.domain == "CORNER":
            return "corner", values[self._corners]
        polygons = np.empty(len(self._mesh.loop_triangles), np.int32)
        self._mesh.loop_triangles.foreach_get("polygon_index", polygons)
        return "face", values[polygons]

    def _tangents(self, uv_map: str) -> tuple[str, Floats] | None:
        """(corners, 4): along the first texture coordinate, and the sign of the second."""
        layers = self._mesh.uv_layers
        layer = layers.get(uv_map) if uv_map else next((item for item in layers if item.active_render), None)
        if layer is None:
            return None
        loops = self._mesh.loops
        normals = np.empty(3 * len(loops), np.float32)
        loops.foreach_get("normal", normals)
        positions = np.empty(3 * len(self._mesh.vertices), np.float32)
        self._mesh.vertices.foreach_get("co", positions)
        vertices = self._corner_vertices[self._corners]
        return "corner", corner_tangents(
            positions.reshape(-1, 3)[vertices], normals.reshape(-1, 3)[self._corners], self._uv(layer)
        )


def texture_space(mesh: bpy.types.Mesh) -> tuple[Floats, Floats]:
    """(3,) each: generated coordinates are a place in the mesh times the first, plus the second."""
    location, size = (np.array(getattr(mesh, f"texspace_{what}"), np.float64) for what in ("location", "size"))
    inverse = np.where(size != 0.0, 0.5 / np.where(size != 0.0, size, 1.0), 0.0)
    return inverse, 0.5 - location * inverse


def mean_at_vertices(values: Floats, edges: NDArray[np.integer], count: int) -> Floats:
    """(edges, width) -> (vertices, width): the mean over each vertex's edges, 0 where it has none."""
    ends, rows = edges.reshape(-1), np.repeat(values, 2, axis=0)
    sums = np.stack([np.bincount(ends, column, count) for column in rows.T], axis=1)
    return np.asarray(sums / np.maximum(np.bincount(ends, minlength=count), 1)[:, None])


def pointiness(positions: Floats, normals: Floats, edges: NDArray[np.integer]) -> Floats:
    """(vertices,): how far a mesh juts out, as Blender's renderers have it: the angle between the normal and the mean
    direction of a vertex's edges, over pi, and then the mean of it and of its neighbours'. Vertices of one place are
    one.

    positions, normals (vertices, 3), edges (edges, 2)."""
    _, first, same = np.unique(positions + np.float32(0.0), axis=0, return_index=True, return_inverse=True)
    same = same.reshape(-1)
    places = positions[first].astype(np.float64)
    own = _unit(np.stack([np.bincount(same, normals[:, i], len(places)) for i in range(3)], axis=1))
    ends = np.unique(np.sort(same[edges], axis=1), axis=0)
    ends = ends[ends[:, 0] != ends[:, 1]]
    starts, stops = np.concatenate([ends, ends[:, ::-1]]).T
    along = _unit(places[stops] - places[starts])
    count = np.bincount(starts, minlength=len(places))
    sums = np.stack([np.bincount(starts, along[:, i], len(places)) for i in range(3)], axis=1)
    means = sums / np.maximum(count, 1)[:, None]
    sharpness = np.where(count > 0, np.arccos(np.clip((own * means).sum(axis=1), -1.0, 1.0)) / np.pi, 0.0)
    around = np.bincount(starts, sharpness[stops], len(places))
    return np.asarray(((sharpness + around) / (count + 1))[same])


def island_roots(count: int, edges: list[list[int]]) -> list[int]:
    """For each vertex that which stands for its island, chosen as Blender's renderers choose it: sets are joined in the
    order of the edges, the lower under the higher, the second under the first of equals."""
    parent, rank = list(range(count)), [0] * count

    def root(x: int) -> int:
        while parent[x] != x:
            parent[x] = parent[parent[x]]
            x = parent[x]
        return x

    for a, b in edges:
        x, y = root(a), root(b)
        if x == y:
            continue
        if rank[x] < rank[y]:
            x, y = y, x
        parent[y] = x
        rank[x] += rank[x] == rank[y]
    return [root(x) for x in range(count)]


def hash_words(words: NDArray[np.uint32]) -> NDArray[np.uint32]:
    """Bob Jenkins' lookup3 of one word each."""
    start = np.uint32(0xDEADBEEF + (1 << 2) + 13)
    a, b, c = words + start, np.full_like(words, start), np.full_like(words, start)

    def mixed(x: NDArray[np.uint32], y: NDArray[np.uint32], bits: int) -> NDArray[np.uint32]:
        return (x ^ y) - ((y << np.uint32(bits)) | (y >> np.uint32(32 - bits)))

    with np.errstate(over="ignore"):
        for bits in (14, 11, 25, 16, 4, 14, 24):
            c = mixed(c, b, bits)
            a, b, c = b, c, a
    return b


def corner_tangents(positions: Floats, normals: Floats, uvs: Floats) -> Floats:
    """The tangents of Mikkelsen's thesis (Simulation of Wrinkled Surfaces Revisited, 2008), of triangles, as Blender's
    renderers have them: along the first texture coordinate, and the sign of the second.

    positions, normals (3 t, 3), uvs (3 t, 2): of corners. Returns (3 t, 4). Corners of one place, normal, texture
    coordinate and handedness share the mean of their triangles' tangents, weighed by their angles.
    """
    p, uv = positions.reshape(-1, 3, 3).astype(np.float64), uvs.reshape(-1, 3, 2).astype(np.float64)
    e1, e2 = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    d1, d2 = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    area = d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0]
    along = (e1 * d2[:, 1:] - e2 * d1[:, 1:]) * np.where(area < 0.0, -1.0, 1.0)[:, None]
    signs = np.repeat(np.where(area < 0.0, -1.0, 1.0), 3)
    n = normals.astype(np.float64)
    tangents = _unit(_across(np.repeat(along, 3, axis=0), n))
    ahead = _unit(_across(np.roll(p, -1, axis=1).reshape(-1, 3) - p.reshape(-1, 3), n))
    behind = _unit(_across(np.roll(p, 1, axis=1).reshape(-1, 3) - p.reshape(-1, 3), n))
    angles = np.arccos(np.clip((ahead * behind).sum(axis=1), -1.0, 1.0)) * np.repeat(area != 0.0, 3)
    keys = np.concatenate([positions, normals, uvs, signs[:, None]], axis=1).astype(np.float32) + np.float32(0.0)
    _, group = np.unique(keys, axis=0, return_inverse=True)
    group = group.reshape(-1)
    weighed = tangents * angles[:, None]
    sums = np.stack([np.bincount(group, weighed[:, axis]) for axis in range(3)], axis=1)
    return np.concatenate([_unit(sums)[group], signs[:, None]], axis=1).astype(np.float32)


def _across(vectors: Floats, normals: Floats) -> Floats:
    return vectors - normals * (vectors * normals).sum(axis=1, keepdims=True)


def _unit(vectors: NDArray[Any]) -> Floats:
    lengths = np.sqrt((vectors**2).sum(axis=1, keepdims=True))
    return vectors / np.where(lengths > 0.0, lengths, 1.0)
