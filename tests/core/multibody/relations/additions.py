"""Requests with something added that changes nothing: a part that shares nothing, what repeats, what is not reached."""

from __future__ import annotations

import copy
import re
from dataclasses import replace
from typing import Any

import numpy as np

from tests.core.multibody.relations.geometry import Transformed, dimension, turns
from tests.core.multibody.relations.numbers import Json, components, is_zero, text
from tests.core.multibody.relations.views import Figure, View

APART = 100
ADDED = "added"
"""How the names of what is added begin."""
OF_ALL = ("momentum", "angular_momentum", "kinetic", "potential", "total")


def without(view: View) -> View:
    """Return a view without what was added, and without the figures of the whole scene."""

    def image(figure: Figure) -> Figure | None:
        return None if figure.owner.startswith(ADDED) else figure

    return replace(
        view.mapped(image),
        events=[event for event in view.events if not event.name.startswith(ADDED)],
    )


def restored(view: View, original: View) -> View:
    """Return a view without what was added, and those of its models that the original has."""
    left = list(view.models)
    models = []
    for model in original.models:
        if model in left:
            left.remove(model)
            models.append(model)
    return replace(without(view), models=models)


def _of_parts(view: View) -> View:
    def image(figure: Figure) -> Figure | None:
        of_all = figure.what in OF_ALL and figure.owner in ("", "energy")
        return None if of_all or (figure.owner == "gravity" and figure.what == "work") else figure

    return view.mapped(image)


def beside(request: Json, other: str) -> Transformed | None:
    """Return a request with a pendulum, a bouncing ball, a driven wheel or a body under a force in time far away."""
    size = dimension(request)
    if any(one["kind"] == "spinning-frame" for one in request.get("connections", ())):
        return None
    if "gravity" not in request or any(t < 0 for t in request.get("times", ())):
        return None
    down = [x for x in components(request["gravity"])]
    if size == 2 and not (is_zero(down[0]) and not is_zero(down[1])):
        return None
    if size == 3 and (
        other not in ("ball", "formula") or not (is_zero(down[0]) and is_zero(down[1]) and not is_zero(down[2]))
    ):
        return None
    found = copy.deepcopy(request)
    names = {i: one.get("name", f"{one['kind']}-{i + 1}") for i, one in enumerate(found.get("connections", ()))}
    for i, name in names.items():
        found["connections"][i]["name"] = name
    place: list[Any] = [APART, 0] if size == 2 else [APART, 0, 0]
    name = f"{ADDED}-{other}"
    connections: list[Json]
    if other == "pendulum":
        body: Json = {"mass": 1, "at": [APART + 0.6, -0.8]}
        connections = [{"kind": "rod", "a": name, "b": place}]
    elif other == "ball":
        body = {"mass": 1, "at": [*place[:-1], 0.3]}
        on = {"at": place} if size == 2 else {"at": place, "normal": [0, 0, 1]}
        connections = [{"kind": "contact", "place": name, "on": on, "restitution": 0.5}]
    elif other == "formula":
        body = {"mass": 1, "at": place}
        connections = [{"kind": "force", "place": name, "force": ["sin(t)", "exp(t) - 1", "t"][:size]}]
    else:
        body = {"mass": 1, "inertia": 0.1, "at": place}
        connections = [{"kind": "pin", "a": name, "b": place}, {"kind": "motor", "a": name, "rate": 2}]
    found["bodies"][name] = body
    for k, connection in enumerate(connections):
        connection["name"] = f"{ADDED}-{k}"
    found["connections"] = [*found.get("connections", []), *connections]

    return Transformed(found, _of_parts, restored)


def repeated(request: Json) -> Transformed | None:
    """Return a request with its first rod or track given twice.

    Two guides without play may press against one another as much as they like: what rubs in them is not decided.
    """
    found = copy.deepcopy(request)
    connections = found.get("connections", [])
    first = next((one for one in connections if one["kind"] in ("rod", "track") and "friction" not in one), None)
    if first is None:
        return None
    names = {i: one.get("name", f"{one['kind']}-{i + 1}") for i, one in enumerate(connections)}
    for i, name in names.items():
        connections[i]["name"] = name
    again = {**copy.deepcopy(first), "name": f"{ADDED}-again"}
    found["connections"] = [*connections, again]

    def image(figure: Figure) -> Figure | None:
        kept = ("position", "velocity", "angle", "angular_velocity", "attitude", "axis", "acceleration", "extremes")
        return figure if figure.what in kept else None

    return Transformed(found, lambda view: view.mapped(image))


def rod_as_track(request: Json) -> Transformed | None:
    """Return a request whose first rod to the ground is a circle or sphere on which its end is held."""
    found = copy.deepcopy(request)
    for i, one in enumerate(found.get("connections", [])):
        if one["kind"] == "rod" and isinstance(one["a"], str) and not isinstance(one["b"], str):
            body, _, spot = one["a"].partition(".")
            if spot or body not in found["bodies"]:
                continue
            at, centre = components(found["bodies"][body]["at"]), components(one["b"])
            square = "+".join(f"({text(x)}-({text(c)}))^2" for x, c in zip(at, centre, strict=True))
            radius = one.get("length", f"sqrt({square})")
            name = one.get("name", f"rod-{i + 1}")
            found["connections"][i] = {
                "kind": "track", "name": name, "place": one["a"], "on": {"at": one["b"], "radius": radius},
            }  # fmt: skip

            def image(figure: Figure, name: str = name) -> Figure | None:
                return None if figure.owner == name else figure

            return Transformed(found, lambda view: view.mapped(image))
    return None


def with_floor_far_below(request: Json) -> Transformed | None:
    """Return a request with a contact that is not reached: its motion goes through phases, and is the same."""
    if any(t < 0 for t in request.get("times", ())) or "times" not in request:
        return None
    kinds = {one["kind"] for one in request.get("connections", ())}
    if kinds & {"chain", "spinning-frame"}:
        return None
    size = dimension(request)
    body = next((name for name, one in request["bodies"].items() if not turns(one)), None)
    if body is None or "radius" in request["bodies"][body]:
        return None
    found = copy.deepcopy(request)
    connections = found.get("connections", [])
    for i, one in enumerate(connections):
        one.setdefault("name", f"{one['kind']}-{i + 1}")
    on = {"at": [0, -100000]} if size == 2 else {"at": [0, 0, -100000], "normal": [0, 0, 1]}
    found["connections"] = [*connections, {"kind": "contact", "name": f"{ADDED}-floor", "place": body, "on": on}]

    return Transformed(found, lambda view: view, lambda view, _: without(view))


def moved_a_little(request: Json, random: np.random.Generator) -> Json | None:
    """Return a request with one of its decimals larger by 1e-12 of itself."""
    found = copy.deepcopy(request)
    places: list[tuple[Any, Any]] = []

    def visit(value: Any, key: str = "") -> None:
        if key in ("times", "outputs", "kind", "name", "accuracy", "searched"):
            return
        entries = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
        for name, entry in entries:
            if isinstance(entry, (int, float)) and not isinstance(entry, bool) and entry != 0:
                if name not in ("times", "accuracy"):
                    places.append((value, name))
            else:
                visit(entry, str(name))

    visit({"bodies": found["bodies"]})
    if not places:
        return None
    where, name = places[int(random.integers(len(places)))]
    number = where[name]
    exact = re.sub(r"[eE].*", "", repr(number))
    where[name] = f"{exact}*1.000000000001" if exact == repr(number) else f"({number!r})*1.000000000001"
    return found
