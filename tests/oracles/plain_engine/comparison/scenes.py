"""Random scenes of two to six bodies: units side by side, tied to one another, or twins."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress

import numpy as np

from core.multibody.language.reading import scene_from
from tests.core.multibody.random_laws import SHARE, Laws
from tests.oracles.plain_engine.comparison import (
    units_in_plane,
    units_in_space,
    units_of_formulas,
    units_of_other_kinds,
    units_of_shapes,
)
from tests.oracles.plain_engine.comparison.drawing import Draw, Json, Unit
from tests.oracles.plain_engine.mechanism import NotSupported
from tests.oracles.plain_engine.motion import follow

ENDS = (0.3, 0.5, 0.8)
"""Last times asked for (s)."""
APART = 5.0
"""How far units stand from one another (m)."""
HOLDS = ("pin", "rod", "track", "weld", "slider", "ball-joint", "rolling", "relation")
"""Kinds of which a second one between the same places changes nothing."""
OTHERS = (units_of_other_kinds, units_of_formulas, units_of_shapes)
PLANE = (*units_in_plane.UNITS, *(unit for module in OTHERS for unit in module.PLANE))
SPACE = (*units_in_space.UNITS, *(unit for module in OTHERS for unit in module.SPACE))
LAWS = ("poisson", "stronge")
"""Laws of impact beside Newton's."""


def scene_of(seed: int) -> tuple[Json, list[float]]:
    """Return the scene of a seed, and the times asked for."""
    random = np.random.default_rng([2026, seed])
    draw = Draw(random, "", 0.0)
    space = draw.chance(0.3)
    kinds = SPACE if space else PLANE
    units = _twins(draw, draw.one(kinds)) if draw.chance(0.25) else _side_by_side(draw, kinds)
    g = draw.one((9.81, 10))
    scene: Json = {"gravity": [0, 0, -g] if space else [0, -g], "bodies": {}, "connections": []}
    for unit in units:
        scene["bodies"] |= unit.bodies
        scene["connections"] += unit.connections
    for _ in units[1:]:
        if draw.chance(0.5):
            scene["connections"] += _tie(draw, units)
    holding = [one for one in scene["connections"] if one["kind"] in HOLDS]
    if holding and draw.chance(0.15):
        scene["connections"].append({**draw.one(holding), "name": "again"})
    # What a frame does to a chain is not modelled.
    if draw.chance(0.06) and not any(one["kind"] == "chain" for one in scene["connections"]):
        frame = {"kind": "spinning-frame", "rate": draw.one((1, 2))}
        scene["connections"].append(frame if space else {**frame, "about": "normal"})
    if draw.chance(0.12):
        law = draw.one(LAWS)
        # In space contacts with friction follow Newton's.
        scene["impacts"] = "newton" if space else law
    if draw.chance(0.12):
        scene["simultaneous"] = draw.one(("together", "in order"))
    later = np.random.default_rng([2026, seed, 1])
    places = [end for unit in units for end in unit.ends]
    if places and later.random() < SHARE:
        turning = [name for name in scene["bodies"] if "inertia" in scene["bodies"][name] and not space]
        scene["connections"].append(Laws(later, places, turning, 3 if space else 2).any_law())
    end = draw.one(ENDS)
    times = [0.0, round(end * 0.45, 4), end]
    return scene, _until_soon_after(scene, times) if draw.chance(0.2) else times


def _twins(draw: Draw, kind: Callable[[Draw], Unit]) -> list[Unit]:
    """Return the same figures twice, side by side."""
    twin = np.random.default_rng()
    twin.bit_generator.state = draw.random.bit_generator.state
    return [kind(Draw(draw.random, "", 0.0)), kind(Draw(twin, "2", APART))]


def _side_by_side(draw: Draw, kinds: Sequence[Callable[[Draw], Unit]]) -> list[Unit]:
    count = draw.one((1, 1, 2, 2, 2, 2, 3))
    return [draw.one(kinds)(Draw(draw.random, str(i + 1) if i else "", APART * i)) for i in range(count)]


def _until_soon_after(scene: Json, times: list[float]) -> list[float]:
    """Return times of which the last is soon after the first event, if there is one."""
    with suppress(NotSupported):
        for event in follow(scene_from(scene), times, tolerance=1e-8).events:
            if event.time > 0.01:
                return [0.0, round(event.time / 2, 6), round(event.time + 1e-3, 6)]
    return times


def _tie(draw: Draw, units: list[Unit]) -> list[Json]:
    """Return what ties two units that may be tied: nothing that holds, so that their velocities stay possible."""
    first = int(draw.random.integers(len(units) - 1))
    units = units[first : first + 2]
    if not all(unit.ends for unit in units):
        return []
    a, b = (draw.one(unit.ends) for unit in units)
    kind = draw.one(("spring", "spring", "damper", "gravitation", "inverse-square", "string"))
    wound = [{"radius", "shape"} & set(unit.bodies.get(end, {})) for unit, end in zip(units, (a, b), strict=True)]
    if kind == "string" and any(wound):
        # It would wind around them.
        kind = "spring"
    if kind == "spring":
        tie: Json = {"kind": "spring", "a": a, "b": b, "stiffness": draw.one((1, 5, 20))}
        return [tie if draw.chance(0.5) else {**tie, "rest_length": draw.one((4, 0))}]
    if kind == "damper":
        return [{"kind": "damper", "a": a, "b": b, "coefficient": draw.one((0.5, 2))}]
    if kind == "gravitation":
        return [{"kind": "gravitation", "a": a.partition(".")[0], "b": b.partition(".")[0], "constant": 5}]
    if kind == "inverse-square":
        return [{"kind": "inverse-square", "a": a, "b": b, "strength": draw.one((5, -5))}]
    return [{"kind": "string", "name": f"between{first}", "through": [a, b], "length": 7}]
