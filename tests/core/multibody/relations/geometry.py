"""Requests turned, moved and seen in a mirror, and what that does to their answers."""

from __future__ import annotations

import copy
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from tests.core.multibody.relations.numbers import Json, components, plus, times, transformed
from tests.core.multibody.relations.views import Figure, View, without_freedoms

PLACES = ("a", "b", "place")
SCALARS = ("tension", "force", "angle", "angular_velocity", "torque", "moment", "work", "path", "kinetic", "potential",
           "total", "angular_momentum", "angular_acceleration")  # fmt: skip
"""Figures of the plane that a rotation leaves as they are."""


@dataclass(frozen=True)
class Transformed:
    """A request and what becomes of the answer to the original one."""

    request: Json
    image: Callable[[View], View]
    restored: Callable[[View, View], View] = lambda found, original: found
    """The answer without what was added, by the original answer."""


def dimension(request: Json) -> int:
    leading = request.get("gravity") or next(iter(request["bodies"].values()))["at"]
    return len(components(leading))


def turns(body: Json) -> bool:
    """Return whether a body has axes."""
    return any(key in body for key in ("inertia", "moments", "tensor", "body", "shape"))


def in_space(place: Any, request: Json) -> bool:
    """Return whether what is described at a place is described in the axes of space."""
    if not isinstance(place, str):
        return True
    return not turns(request["bodies"].get(place.partition(".")[0], {}))


def _moved_places(connection: Json, point: Callable[[Any], Any]) -> None:
    """Change the places of the ground among the ends of a connection."""
    for key in PLACES:
        if key in connection and not isinstance(connection[key], str):
            connection[key] = point(connection[key])
    if "on" in connection and not isinstance(connection["on"]["at"], str):
        connection["on"]["at"] = point(connection["on"]["at"])
    if "through" in connection:
        connection["through"] = [one if isinstance(one, str) else point(one) for one in connection["through"]]
    if connection["kind"] == "spinning-frame" and "at" in connection:
        connection["at"] = point(connection["at"])


def moved(request: Json, by: Sequence[str]) -> Transformed | None:
    """Return a request moved as a whole."""
    if any(one["kind"] == "spinning-frame" and "at" not in one for one in request.get("connections", ())):
        return None
    found = copy.deepcopy(request)

    def point(at: Any) -> list[Any]:
        return [plus(x, d) for x, d in zip(components(at), by, strict=True)]

    for body in found["bodies"].values():
        body["at"] = point(body["at"])
    for connection in found.get("connections", ()):
        _moved_places(connection, point)
    offset = np.array([float(Fraction(x)) for x in by])

    def image(figure: Figure) -> Figure | None:
        if figure.what == "position":
            # The moved columns are larger, and so is their rounding.
            return replace(
                figure, values=figure.values + offset, error=figure.error + 2.0**-50 * float(np.abs(offset).max())
            )
        if figure.what in ("angular_momentum", "potential", "total"):
            return None
        return figure

    return Transformed(found, lambda view: view.mapped(image))


def turned(request: Json, *, about: int = 2, sides: tuple[int, int, int] = (3, 4, 5)) -> Transformed | None:
    """Return a request turned by an angle of a right triangle with whole sides, in space about one of the axes."""
    size = dimension(request)
    if any("sides" in one for one in request.get("connections", ())):
        return None
    if size == 3 and about != 2 and any(one["kind"] == "spinning-frame" for one in request.get("connections", ())):
        return None
    cosine, sine = f"{sides[0]}/{sides[2]}", f"{sides[1]}/{sides[2]}"
    c, s = sides[0] / sides[2], sides[1] / sides[2]
    matrix = [[cosine, f"-{sine}"], [sine, cosine]]
    numbers = np.array([[c, -s], [s, c]])
    if size == 3:
        i, j = [axis for axis in range(3) if axis != about]
        whole = [["1" if r == c else "0" for c in range(3)] for r in range(3)]
        numbers = np.eye(3)
        for row, column in ((0, 0), (0, 1), (1, 0), (1, 1)):
            r, q = (i, j)[row], (i, j)[column]
            numbers[r, q] = [[c, -s], [s, c]][row][column]
            whole[r][q] = matrix[row][column]
        matrix = whole
    found = copy.deepcopy(request)

    def vector(v: Any) -> list[Any]:
        return transformed(matrix, v)

    if "gravity" in found:
        found["gravity"] = vector(found["gravity"])
    for body in found["bodies"].values():
        body["at"] = vector(body["at"])
        if "velocity" in body:
            body["velocity"] = vector(body["velocity"])
        if turns(body):
            if size == 2:
                body["angle"] = plus(body.get("angle", 0), f"acos({cosine})")
            else:
                body["axes"] = [vector(axis) for axis in body.get("axes", [[1, 0, 0], [0, 1, 0], [0, 0, 1]])]
    for connection in found.get("connections", ()):
        _moved_places(connection, vector)
        for key in ("force", "direction", "axis"):
            if key in connection and (key != "direction" or in_space(connection["b"], request)):
                connection[key] = vector(connection[key])
        if size == 2 and connection.get("b", "ground") == "ground":
            for key in ("rest_angle", "at_least", "at_most"):
                if key in connection:
                    connection[key] = plus(connection[key], f"acos({cosine})")
        if isinstance(connection.get("torque"), list):
            connection["torque"] = vector(connection["torque"])
        _turn_slopes(connection, request, size, vector, f"acos({cosine})")
    angle = float(np.arccos(c))
    # The potential of a torque is zero where the angle is.
    shifted = ("potential", "total") if any(one["kind"] == "torque" for one in request.get("connections", ())) else ()

    def image(figure: Figure) -> Figure | None:
        values = figure.values
        if figure.what in ("x", "y", "z", *shifted):
            return None
        if figure.what == "extremes":
            return figure
        if figure.what == "angle":
            return replace(figure, values=values + angle, error=figure.error + 2.0**-50)
        if figure.what == "attitude":
            return replace(figure, values=_quaternions_after(about, angle, values))
        in_body = size == 3 and figure.what in ("angular_velocity", "angular_acceleration")
        if size == 3 and figure.what.startswith("friction"):
            return None
        if values.ndim == 2 and values.shape[1] == size and not in_body:
            return replace(figure, values=values @ numbers.T)
        if values.ndim == 2 and values.shape[1] > 1 and not in_body:
            return None
        if size == 3 and figure.owner.endswith(".normal"):
            return None
        return figure

    return Transformed(found, lambda view: without_freedoms(view.mapped(image)), lambda view, _: without_freedoms(view))


def _turn_slopes(connection: Json, request: Json, size: int, vector: Callable[[Any], list[Any]], angle: str) -> None:
    """Turn the faces and lines of a connection that are given in the axes of space."""
    if (
        connection["kind"] == "slider"
        and size == 2
        and "direction" not in connection
        and in_space(connection["b"], request)
    ):
        connection["slope"] = plus(connection.get("slope", 0), angle)
    on = connection.get("on")
    if on is None or not in_space(on["at"], request):
        return
    for key in ("normal", "direction"):
        if key in on:
            on[key] = vector(on[key])
    if size == 2 and "radius" not in on and "normal" not in on:
        on["slope"] = plus(on.get("slope", 0), angle)


def _quaternions_after(about: int, angle: float, q: np.ndarray) -> np.ndarray:
    """Return the attitudes that follow when space is turned about one of its axes."""
    w, v = np.cos(angle / 2), np.zeros(3)
    v[about] = np.sin(angle / 2)
    first = w * q[:, 0] - q[:, 1:] @ v
    rest = w * q[:, 1:] + q[:, :1] * v + np.cross(np.broadcast_to(v, q[:, 1:].shape), q[:, 1:])
    return np.column_stack([first, rest])


MIRRORED_SIDES = {"left": "right", "right": "left", "above": "above", "below": "below"}
MIRRORED_STATES = {"slide": "slide back", "slide back": "slide"}


def mirrored(request: Json) -> Transformed | None:
    """Return a request of the plane seen in a mirror along its first axis."""
    if dimension(request) == 3:
        return None
    found = copy.deepcopy(request)

    def vector(v: Any) -> list[Any]:
        x, y = components(v)
        return [times(x, "-1"), y]

    if "gravity" in found:
        found["gravity"] = vector(found["gravity"])
    for body in found["bodies"].values():
        body["at"] = vector(body["at"])
        body["places"] = {name: vector(place) for name, place in body.get("places", {}).items()}
        for key in ("angle", "angular_velocity"):
            if key in body:
                body[key] = times(body[key], "-1")
        if "velocity" in body:
            body["velocity"] = vector(body["velocity"])
    for connection in found.get("connections", ()):
        _moved_places(connection, vector)
        for key in ("force", "direction"):
            if key in connection:
                connection[key] = vector(connection[key])
        for key in ("slope", "torque", "rest_angle"):
            if key in connection:
                connection[key] = times(connection[key], "-1")
        if "rate" in connection and (connection["kind"] == "motor" or connection.get("about") == "normal"):
            connection["rate"] = times(connection["rate"], "-1")
        low, high = connection.pop("at_least", None), connection.pop("at_most", None)
        connection |= {} if high is None else {"at_least": times(high, "-1")}
        connection |= {} if low is None else {"at_most": times(low, "-1")}
        if "on" in connection and "slope" in connection["on"]:
            connection["on"]["slope"] = times(connection["on"]["slope"], "-1")
        for drum, sides in connection.get("sides", {}).items():
            own = [MIRRORED_SIDES[side] for side in ([sides] if isinstance(sides, str) else sides)]
            connection["sides"][drum] = own[0] if isinstance(sides, str) else own

    def image(figure: Figure) -> Figure | None:
        values = figure.values
        if figure.what in ("angle", "angular_velocity", "angular_momentum", "angular_acceleration"):
            return replace(figure, values=-values)
        if figure.what in ("torque", "moment", "normal") or figure.what.startswith("friction"):
            return None
        if figure.what == "extremes":
            return figure
        if values.ndim == 2 and values.shape[1] == 2:
            return replace(figure, values=values * [-1.0, 1.0])
        return figure

    def whole(view: View) -> View:
        states = [
            (t, {name: MIRRORED_STATES.get(state, state) for name, state in own.items()}) for t, own in view.states
        ]
        return replace(view.mapped(image), states=states)

    return Transformed(found, whole)


def reversed_in_time(request: Json) -> Transformed | None:
    """Return a smooth request whose motion is the original one at opposite times, which that under friction is not."""
    kinds = {one["kind"] for one in request.get("connections", ())}
    restless = any({"restitution", "friction"} & one.keys() for one in request.get("connections", ()))
    if kinds & {"contact", "damper", "string", "chain"} or restless or "times" not in request:
        return None
    found = copy.deepcopy(request)
    for body in found["bodies"].values():
        if "velocity" in body:
            body["velocity"] = [times(x, "-1") for x in components(body["velocity"])]
        if "angular_velocity" in body:
            rate = body["angular_velocity"]
            body["angular_velocity"] = [times(x, "-1") for x in rate] if isinstance(rate, list) else times(rate, "-1")
    for connection in found.get("connections", ()):
        for rated in (connection, connection.get("on", {})):
            if "rate" in rated:
                rated["rate"] = times(rated["rate"], "-1")
    found["times"] = [-t for t in found["times"]]
    found.pop("searched", None)
    odd = ("velocity", "angular_velocity", "angular_velocity_in_space", "momentum", "angular_momentum")

    def image(figure: Figure) -> Figure | None:
        if figure.what in ("path", "work", "extremes"):
            return None
        return replace(figure, values=-figure.values) if figure.what in odd else figure

    def whole(view: View) -> View:
        own = view.mapped(image)
        return replace(own, times=-own.times, events=[], ended=None, found={})

    # What ends the motion is an event of one answer, and of the other one before its start, where nothing is compared.
    return Transformed(found, whole, lambda view, _: replace(view, events=[]))
