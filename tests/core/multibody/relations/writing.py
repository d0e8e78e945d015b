"""The same scene written in another way: units, order, names, ends, forms of numbers, times and outputs."""

from __future__ import annotations

import copy
import re
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np

from tests.core.multibody.relations.geometry import Transformed, dimension, turns
from tests.core.multibody.relations.numbers import Json, components, times
from tests.core.multibody.relations.views import Figure, View

BODY_UNITS = {"mass": (0, 1, 0), "inertia": (2, 1, 0), "radius": (1, 0, 0)}
"""Powers of length, mass and time."""
UNITS: dict[str, tuple[int, int, int]] = {
    "m": (1, 0, 0), "m/s": (1, 0, -1), "rad": (0, 0, 0), "rad/s": (0, 0, -1), "1": (0, 0, 0), "N": (1, 1, -2),
    "N m": (2, 1, -2), "J": (2, 1, -2), "kg m/s": (1, 1, -1), "kg m^2/s": (2, 1, -1), "m/s^2": (1, 0, -2),
    "rad/s^2": (0, 0, -2),
}  # fmt: skip

_BY_TIME = re.compile(r"\bt\b")
"""The name of the time in a formula."""


def in_units(request: Json, length: int, mass: int, time: int) -> Transformed | None:
    """Return a request in units in which lengths, masses and times have other numbers, by these factors.

    Numbers within formulas of the motion have units that nothing says, so that such requests are left out.
    """
    in_formulas = any(
        {"law", "drive"} & one.keys() or _BY_TIME.search(str(one)) for one in request.get("connections", ())
    )
    if in_formulas or any("body" in body for body in request["bodies"].values()):
        return None
    found = copy.deepcopy(request)

    def scaled(value: Any, powers: tuple[int, int, int]) -> Any:
        factor = Fraction(length) ** powers[0] * Fraction(mass) ** powers[1] * Fraction(time) ** powers[2]
        if isinstance(value, list) or (isinstance(value, dict) and "polar" in value):
            return [scaled(x, powers) for x in components(value)]
        return times(value, str(factor))

    if "gravity" in found:
        found["gravity"] = scaled(found["gravity"], (1, 0, -2))
    for body in found["bodies"].values():
        for key, powers in BODY_UNITS.items():
            if key in body:
                body[key] = scaled(body[key], powers)
        body["at"] = scaled(body["at"], (1, 0, 0))
        if "velocity" in body:
            body["velocity"] = scaled(body["velocity"], (1, 0, -1))
        for key in ("moments", "tensor"):
            if key in body:
                body[key] = scaled(body[key], (2, 1, 0))
        if "shape" in body:
            body["shape"] = {
                key: value if key == "kind" else scaled(value, (1, 0, 0)) for key, value in body["shape"].items()
            }
        if "angular_velocity" in body:
            body["angular_velocity"] = scaled(body["angular_velocity"], (0, 0, -1))
        body["places"] = {name: scaled(place, (1, 0, 0)) for name, place in body.get("places", {}).items()}
    for connection in found.get("connections", ()):
        kind = connection["kind"]
        if kind == "gravitation":
            connection.setdefault("constant", "6.6743e-11")
        turn = kind == "torsion-spring" or connection.get("measure") == "turn"
        powers = {
            "length": (1, 0, 0), "rest_length": (1, 0, 0), "stiffness": (2, 1, -2) if turn else (0, 1, -2),
            "coefficient": (2, 1, -1) if turn else (0, 1, -1), "strength": (3, 1, -2), "constant": (3, -1, -2),
            "rate": (0, 0, -1), "force": (1, 1, -2), "torque": (2, 1, -2), "density": (-1, 1, 0), "at": (1, 0, 0),
        }  # fmt: skip
        for key, own in powers.items():
            if key in connection:
                connection[key] = scaled(connection[key], own)
        for key in ("a", "b", "place"):
            if key in connection and not isinstance(connection[key], str):
                connection[key] = scaled(connection[key], (1, 0, 0))
        if "through" in connection:
            connection["through"] = [
                one if isinstance(one, str) else scaled(one, (1, 0, 0)) for one in connection["through"]
            ]
        on = connection.get("on")
        if on is not None:
            on["at"] = on["at"] if isinstance(on["at"], str) else scaled(on["at"], (1, 0, 0))
            for key, own in (("radius", (1, 0, 0)), ("curvature", (-1, 0, 0)), ("rate", (0, 0, -1))):
                if key in on:
                    on[key] = scaled(on[key], own)
    if "times" in found:
        found["times"] = [t * time for t in found["times"]]
    if "searched" in found:
        found["searched"] = [found["searched"][0], found["searched"][1] * length / time]

    def factor(unit: str) -> float:
        powers = UNITS[unit]
        return float(Fraction(length) ** powers[0] * Fraction(mass) ** powers[1] * Fraction(time) ** powers[2])

    def image(figure: Figure) -> Figure | None:
        by = factor(figure.unit)
        return replace(figure, values=figure.values * by, error=figure.error * by, until=figure.until * time)

    def whole(view: View) -> View:
        own = view.mapped(image)
        return replace(
            own,
            times=own.times * time,
            events=[
                replace(
                    event,
                    time=event.time * time,
                    error=event.error * time,
                    impulse=event.impulse,
                    loss=event.loss,
                )
                for event in own.events
            ],
            ended=None if own.ended is None else (own.ended[0], own.ended[1] * time),
            models=[(name, free, None if t is None else t * time) for name, free, t in own.models],
            states=[(t * time, states) for t, states in own.states],
            found={key: (t * time, error * time) for key, (t, error) in own.found.items()},
        )

    return Transformed(found, whole)


def reordered(request: Json) -> Transformed | None:
    """Return a request with bodies, connections and the ends of symmetric connections the other way round."""
    found = copy.deepcopy(request)
    names = {i: one.get("name", f"{one['kind']}-{i + 1}") for i, one in enumerate(found.get("connections", ()))}
    for i, connection in enumerate(found.get("connections", ())):
        connection["name"] = names[i]
        if connection["kind"] in ("rod", "spring", "inverse-square", "gravitation") and "b" in connection:
            connection["a"], connection["b"] = connection["b"], connection["a"]
        if connection["kind"] == "string" and "sides" not in connection and len(connection["through"]) == 2:
            connection["through"] = connection["through"][::-1]
    found["connections"] = found.get("connections", [])[::-1]
    leading = "gravity" in found or dimension(request) == 2
    if leading:
        found["bodies"] = dict(reversed(found["bodies"].items()))
    # The force of a spring without a rest length is the vector from one end to the other.
    springs = [names[i] for i, one in enumerate(request.get("connections", ())) if one["kind"] == "spring"]

    def image(figure: Figure) -> Figure | None:
        return None if figure.what == "vector" and figure.owner in springs else figure

    return Transformed(found, lambda view: view.mapped(image))


def renamed(request: Json) -> Transformed | None:
    """Return a request with other names of bodies and connections."""
    found = copy.deepcopy(request)
    bodies = {name: f"x{k}_{name[:40]}" for k, name in enumerate(reversed(found["bodies"]))}
    read = re.compile(rf"(?<![\w.-])({'|'.join(map(re.escape, bodies))})(?=\.[a-z])") if bodies else None
    names = dict(bodies)
    found["bodies"] = {bodies[name]: body for name, body in found["bodies"].items()}

    def place(value: Any) -> Any:
        if not isinstance(value, str):
            return value
        head, dot, rest = value.partition(".")
        return bodies.get(head, head) + dot + rest

    def formula(value: Any) -> Any:
        if isinstance(value, list):
            return [formula(one) for one in value]
        return read.sub(lambda hit: bodies[hit[1]], value) if read and isinstance(value, str) else value

    for i, connection in enumerate(found.get("connections", ())):
        for key in ("force", "torque", "acceleration", "law", "equals", "rate", "drive"):
            if key in connection:
                connection[key] = formula(connection[key])
        old = connection.get("name", f"{connection['kind']}-{i + 1}")
        names[old] = connection["name"] = f"y{50 - i}-{old[:40]}"
        for key in ("a", "b", "place", "body"):
            if key in connection:
                connection[key] = place(connection[key])
        if "on" in connection:
            connection["on"]["at"] = place(connection["on"]["at"])
        if "through" in connection:
            connection["through"] = [place(one) for one in connection["through"]]
        if "slips" in connection:
            connection["slips"] = [place(one) for one in connection["slips"]]
        if "sides" in connection:
            connection["sides"] = {place(name): sides for name, sides in connection["sides"].items()}
    for occasion in (one[key] for one in found.get("connections", ()) for key in ("from", "until", "at") if key in one):
        if isinstance(occasion, dict) and "name" in (event := occasion.get("event", {})):
            event["name"] = names[event["name"]]
        if isinstance(occasion, dict) and "when" in occasion:
            owner, dot, rest = occasion["when"]["quantity"].partition(".")
            occasion["when"]["quantity"] = names.get(owner, owner) + dot + rest
    if "searched" in found:
        found["searched"] = [bodies[found["searched"][0]], found["searched"][1]]
    return Transformed(found, lambda view: view.renamed(names))


def as_formulas(request: Json) -> Transformed | None:
    """Return a request whose decimals are written as quotients of whole numbers."""
    exempt = ("times", "outputs", "name", "kind", "numbers", "accuracy", "searched")

    def written(value: Any, key: str = "") -> Any:
        if key in exempt or isinstance(value, (bool, str)):
            return value
        if isinstance(value, dict):
            return {name: written(entry, name) for name, entry in value.items()}
        if isinstance(value, list):
            return [written(entry) for entry in value]
        exact = Fraction(repr(value)) if isinstance(value, float) else Fraction(value)
        return f"{exact.numerator}/{exact.denominator}" if exact.denominator > 1 else value

    if any("body" in body for body in request["bodies"].values()):
        return None
    return Transformed(written(request), lambda view: view)


def asked_at_other_times(request: Json) -> Transformed | None:
    """Return a request at half of its times, with two more before the last."""
    if "times" not in request:
        return None
    own = request["times"]
    if len(own) < 3:
        return None
    found = copy.deepcopy(request)
    last = max(own, key=abs)
    kept = [t for k, t in enumerate(own) if k % 2 == 0 or t == last]
    found["times"] = [*kept, 0.37 * last, 0.71 * last]

    def whole(view: View) -> View:
        rows = [k for k, t in enumerate(view.times) if t in kept]

        def image(figure: Figure) -> Figure | None:
            if len(figure.values) != len(view.times):
                return figure
            return replace(figure, values=figure.values[rows])

        figures = {key: image(figure) if key.startswith("column") else figure for key, figure in view.figures.items()}
        return replace(view, figures={k: v for k, v in figures.items() if v is not None}, times=view.times[rows])

    return Transformed(found, whole)


def asked_for_less(request: Json) -> Transformed | None:
    """Return a request for its trajectory alone."""
    found = copy.deepcopy(request)
    found["outputs"] = ["trajectory"]
    found.pop("searched", None)
    kept = ("position", "velocity", "angle", "angular_velocity", "attitude", "axis", "angular_velocity_in_space")

    def image(figure: Figure) -> Figure | None:
        return figure if figure.what in kept else None

    return Transformed(found, lambda view: replace(view.mapped(image), found={}))


def more_accurate(request: Json) -> Transformed | None:
    """Return a request for a finer accuracy."""
    found = copy.deepcopy(request)
    found["accuracy"] = request.get("accuracy", 1e-6) * 1e-5
    return Transformed(found, lambda view: view)


def has_axes(request: Json) -> bool:
    return any(turns(body) for body in request["bodies"].values())


def at(times_of: Any) -> list[float]:
    """Return times as a list, at most nine of them."""
    if isinstance(times_of, dict):
        count = min(int(times_of["count"]), 9)
        return [float(t) for t in np.linspace(times_of["start"], times_of["stop"], count)]
    if len(times_of) > 9:
        return [float(t) for t in times_of[:: len(times_of) // 8][:8]] + [float(times_of[-1])]
    return [float(t) for t in times_of]
