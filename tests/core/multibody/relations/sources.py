"""The scenes on which relations are tried: the catalogue, the random scenes of other tests, and combinations."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.core.multibody import contact_judge, random_scenes
from tests.core.multibody.random_laws import with_law
from tests.core.multibody.relations import combined_scenes
from tests.core.multibody.relations.numbers import Json
from tests.core.multibody.relations.writing import at

CATALOGUE = Path(__file__).parents[4] / "examples" / "scenes"
OUTPUTS = ["accelerations", "forces", "energy", "trajectory", "forces-in-time", "energy-in-time", "momenta-in-time"]
TIMES = [0.0, 0.11, 0.31, 0.53, 0.8, 1.0]
LATEST = 20.0
"""Time (s) up to which scenes of the catalogue are followed."""


def catalogue() -> dict[str, Json]:
    """Return the described scenes of the catalogue, each at a few times."""
    found: dict[str, Json] = {}
    for path in sorted(CATALOGUE.glob("*.json")):
        scene = json.loads(path.read_text(encoding="utf-8"))
        if "bodies" not in scene:
            continue
        times = at(scene.get("times", TIMES))
        latest = max(map(abs, times)) or 1.0
        scene["times"] = [t * min(1.0, LATEST / latest) for t in times]
        found[path.stem] = asked(scene)
    return found


def asked(scene: Json) -> Json:
    """Return the request for everything that relations compare, a speed that is looked for among it."""
    kept = {
        name: scene[name] for name in ("gravity", "let", "bodies", "connections", "numbers", "times") if name in scene
    }
    found = {"times": list(TIMES), "accuracy": 1e-6, **kept, "outputs": list(OUTPUTS)}
    # Times that stay exact in other units.
    times = [round(t * 2.0**20) / 2.0**20 for t in found["times"]]
    return found | {"times": times, "searched": [next(iter(scene["bodies"])), 1.25]}


def without_search(request: Json) -> Json:
    """Return a request that looks for nothing."""
    return {name: value for name, value in request.items() if name != "searched"}


def without_law(request: Json) -> Json:
    """Return a request without the law by formula that was added to it."""
    return {**request, "connections": [one for one in request.get("connections", ()) if one.get("name") != "formula"]}


def by_its_motion(request: Json) -> bool:
    """Return whether what acts depends on components, places or occasions of the motion, which no relation rewrites.

    That are formulas of a force of its place, and what begins, ends or strikes at a time, an event or a value.
    """
    if any(one["kind"] == "impulse" or one.keys() & {"from", "until"} for one in request.get("connections", ())):
        return True
    forces = [one["force"] for one in request.get("connections", ()) if one["kind"] == "force" and "force" in one]
    return any(re.search(r"\b(speed|v?[xyz])\b", str(x)) for force in forces for x in force)


RANDOM: tuple[Callable[[int], Any], ...] = (
    combined_scenes.plane,
    combined_scenes.plane,
    combined_scenes.space,
    contact_judge.any_scene,
    random_scenes.any_scene,
)


def random_scene(seed: int) -> Json:
    """Return the request of a seed; the sources take turns."""
    scene = with_law(RANDOM[seed % len(RANDOM)](seed // len(RANDOM)), seed)
    return asked(json.loads(json.dumps(scene)))


def side_by_side(one: Json, other: Json) -> Json | None:
    """Return two scenes far apart in one, if they have gravity and dimension in common."""
    from tests.core.multibody.relations.geometry import dimension, moved
    from tests.core.multibody.relations.writing import renamed

    frames = any(c["kind"] == "spinning-frame" for scene in (one, other) for c in scene.get("connections", ()))
    if dimension(one) != dimension(other) or one.get("gravity") != other.get("gravity") or frames:
        return None
    if set(one.get("let", {})) & set(other.get("let", {})) or one.get("numbers") != other.get("numbers"):
        return None
    far = moved(other, ["100", "0", "0"][: dimension(other)])
    new = None if far is None else renamed(far.request)
    if new is None:
        return None
    found = json.loads(json.dumps(one))
    for k, connection in enumerate(found.get("connections", [])):
        connection.setdefault("name", f"{connection['kind']}-{k + 1}")
    found["bodies"] |= new.request["bodies"]
    found["connections"] = [*found.get("connections", []), *new.request.get("connections", [])]
    found["let"] = {**one.get("let", {}), **other.get("let", {})}
    return found
