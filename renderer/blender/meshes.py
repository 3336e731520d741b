"""Meshes as arrays: for each material the triangles that have it, with normals where any face is smooth, and with the
coordinates that the material's pictures are laid out by."""

from collections import namedtuple

import numpy as np

from .atlas import Corners
from .materials import IN_SPACE

SURFACES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}

# positions, normals: (count, 3), or of a mesh that deforms (steps, count, 3), and then at_frame has those of the frame, else
# None. corners: of a part whose textures are made in space, else None. tangents: (count, 3) of one that is brushed, or None.
Part = namedtuple("Part", "slot positions triangles normals uvs corners at_frame tangents", defaults=(None, None, None))

# A mesh at one time: positions of its vertices, normals of its loops (or None), and the vertices of the loops.
Pose = namedtuple("Pose", "positions normals loop_vertices")


def _array(collection, name, width, dtype):
    values = np.empty(len(collection) * width, dtype)
    collection.foreach_get(name, values)
    return values.reshape(-1, width) if width > 1 else values


def _uvs(mesh, name):
    """Of the loops; zeros where there is no such map, as in Blender."""
    if name:
        layer = mesh.uv_layers.get(name)
    else:
        layer = next((candidate for candidate in mesh.uv_layers if candidate.active_render), None)
    return _array(layer.data, "uv", 2, np.float32) if layer else np.zeros((len(mesh.loops), 2), np.float32)


def _box(mesh, points, loop_count):
    """As Cycles projects a picture onto the six sides of a box, for each loop by its face's normal."""
    normals = _array(mesh.polygons, "normal", 3, np.float32)[_faces_of_loops(mesh, loop_count)]
    axis = np.abs(normals).argmax(axis=-1)
    is_ahead = np.take_along_axis(normals, axis[:, None], 1)[:, 0] > 0
    x, y, z = points.T
    u, v = np.choose(axis, [y, x, y]), np.choose(axis, [z, z, x])
    return np.stack([np.where(np.choose(axis, [~is_ahead, is_ahead, is_ahead]), 1 - u, u), v], -1)


def _generated(positions):
    low, high = positions.min(axis=0), positions.max(axis=0)
    return np.where(high > low, (positions - low) / np.maximum(high - low, 1e-30), 0.5)


def _layout(mesh, how, positions, loop_vertices):
    """The coordinates of a material's pictures, of the loops; how: None, or as Graph.layout in nodes.py gives it."""
    if not how:
        return None
    (source, name, projection), matrix = how
    if source == "UV":
        uvs = _uvs(mesh, name)
        space = np.concatenate([uvs, np.zeros((len(uvs), 1), np.float32)], 1)
    else:
        space = positions
        if source == "GENERATED":
            space = _generated(positions)
        space = space[loop_vertices]
    points = space @ matrix[:, :3].T + matrix[:, 3]
    points = _box(mesh, points, len(loop_vertices)) if projection == "BOX" else points[:, :2]
    return np.ascontiguousarray(points, np.float32)


def _faces_of_loops(mesh, loop_count):
    starts, counts = _array(mesh.polygons, "loop_start", 1, np.int32), _array(mesh.polygons, "loop_total", 1, np.int32)
    face_of = np.empty(loop_count, np.int64)
    at = np.repeat(starts - np.cumsum(counts) + counts, counts) + np.arange(counts.sum())  # loops, face by face
    face_of[at] = np.repeat(np.arange(len(starts)), counts)
    return face_of


def _tangents(mesh, how, positions, loop_vertices, triangles):
    """Of the loops, not yet along the surface, into which the renderer turns them; how: as closures.tangent_of gives it, or
    None. Around an axis they are Cycles'; of a map they are the means around a vertex of those of its triangles whose map is
    not mirrored, or that of the others."""
    if how is None:
        return None
    if how[0] == "RADIAL":
        along = np.zeros((len(positions), 3), np.float32)
        ahead, aside = (how[1] + 1) % 3, (how[1] + 2) % 3
        centred = _generated(positions) - 0.5
        along[:, ahead], along[:, aside] = -centred[:, aside], centred[:, ahead]
        return along[loop_vertices]
    corners, uvs = positions[loop_vertices[triangles]].astype(np.float64), _uvs(mesh, how[1])[triangles].astype(np.float64)
    edges, sides = corners[:, 1:] - corners[:, :1], uvs[:, 1:] - uvs[:, :1]
    area = sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 1, 0] * sides[:, 0, 1]
    along = _unit((edges[:, 0] * sides[:, 1, 1:] - edges[:, 1] * sides[:, 0, 1:]) * np.sign(area)[:, None])
    keys = 2 * loop_vertices[triangles] + (area < 0)[:, None]
    sums = np.stack([np.bincount(keys.ravel(), np.repeat(along[:, axis], 3), 2 * len(positions)) for axis in range(3)], -1)
    made = np.zeros((len(loop_vertices), 3), np.float32)
    made[triangles] = _unit(sums)[keys]
    return made


def _unit(vectors):
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-30)


def _plain_normals(mesh, positions, loop_vertices, is_smooth):
    """Of the loops: at smooth faces the mean of the normals around the vertex by their angles. Blender's own are the same
    but for the order in which its threads add, so that their last bits differ from time to time."""
    starts, counts = _array(mesh.polygons, "loop_start", 1, np.int32), _array(mesh.polygons, "loop_total", 1, np.int32)
    faces = _array(mesh.polygons, "normal", 3, np.float32).astype(np.float64)
    face_of = _faces_of_loops(mesh, len(loop_vertices))
    loops = np.arange(len(loop_vertices))
    first, last = starts[face_of], (starts + counts - 1)[face_of]
    corners = positions[loop_vertices].astype(np.float64)
    before = _unit(corners[np.where(loops == first, last, loops - 1)] - corners)
    after = _unit(corners[np.where(loops == last, first, loops + 1)] - corners)
    angles = np.arccos(np.clip((before * after).sum(axis=-1), -1, 1))
    weighted = faces[face_of] * angles[:, None]
    sums = [np.bincount(loop_vertices, weighted[:, axis], len(positions)) for axis in range(3)]
    smooth = _unit(np.stack(sums, -1))[loop_vertices]
    return np.where(is_smooth[face_of][:, None], smooth, faces[face_of]).astype(np.float32)


def _normals(mesh, positions, loop_vertices):
    """Of the loops; None where all faces are flat."""
    is_smooth = _array(mesh.polygons, "use_smooth", 1, bool)
    if not is_smooth.any():
        return None
    if mesh.use_auto_smooth or mesh.has_custom_normals:
        mesh.calc_normals_split()
        return _array(mesh.loops, "normal", 3, np.float32)
    return _plain_normals(mesh, positions, loop_vertices, is_smooth)


def pose_of(mesh, before=None):
    """The mesh as it is now; `before` itself, an earlier pose, where it has not changed."""
    positions = _array(mesh.vertices, "co", 3, np.float32)
    loop_vertices = _array(mesh.loops, "vertex_index", 1, np.int32)
    if before and np.array_equal(positions, before.positions) and np.array_equal(loop_vertices, before.loop_vertices):
        return before
    return Pose(positions, _normals(mesh, positions, loop_vertices), loop_vertices)


def _agree(poses, normals, loop_vertices):
    """Whether all poses are of one mesh, but for where its vertices are."""
    return all(pose and np.array_equal(pose.loop_vertices, loop_vertices) and (pose.normals is None) == (normals is None)
               and len(pose.positions) == len(poses[0].positions) for pose in poses)


class _Vertices:
    """Positions of a mesh's vertices and normals of its loops (or None), at the frame and, where the mesh deforms, at each
    step."""

    def __init__(self, positions, normals, poses):
        self._at_frame = positions, normals
        self._moving = None
        if poses:
            self._moving = (np.stack([pose.positions for pose in poses]),
                            None if normals is None else np.stack([pose.normals for pose in poses]))

    def part(self, slot, vertices, loops, triangles, uvs, corners=None, tangents=None):
        """Of these vertices and loops, in this order; tangents: of all loops."""
        def chosen(values):
            positions, normals = values
            return positions[..., vertices, :], None if normals is None else normals[..., loops, :]

        positions, normals = chosen(self._moving or self._at_frame)
        return Part(int(slot), positions, triangles.astype(np.int32), normals, uvs, corners,
                    chosen(self._at_frame) if self._moving else None, None if tangents is None else tangents[loops])


def _part_in_space(mesh, slot, chosen, positions, loop_vertices, vertices_of, tangents):
    """No two triangles have a vertex in common."""
    vertices = loop_vertices[chosen]
    uvs = {layer.name: _array(layer.data, "uv", 2, np.float32)[chosen] for layer in mesh.uv_layers}
    uvs[""] = _uvs(mesh, "")[chosen]
    corners = Corners(positions[vertices], _generated(positions)[vertices], uvs)
    return vertices_of.part(slot, vertices.ravel(), chosen.ravel(), np.arange(chosen.size).reshape(-1, 3), None, corners,
                            tangents)


def parts_of(mesh, layouts, poses=None, tangents=()):
    """The parts of an evaluated mesh, and whether they are as it was asked. layouts: for each material slot how its pictures
    are laid out (see _layout), or IN_SPACE. poses: of the mesh from the opening of the shutter to its closing; where they
    are not of this mesh the parts are at rest, which is not as it was asked. tangents: for each slot as _tangents takes it."""
    mesh.calc_loop_triangles()
    if not mesh.loop_triangles:
        return [], True
    positions = _array(mesh.vertices, "co", 3, np.float32)
    loop_vertices = _array(mesh.loops, "vertex_index", 1, np.int32)
    triangles = _array(mesh.loop_triangles, "loops", 3, np.int32)
    slots = _array(mesh.loop_triangles, "material_index", 1, np.int32)
    normals = _normals(mesh, positions, loop_vertices)
    agree = not poses or _agree(poses, normals, loop_vertices)
    vertices_of = _Vertices(positions, normals, poses if agree else None)
    parts = []
    slots = np.clip(slots, 0, max(len(layouts) - 1, 0))
    for slot in np.unique(slots):
        chosen = triangles[slots == slot]
        along = _tangents(mesh, tangents[slot] if tangents else None, positions, loop_vertices, triangles)
        if layouts and layouts[slot] == IN_SPACE:
            parts.append(_part_in_space(mesh, slot, chosen, positions, loop_vertices, vertices_of, along))
            continue
        uvs = _layout(mesh, layouts[slot] if layouts else None, positions, loop_vertices)
        if normals is None and uvs is None and along is None:
            used, indices = np.unique(loop_vertices[chosen], return_inverse=True)
            parts.append(vertices_of.part(slot, used, None, indices, None))
            continue
        used, indices = np.unique(chosen, return_inverse=True)
        parts.append(vertices_of.part(slot, loop_vertices[used], used, indices, None if uvs is None else uvs[used],
                                      tangents=along))
    return parts, agree


def at_rest(part):
    """The part as it is at the frame."""
    if part.at_frame is None:
        return part
    positions, normals = part.at_frame
    return part._replace(positions=positions, normals=normals, at_frame=None)


def parameters_of(part):
    """As those of a shape "trianglemesh"."""
    parameters = {"point3 P": part.positions, "integer indices": part.triangles}
    if part.positions.ndim == 3:
        parameters["integer motionsteps"] = len(part.positions)
    if part.normals is not None:
        parameters["normal N"] = part.normals
    if part.tangents is not None:
        steps = len(part.positions) if part.positions.ndim == 3 else 1
        parameters["vector3 S"] = np.tile(part.tangents, (steps, 1))
    if part.uvs is not None:
        parameters["point2 uv"] = part.uvs
    return parameters
