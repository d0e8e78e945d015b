"""Whether triangles form a closed surface: every edge belongs to two faces, which traverse it in opposite senses."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats, Integers
from core.errors import InvalidParameter, OpenMesh


def closed(vertices: Floats, faces: Integers) -> Integers:
    """Return the faces if they enclose a volume on a known side; otherwise raise.

    Parameters
    ----------
    vertices : ndarray, shape (n, 3)
        Vertices at the same position are merged if the faces are not closed by their indices alone, as in files that
        repeat the corners of each triangle.
    faces : ndarray, shape (m, 3)
        Indices of vertices.

    Returns
    -------
    ndarray, shape (m, 3)
        The faces, with indices that form a closed surface; read-only.

    Raises
    ------
    OpenMesh
        If an edge belongs to one face only.
    InvalidParameter
        If a face has an index out of range, or an index twice; if a face is given twice; if more than two faces share
        an edge; if two neighbouring faces traverse their edge in the same direction.
    """
    _refuse_wrong_indices(faces, len(vertices))
    if _closes(faces, len(vertices)):
        return faces
    # Adding zero turns -0 into 0.
    _, kept, place = np.unique(vertices + 0.0, axis=0, return_index=True, return_inverse=True)
    joined: Integers = kept[place.reshape(-1)][faces]
    joined.setflags(write=False)
    # A face of which two corners coincide has no area, and does not belong to the surface.
    solid = np.flatnonzero((joined != joined[:, (1, 2, 0)]).all(axis=1))
    if not _closes(joined[solid], len(vertices)):
        _refuse_repeated_faces(joined[solid], solid)
        _refuse_edges(joined[solid], solid)
    return joined


def _closes(faces: Integers, vertices: int) -> bool:
    # An edge with its direction is one integer, so one sort pairs all neighbours.
    start, end = _directed_edges(faces)
    keys = (np.minimum(start, end) * vertices + np.maximum(start, end)) * 2 + (start > end)
    keys.sort()
    if keys.size == 0 or keys.size % 2:
        return False
    forward, backward = keys[0::2], keys[1::2]
    return not (forward & 1).any() and bool((backward == forward + 1).all()) and bool((np.diff(forward) > 0).all())


def _directed_edges(faces: Integers) -> tuple[Integers, Integers]:
    """Return first and last vertices of all edges, each of shape (3 m,); edge e belongs to face e modulo m."""
    return faces.T.ravel(), faces[:, (1, 2, 0)].T.ravel()


def _refuse_wrong_indices(faces: Integers, vertices: int) -> None:
    if faces.max() >= vertices:
        i, k = (int(x) for x in np.argwhere(faces >= vertices)[0])
        remedy = "count the vertices from 0"
        raise InvalidParameter(
            ("faces", i, k), f"be at most {vertices - 1}, the index of the last vertex", remedy=remedy
        )
    a, b, c = faces.T
    repeated = (a == b) | (b == c) | (c == a)
    if repeated.any():
        raise InvalidParameter(
            ("faces", int(np.argmax(repeated))),
            "name three different vertices",
            remedy=f"leave out the {np.count_nonzero(repeated)} faces that name a vertex twice",
        )


def _refuse_repeated_faces(faces: Integers, numbers: Integers) -> None:
    # Starting from its smallest index, a face is the same row whatever its first corner was.
    turned = (np.argmin(faces, axis=1)[:, None] + np.arange(3)) % 3
    rows = np.take_along_axis(faces, turned, axis=1)
    _, first, place = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    repeated = np.flatnonzero(first[place.reshape(-1)] != np.arange(len(rows)))
    if repeated.size:
        i = repeated[0]
        raise InvalidParameter(
            ("faces", int(numbers[i])),
            f"differ from faces/{numbers[first[place.reshape(-1)[i]]]}: it is the same face again",
            remedy=f"give each face once; {repeated.size} are repeated",
        )


def _refuse_edges(faces: Integers, numbers: Integers) -> None:
    start, end = _directed_edges(faces)
    keys = np.minimum(start, end) * (1 + int(faces.max(initial=0))) + np.maximum(start, end)
    order = np.argsort(keys, kind="stable")
    begins = np.flatnonzero(np.diff(keys[order], prepend=-1))
    count = np.diff(begins, append=keys.size)
    direction = np.add.reduceat(np.where(start < end, 1, -1)[order], begins) if keys.size else count
    single, crowded, alike = count == 1, count > 2, (count == 2) & (direction != 0)

    def one_of(kind: NDArray[np.bool_]) -> str:
        # The edge that comes first in the list of faces, not in the order of keys.
        edges = order[begins[kind]]
        e = int(edges[np.argmin(edges % len(faces))])
        return f"one is of faces/{numbers[e % len(faces)]}, from vertex {start[e]} to {end[e]}"

    if not keys.size:
        raise OpenMesh("faces", "close: every face has corners that coincide")
    if single.any():
        more = np.count_nonzero(crowded)
        raise OpenMesh(
            "faces",
            f"close: {np.count_nonzero(single)} of {count.size} edges belong to one face only ({one_of(single)})"
            + (f", and {more} to more than two" if more else ""),
            remedy="close the holes of the surface",
        )
    if crowded.any():
        raise InvalidParameter(
            "faces",
            f"meet in pairs: {np.count_nonzero(crowded)} of {count.size} edges belong to more than two faces "
            f"({one_of(crowded)})",
            remedy="leave inner walls out, and keep surfaces apart that touch in an edge",
        )
    raise InvalidParameter(
        "faces",
        f"all run counter-clockwise as seen from outside: at {np.count_nonzero(alike)} of {count.size} edges both "
        f"faces run in the same direction ({one_of(alike)})",
        remedy="reverse the order of vertices in the faces that are turned over",
    )
