"""Scenes drawn at random, in decimals of a few digits."""

from __future__ import annotations

from typing import Any

import numpy as np

from tests.core.multibody.worked_examples import points


def decimal(random: np.random.Generator, low: float, high: float) -> float:
    """Return a number of four digits."""
    return float(f"{random.uniform(low, high):.4g}")


def pendulum_of_points(random: np.random.Generator, links: int) -> dict[str, Any]:
    """Return a chain of points with any angles and rates."""
    lengths = tuple(decimal(random, 0.3, 2) for _ in range(links))
    angles = tuple(decimal(random, -3.1, 3.1) for _ in range(links))
    masses = tuple(decimal(random, 0.2, 5) for _ in range(links))
    rates = tuple(decimal(random, -4, 4) for _ in range(links))
    return points(lengths, angles, masses, rates=rates)


def pendulum_of_rods(random: np.random.Generator, links: int) -> dict[str, Any]:
    """Return a chain of rods, each pinned to the one before it; the omitted velocities follow."""
    bodies: dict[str, Any] = {}
    connections = []
    let: dict[str, str] = {}
    x, y, before = "0", "0", [0, 0]
    for i in range(links):
        half, angle = decimal(random, 0.2, 1), decimal(random, -3.1, 3.1)
        let[f"x{i}"], let[f"y{i}"] = f"{x} + {half}*cos({angle})", f"{y} + {half}*sin({angle})"
        let[f"ex{i}"], let[f"ey{i}"] = f"x{i} + {half}*cos({angle})", f"y{i} + {half}*sin({angle})"
        x, y = f"ex{i}", f"ey{i}"
        mass = decimal(random, 0.2, 5)
        bodies[f"b{i}"] = {
            "mass": mass,
            "inertia": f"{mass}*{half}*{half}/3",
            "at": [f"x{i}", f"y{i}"],
            "angle": angle,
            "angular_velocity": decimal(random, -4, 4),
            "places": {"top": [-half, 0], "end": [half, 0]},
        }
        connections.append({"kind": "pin", "name": f"c{i}", "a": f"b{i}.top", "b": before})
        before = f"b{i}.end"  # type: ignore[assignment]
    return {"gravity": [0, -9.81], "let": let, "bodies": bodies, "connections": connections}


def spherical_pendulum(random: np.random.Generator) -> dict[str, Any]:
    """Return a point on a rod in space; of its velocity, what is along the rod does not count."""
    theta, u, w = decimal(random, 0.2, 2.9), decimal(random, -3, 3), decimal(random, -3, 3)
    return {
        "gravity": [0, 0, -9.81],
        "let": {"s": f"sin({theta})", "c": f"cos({theta})"},
        "bodies": {"p": {"mass": 1, "at": ["s", 0, "-c"], "velocity": [f"{u}*c", w, f"{u}*s"]}},
        "connections": [{"kind": "rod", "name": "r", "a": "p", "b": [0, 0, 0]}],
    }


def double_spherical_pendulum(random: np.random.Generator) -> dict[str, Any]:
    """Return two points on rods in space, at rest."""
    a, b, f = decimal(random, 0.2, 2.9), decimal(random, 0.2, 2.9), decimal(random, -3, 3)
    return {
        "gravity": [0, 0, -9.81],
        "let": {"x": f"sin({a})", "z": f"-cos({a})"},
        "bodies": {
            "p": {"mass": decimal(random, 0.2, 3), "at": ["x", 0, "z"]},
            "q": {"mass": 1, "at": [f"x + sin({b})*cos({f})", f"sin({b})*sin({f})", f"z - cos({b})"]},
        },
        "connections": [
            {"kind": "rod", "name": "r", "a": "p", "b": [0, 0, 0]},
            {"kind": "rod", "name": "t", "a": "p", "b": "q"},
        ],
    }


def top(random: np.random.Generator, *, symmetric: bool) -> dict[str, Any]:
    """Return a body in space that is held at one point."""
    a, b, c = (decimal(random, 0.01, 0.1) for _ in range(3))
    # Integrals of squares of coordinates, so that the moments are those of matter.
    moments = [f"{b}+{c}", f"{a}+{c}", f"{a}+{b}"] if not symmetric else [f"{a}+{c}", f"{a}+{c}", f"{a}+{a}"]
    tip = [0, 0, decimal(random, -0.3, -0.05)]
    if not symmetric:
        tip = [decimal(random, -0.1, 0.1), decimal(random, -0.1, 0.1), tip[2]]
    tilt = decimal(random, 0.1, 3)
    at = [f"-({tip[0]}*c + {tip[2]}*s)", f"-({tip[1]})", f"-({tip[2]}*c - {tip[0]}*s)"]
    return {
        "gravity": [0, 0, -9.81],
        "let": {"c": f"cos({tilt})", "s": f"sin({tilt})"},
        "bodies": {
            "top": {
                "mass": 1,
                "moments": moments,
                "at": at,
                "axes": [["c", 0, "-s"], [0, 1, 0], ["s", 0, "c"]],
                "angular_velocity": [decimal(random, -5, 5), decimal(random, -5, 5), decimal(random, -40, 40)],
                "places": {"tip": tip},
            }
        },
        "connections": [{"kind": "pin", "name": "j", "a": "top.tip", "b": [0, 0, 0]}],
    }


def springs(random: np.random.Generator) -> dict[str, Any]:
    """Return two points in the plane on springs."""
    return {
        "gravity": [0, -9.81],
        "bodies": {
            "p": {"mass": decimal(random, 0.5, 2), "at": [decimal(random, -1, 1), decimal(random, -1.5, -0.5)]},
            "q": {"mass": decimal(random, 0.5, 2), "at": [decimal(random, -1, 1), decimal(random, -3, -2)]},
        },
        "connections": [
            {"kind": "spring", "a": "p", "b": [0, 0], "stiffness": decimal(random, 30, 300), "rest_length": 1},
            {"kind": "spring", "a": "p", "b": "q", "stiffness": decimal(random, 30, 300)},
        ],
    }


def rolling_cart(random: np.random.Generator) -> dict[str, Any]:
    """Return a rod pinned to the centre of a disc that rolls on the level."""
    angle, half = decimal(random, -3, 3), decimal(random, 0.2, 1)
    return {
        "gravity": [0, -9.81],
        "bodies": {
            "disc": {"mass": decimal(random, 0.5, 2), "inertia": 0.02, "radius": 0.2, "at": [0, 0.2]},
            "rod": {
                "mass": decimal(random, 0.5, 2),
                "inertia": 0.1,
                "at": [f"{half}*cos({angle})", f"0.2 + {half}*sin({angle})"],
                "angle": angle,
                "angular_velocity": decimal(random, -4, 4),
                "places": {"top": [-half, 0]},
            },
        },
        "connections": [
            {"kind": "rolling", "name": "w", "place": "disc", "on": {"at": [0, 0]}},
            {"kind": "pin", "name": "h", "a": "rod.top", "b": "disc"},
        ],
    }


def any_scene(seed: int) -> dict[str, Any]:
    """Return the scene of a seed, the kinds in turn."""
    random = np.random.default_rng(seed)
    kinds = (
        lambda: pendulum_of_points(random, 2),
        lambda: pendulum_of_points(random, 3),
        lambda: pendulum_of_rods(random, 2),
        lambda: pendulum_of_rods(random, 3),
        lambda: spherical_pendulum(random),
        lambda: double_spherical_pendulum(random),
        lambda: top(random, symmetric=True),
        lambda: top(random, symmetric=False),
        lambda: springs(random),
        lambda: rolling_cart(random),
        lambda: pendulum_of_points(random, 1),
    )
    return kinds[seed % len(kinds)]()


def stars(random: np.random.Generator, count: int) -> dict[str, Any]:
    """Return bodies that attract one another, in the plane, with room between them."""
    bodies = {}
    for i in range(count):
        turn, away = 2 * np.pi * i / count, decimal(random, 0.8, 1.5)
        at = [float(f"{away * x:.4g}") for x in (np.cos(turn), np.sin(turn))]
        bodies[f"s{i}"] = {
            "mass": decimal(random, 0.2, 2),
            "at": at,
            "velocity": [decimal(random, -0.6, 0.6), decimal(random, -0.6, 0.6)],
        }
    pairs = [(i, j) for i in range(count) for j in range(i)]
    pulls = [{"kind": "gravitation", "a": f"s{i}", "b": f"s{j}", "constant": decimal(random, 0.2, 1)} for i, j in pairs]
    return {"bodies": bodies, "connections": pulls}


def beside_charges(random: np.random.Generator) -> dict[str, Any]:
    """Return a point beside two fixed charges of either sign."""
    body = {
        "mass": decimal(random, 0.5, 2),
        "at": [decimal(random, -0.5, 0.5), decimal(random, 0.5, 1.5)],
        "velocity": [decimal(random, -1, 1), decimal(random, -1, 1)],
    }
    charges = [
        {"kind": "inverse-square", "a": "p", "b": [x, 0], "strength": decimal(random, -1, 1) + 0.01} for x in (-1, 1)
    ]
    return {"bodies": {"p": body}, "connections": charges}


def ball(random: np.random.Generator, surface: str) -> dict[str, Any]:
    """Return a ball that rolls, with a spin of its own about the normal where that is easily said."""
    radius, mass = decimal(random, 0.05, 0.2), decimal(random, 0.3, 2)
    angle = decimal(random, -3, 3)
    fields: dict[str, Any] = {"mass": mass, "radius": radius, "moments": [decimal(random, 0.001, 0.01)] * 3}
    speed = [decimal(random, -1, 1), decimal(random, -1, 1)]
    if surface == "turntable":
        fields |= {"at": [decimal(random, -1, 1), decimal(random, -1, 1), radius], "velocity": [*speed, 0]}
        on = {"at": [0, 0, 0], "normal": [0, 0, 1], "rate": decimal(random, -4, 4)}
        let = {}
    else:
        let = {"d": f"1 - {radius}", "c": f"cos({angle})", "s": f"sin({angle})"}
        along = speed[1] if surface == "cylinder" else 0
        # Tangents of the circle, and along the axis.
        fields |= {"at": ["d*c", 0, "d*s"], "velocity": [f"-({speed[0]})*s", along, f"{speed[0]}*c"]}
        on = {"at": [0, 0, 0], "radius": -1} | ({"direction": [0, 1, 0]} if surface == "cylinder" else {})
        if surface == "sphere":
            fields["velocity"][1] = speed[1]
    rolling = {"kind": "rolling", "place": "ball", "on": on}
    return {"gravity": [0, 0, -9.81], "let": let, "bodies": {"ball": fields}, "connections": [rolling]}


def loaded_ball(random: np.random.Generator) -> dict[str, Any]:
    """Return a ball whose centre of mass is beside its middle, on a level."""
    a, b, c = (decimal(random, 0.01, 0.1) for _ in range(3))
    radius, arm = decimal(random, 0.3, 0.5), [decimal(random, -0.1, 0.1) for _ in range(3)]
    body = {
        "mass": 1,
        "radius": radius,
        "moments": [f"{b}+{c}", f"{a}+{c}", f"{a}+{b}"],
        "at": [f"-({arm[0]})", f"-({arm[1]})", f"{radius} - ({arm[2]})"],
        "angular_velocity": [decimal(random, -4, 4) for _ in range(3)],
        "places": {"middle": arm},
    }
    rolling = {"kind": "rolling", "place": "ball.middle", "on": {"at": [0, 0, 0], "normal": [0, 0, 1]}}
    return {"gravity": [0, 0, -9.81], "bodies": {"ball": body}, "connections": [rolling]}


def attracted_or_rolling(seed: int) -> dict[str, Any]:
    """Return the scene of a seed among those with attraction and with balls, the kinds in turn."""
    random = np.random.default_rng(seed)
    kinds = (
        lambda: stars(random, 3),
        lambda: beside_charges(random),
        lambda: ball(random, "turntable"),
        lambda: ball(random, "cylinder"),
        lambda: ball(random, "sphere"),
        lambda: loaded_ball(random),
        lambda: stars(random, 4),
    )
    return kinds[seed % len(kinds)]()


def stiff_linkage(seed: int) -> dict[str, Any]:
    """Return a chain of points, some of whose rods are stiff springs with dampers that bring them to rest fast."""
    random = np.random.default_rng(seed)
    links = int(random.integers(1, 4))
    found = pendulum_of_points(random, links)
    soft = int(random.integers(links))
    for i, one in enumerate(found["connections"]):
        if i != soft and random.random() < 0.5:
            continue
        stiffness = float(f"{10 ** random.uniform(3, 6):.3g}")
        # The faster of two real roots of a mass on such a spring and damper.
        damping = float(f"{2.5 * stiffness**0.5 * random.uniform(1, 4):.3g}")
        ends = {"a": one["a"], "b": one["b"]}
        found["connections"][i] = {"kind": "spring", "name": f"s{i}", "stiffness": stiffness, **ends}
        found["connections"].append({"kind": "damper", "name": f"d{i}", "coefficient": damping, **ends})
    return found
