"""Rest and its end, equilibria and accelerations: what a slope, a coefficient, a mass or a force must be."""

from __future__ import annotations

from mpmath import acos, asin, atan, cos, mpf, pi, sin, sqrt, tan

from tests.service.textbook.asked import SCENES, Asked, Body, changes, equals, let

G = mpf("9.81")

LADDER: Body = {
    "gravity": [0, -9.81],
    "let": {"f": 0.3, "n": 0.3, "a": 1.2},
    "bodies": {
        "ladder": {
            "mass": 4,
            "inertia": 3,
            "at": ["-1.5*cos(a)", "1.5*sin(a)"],
            "angle": "a",
            "places": {"foot": [-1.5, 0], "head": [1.5, 0]},
        }
    },
    "connections": [
        {"kind": "contact", "name": "floor", "place": "ladder.foot", "on": {"at": [0, 0]}, "friction": "f"},
        {
            "kind": "contact",
            "name": "wall",
            "place": "ladder.head",
            "on": {"at": [0, 0], "slope": {"degrees": 90}},
            "friction": "n",
        },
    ],
    "times": [0.001],
}
FLOOR = "/phases/0/states/floor"
INCLINE: Body = {
    "gravity": [0, -9.81],
    "let": {"a": 0.3, "f": 0.5},
    "bodies": {"block": {"mass": 2, "at": [0, 0]}},
    "connections": [
        {"kind": "contact", "name": "floor", "place": "block", "on": {"at": [0, 0], "slope": "a"}, "friction": "f"}
    ],
    "times": [0.001],
}
PULLED: Body = {
    "gravity": [0, -9.81],
    "let": {"F": 3, "a": 0.5},
    "bodies": {"block": {"mass": 2, "at": [0, 0]}},
    "connections": [
        {"kind": "contact", "name": "floor", "place": "block", "on": {"at": [0, 0]}, "friction": 0.5},
        {"kind": "force", "place": "block", "force": ["F*cos(a)", "F*sin(a)"]},
    ],
    "times": [0.001],
}
SLIDING: Body = PULLED | {
    "let": {"F": 15, "a": 0.5},
    "bodies": {"block": {"mass": 2, "at": [0, 0], "velocity": [1, 0]}},
    "times": [0.1],
}
ATWOOD: Body = {
    "gravity": [0, -9.81],
    "let": {"m": 2, "n": 1},
    "bodies": {"left": {"mass": "n", "at": [-0.1, -1]}, "right": {"mass": "m", "at": [0.1, -1]}},
    "connections": [{"kind": "string", "name": "cord", "through": ["left", [-0.1, 0], [0.1, 0], "right"]}],
}
FALL = "/accelerations/right/linear/1"
TENSION = "/forces/cord.tension/value"
PULLEY: Body = {
    "gravity": [0, -9.81],
    "let": {"w": 0.5},
    "bodies": {
        "left": {"mass": 1, "at": [-0.1, -1]},
        "right": {"mass": 2, "at": [0.1, -1]},
        "wheel": {"mass": "w", "radius": 0.1, "inertia": "w*0.1^2/2", "at": [0, 0]},
    },
    "connections": [
        {"kind": "pin", "a": "wheel", "b": [0, 0]},
        {"kind": "string", "through": ["left", "wheel", "right"], "sides": {"wheel": ["left", "right"]}},
    ],
}
INCLINED: Body = {
    "gravity": [0, -9.81],
    "let": {"a": 0.5, "m": 1.5},
    "bodies": {"block": {"mass": 2, "at": ["-cos(a)", "-sin(a)"]}, "weight": {"mass": "m", "at": [0, -1]}},
    "connections": [
        {"kind": "track", "name": "face", "place": "block", "on": {"at": [0, 0], "slope": "a"}},
        {"kind": "string", "name": "cord", "through": ["block", [0, 0], "weight"]},
    ],
}
HOOP: Body = {
    "gravity": [0, -9.81],
    "let": {"w": 4},
    "bodies": {"bead": {"mass": 0.1, "at": [0.6, -0.8]}},
    "connections": [{"kind": "rod", "a": "bead", "b": [0, 0]}, {"kind": "spinning-frame", "rate": "w"}],
    "outputs": ["equilibria"],
}
UPRIGHT: Body = {
    "gravity": [0, -9.81],
    "let": {"k": 4},
    "bodies": {"rod": {"mass": 1, "inertia": "1/12", "at": [0, 0.5], "angle": "pi/2", "places": {"foot": [-0.5, 0]}}},
    "connections": [
        {"kind": "pin", "name": "hinge", "a": "rod.foot", "b": [0, 0]},
        {"kind": "torsion-spring", "a": "rod", "stiffness": "k", "rest_angle": "pi/2"},
    ],
    "outputs": ["equilibria"],
}
STACK: Body = {
    "gravity": [0, -9.81],
    "let": {"F": 5},
    "bodies": {"lower": {"mass": 3, "at": [0, 0]}, "upper": {"mass": 1, "at": [0, 0]}},
    "connections": [
        {"kind": "contact", "name": "floor", "place": "lower", "on": {"at": [0, 0]}, "friction": 0.1},
        {"kind": "contact", "name": "between", "place": "upper", "on": {"at": "lower"}, "friction": 0.2},
        {"kind": "force", "name": "pull", "place": "lower", "force": ["F", 0]},
    ],
    "times": [0.001],
}
CYLINDER: Body = {
    "gravity": ["9.81*sin(a)", "-9.81*cos(a)"],
    "let": {"f": 0.2, "a": 0.5},
    "bodies": {"cylinder": {"mass": 2, "radius": 0.1, "inertia": 0.01, "at": [0, 0.1]}},
    "connections": [{"kind": "contact", "name": "floor", "place": "cylinder", "on": {"at": [0, 0]}, "friction": "f"}],
    "times": [0.001],
}
SPOOL: Body = {
    "gravity": [0, -9.81],
    "let": {"a": 0.6, "T": 1},
    "bodies": {"spool": {"mass": 2, "radius": 0.2, "inertia": 0.03, "at": [0, 0.2]}},
    "connections": [
        {"kind": "rolling", "name": "floor", "place": "spool", "on": {"at": [0, 0]}},
        {"kind": "force", "place": "spool", "force": ["T*cos(a)", "T*sin(a)"]},
        {"kind": "torque", "body": "spool", "torque": "0.1*T"},
    ],
    "outputs": ["accelerations"],
}
BOX: Body = {
    "gravity": ["9.81*sin(a)", "-9.81*cos(a)"],
    "let": {"a": 0.2},
    "bodies": {
        "block": {
            "mass": 6,
            "inertia": 0.2,
            "at": [0, 0.3],
            "places": {"front": [0.1, -0.3], "back": [-0.1, -0.3]},
        }
    },
    "connections": [
        {"kind": "contact", "name": "front", "place": "block.front", "on": {"at": [0, 0]}, "friction": 0.9},
        {"kind": "contact", "name": "back", "place": "block.back", "on": {"at": [0, 0]}, "friction": 0.9},
    ],
    "times": [0.001],
}
SPHERE: Body = {
    "gravity": [0, -9.81],
    "let": {"v": 1},
    "bodies": {"stone": {"mass": 1, "at": [0, 2], "velocity": ["v", 0]}},
    "connections": [{"kind": "contact", "name": "dome", "place": "stone", "on": {"at": [0, 0], "radius": 2}}],
    "times": [0.001],
}
BIASED: Body = {
    "gravity": [0, -9.81],
    "let": {"F": 2},
    "bodies": {"bob": {"mass": 1, "at": [0.3, "-sqrt(0.91)"]}},
    "connections": [
        {"kind": "rod", "name": "rod", "a": "bob", "b": [0, 0]},
        {"kind": "force", "place": "bob", "force": ["F", 0]},
    ],
    "outputs": ["equilibria"],
}

STATICS = [
    Asked(
        "ladder on a rough floor and wall",
        SCENES,
        LADDER,
        let("a", 0.5, 1.5),
        changes(FLOOR),
        [pi / 2 - 2 * atan(mpf("0.3"))],
        "pi/2 - 2 atan(f)",
    ),
    Asked(
        "ladder on a smooth wall",
        SCENES,
        LADDER | {"let": {"f": 0.3, "n": 0, "a": 1.2}},
        let("a", 0.5, 1.5),
        changes(FLOOR),
        [atan(1 / mpf("0.6"))],
        "tan a = 1/(2 f)",
    ),
    Asked(
        "friction for a ladder",
        SCENES,
        LADDER | {"let": {"f": 0.5, "n": 0, "a": 1}},
        let("f", 0.1, 0.9),
        changes(FLOOR),
        [1 / (2 * tan(mpf(1)))],
        "f = 1/(2 tan a)",
    ),
    Asked(
        "slope on which a block slips",
        SCENES,
        INCLINE,
        let("a", 0.1, 1),
        changes(FLOOR),
        [atan(mpf("0.5"))],
        "tan a = f",
    ),
    Asked("friction that holds", SCENES, INCLINE, let("f", 0.1, 1), changes(FLOOR), [tan(mpf("0.3"))], "f = tan a"),
    Asked(
        "pull that moves a block",
        SCENES,
        PULLED,
        let("F", 1, 20),
        changes(FLOOR),
        [mpf("0.5") * 2 * G / (cos(mpf("0.5")) + mpf("0.5") * sin(mpf("0.5")))],
        "f m g/(cos a + f sin a)",
    ),
    Asked(
        "best direction of a pull",
        SCENES,
        SLIDING,
        let("a", 0.1, 1.2),
        {"figure": "/accelerations/block/linear/0", "largest": True},
        [atan(mpf("0.5"))],
        "tan a = f",
    ),
    Asked(
        "mass for an acceleration",
        SCENES,
        ATWOOD,
        let("m", 1.1, 5),
        equals(FALL, -2),
        [(G + 2) / (G - 2)],
        "(g + a)/(g - a) m",
        quick=True,
    ),
    Asked(
        "mass for a tension",
        SCENES,
        ATWOOD,
        let("m", 1.1, 5),
        equals(TENSION, 12),
        [12 / (2 * G - 12)],
        "T = 2 m n g/(m + n)",
        quick=True,
    ),
    Asked(
        "both masses of Atwood's machine",
        SCENES,
        ATWOOD,
        [let("m", 0.5, 5), let("n", 0.5, 5)],
        [equals(FALL, -3), equals(TENSION, 15)],
        [(float(15 / (G - 3)), float(15 / (G + 3)))],
        "T/(g - a), T/(g + a)",
    ),
    Asked(
        "mass of a pulley",
        SCENES,
        PULLEY,
        let("w", 0.1, 5),
        equals(FALL, -2.5),
        [2 * (G / mpf("2.5") - 3)],
        "a = g/(3 + w/2)",
        quick=True,
    ),
    Asked(
        "slope of balance",
        SCENES,
        INCLINED,
        let("a", 0.2, 1.3),
        equals("/accelerations/weight/linear/1", 0),
        [asin(mpf("0.75"))],
        "sin a = m/M",
        quick=True,
    ),
    Asked(
        "weight of balance",
        SCENES,
        INCLINED,
        let("m", 0.2, 3),
        equals("/accelerations/weight/linear/1", 0),
        [2 * sin(mpf("0.5"))],
        "m = M sin a",
        quick=True,
    ),
    Asked(
        "critical rate of the hoop",
        SCENES,
        HOOP,
        let("w", 1, 6),
        changes({"count": "/equilibria"}),
        [sqrt(G)],
        "w^2 = g/r",
    ),
    Asked(
        "stiffness for an upright rod's 2 rad/s",
        SCENES,
        UPRIGHT,
        let("k", 5.5, 8),
        equals("/equilibria/0/modes/0/frequency", 2),
        [G / 2 + mpf(4) / 3],
        "k = m g l/2 + I w^2",
    ),
    Asked(
        "side force for an angle",
        SCENES,
        BIASED,
        let("F", 0.5, 20),
        equals("/equilibria/0/positions/bob/0", 0.6),
        [G * mpf("0.75")],
        "F = m g tan a",
    ),
    Asked(
        "pull that leaves a block behind",
        SCENES,
        STACK,
        let("F", 2, 30),
        changes("/phases/0/states/between"),
        [4 * G * mpf("0.3")],
        "(f1 + f2) (m1 + m2) g",
    ),
    Asked(
        "friction to roll", SCENES, CYLINDER, let("f", 0.05, 0.5), changes(FLOOR), [tan(mpf("0.5")) / 3], "f = tan(a)/3"
    ),
    Asked(
        "critical angle of a spool",
        SCENES,
        SPOOL,
        let("a", 0.2, 1.5),
        equals("/accelerations/spool/linear/0", 0),
        [acos(mpf("0.5"))],
        "cos a = r/R",
        quick=True,
    ),
    Asked(
        "slope on which a box tips",
        SCENES,
        BOX,
        let("a", 0.1, 0.6),
        changes("/phases/0/states/back"),
        [atan(mpf(1) / 3)],
        "tan a = b/h",
    ),
    Asked(
        "speed that leaves a dome at once",
        SCENES,
        SPHERE,
        let("v", 1, 8),
        changes("/phases/0/states/dome"),
        [sqrt(2 * G)],
        "v^2 = g r",
    ),
]
