"""Pendulums, springs, falls, orbits: from a motion to what it began with."""

from __future__ import annotations

from typing import Any

from mpmath import asin, cosh, ellipk, exp, findroot, log, mp, mpf, pi, sin, sqrt, tanh

from tests.service.textbook.asked import SCENES, Asked, Body, changes, equals, let

mp.dps = 30

G = mpf("9.81")
PERIOD = "/period"

ROD: Body = {
    "gravity": [0, -9.81],
    "let": {"v": 2, "l": 1, "a": 1},
    "bodies": {"bob": {"mass": 1, "at": [0, "-l"], "velocity": ["v", 0]}},
    "connections": [{"kind": "rod", "a": "bob", "b": [0, 0]}],
    "times": [1],
}
RELEASED: Body = ROD | {"bodies": {"bob": {"mass": 1, "at": ["l*sin(a)", "-l*cos(a)"]}}}
COMPOUND: Body = {
    "gravity": [0, -9.81],
    "let": {"x": 0.3, "a": 0.1},
    "bodies": {
        "rod": {
            "mass": 1,
            "inertia": "1/12",
            "at": ["x*sin(a)", "-x*cos(a)"],
            "angle": "a - pi/2",
            "places": {"pivot": ["-x", 0]},
        }
    },
    "connections": [{"kind": "pin", "a": "rod.pivot", "b": [0, 0]}],
    "times": [0.1],
}
SPRING: Body = {
    "let": {"k": 25, "c": 2, "m": 1},
    "bodies": {"block": {"mass": "m", "at": [1, 0]}},
    "connections": [
        {"kind": "slider", "a": "block", "b": [0, 0]},
        {"kind": "spring", "a": "block", "b": [0, 0], "stiffness": "k", "rest_length": 0},
        {"kind": "damper", "a": "block", "b": [0, 0], "coefficient": "c"},
    ],
    "times": [1],
}
UNDAMPED: Body = SPRING | {"connections": SPRING["connections"][:2]}
THROWN: Body = {
    "gravity": [0, -9.81],
    "let": {"a": 0.7, "v": 10, "vx": 5, "vy": 5},
    "bodies": {"ball": {"mass": 1, "at": [0, 0], "velocity": ["v*cos(a)", "v*sin(a)"]}},
    "connections": [
        {"kind": "contact", "name": "field", "place": "ball", "on": {"at": [0, 0]}, "friction": 100, "restitution": 0}
    ],
    "times": [2.5],
}
X = "/trajectory/columns/ball.position/values/0/0"
Y = "/trajectory/columns/ball.position/values/0/1"
FREE: Body = THROWN | {
    "bodies": {"ball": {"mass": 1, "at": [0, 0], "velocity": ["vx", "vy"]}},
    "connections": [],
    "times": [1.5],
}
UPWARDS: Body = {
    "gravity": [0, -9.81],
    "let": {"v": 10, "c": 0.02},
    "bodies": {"stone": {"mass": 1, "at": [0, 0], "velocity": [0, "v"]}},
    "connections": [{"kind": "force", "place": "stone", "force": ["-c*speed*vx", "-c*speed*vy"]}],
    "times": [4],
    "outputs": [{"extremes": "stone.position.y"}],
}
FALLING: Body = {
    "gravity": [0, -9.81],
    "let": {"c": 0.25},
    "bodies": {"stone": {"mass": 1, "at": [0, 100]}},
    "connections": [{"kind": "force", "place": "stone", "force": ["-c*speed*vx", "-c*speed*vy"]}],
    "times": [2],
}
BUNGEE: Body = {
    "gravity": [0, -9.81],
    "let": {"k": 100},
    "bodies": {"jumper": {"mass": 2, "at": [0, 0]}},
    "connections": [
        {"kind": "slider", "a": "jumper", "b": [0, 0], "slope": {"degrees": 90}},
        {"kind": "spring", "a": "jumper", "b": [0, 0], "stiffness": "k", "rest_length": 0},
    ],
    "times": [3],
    "outputs": [{"extremes": "jumper.position.y"}],
}
ORBIT: Body = {
    "let": {"mu": 3.986004418e14, "r": 7e6, "v": 7.6e3},
    "bodies": {"satellite": {"mass": 1, "at": ["r", 0], "velocity": [0, "sqrt(mu/r)"]}},
    "connections": [{"kind": "inverse-square", "a": "satellite", "b": [0, 0], "strength": "mu"}],
    "times": [100],
}
LAUNCHED: Body = ORBIT | {"bodies": {"satellite": {"mass": 1, "at": ["r", 0], "velocity": [0, "v"]}}}
MU, R = mpf("3.986004418e14"), mpf("7e6")
DAY = mpf("86164.1")
BOUNCING: Body = {
    "gravity": [0, -9.81],
    "let": {"e": 0.5, "h": 1.25},
    "bodies": {"ball": {"mass": 1, "at": [0, "h"]}},
    "connections": [{"kind": "contact", "name": "floor", "place": "ball", "on": {"at": [0, 0]}, "restitution": "e"}],
    "times": [4],
    "outputs": ["energy"],
}
CHAINED: Body = {
    "let": {"a": 1, "b": 1},
    "bodies": {"first": {"mass": 1, "at": [1, 0], "velocity": [1, 0]}, "second": {"mass": 1, "at": [2, 0]}},
    "connections": [
        {"kind": "slider", "a": "first", "b": [1, 0]},
        {"kind": "slider", "a": "second", "b": [2, 0]},
        {"kind": "spring", "a": "first", "b": [0, 0], "stiffness": "a", "rest_length": 1},
        {"kind": "spring", "a": "second", "b": "first", "stiffness": "b", "rest_length": 1},
    ],
    "times": [0.1],
}


def swing(k: Any) -> Any:
    """Return the period of a pendulum of 1 m whose speed below is k times that which just goes round."""
    return 4 * sqrt(1 / G) * ellipk(k**2) if k < 1 else 2 * sqrt(1 / G) * ellipk(1 / k**2) / k


def speed_for(period: Any, low: Any, high: Any) -> float:
    return float(findroot(lambda k: swing(k) - period, (mpf(low), mpf(high)), solver="anderson") * 2 * sqrt(G))


def pivot(low: str, high: str) -> float:
    """Return how far the pivot of a rod of 1 m is from its middle, for 1.6 s with an amplitude of 0.1 rad."""
    square = ellipk(sin(mpf("0.05")) ** 2)

    def miss(x: Any) -> Any:
        return 4 * sqrt((mpf(1) / 12 + x**2) / (G * x)) * square - mpf("1.6")

    return float(findroot(miss, (mpf(low), mpf(high)), solver="anderson"))


def stiffnesses() -> list[tuple[float, float]]:
    """Return the pairs with which two masses of 1 kg have the frequencies 1 and 3 rad/s: a + 2 b = 10, a b = 9."""
    pairs = [(10 - 2 * b, b) for b in ((5 + sqrt(7)) / 2, (5 - sqrt(7)) / 2)]
    return sorted((float(a), float(b)) for a, b in pairs)


MOTION = [
    Asked(
        "just goes round",
        SCENES,
        ROD,
        let("v", 1, 10),
        {"figure": PERIOD, "infinite": True},
        [2 * sqrt(G)],
        "2 sqrt(g l)",
    ),
    Asked(
        "period of 3 s",
        SCENES,
        ROD,
        let("v", 1, 10),
        equals(PERIOD, 3),
        [speed_for(3, "0.8", "0.99"), speed_for(3, "1.0001", "1.01")],
        "4 sqrt(l/g) K(k), 2 sqrt(l/g) K(1/k)/k",
    ),
    Asked(
        "goes round twice a second",
        SCENES,
        ROD,
        let("v", 7, 20),
        equals(PERIOD, 0.5),
        [speed_for(mpf("0.5"), "1.5", "3")],
        "2 sqrt(l/g) K(1/k)/k",
        quick=True,
    ),
    Asked(
        "seconds pendulum of wide swing",
        SCENES,
        RELEASED,
        let("l", 0.3, 1.5),
        equals(PERIOD, 2),
        [G * (2 / (4 * ellipk(sin(mpf(1) / 2) ** 2))) ** 2],
        "4 sqrt(l/g) K(sin(a/2))",
        quick=True,
    ),
    Asked(
        "amplitude whose period is a tenth longer",
        SCENES,
        RELEASED,
        let("a", 0.2, 2),
        equals(PERIOD, 2.2),
        [findroot(lambda a: 4 * sqrt(1 / G) * ellipk(sin(a / 2) ** 2) - mpf("2.2"), 1)],
        "4 sqrt(l/g) K(sin(a/2))",
    ),
    Asked(
        "pivot of the quickest compound pendulum",
        SCENES,
        COMPOUND,
        let("x", 0.1, 0.5),
        {"figure": PERIOD, "least": True},
        [1 / sqrt(mpf(12))],
        "x = L/sqrt(12)",
    ),
    Asked(
        "two pivots of one period",
        SCENES,
        COMPOUND,
        let("x", 0.1, 0.5),
        equals(PERIOD, 1.6),
        [pivot("0.1", "0.28"), pivot("0.3", "0.5")],
        "Kater: 4 sqrt((k^2 + x^2)/(g x)) K(sin(a/2))",
    ),
    Asked(
        "critical damping",
        SCENES,
        SPRING,
        let("c", 1, 20),
        changes({"count": "/model/apart/0/modes"}),
        [10.0],
        "2 sqrt(k m)",
    ),
    Asked(
        "damping for 3 rad/s",
        SCENES,
        SPRING,
        let("c", 1, 9.5),
        equals("/model/apart/0/modes/0/frequency", 3),
        [8.0],
        "2 sqrt(k m - (m w)^2)",
        quick=True,
    ),
    Asked(
        "stiffness for 2 s", SCENES, UNDAMPED, let("k", 1, 30), equals(PERIOD, 2), [pi**2], "m (2 pi/T)^2", quick=True
    ),
    Asked(
        "mass for 2 s", SCENES, UNDAMPED, let("m", 1, 30), equals(PERIOD, 2), [25 / pi**2], "k (T/2 pi)^2", quick=True
    ),
    Asked("farthest throw", SCENES, THROWN, let("a", 0.2, 1.4), {"figure": X, "largest": True}, [pi / 4], "45 degrees"),
    Asked(
        "flat and steep throw",
        SCENES,
        THROWN,
        let("a", 0.2, 1.4),
        equals(X, 8),
        [float(asin(8 * G / 100) / 2), float(pi / 2 - asin(8 * G / 100) / 2)],
        "sin 2a = g x/v^2",
    ),
    Asked(
        "time of flight",
        SCENES,
        THROWN,
        let("v", 5, 15),
        equals({"event": {"kind": "touch", "name": "field"}}, 1.5),
        [G * mpf("0.75") / sin(mpf("0.7"))],
        "2 v sin(a)/g",
    ),
    Asked(
        "to be there then",
        SCENES,
        FREE,
        [let("vx", 0, 20), let("vy", 0, 20)],
        [equals(X, 6), equals(Y, 2)],
        [(4.0, float((2 + G * mpf("1.5") ** 2 / 2) / mpf("1.5")))],
        "x/t, (y + g t^2/2)/t",
    ),
    Asked(
        "height against drag",
        SCENES,
        UPWARDS,
        let("v", 5, 40),
        equals("/extremes/0/largest", 20),
        [sqrt(G / mpf("0.02") * (exp(2 * mpf("0.02") * 20) - 1))],
        "h = m/(2 c) log(1 + c v^2/(m g))",
    ),
    Asked(
        "drag from a speed",
        SCENES,
        FALLING,
        let("c", 0.05, 1),
        equals("/trajectory/columns/stone.velocity/values/0/1", -6),
        [findroot(lambda c: sqrt(G / c) * tanh(sqrt(G * c) * 2) - 6, "0.27")],
        "sqrt(mg/c) tanh(sqrt(g c/m) t)",
    ),
    Asked(
        "drag from a depth",
        SCENES,
        FALLING,
        let("c", 0.05, 1),
        equals("/trajectory/columns/stone.position/values/0/1", 90),
        [findroot(lambda c: log(cosh(sqrt(G * c) * 2)) / c - 10, "0.25")],
        "log(cosh(sqrt(g c/m) t)) m/c",
    ),
    Asked(
        "cord for a depth",
        SCENES,
        BUNGEE,
        let("k", 20, 200),
        equals("/extremes/0/least", -0.5),
        [4 * G / mpf("0.5")],
        "k d^2/2 = m g d",
    ),
    Asked(
        "synchronous satellite",
        SCENES,
        ORBIT,
        let("r", 1e7, 1e8),
        equals(PERIOD, 86164.1),
        [(MU * (DAY / (2 * pi)) ** 2) ** (mpf(1) / 3)],
        "(GM (T/2 pi)^2)^(1/3)",
    ),
    Asked(
        "speed of escape",
        SCENES,
        LAUNCHED,
        let("v", 8e3, 1.2e4),
        {"figure": PERIOD, "infinite": True},
        [sqrt(2 * MU / R)],
        "sqrt(2 GM/r)",
    ),
    Asked(
        "speed for an ellipse of a day",
        SCENES,
        LAUNCHED,
        let("v", 8e3, 1.05e4),
        equals(PERIOD, 86164.1),
        [sqrt(MU * (2 / R - 1 / (MU * (DAY / (2 * pi)) ** 2) ** (mpf(1) / 3)))],
        "vis-viva",
    ),
    Asked(
        "restitution from the time of rest",
        SCENES,
        BOUNCING,
        let("e", 0.1, 0.7),
        equals({"event": {"kind": "settle", "name": "floor"}}, 2),
        [(2 - sqrt(mpf("2.5") / G)) / (2 + sqrt(mpf("2.5") / G))],
        "t0 (1 + e)/(1 - e)",
    ),
    Asked(
        "height from the time of rest",
        SCENES,
        BOUNCING,
        let("h", 0.1, 3),
        equals({"event": {"kind": "settle", "name": "floor"}}, 1),
        [G / 18],
        "3 sqrt(2 h/g)",
    ),
    Asked(
        "stiffnesses for two frequencies",
        SCENES,
        CHAINED,
        [let("a", 0.5, 20), let("b", 0.5, 20)],
        [equals("/model/apart/0/modes/0/frequency", 1), equals("/model/apart/0/modes/1/frequency", 3)],
        stiffnesses(),
        "a + 2 b = 10, a b = 9",
    ),
]
