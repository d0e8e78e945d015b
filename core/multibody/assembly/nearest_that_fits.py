"""What is said where places do not satisfy the connections: the nearest that do."""

from __future__ import annotations

from dataclasses import replace

from core.errors import MechanicsError, PlacesDisagree
from core.multibody.assembly.assembled_scene import assembled
from core.multibody.language.scene import Scene
from core.multibody.model_answer import AssembledBody

MOST_NAMED = 5
"""Bodies that a remedy names: it is one sentence."""

_DIGITS = 10
"""Digits of their places: four more than connections need to take them as rounded."""


def with_nearest(fault: PlacesDisagree, scene: Scene) -> PlacesDisagree:
    """Return the fault of places that do not satisfy the connections, its remedy with the nearest that do."""
    try:
        found = assembled(replace(scene, assemble="nearest")).assembly
    except MechanicsError as worse:
        if worse.path[:1] == ("assemble",):
            # None is the nearest, which nobody asked for.
            return fault
        # No places satisfy them: that says more than a body that should be moved.
        return PlacesDisagree(fault.path, fault.rule, remedy=f"{worse.detail}; {worse.remedy}", further=fault.further)
    assert found is not None, "nearest places were requested"
    moved = {name: body for name, body in found.bodies.items() if body.moved > 0.0 or body.turned != 0.0}
    named = sorted(moved, key=lambda name: -moved[name].moved)[:MOST_NAMED]
    others = "" if len(moved) <= MOST_NAMED else ", and others"
    places = ", ".join(f'"{name}" at {_written(moved[name])}' for name in named)
    remedy = f'the nearest places that fit are {places}{others}; "assemble": "nearest" takes them'
    return PlacesDisagree(fault.path, fault.rule, remedy=remedy, further=fault.further)


def _written(body: AssembledBody) -> str:
    at = ", ".join(f"{x:.{_DIGITS}g}" for x in body.at)
    turned = f" with the angle {body.angle:.{_DIGITS}g} rad" if body.angle is not None and body.turned != 0.0 else ""
    return f"[{at}]{turned}"
