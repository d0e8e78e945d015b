"""At which times an audit asks for the motion beside those of the answer."""

from __future__ import annotations

from math import frexp, hypot, ldexp, log, sqrt
from random import Random
from zlib import crc32

import numpy as np

from core.multibody.answer import SceneSolution
from core.multibody.audit.definitions import Description
from core.multibody.audit.placement import Numbers, Placement
from core.multibody.audit.samples import Columns
from core.multibody.audit.windows import GRID

WIDTH = 0.05
"""Half of the width of a window, in radians of the quickest motion that the scene is known to have."""

MOST_WINDOWS = 2
"""Windows in which rates are compared, one in a smooth motion: with the start they ask for 15 times at most."""

WEIGHT_OF_TOUCH = 100.0
"""How much more often a time is chosen in a phase in which something touches than in free flight."""

MOST_ROWS = 200
"""Rows of a long trajectory that are compared."""


def generator(description: Description, times: Numbers) -> Random:
    """Return random numbers that depend on the question alone."""
    seed = crc32(times.tobytes())
    for pose in description.start.values():
        seed = crc32(pose.position.tobytes(), seed)
    return Random(seed)


def rows_of(random: Random, count: int) -> Numbers:
    """Return which rows of an answer are compared: all, or the first, the last and a random subset."""
    if count <= MOST_ROWS:
        return np.arange(count)
    return np.array([0, *sorted(random.sample(range(1, count - 1), MOST_ROWS - 2)), count - 1])


def quickness(description: Description, placement: Placement, speed: float, spin: float) -> float:
    """Return the largest rate that the scene is known to change at (rad/s), 0 where none is known.

    Spins and what is prescribed, speeds and forces over lengths, and stiffness over masses.

    Parameters
    ----------
    placement : mapping of str to Pose
    speed, spin : float
        Largest components of velocities and spins (m/s, rad/s).
    """
    found, masses = spin, description.masses
    for body in description.bodies.values():
        if body.angular_velocity is not None:
            found = max(found, float(np.max(np.abs(body.angular_velocity))))
    least, length = min(masses.values(), default=0.0), description.shortest
    if length is None:
        length = max(float(np.abs(pose.position).max()) for pose in placement.values())
    if length > 0.0:
        found = max(found, speed / length, sqrt(hypot(*description.gravity) / length))
    for connection in description.connections:
        found = max(found, connection.quickness(placement, masses, least))
    return found


def largest_rates(columns: Columns) -> tuple[float, float]:
    """Return the largest components of velocities and spins among columns (m/s, rad/s)."""
    found = {"m/s": 0.0, "rad/s": 0.0}
    for column in columns.values():
        if column.unit in found:
            found[column.unit] = max(found[column.unit], float(np.abs(column.values).max(initial=0.0)))
    return found["m/s"], found["rad/s"]


def windows(random: Random, answer: SceneSolution, begin: float, end: float, rate: float) -> list[tuple[float, float]]:
    """Return middles and half widths of windows within the motion that an answer samples, each in another phase."""
    parts = [(begin, end, 1.0)]
    if answer.phases is not None:
        parts = [
            (
                max(phase.start, begin),
                end if phase.end is None else min(phase.end, end),
                1.0 if set(phase.states.values()) == {"open"} else WEIGHT_OF_TOUCH,
            )
            for phase in answer.phases
            if phase.model != "accumulating bounces"
        ]
    parts = [part for part in parts if part[1] > part[0]]
    if not parts:
        return []
    # Without replacement, with chances by length (P. S. Efraimidis, P. G. Spirakis, Inf. Process. Lett. 97, 2006).
    keys = [log(1.0 - random.random()) / ((last - first) * weight) for first, last, weight in parts]
    chosen = sorted(range(len(parts)), key=keys.__getitem__, reverse=True)[:MOST_WINDOWS]
    placed = [_window(random, *parts[k][:2], rate) for k in chosen]
    return [one for one in placed if one is not None]


def _window(random: Random, first: float, last: float, rate: float) -> tuple[float, float] | None:
    """Return middle and half width of a window between two times, None where it has no room."""
    # Phases are known to rounding: a window stays inside.
    room = (last - first) * (1.0 - 1e-6) / 2.0
    half = min(room, WIDTH / rate if rate > 0.0 else room)
    middle = random.uniform(first + half * (1.0 + 1e-6), last - half * (1.0 + 1e-6))
    # A power of two, and a multiple of its share: the times of the samples are doubles.
    half = ldexp(1.0, frexp(half)[1] - 1)
    # Times of doubles are too coarse where the window is next to nothing beside them.
    if not half > 2.0**-26 * max(abs(first), abs(last)):
        return None
    return round(middle / half * GRID) * (half / GRID), half
