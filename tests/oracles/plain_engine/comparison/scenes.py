"""Random scenes of two to six bodies: units side by side, tied to one another, or twins."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

import numpy as np

from core.multibody.language.reading import scene_from
from tests.oracles.plain_engine.comparison import units_in_plane, units_in_space, units_of_other_kinds
from tests.oracles.plain_engine.comparison.drawing import Draw, Json, Unit
from tests.oracles.plain_engine.mechanism import NotSupported
from tests.oracles.plain_engine.motion import follow

ENDS = (0.3, 0.5, 0.8)
"""Last times asked for (s)."""
OTHER = 10_000
"""Seed from which on scenes are drawn from the units of other kinds, too."""
SOON_AFTER = 20_000
"""Seed from which on the last time is soon after the first event."""
APART = 5.0
"""How far units stand from one another (m)."""


def scene_of(seed: int) -> tuple[Json, list[float]]:
    """Return the scene of a seed, and the times asked for."""
    random = np.random.default_rng([2024, seed])
    draw = Draw(random, "", 0.0)
    space = draw.chance(0.3)
    kinds: Any = units_in_space.UNITS if space else units_in_plane.UNITS
    if seed >= OTHER:
        kinds = (*kinds, *(2 * (units_of_other_kinds.SPACE if space else units_of_other_kinds.PLANE)))
    first = draw.one(kinds)
    start = random.bit_generator.state
    units: list[Unit] = [first(Draw(random, "", 0.0))]
    if draw.chance(0.25):
        # Twins: the same figures again, further on.
        twin = np.random.default_rng()
        twin.bit_generator.state = start
        units.append(first(Draw(twin, "2", APART)))
    elif draw.chance(0.6):
        units.append(draw.one(kinds)(Draw(random, "2", APART)))
    g = draw.one((9.81, 10))
    scene: Json = {"gravity": [0, 0, -g] if space else [0, -g], "bodies": {}, "connections": []}
    for unit in units:
        scene["bodies"] |= unit.bodies
        scene["connections"] += unit.connections
    if len(units) == 2 and draw.chance(0.5):
        scene["connections"].append(_tie(draw, units))
    if not space and draw.chance(0.04):
        scene["connections"].append({"kind": "spinning-frame", "rate": draw.one((1, 2)), "about": "normal"})
    if space and draw.chance(0.1):
        scene["connections"].append({"kind": "spinning-frame", "rate": draw.one((1, 2))})
    end = draw.one(ENDS)
    times = [0.0, round(end * 0.45, 4), end]
    return scene, times if seed < SOON_AFTER else _until_soon_after(scene, times)


def _until_soon_after(scene: Json, times: list[float]) -> list[float]:
    """Return times of which the last is soon after the first event, if there is one."""
    with suppress(NotSupported):
        for event in follow(scene_from(scene), times).events:
            if event.time > 0.01:
                return [0.0, round(event.time / 2, 6), round(event.time + 1e-3, 6)]
    return times


def _tie(draw: Draw, units: list[Unit]) -> Json:
    """Return what ties two units: nothing that holds, so that their velocities stay possible."""
    a, b = (draw.one(unit.ends) for unit in units)
    kind = draw.one(("spring", "spring", "damper", "gravitation", "inverse-square", "string"))
    if kind == "string" and any("radius" in unit.bodies.get(end, {}) for unit, end in zip(units, (a, b), strict=True)):
        # It would wind around them.
        kind = "spring"
    if kind == "spring":
        tie: Json = {"kind": "spring", "a": a, "b": b, "stiffness": draw.one((1, 5, 20))}
        return tie if draw.chance(0.5) else {**tie, "rest_length": draw.one((4, 0))}
    if kind == "damper":
        return {"kind": "damper", "a": a, "b": b, "coefficient": draw.one((0.5, 2))}
    if kind == "gravitation":
        return {"kind": "gravitation", "a": a.partition(".")[0], "b": b.partition(".")[0], "constant": 5}
    if kind == "inverse-square":
        return {"kind": "inverse-square", "a": a, "b": b, "strength": draw.one((5, -5))}
    return {"kind": "string", "name": "between", "through": [a, b], "length": 7}
