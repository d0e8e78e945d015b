"""Random scenes in which connections begin and end, and blows fall, beside whatever else there is."""

from __future__ import annotations

from typing import Any

import numpy as np

from tests.oracles.plain_engine.comparison.drawing import Draw, Json
from tests.oracles.plain_engine.comparison.scenes import scene_of

ALWAYS = ("spinning-frame", "chain", "impulse")
"""Kinds that act all the time, or in none."""
ONE_SIDED = ("contact", "string", "stop")
"""Kinds of connections to which something happens."""
LATER = ("spring", "damper", "string", "contact", "force", "torque", "rod", "inverse-square", "gravitation")
"""Kinds that may begin wherever bodies are, if a contact is not on its other side then."""


def changing_scene_of(seed: int) -> tuple[Json, list[float]]:
    """Return the scene of a seed with one to three changes, and the times asked for; chains go through none."""
    scene, times = scene_of(seed)
    if any(one["kind"] == "chain" for one in scene["connections"]):
        return scene, times
    change = _Changes(np.random.default_rng([2026, seed, 2]), scene, times[-1])
    for _ in range(change.draw.one((1, 1, 2, 3))):
        change.draw.one((change.end_one, change.begin_one, change.begin_another, change.begin_another, change.strike))()
    return {**scene, "connections": change.connections}, times


class _Changes:
    def __init__(self, random: np.random.Generator, scene: Json, end: float) -> None:
        self.draw, self.bodies, self.end = Draw(random, "", 0.0), scene["bodies"], end
        self.space = len(scene["gravity"]) == 3
        self.connections: list[Json] = [
            one if "name" in one else {**one, "name": f"{one['kind']}-{i + 1}"}
            for i, one in enumerate(scene["connections"])
        ]
        spots = [f"{name}.{spot}" for name, own in self.bodies.items() for spot in own.get("places", {})]
        self.places = [*self.bodies, *spots]

    def end_one(self) -> None:
        """Let one of the connections end."""
        chosen = self._one_of([i for i, one in enumerate(self.connections) if one["kind"] not in ALWAYS])
        if chosen is not None and "until" not in self.connections[chosen]:
            late = self.connections[chosen].get("from")
            self.connections[chosen] |= {"until": self._later_than(late)}

    def begin_one(self) -> None:
        """Let one of the connections that act from the start begin later."""
        chosen = self._one_of([i for i, one in enumerate(self.connections) if one["kind"] in LATER])
        if chosen is not None and not {"from", "until"} & set(self.connections[chosen]):
            self.connections[chosen] |= {"from": self._occasion(self.connections[chosen])}

    def begin_another(self) -> None:
        """Add a connection between two places, or a place and the ground, that begins later."""
        draw = self.draw
        a = draw.one(self.places)
        others = [place for place in self.places if place.partition(".")[0] != a.partition(".")[0]]
        ground = [draw.one((-1, 0, 1.5, 4)), draw.one((-1, 2)), draw.one((0, 2))][: 3 if self.space else 2]
        b: Any = draw.one(others) if others and draw.chance(0.7) else ground
        kind = draw.one(("rod", "rod", "weld", "spring", "damper", "string"))
        rigid = [x for x in (a, b) if isinstance(x, str) and self._turns(x)]
        name = f"begun-{len(self.connections) + 1}"
        if kind == "weld" and len(rigid) == 2:
            one: Json = {"kind": "weld", "a": a.partition(".")[0], "b": b.partition(".")[0]}
        elif kind == "spring":
            one = {"kind": "spring", "a": a, "b": b, "stiffness": draw.one((5, 20, 100))}
        elif kind == "damper":
            one = {"kind": "damper", "a": a, "b": b, "coefficient": draw.one((0.5, 2))}
        elif kind == "string" and not any("radius" in own or "shape" in own for own in self.bodies.values()):
            one = {"kind": "string", "through": [a, b]}
        else:
            one = {"kind": "rod", "a": a, "b": b}
        self.connections.append({**one, "name": name, "from": self._occasion()})
        if draw.chance(0.3):
            self.connections[-1]["until"] = self._later_than(self.connections[-1]["from"])

    def strike(self) -> None:
        """Add a blow."""
        draw, place = self.draw, self.draw.one(self.places)
        one: Json = {"kind": "impulse", "name": f"blow-{len(self.connections) + 1}"}
        components = [draw.one((-1, 0, 0.5, 2)) for _ in range(3 if self.space else 2)]
        if self._turns(place) and draw.chance(0.3):
            one |= {"body": place.partition(".")[0], "impulse": components if self.space else components[0] or 1}
        else:
            one |= {"place": place, "impulse": components}
        if self._turns(place) and ("place" in one or self.space) and draw.chance(0.3):
            one["in"] = "body"
        if draw.chance(0.9):
            one["at"] = self._occasion()
        self.connections.append(one)

    def _turns(self, place: str) -> bool:
        return bool({"inertia", "moments", "body", "shape"} & set(self.bodies[place.partition(".")[0]]))

    def _one_of(self, numbers: list[int]) -> int | None:
        return self.draw.one(numbers) if numbers else None

    def _time(self, first: float) -> float:
        return round(float(first + (self.end - first) * self.draw.random.uniform(0.05, 0.9)), 3)

    def _later_than(self, begins: object) -> object:
        """Return an occasion; a time after one at which something begins."""
        return self._time(begins) if isinstance(begins, float) else self._occasion()

    def _occasion(self, own: Json | None = None) -> object:
        """Return an occasion that is no event of a connection itself."""
        draw = self.draw
        happens = [one for one in self.connections if one["kind"] in ONE_SIDED or {"from", "until"} & set(one)]
        happens = [one for one in happens if one is not own]
        if happens and draw.chance(0.35):
            chosen = draw.one(happens)
            event: Json = {"name": chosen["name"]}
            if chosen["kind"] in ONE_SIDED and draw.chance(0.2):
                event["nth"] = 2
            return {"event": event}
        if draw.chance(0.2):
            body = draw.one(list(self.bodies))
            column = draw.one(("velocity.x", "velocity.y", "position.x", "position.y"))
            return {"when": {"quantity": f"{body}.{column}", "equals": draw.one(("-0.7", "-1.3", "0.3", "0.9", "0"))}}
        return self._time(0.0)
