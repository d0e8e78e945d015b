"""Scenes that combine connections of all kinds at random, with the numbers of textbooks: level, at rest, alike."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tests.core.multibody.relations.numbers import Json

DIRECTIONS = (
    ("1", "0"), ("0", "-1"), ("0", "1"), ("0.6", "-0.8"), ("-0.6", "-0.8"), ("0.8", "0.6"), ("sqrt(2)/2", "-sqrt(2)/2"),
    ("1/2", "-sqrt(3)/2"), ("sqrt(3)/2", "1/2"), ("-5/13", "-12/13"), ("0.96", "-0.28"),
)  # fmt: skip
"""Cosines and sines."""


class Draw:
    """Draws what textbooks write."""

    def __init__(self, seed: int) -> None:
        self.random = np.random.default_rng(seed)

    def one_of(self, options: Sequence[Any]) -> Any:
        return options[int(self.random.integers(len(options)))]

    def chance(self, share: float) -> bool:
        return bool(self.random.random() < share)

    def decimal(self, low: float, high: float, digits: int = 2) -> float:
        return round(float(self.random.uniform(low, high)), digits)

    def mass(self) -> Any:
        return self.one_of([1, 1, 2, 0.5, self.decimal(0.3, 4)])

    def length(self) -> Any:
        return self.one_of([1, 0.5, self.decimal(0.4, 1.6)])

    def rate(self) -> Any:
        return self.one_of([0, 0, 1, -2, self.decimal(-4, 4)])

    def law(self, friction: bool = True) -> Json:
        law: Json = {"restitution": self.one_of([0, 0.5, 1])} if self.chance(0.6) else {}
        return law | ({"friction": self.one_of([0.2, 0.5, [0.4, 0.3]])} if friction and self.chance(0.5) else {})


def plane(seed: int) -> Json:
    """Return a scene of the plane of one to four bodies."""
    draw = Draw(seed)
    scene: Json = {"gravity": draw.one_of([[0, -9.81], [0, -10], [0, -9.81], [0, 0]]), "bodies": {}, "connections": []}
    anchor: tuple[Any, list[str]] = ([0, 0], ["0", "0"])
    for k in range(int(draw.random.integers(1, 4))):
        kind = draw.one_of([_point, _point, _bar, _bar, _wheel, _cart])
        if draw.chance(0.3):
            anchor = ([4 * k, 0], [str(4 * k), "0"])
        anchor = kind(draw, scene, f"b{k}", *anchor)
    _extras(draw, scene)
    return scene


def _along(at: Sequence[str], length: Any, direction: Sequence[str]) -> list[str]:
    return [f"{x}+{length}*({d})" for x, d in zip(at, direction, strict=True)]


def _point(draw: Draw, scene: Json, name: str, to: Any, at: list[str]) -> tuple[Any, list[str]]:
    direction, length = draw.one_of(DIRECTIONS), draw.length()
    place = _along(at, length, direction)
    body: Json = {"mass": draw.mass(), "at": place}
    ground = not isinstance(to, str)
    rate = draw.rate()
    if ground and rate:
        body["velocity"] = [f"-({rate})*{length}*({direction[1]})", f"({rate})*{length}*({direction[0]})"]
    kind = draw.one_of(["rod", "rod", "string", "spring", "circle", "line", "loose", "damped", "attracted"])
    add = scene["connections"].append
    drum = isinstance(to, str) and "radius" in scene["bodies"].get(to, {})
    if kind == "rod" or (kind == "string" and drum):
        add({"kind": "rod", "a": name, "b": to})
    elif kind == "string":
        add(
            {"kind": "string", "through": [name, to]}
            | ({"restitution": draw.one_of([0, 0.5])} if draw.chance(0.5) else {})
        )
    elif kind == "circle" and ground:
        add({"kind": "track", "place": name, "on": {"at": to, "radius": length}})
    elif kind == "line":
        slope = draw.one_of([0, {"degrees": 30}, {"degrees": 90}, "atan(3/4)"])
        add({"kind": "track", "place": name, "on": {"at": place, "slope": slope}})
        body.pop("velocity", None)
        if draw.chance(0.5):
            add({"kind": "spring", "a": name, "b": to, "stiffness": draw.one_of([5, 20])})
    elif kind == "attracted":
        add({"kind": "inverse-square", "a": name, "b": to, "strength": draw.one_of([1, 3, -1])})
    elif kind != "loose":
        add(
            {"kind": "spring", "a": name, "b": to, "stiffness": draw.one_of([5, 20, 100]), "rest_length": draw.length()}
        )
        if kind == "damped":
            add({"kind": "damper", "a": name, "b": to, "coefficient": draw.one_of([0.5, 2])})
    if draw.chance(0.4):
        height = f"{place[1]}-{draw.one_of([0, 0.3, 1])}"
        on = {"at": [0, height]} | ({"slope": draw.one_of([0, 0.2])} if draw.chance(0.3) else {})
        if "slope" not in on or height.endswith("-1"):
            add({"kind": "contact", "place": name, "on": on, **draw.law()})
    scene["bodies"][name] = body
    return name, place


def _angle(direction: Sequence[str]) -> str:
    sign = "-" if direction[1].startswith("-") else ""
    return f"{sign}acos({direction[0]})"


def _bar(draw: Draw, scene: Json, name: str, to: Any, at: list[str]) -> tuple[Any, list[str]]:
    direction, half, mass = draw.one_of(DIRECTIONS), draw.one_of([0.5, 0.5, 0.3]), draw.mass()
    body: Json = {
        "mass": mass,
        "inertia": f"{mass}*{half}*{half}/3",
        "at": _along(at, half, direction),
        "angle": _angle(direction),
        "places": {"top": [-half, 0], "end": [half, 0]},
    }
    ground = not isinstance(to, str)
    if ground and draw.chance(0.6):
        body["angular_velocity"] = draw.rate()
    kind = draw.one_of(["pin", "pin", "pin", "spring", "slider", "driven", "wound", "weld", "rods"])
    add = scene["connections"].append
    if kind == "spring":
        add({"kind": "spring", "a": f"{name}.top", "b": [at[0], f"{at[1]}+1"], "stiffness": 20, "rest_length": 0.2})
        add({"kind": "spring", "a": f"{name}.end", "b": to, "stiffness": 10, "rest_length": 0.7})
    elif kind == "slider":
        body.pop("angular_velocity", None)
        add(
            {"kind": "slider", "a": f"{name}.top", "b": to, "slope": 0}
            if ground
            else {"kind": "pin", "a": f"{name}.top", "b": to}
        )
    elif kind == "rods" and ground:
        body.pop("angular_velocity", None)
        for end in ("top", "end"):
            own = at if end == "top" else _along(at, 2 * half, direction)
            add({"kind": "rod", "a": f"{name}.{end}", "b": [own[0], f"{own[1]}+1"]})
    elif kind == "weld":
        body.pop("angular_velocity", None)
        turning = not ground and "inertia" in scene["bodies"][to.partition(".")[0]]
        add({"kind": "weld", "a": f"{name}.top", "b": to} if turning else {"kind": "pin", "a": f"{name}.top", "b": to})
    else:
        add({"kind": "pin", "a": f"{name}.top", "b": to})
    if kind == "driven":
        body.pop("angular_velocity", None)
        add({"kind": "motor", "a": name, "rate": draw.one_of([1, -2])})
    if kind == "wound":
        add({"kind": "torsion-spring", "a": name, "stiffness": draw.one_of([1, 5]), "rest_angle": 0})
        if draw.chance(0.5):
            add({"kind": "damper", "measure": "turn", "a": name, "b": "ground", "coefficient": 0.3})
    end = _along(at, 2 * half, direction)
    if draw.chance(0.3) and kind not in ("weld", "driven"):
        add(
            {
                "kind": "contact",
                "place": f"{name}.end",
                "on": {"at": [0, f"{end[1]}-{draw.one_of([0, 0.2])}"]},
                **draw.law(),
            }
        )
    scene["bodies"][name] = body
    return f"{name}.end", end


def _wheel(draw: Draw, scene: Json, name: str, to: Any, at: list[str]) -> tuple[Any, list[str]]:
    radius, mass = draw.one_of([0.5, 0.2]), draw.mass()
    body: Json = {"mass": mass, "inertia": f"{mass}*{radius}*{radius}/2", "radius": radius}
    add = scene["connections"].append
    kind = draw.one_of(["pinned", "rolling", "touching", "pulley", "gear"])
    centre = [f"{at[0]}+2", f"{at[1]}"]
    body["at"] = centre
    if kind == "rolling":
        slope = draw.one_of([0, "atan(3/4)"])
        foot = (
            [centre[0], f"{centre[1]}-{radius}"]
            if slope == 0
            else [f"{centre[0]}+0.6*{radius}", f"{centre[1]}-0.8*{radius}"]
        )
        add({"kind": "rolling", "place": name, "on": {"at": foot, "slope": slope}})
        if draw.chance(0.5):
            add({"kind": "spring", "a": name, "b": to, "stiffness": 10})
    elif kind == "touching":
        body |= {"velocity": [draw.rate(), 0], "angular_velocity": draw.rate()}
        foot = f"{centre[1]}-{radius}-{draw.one_of([0, 0.4])}"
        add({"kind": "contact", "place": name, "on": {"at": [0, foot]}, **draw.law()})
    else:
        add({"kind": "pin", "a": name, "b": centre})
        if kind == "pinned":
            body["angular_velocity"] = draw.rate()
            add({"kind": "spring", "a": name, "b": to, "stiffness": 10}) if isinstance(to, str) else None
        elif kind == "pulley":
            for end, side in (("l", "-"), ("r", "+")):
                scene["bodies"][f"{name}{end}"] = {
                    "mass": draw.mass(),
                    "at": [f"{centre[0]}{side}{radius}", f"{centre[1]}-2"],
                }
            law = {"restitution": 0} if draw.chance(0.4) else {}
            add(
                {"kind": "string", "through": [f"{name}l", name, f"{name}r"], "sides": {name: ["left", "right"]}, **law}
            )
            if draw.chance(0.4):
                add({"kind": "contact", "place": f"{name}l", "on": {"at": [0, f"{centre[1]}-2.5"]}, **draw.law(False)})
        else:
            other = {"mass": 1, "inertia": 0.02, "radius": 0.2, "at": [f"{centre[0]}+{radius}+0.2", centre[1]]}
            scene["bodies"][f"{name}g"] = other | ({"angular_velocity": 3} if draw.chance(0.5) else {})
            add({"kind": "pin", "a": f"{name}g", "b": other["at"]})
            add({"kind": "rolling", "a": name, "b": f"{name}g"})
            add({"kind": "torque", "body": name, "torque": draw.one_of([1, -0.5])})
    scene["bodies"][name] = body
    return name, centre


def _cart(draw: Draw, scene: Json, name: str, to: Any, at: list[str]) -> tuple[Any, list[str]]:
    place = [f"{at[0]}+1", at[1]]
    body: Json = {"mass": draw.mass(), "at": place, "velocity": [draw.rate(), 0]}
    add = scene["connections"].append
    kind = draw.one_of(["track", "contact", "wall"])
    if kind == "track":
        add({"kind": "track", "place": name, "on": {"at": place}})
    else:
        add({"kind": "contact", "place": name, "on": {"at": place}, **draw.law()})
        if kind == "wall":
            add(
                {
                    "kind": "contact",
                    "place": name,
                    "on": {"at": [f"{place[0]}+0.5", 0], "slope": {"degrees": 90}},
                    **draw.law(False),
                }
            )
    choice = draw.one_of(["spring", "force", "string", "none"])
    drum = isinstance(to, str) and "radius" in scene["bodies"].get(to, {})
    choice = "spring" if choice == "string" and drum else choice
    if choice == "spring":
        add(
            {
                "kind": "spring",
                "a": name,
                "b": to,
                "stiffness": draw.one_of([4, 30]),
                "rest_length": draw.one_of([0.5, 1, 2]),
            }
        )
    elif choice == "force":
        add({"kind": "force", "place": name, "force": [draw.one_of([1, -3]), 0]})
    elif choice == "string":
        add({"kind": "string", "through": [name, to], "length": draw.one_of([1.5, 2]), "restitution": 0})
    scene["bodies"][name] = body
    return name, place


def _extras(draw: Draw, scene: Json) -> None:
    points = [name for name, body in scene["bodies"].items() if "inertia" not in body]
    if len(points) > 1 and draw.chance(0.2):
        scene["connections"].append({"kind": "gravitation", "a": points[0], "b": points[1], "constant": 1})
    if len(points) == len(scene["bodies"]) and draw.chance(0.1) and scene["gravity"][1]:
        kinds = {one["kind"] for one in scene["connections"]}
        if not kinds & {"contact", "string"}:
            scene["connections"].append({"kind": "spinning-frame", "rate": draw.one_of([1, 3])})


def space(seed: int) -> Json:
    """Return a scene of space of one to three bodies."""
    draw = Draw(seed)
    scene: Json = {"gravity": draw.one_of([[0, 0, -9.81], [0, 0, -10], [0, 0, 0]]), "bodies": {}, "connections": []}
    to: Any = [0, 0, 0]
    at = ["0", "0", "0"]
    for k in range(int(draw.random.integers(1, 4))):
        name = f"b{k}"
        if draw.chance(0.4):
            to, at = [4 * k, 0, 0], [str(4 * k), "0", "0"]
        kind = draw.one_of([_particle, _particle, _body, _ball])
        to, at = kind(draw, scene, name, to, at)
    return scene


UNIT = (
    ("1", "0", "0"),
    ("0", "0", "-1"),
    ("0.6", "0", "-0.8"),
    ("0", "0.8", "-0.6"),
    ("1/3", "2/3", "-2/3"),
    ("0.48", "0.64", "-0.6"),
)


def _particle(draw: Draw, scene: Json, name: str, to: Any, at: list[str]) -> tuple[Any, list[str]]:
    direction, length = draw.one_of(UNIT), draw.length()
    place = _along(at, length, direction)
    body: Json = {"mass": draw.mass(), "at": place}
    ground = not isinstance(to, str)
    u = draw.rate()
    if ground and u:
        # Across the direction from the anchor.
        body["velocity"] = [f"({u})*({direction[1]})", f"-({u})*({direction[0]})", 0]
    kind = draw.one_of(["rod", "rod", "sphere", "string", "spring", "plane", "line", "loose"])
    add = scene["connections"].append
    if kind == "rod":
        add({"kind": "rod", "a": name, "b": to})
    elif kind == "sphere" and ground:
        add({"kind": "track", "place": name, "on": {"at": to, "radius": length}})
    elif kind == "string":
        add({"kind": "string", "through": [name, to]})
    elif kind == "plane":
        body.pop("velocity", None)
        add(
            {
                "kind": "track",
                "place": name,
                "on": {"at": place, "normal": draw.one_of([[0, 0, 1], [0, 0.6, 0.8], [1, 2, 2]])},
            }
        )
        add({"kind": "spring", "a": name, "b": to, "stiffness": 10})
    elif kind == "line":
        body.pop("velocity", None)
        add(
            {
                "kind": "track",
                "place": name,
                "on": {"at": place, "direction": draw.one_of([[1, 0, 0], [0.6, 0.8, 0], [1, 2, 2]])},
            }
        )
    elif kind == "loose":
        foot = f"{place[2]}-{draw.one_of([0, 0.5])}"
        add({"kind": "contact", "place": name, "on": {"at": [0, 0, foot], "normal": [0, 0, 1]}, **draw.law()})
    else:
        add({"kind": "spring", "a": name, "b": to, "stiffness": 10, "rest_length": draw.length()})
    scene["bodies"][name] = body
    return name, place


def _body(draw: Draw, scene: Json, name: str, to: Any, at: list[str]) -> tuple[Any, list[str]]:
    arm = draw.one_of([0.5, 0.3])
    tilted = draw.chance(0.5)
    axes = [["0.8", 0, "0.6"], [0, 1, 0], ["-0.6", 0, "0.8"]] if tilted else [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    place = [f"{x}-({arm})*({d})" for x, d in zip(at, axes[2], strict=True)]
    body: Json = {
        "mass": draw.mass(),
        "moments": draw.one_of([[0.2, 0.2, 0.1], [0.1, 0.2, 0.25], [0.3, 0.3, 0.3]]),
        "at": place,
        "axes": axes,
        "places": {"top": [0, 0, arm], "end": [0, 0, -arm]},
    }
    add = scene["connections"].append
    kind = draw.one_of(["hinge", "ball-joint", "free", "spring"])
    ground = not isinstance(to, str)
    if kind == "hinge":
        rigid = ground or "moments" in scene["bodies"][to.partition(".")[0]]
        add({"kind": "pin", "a": f"{name}.top", "b": to} | ({"axis": [0, 1, 0]} if rigid else {}))
        if ground:
            body["angular_velocity"] = [0, draw.rate(), 0]
    elif kind == "ball-joint":
        add({"kind": "ball-joint", "a": f"{name}.top", "b": to})
        if ground:
            body["angular_velocity"] = [draw.rate(), draw.rate(), draw.rate()]
    else:
        body["angular_velocity"] = [draw.rate(), draw.rate(), draw.rate()]
        body["velocity"] = [draw.rate(), 0, 0]
        if kind == "spring":
            above = [at[0], at[1], f"{at[2]}+1"]
            add({"kind": "spring", "a": f"{name}.top", "b": above, "stiffness": 20, "rest_length": 0.3})
    scene["bodies"][name] = body
    return f"{name}.end", _along(at, f"(-2*{arm})", [str(x) for x in axes[2]])


def _ball(draw: Draw, scene: Json, name: str, to: Any, at: list[str]) -> tuple[Any, list[str]]:
    radius = draw.one_of([0.5, 0.1])
    place = [f"{at[0]}+2", at[1], at[2]]
    inertia = f"0.4*{radius}*{radius}"
    body: Json = {"mass": 1, "moments": [inertia] * 3, "radius": radius, "at": place}
    kind = draw.one_of(["rolling", "contact"])
    normal = draw.one_of([[0, 0, 1], [0, 0, 1], [0.6, 0, 0.8]])
    foot = [f"{x}-{radius}*{n}" for x, n in zip(place, normal, strict=True)]
    on = {"at": foot, "normal": normal}
    if kind == "rolling":
        scene["connections"].append({"kind": "rolling", "place": name, "on": on})
        if draw.chance(0.3):
            scene["connections"].append({"kind": "spring", "a": name, "b": to, "stiffness": 5})
    else:
        body |= {"velocity": [draw.rate(), draw.rate(), 0], "angular_velocity": [draw.rate(), 0, draw.rate()]}
        scene["connections"].append({"kind": "contact", "place": name, "on": on, **draw.law()})
    scene["bodies"][name] = body
    return name, place
