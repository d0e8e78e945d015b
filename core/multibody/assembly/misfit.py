"""What connections that cannot be satisfied miss: by how much one of them stays open while the others hold.

References
----------
D. W. Marquardt, "An algorithm for least-squares estimation of nonlinear parameters", SIAM Journal 11 (1963).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import hypot

import numpy as np

from core.arrays import Floats
from core.errors import InvalidParameter, Path
from core.multibody.assembly.four_bar import FourBar
from core.multibody.assembly.quadratics import LEAST_SCALE, STEPS, Quadratics
from core.multibody.table.frames import Frame

WEIGHTS = (10.0, 100.0, 1000.0)
"""Weights of the connections that are to hold beside the one that stays open, one after the other: at the last they
miss by a thousandth of what it misses. From the first on the way would be a narrow valley."""


LEAST_DAMPING = 1e-12
"""Share of a step that is left to directions in which nothing changes, without which their equations are singular: far
above the rounding of the others."""
STALLED = 1e-12
"""Gain of a step, relative to the sum of squares, at which an iteration ends: three digits are answered."""


def refusal(
    measures: Quadratics,
    names: Sequence[str],
    start: Floats,
    across: Floats,
    frames: Mapping[str, Frame],
    paths: Mapping[str, Path],
    linkage: FourBar | None,
) -> InvalidParameter:
    """Return the fault of connections that no places satisfy.

    Parameters
    ----------
    measures : Quadratics
    names : sequence of str
        Connection or body of each.
    start : ndarray, shape (n,)
        The sketch.
    across : ndarray, shape (n, f)
        Changes of the coordinates by what may change.
    frames : mapping of str to Frame
    paths : mapping of str to Path
    linkage : FourBar or None
        If the scene is one.
    """
    own = np.array([name in frames for name in names])
    near = _least_squares(measures.weighted(np.where(own, WEIGHTS[0], 1.0)), start, across)
    missed = _lengths(measures, names, near, frames)
    worst = max(missed, key=lambda name: missed[name])
    opened = np.array([name == worst for name in names])
    for held in WEIGHTS:
        near = _least_squares(measures.weighted(np.where(opened, 1.0, held)), near, across)
    left = _lengths(measures, names, near, frames)[worst]
    what = f'hold together with the others: no places satisfy them all; where they do, "{worst}" stays open'
    far = f" by about {left:.3g} m" if 0.0 < left < np.inf else ""
    told = "" if linkage is None else f" ({linkage.told()})"
    return InvalidParameter(
        paths.get(worst, ("connections",)),
        f"{what}{far}{told}",
        remedy="change a length, a place of the ground, or which bodies may be moved",
    )


def _lengths(measures: Quadratics, names: Sequence[str], q: Floats, frames: Mapping[str, Frame]) -> dict[str, float]:
    """Return by how much connections are missed (m), to first order in a displacement of one of their bodies."""
    values, lines = measures.values(q), measures.jacobian(q)
    found: dict[str, float] = {}
    for k, name in enumerate(names):
        if name in frames:
            continue
        reach = max(float(np.linalg.norm(lines[k, frame.position])) for frame in frames.values())
        length = values[k] / reach if reach > 0.0 else 0.0
        found[name] = hypot(found.get(name, 0.0), length)
    return found or {names[0]: float(np.abs(values).max())}


def _least_squares(measures: Quadratics, q: Floats, across: Floats) -> Floats:
    """Return places at which the sum of the squares of the measures is least near `q`."""
    values, damping = measures.values(q), 1e-3
    for _ in range(4 * STEPS):
        lines = measures.jacobian(q) @ across
        normal, slope = lines.T @ lines, lines.T @ values
        scale = float(np.trace(normal)) / len(normal)
        if not LEAST_SCALE < scale < np.inf or damping > 1e12:
            break
        step = across @ np.linalg.solve(normal + damping * scale * np.eye(len(normal)), -slope)
        further = measures.values(q + step)
        gained = float(values @ values) - float(further @ further)
        if gained > 0.0:
            done = gained <= STALLED * float(values @ values) and damping < 1.0
            q, values, damping = q + step, further, max(damping / 4.0, LEAST_DAMPING)
            if done:
                break
        else:
            damping *= 8.0
    return q
