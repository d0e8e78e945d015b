"""Impacts, rolling and strings: which start leads to what is wanted."""

from __future__ import annotations

from mpmath import cos, mpf, sin, sqrt

from tests.service.textbook.asked import SCENES, Asked, Body, equals, let

G = mpf("9.81")

LOOP: Body = {
    "gravity": [0, -9.81],
    "let": {"v": 4},
    "bodies": {"stone": {"mass": 1, "at": [0, -0.5], "velocity": ["v", 0]}},
    "connections": [{"kind": "string", "name": "string", "through": ["stone", [0, 0]]}],
    "times": [0.5],
    "outputs": ["energy"],
}
THROWN_DISC: Body = {
    "gravity": [0, -9.81],
    "let": {"f": 0.2, "w": 0, "v": 3},
    "bodies": {
        "disc": {
            "mass": 1,
            "inertia": 0.005,
            "radius": 0.1,
            "at": [0, 0.1],
            "velocity": ["v", 0],
            "angular_velocity": "w",
        }
    },
    "connections": [{"kind": "contact", "name": "floor", "place": "disc", "on": {"at": [0, 0]}, "friction": "f"}],
    "times": [5],
}
SPEED = "/trajectory/columns/disc.velocity/values/0/0"
COLLISION: Body = {
    "let": {"m": 2, "e": 1},
    "bodies": {
        "first": {"mass": 1, "inertia": 1, "radius": 0.1, "at": [0, 0], "velocity": [2, 0]},
        "second": {"mass": "m", "inertia": 1, "radius": 0.1, "at": [1, 0]},
    },
    "connections": [{"kind": "contact", "name": "pair", "a": "first", "b": "second", "restitution": "e"}],
    "times": [1],
}
FIRST = "/trajectory/columns/first.velocity/values/0/0"
CLIMB: Body = {
    "gravity": ["-9.81*sin(a)", "-9.81*cos(a)"],
    "let": {"v": 4, "a": 0.5},
    "bodies": {"block": {"mass": 2, "at": [0, 0], "velocity": ["v", 0]}},
    "connections": [{"kind": "contact", "name": "floor", "place": "block", "on": {"at": [0, 0]}, "friction": 0.3}],
    "times": [2],
    "outputs": [{"extremes": "block.position.x"}],
}
SLOWED: Body = {
    "gravity": [0, -9.81],
    "let": {"f": 0.3, "v": 4},
    "bodies": {"block": {"mass": 2, "at": [0, 0], "velocity": ["v", 0]}},
    "connections": [{"kind": "contact", "name": "floor", "place": "block", "on": {"at": [0, 0]}, "friction": "f"}],
    "times": [20],
}
DRAWN: Body = {
    "gravity": [0, -9.81],
    "let": {"v": 2},
    "bodies": {
        "plank": {"mass": 4, "inertia": 1, "at": [0, 0]},
        "block": {"mass": 1, "at": [0, 0], "velocity": ["v", 0]},
    },
    "connections": [
        {"kind": "slider", "name": "ice", "a": "plank", "b": [0, 0], "slope": 0},
        {"kind": "contact", "name": "top", "place": "block", "on": {"at": "plank"}, "friction": 0.3},
    ],
    "times": [2],
}

CONTACTS = [
    Asked(
        "just round the loop",
        SCENES,
        LOOP,
        let("v", 4, 6),
        {"event": {"kind": "slack", "name": "string"}, "happens": True},
        [sqrt(5 * G / 2)],
        "v^2 = 5 g l",
    ),
    Asked(
        "just leaves the lower half",
        SCENES,
        LOOP,
        let("v", 2, 4),
        {"event": {"kind": "slack", "name": "string"}, "happens": True},
        [sqrt(2 * G / 2)],
        "v^2 = 2 g l",
    ),
    Asked(
        "friction for rolling after 1 s",
        SCENES,
        THROWN_DISC,
        let("f", 0.05, 0.5),
        equals({"event": {"kind": "roll", "name": "floor"}}, 1),
        [1 / G],
        "t = v/(3 f g)",
    ),
    Asked(
        "backspin that stops a disc",
        SCENES,
        THROWN_DISC | {"let": {"f": 0.2, "w": 10, "v": 1}},
        let("w", 0, 50),
        equals(SPEED, 0),
        [20.0],
        "w r = 2 v",
    ),
    Asked("mass that stops the first", SCENES, COLLISION, let("m", 0.3, 4), equals(FIRST, 0), [1.0], "equal masses"),
    Asked(
        "mass that sends the first back",
        SCENES,
        COLLISION,
        let("m", 1.1, 20),
        equals(FIRST, -1),
        [3.0],
        "v (1 - m)/(1 + m)",
    ),
    Asked(
        "restitution from a speed",
        SCENES,
        COLLISION,
        let("e", 0.1, 0.95),
        equals(FIRST, 0),
        [0.5],
        "(m1 - e m2) v/(m1 + m2)",
    ),
    Asked(
        "stopping distance",
        SCENES,
        SLOWED,
        let("f", 0.1, 0.8),
        equals("/trajectory/columns/block.position/values/0/0", 2),
        [4 / G],
        "v^2/(2 f g)",
    ),
    Asked(
        "speed for a stopping time",
        SCENES,
        SLOWED,
        let("v", 1, 10),
        equals({"event": {"kind": "stick", "name": "floor"}}, 2),
        [mpf("0.6") * G],
        "v/(f g)",
    ),
    Asked(
        "speed for a height on an incline",
        SCENES,
        CLIMB,
        let("v", 1, 8),
        equals("/extremes/0/largest", 1),
        [sqrt(2 * G * (mpf("0.3") * cos(mpf("0.5")) + sin(mpf("0.5"))))],
        "v^2 = 2 g s (sin a + f cos a)",
    ),
    Asked(
        "speed for a way on a plank",
        SCENES,
        DRAWN,
        let("v", 0.5, 4),
        equals({"event": {"kind": "stick", "name": "top"}}, 1),
        [mpf("0.3") * G * mpf("1.25")],
        "v = f g (1 + m/M) t",
    ),
]
