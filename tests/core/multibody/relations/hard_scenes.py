"""Scenes that are hard for a reason: redundant rows, double zeros, events at one instant, shared loads, near misses."""

from __future__ import annotations

import json
from typing import Any

from tests.core.multibody.relations.numbers import Json
from tests.core.multibody.relations.sources import asked

G = [0, -9.81]
FLOOR = {"at": [0, 0]}
UPRIGHT = {"degrees": 90}


def _contact(place: str, on: Json, **law: Any) -> Json:
    return {"kind": "contact", "place": place, "on": on, **law}


def _rod(a: str, b: Any) -> Json:
    return {"kind": "rod", "a": a, "b": b}


PLATFORM = {"mass": 4, "inertia": 1, "at": [0.6, -0.8], "places": {"a": [-0.5, 0], "b": [0.5, 0]}}
LADDER = {
    "mass": 1,
    "inertia": "1/12",
    "at": [-0.14, 0.48],
    "angle": "acos(0.28)",
    "places": {"f": [-0.5, 0], "h": [0.5, 0]},
}
GEAR = {"mass": 1, "inertia": 0.5, "radius": 1, "at": [0, 0]}

SCENES: dict[str, Json] = {
    "platform on three parallel rods": {
        "gravity": G,
        "bodies": {"p": PLATFORM},
        "connections": [_rod("p.a", [-0.5, 0]), _rod("p.b", [0.5, 0]), _rod("p", [0, 0])],
        "times": [0.2, 0.5, 1.0],
    },
    "pendulum from 45 degrees": {
        "gravity": G,
        "bodies": {"p": {"mass": 1, "at": [1, -1]}},
        "connections": [_rod("p", [0, 0])],
        "times": [0.3, 1.0, 4.0],
    },
    "bead on a parabola from slope 1": {
        "gravity": G,
        "bodies": {"p": {"mass": 1, "at": [1, 0.5]}},
        "connections": [{"kind": "track", "place": "p", "on": {"at": [0, 0], "curvature": 1, "slope": 0}}],
        "times": [0.3, 1.0, 4.0],
    },
    "driven wheel and a pendulum": {
        "gravity": G,
        "bodies": {"c": {"mass": 1, "inertia": 0.1, "at": [0, 0]}, "d": {"mass": 1, "at": [5.6, -0.8]}},
        "connections": [
            {"kind": "motor", "a": "c", "rate": -3.2},
            {"kind": "pin", "a": "c", "b": [0, 0]},
            _rod("d", [5, 0]),
        ],
        "times": [0.5, 1.0, 2.0],
    },
    "block whose string reaches its pulley": {
        "gravity": G,
        "bodies": {"b": {"mass": 1, "at": [-1, 0]}, "w": {"mass": 1, "at": [0, -0.5]}},
        "connections": [
            _contact("b", FLOOR, friction=0.2),
            {"kind": "string", "through": ["b", [0, 0], "w"]},
        ],
        "times": [0.2, 0.5, 1.0],
    },
    "block on a track whose string reaches its pulley": {
        "gravity": G,
        "bodies": {"b": {"mass": 1, "at": [-1, 0]}, "w": {"mass": 1, "at": [0, -0.5]}},
        "connections": [
            {"kind": "track", "place": "b", "on": FLOOR},
            {"kind": "string", "through": ["b", [0, 0], "w"]},
        ],
        "times": [0.2, 0.5, 1.0],
    },
    "ball that bounces for ever beside one that comes to rest": {
        "gravity": [0, -10],
        "bodies": {"a": {"mass": 1, "at": [0, 1.25]}, "b": {"mass": 1, "at": [3, 11.25]}},
        "connections": [_contact("a", FLOOR, restitution=0.5), _contact("b", {"at": [3, 0]}, restitution=1)],
        "times": [1.0, 1.6, 2.0, 4.0],
    },
    "weight of an Atwood machine that lands": {
        "gravity": [0, -10],
        "bodies": {"a": {"mass": 3, "at": [-0.5, 2]}, "b": {"mass": 2, "at": [0.5, 2]}},
        "connections": [
            {"kind": "string", "through": ["a", [-0.5, 3], [0.5, 3], "b"], "restitution": 0},
            _contact("a", {"at": [0, 1.8]}, restitution=0.5),
        ],
        "times": [0.3, 0.6, 0.7, 1.0],
    },
    "stone on a string that is slack for an instant": {
        "gravity": [0, -10],
        "bodies": {"p": {"mass": 1, "at": [0, -1], "velocity": ["sqrt(50*(1-1e-6))", 0]}},
        "connections": [{"kind": "string", "through": ["p", [0, 0]], "restitution": 0}],
        "times": [0.2, 0.5, 0.8],
    },
    "pendulum from beside its highest place": {
        "gravity": G,
        "bodies": {
            "p": {
                "mass": 1,
                "inertia": 0.1,
                "at": ["sin(1e-9)", "cos(1e-9)"],
                "angle": "pi-1e-9",
                "places": {"o": [0, 1]},
            }
        },
        "connections": [{"kind": "pin", "a": "p.o", "b": [0, 0]}],
        "times": [1.0, 5.0, 9.0, 14.0],
    },
    "pendulum beside a ball that comes to rest": {
        "gravity": G,
        "bodies": {"p": {"mass": 1, "at": ["sin(2.5)", "-cos(2.5)"]}, "q": {"mass": 1, "at": [100, 1]}},
        "connections": [_rod("p", [0, 0]), _contact("q", FLOOR, restitution=0.5)],
        "times": [1.0, 3.0, 10.0],
    },
    "bead on a rough turning wire": {
        "gravity": [0, 0],
        "bodies": {"p": {"mass": 1, "at": [1, 0], "velocity": [1, 0]}},
        "connections": [
            {"kind": "spinning-frame", "rate": 3, "about": "normal"},
            _contact("p", FLOOR, friction=0.3),
        ],
        "times": [0.1, 0.3],
    },
    "block that lands flat": {
        "gravity": [0, -10],
        "bodies": {"p": {"mass": 1, "inertia": 0.1, "at": [0, 0.7], "places": {"l": [-0.5, -0.2], "r": [0.5, -0.2]}}},
        "connections": [_contact("p.l", FLOOR, order=1), _contact("p.r", FLOOR, order=1)],
        "times": [0.2, 0.5],
    },
    "masses on a string above a floor": {
        "gravity": G,
        "bodies": {"a": {"mass": 1, "at": [-0.5, 2]}, "b": {"mass": 1.01, "at": [0.5, 2]}},
        "connections": [
            {"kind": "string", "through": ["a", [-0.5, 3], [0.5, 3], "b"], "restitution": 0},
            _contact("a", FLOOR),
            _contact("b", FLOOR),
        ],
        "times": [1.0, 5.0, 20.0],
    },
    "ladder with friction at both ends": {
        "gravity": G,
        "bodies": {"l": LADDER},
        "connections": [
            _contact("l.f", FLOOR, friction=0.4),
            _contact("l.h", {"at": [0, 0], "slope": UPRIGHT}, friction=0.4),
        ],
        "times": [0.1, 0.3],
    },
    "ladder that is pulled": {
        "bodies": {"l": LADDER, "m": {"mass": 1000, "at": [-1.14, 0.48], "velocity": [-1, 0]}},
        "gravity": [0, -10],
        "connections": [
            {"name": "floor", **_contact("l.f", FLOOR, friction=0.3)},
            {"name": "wall", **_contact("l.h", {"at": [0, 0], "slope": UPRIGHT}, friction=0.3)},
            {"kind": "track", "place": "m", "on": {"at": [0, 0.48]}},
            {"kind": "spring", "a": "l", "b": "m", "stiffness": 10},
        ],
        "times": [0.2, 0.4],
    },
    "loop and a mass that is attracted": {
        "gravity": [0, -10],
        "bodies": {"v": {"mass": 1, "at": [0, -1], "velocity": ["sqrt(35)", 0]}, "m": {"mass": 1, "at": [3.5, 0]}},
        "connections": [
            _contact("v", {"at": [0, 0], "radius": -1}),
            {"kind": "track", "place": "m", "on": {"at": [3, 0]}},
            {"kind": "inverse-square", "a": [3, 0], "b": "m", "strength": 1.5},
            {"kind": "spring", "a": "m", "b": "v", "stiffness": 5},
        ],
        "times": [0.2, 0.375, 0.41],
    },
    "two pendulums against two walls": {
        "gravity": [0, -10],
        "bodies": {"a": {"mass": 1, "at": [0.6, -0.8]}, "b": {"mass": 1, "at": [5.6, -0.8]}},
        "connections": [
            _rod("a", [0, 0]),
            _rod("b", [5, 0]),
            _contact("a", {"at": [0, 0], "slope": {"degrees": -90}}),
            _contact("b", {"at": [5, 0], "slope": {"degrees": -90}}),
        ],
        "times": [0.3, 0.8],
    },
    "two stones on humps with a string": {
        "gravity": [0, -10],
        "bodies": {"a": {"mass": 1, "at": [0.6, 0.8]}, "b": {"mass": 1, "at": [5.6, 0.8]}},
        "connections": [
            _contact("a", {"at": [0, 0], "radius": 1}),
            _contact("b", {"at": [5, 0], "radius": 1}),
            {"kind": "string", "through": ["a", "b"]},
        ],
        "times": [0.1, 0.2, 0.5],
    },
    "two stones on humps with a rod and a damper": {
        "gravity": [0, -10],
        "bodies": {"a": {"mass": 1, "at": [0.6, 0.8]}, "b": {"mass": 1, "at": [5.6, 0.8]}},
        "connections": [
            _contact("a", {"at": [0, 0], "radius": 1}),
            _contact("b", {"at": [5, 0], "radius": 1}),
            _rod("a", "b"),
            {"kind": "damper", "a": "a", "b": "b", "coefficient": 1},
        ],
        "times": [0.1, 0.2, 0.5],
    },
    "body on an oblique line of space": {
        "gravity": [0, 0, -10],
        "bodies": {"p": {"mass": 1, "moments": [0.1, 0.2, 0.25], "at": [0, 0, 0], "places": {"e": [0.5, 0, 0]}}},
        "connections": [{"kind": "track", "place": "p.e", "on": {"at": [0.5, 0, 0], "direction": [0.6, 0.8, 0]}}],
        "times": [0.1, 0.3],
    },
    "gears, a spring and a stone on a slack string": {
        "gravity": [0, -10],
        "bodies": {
            "u": {**GEAR, "angular_velocity": 1},
            "w": {**GEAR, "at": [2, 0]},
            "s": {"mass": 1, "at": [4, 0]},
        },
        "connections": [
            {"kind": "pin", "a": "u", "b": [0, 0]},
            {"kind": "pin", "a": "w", "b": [2, 0]},
            {"kind": "rolling", "a": "u", "b": "w"},
            {"kind": "string", "through": ["s", [5, 0]], "length": 1.5, "restitution": 0},
            {"kind": "spring", "a": "w", "b": "s", "stiffness": 2},
        ],
        "times": [0.2, 0.5, 1.0],
    },
    "ladder with one rough end": {
        "gravity": [0, -10],
        "bodies": {
            "l": {
                "mass": 1,
                "inertia": 0.1,
                "at": [-0.3, 0.4],
                "angle": "atan(4/3)",
                "places": {"f": [-0.5, 0], "h": [0.5, 0]},
            }
        },
        "connections": [
            _contact("l.f", FLOOR),
            {"name": "wall", **_contact("l.h", {"at": [0, 0], "slope": UPRIGHT}, friction=0.5)},
        ],
        "times": [0.1, 0.2, 0.4],
    },
    "driven paddle that strikes": {
        "gravity": [0, 0],
        "bodies": {
            "c": {"mass": 1, "inertia": 0.1, "at": [0, 0], "angular_velocity": 2},
            "m": {"mass": 1, "at": [1, 0.5], "velocity": [0, 0]},
        },
        "connections": [
            {"kind": "pin", "a": "c", "b": [0, 0]},
            {"kind": "motor", "a": "c", "rate": 2},
            {"name": "paddle", **_contact("m", {"at": "c"})},
        ],
        "times": [0.2, 0.5, 1.0],
    },
    "weight that reaches its drum": {
        "gravity": [0, -10],
        "bodies": {
            "a": {"mass": 1, "at": [-0.5, -0.5]},
            "b": {"mass": 3, "at": [0.5, -2]},
            "w": {"mass": 1, "inertia": 0.1, "radius": 0.5, "at": [0, 0]},
        },
        "connections": [
            {"kind": "pin", "a": "w", "b": [0, 0]},
            {"kind": "string", "through": ["a", "w", "b"], "sides": {"w": ["left", "right"]}},
        ],
        "times": [0.1, 0.3, 0.6],
    },
    "bar on three places": {
        "gravity": [0, -10],
        "bodies": {
            "p": {
                "mass": 1,
                "inertia": 0.3,
                "at": [0, 0],
                "velocity": [1, 0],
                "places": {"l": [-0.5, 0], "m": [0, 0], "r": [0.5, 0]},
            }
        },
        "connections": [_contact(f"p.{k}", FLOOR, friction=0.4) for k in "lmr"],
        "times": [0.1, 0.3],
    },
}
"""Numbers are those that a textbook would write, in SI units."""


def hard_scenes() -> dict[str, Json]:
    """Return the requests for these scenes."""
    return {name: asked(json.loads(json.dumps(scene))) for name, scene in SCENES.items()}
