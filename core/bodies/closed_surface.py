"""Whether triangles close: every edge belongs to two faces, which run along it in opposite directions."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from core.errors import InvalidParameter, OpenMesh

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


def refuse_unless_closed(vertices: Floats, faces: Integers) -> None:
    """Refuse a triangulated surface that does not enclose a volume on a known side.

    Parameters
    ----------
    vertices : ndarray, shape (n, 3)
        Used only to say whether vertices coincide.
    faces : ndarray, shape (m, 3)
        Indices of vertices.

    Raises
    ------
    OpenMesh
        If an edge belongs to one face only.
    InvalidParameter
        If a face names a vertex that there is not, or one twice; if a face is given twice; if more than two faces share
        an edge; if two neighbours run along their edge in the same direction.
    """
    _refuse_wrong_indices(faces, len(vertices))
    # An edge and the direction in which a face runs along it are one whole number, so one sort pairs all neighbours.
    start, end = _directed_edges(faces)
    keys = (np.minimum(start, end) * len(vertices) + np.maximum(start, end)) * 2 + (start > end)
    keys.sort()
    if keys.size % 2 == 0:
        forward, backward = keys[0::2], keys[1::2]
        if not (forward & 1).any() and (backward == forward + 1).all() and (np.diff(forward) > 0).all():
            return
    _refuse_repeated_faces(faces)
    _refuse_edges(vertices, faces)


def _directed_edges(faces: Integers) -> tuple[Integers, Integers]:
    """Return first and last vertices of all edges, each of shape (3 m,); edge e belongs to face e modulo m."""
    return faces.T.ravel(), faces[:, (1, 2, 0)].T.ravel()


def _refuse_wrong_indices(faces: Integers, vertices: int) -> None:
    if faces.max() >= vertices:
        i, k = (int(x) for x in np.argwhere(faces >= vertices)[0])
        raise InvalidParameter(("faces", i, k), f"be at most {vertices - 1}, the index of the last vertex")
    a, b, c = faces.T
    repeated = (a == b) | (b == c) | (c == a)
    if repeated.any():
        raise InvalidParameter(
            ("faces", int(np.argmax(repeated))),
            "name three different vertices",
            remedy=f"leave out the {np.count_nonzero(repeated)} faces that name a vertex twice",
        )


def _refuse_repeated_faces(faces: Integers) -> None:
    # Written from its smallest index on, a face is the same row whichever corner it was started from.
    turned = (np.argmin(faces, axis=1)[:, None] + np.arange(3)) % 3
    rows = np.take_along_axis(faces, turned, axis=1)
    order = np.lexsort((rows[:, 2], rows[:, 1], rows[:, 0]))
    same = (rows[order[1:]] == rows[order[:-1]]).all(axis=1)
    if same.any():
        # The sort is stable, so the second of two equal rows is the later face.
        later = order[1:][same]
        i = int(later.min())
        first = int(order[np.nonzero((rows[order] == rows[i]).all(axis=1))[0][0]])
        raise InvalidParameter(
            ("faces", i),
            f"differ from faces/{first}: it is the same face again",
            remedy=f"give each face once; {later.size} are repeated",
        )


def _refuse_edges(vertices: Floats, faces: Integers) -> None:
    start, end = _directed_edges(faces)
    keys = np.minimum(start, end) * len(vertices) + np.maximum(start, end)
    order = np.argsort(keys, kind="stable")
    begins = np.flatnonzero(np.diff(keys[order], prepend=-1))
    count = np.diff(begins, append=keys.size)
    direction = np.add.reduceat(np.where(start < end, 1, -1)[order], begins)
    crowded, alike = count > 2, (count == 2) & (direction != 0)
    single = count == 1

    def first_of(kind: NDArray[np.bool_]) -> tuple[int, str]:
        # The edge that comes first in the list of faces, not in the order of keys.
        edges = order[begins[kind]]
        e = int(edges[np.argmin(edges % len(faces))])
        return e % len(faces), f"from vertex {start[e]} to {end[e]}"

    edges = len(begins)
    if single.any():
        face, where = first_of(single)
        merged = len(vertices) - len(np.unique(vertices + 0.0, axis=0))
        raise OpenMesh(
            "faces",
            f"close: {np.count_nonzero(single)} of {edges} edges belong to one face only "
            f"(one is of faces/{face}, {where}), {np.count_nonzero(crowded)} to more than two",
            remedy=f"merge the vertices that coincide ({merged} of them do)" if merged else "close the holes",
        )
    if crowded.any():
        face, where = first_of(crowded)
        raise InvalidParameter(
            "faces",
            f"meet in pairs: {np.count_nonzero(crowded)} of {edges} edges belong to more than two faces "
            f"(one is of faces/{face}, {where})",
            remedy="give surfaces that touch in an edge vertices of their own, and leave inner walls out",
        )
    face, where = first_of(alike)
    raise InvalidParameter(
        "faces",
        f"all run counter-clockwise as seen from outside: at {np.count_nonzero(alike)} of {edges} edges both faces run "
        f"in the same direction (one is of faces/{face}, {where})",
        remedy="reverse the order of vertices in the faces that are turned over",
    )
