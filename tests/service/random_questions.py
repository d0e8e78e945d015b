"""Random questions to every endpoint: all bodies, regimes, methods, layouts, outputs, roundings and scenes.

Magnitudes are ordinary; what is special (rest, steady spins, equal moments, the separatrix, a smooth slope) is drawn
often. Some questions are refused.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import sqrt
from random import Random
from typing import Any

Question = dict[str, Any]
STEPPING = ("explicit-euler", "runge-kutta-4", "implicit-midpoint", "symmetric-splitting", "discrete-moser-veselov")
CHOOSING = ("dormand-prince-853", "lsoda", "radau")
TETRAHEDRON = (
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]],
)
HALF_TURNS = ([1.0, 0.0, 0.0, 0.0], [0.6, 0.0, 0.8, 0.0], [1.0, 1.0, 0.0, 0.0], [0.5, -0.1, 0.3, 0.8])


def number(random: Random, low: float = 0.1, high: float = 3.0) -> float:
    """Return a number of as many digits as people write, or of all."""
    value = random.uniform(low, high)
    return random.choice([value, value, max(low, round(value, 1)), max(low, round(value, 3))])


def count(random: Random, most: int) -> int:
    return int(most ** random.random())


def moments(random: Random) -> list[float]:
    a, b = sorted((number(random), number(random)))
    found = random.choice(
        [[a, b, b + a * random.random()], [a, b, b], [a, a, min(b, 2 * a)], [a, a, a], [1.0, 2.0, 3.0]]
    )
    random.shuffle(found)
    return found


def solid(random: Random) -> Question:
    size = lambda: number(random, 0.01, 2.0)  # noqa: E731
    inner, ring = sorted((size(), size()))
    shapes: list[Question] = [
        {"kind": "ball", "radius": size()},
        {"kind": "cuboid", "edges": random.choice([[size(), size(), size()], [inner] * 3, [inner, inner, ring]])},
        {"kind": "cylinder", "radius": size(), "height": size()},
        {"kind": "rod", "length": size(), "radius": size()},
        {"kind": "disc", "radius": size(), "thickness": size()},
        {"kind": "ellipsoid", "semi_axes": [size(), size(), size()]},
        {"kind": "cone", "radius": size(), "height": size()},
        {"kind": "spherical-shell", "outer_radius": ring, "inner_radius": inner},
        {"kind": "cylindrical-shell", "outer_radius": ring, "inner_radius": inner, "height": size()},
        {"kind": "torus", "ring_radius": ring, "tube_radius": 0.9 * inner},
        {"kind": "capsule", "radius": size(), "length": size()},
        {"kind": "hemisphere", "radius": size()},
    ]
    return random.choice(shapes) | random.choice([{"mass": size()}, {"density": number(random, 1.0, 8000.0)}])


def body(random: Random, *, mesh: bool = True) -> Question:
    kind = random.choice(["moments", "moments", "tensor", "points", "solid", "solid", "composite", "mesh"])
    if kind == "moments":
        return {"kind": "principal-moments", "moments": moments(random)}
    if kind == "tensor":
        a, b, c = moments(random)
        turned = random.choice([
            [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]],
            [[0.36 * a + 0.64 * c, 0.0, 0.48 * (c - a)], [0.0, b, 0.0], [0.48 * (c - a), 0.0, 0.64 * a + 0.36 * c]],
        ])  # fmt: skip
        return {"kind": "inertia-tensor", "tensor": turned} | random.choice([{}, {"mass": number(random)}])
    if kind == "points":
        several = 3 + count(random, 60)
        positions = [[number(random, -2.0, 2.0) for _ in range(3)] for _ in range(several)]
        masses = random.choice([1.0, [number(random) for _ in range(several)]])
        return {"kind": "point-masses", "masses": masses, "positions": positions}
    if kind == "composite":
        parts = [
            {"body": solid(random), "position": [number(random, -1.0, 1.0) for _ in range(3)]}
            | random.choice([{}, {"attitude": random.choice(HALF_TURNS)}])
            for _ in range(random.randint(1, 3))
        ]
        return {"kind": "composite", "parts": parts}
    if kind == "mesh" and mesh:
        return {"kind": "mesh", "vertices": TETRAHEDRON[0], "faces": TETRAHEDRON[1], "density": number(random)}
    return solid(random)


def spin(random: Random) -> list[float]:
    anyhow = [number(random, -10.0, 10.0) for _ in range(3)]
    axis = [0.0, 0.0, 0.0]
    axis[random.randrange(3)] = number(random, 0.1, 20.0)
    nearly = [rate + 1e-3 * number(random) for rate in axis]
    slow = [1e-6 * rate for rate in anyhow]
    return random.choice([anyhow, anyhow, anyhow, axis, nearly, slow, [0.0, 0.0, 0.0]])


def turning(random: Random, *, mesh: bool = True) -> Question:
    """Return a body and how it turns, now and then on the separatrix."""
    if random.random() < 0.1:
        # (C - B) (C - A)^-1 = 1/2, so that A (B - A) w1^2 = C (C - B) w3^2 has w1^2 = 3 w3^2.
        rate = number(random)
        axes = {"kind": "principal-moments", "moments": [1.0, 2.0, 3.0]}
        return {"body": axes, "angular_velocity": [sqrt(3.0) * rate, number(random, 0.0, 2.0), rate]}
    return {"body": body(random, mesh=mesh), "angular_velocity": spin(random)}


def times(random: Random, most: int, far: float = 100.0) -> Any:
    stop = number(random, 0.01, far)
    several = count(random, most)
    if random.random() < 0.3:
        return [number(random, -stop if random.random() < 0.3 else 0.0, stop) for _ in range(min(several, 50))]
    start = random.choice([0.0, 0.0, 0.0, -stop, number(random, 0.0, stop)])
    return {"start": start, "stop": random.choice([stop, float(round(stop) + 1)]), "count": several}


def method(random: Random, far: float) -> Question:
    if random.random() < 0.6:
        step = random.choice([0.001, 0.01, 0.02, number(random, 0.001, 0.05)])
        return {"kind": random.choice(STEPPING), "step": max(step, far / 20_000)}
    return {"kind": random.choice(CHOOSING), "tolerance": 10.0 ** -random.randint(3, 10)}


def sampled(random: Random, most: int) -> Question:
    """Return times, and what else is asked of samples."""
    found: Question = {"times": times(random, most)}
    if random.random() < 0.4:
        found["method"] = random.choice([method(random, 100.0), method(random, 100.0), {"kind": "closed-form"}])
    if random.random() < 0.4:
        found["round"] = random.choice(["meaningful", 1, 4, 9, 17])
    if random.random() < 0.2:
        found["accuracy"] = 10.0 ** -random.randint(1, 12)
    return found


def trajectory(random: Random) -> Question:
    found = turning(random) | sampled(random, 5000)
    if random.random() < 0.3:
        found["attitude"] = random.choice(HALF_TURNS)
    if random.random() < 0.3:
        found["outputs"] = random.sample(["time", "angular_velocity", "attitude"], random.randint(1, 3))
    if random.random() < 0.2:
        found["input_uncertainty"] = 10.0 ** -random.randint(2, 12)
    return found


def ensemble(random: Random) -> Question:
    several = count(random, 200)
    drawn = {"sample": {"energy": number(random, 0.01, 100.0), "count": several, "seed": random.randrange(100)}}
    given = {"angular_velocities": [spin(random) for _ in range(min(several, 40))]}
    found = {"body": body(random)} | sampled(random, max(2, 5000 // several)) | random.choice([drawn, given])
    if "method" in found:
        found["times"] = times(random, 50, 5.0)
    return found


def precession(random: Random) -> Question:
    found = turning(random)
    if random.random() < 0.4:
        duration = number(random, 0.5, 40.0)
        found["measure"] = {
            "method": method(random, duration),
            "duration": duration,
            "samples": 3 + count(random, 5000),
            "tolerance": number(random, 0.001, 0.5),
        }
    return found


def stability(random: Random) -> Question:
    found: Question = {"body": body(random)}
    if random.random() < 0.5:
        found["rate"] = random.choice([0.0, number(random, -20.0, 20.0)])
    if random.random() < 0.4:
        found["disturbance"] = random.choice([[1e-3, 2e-3], [0.0, 1e-9], [0.0, 0.0]])
    return found


def surface(random: Random) -> Question:
    found = turning(random) if random.random() < 0.5 else {"body": body(random), "energy": number(random, 0.01, 50.0)}
    found["resolution"] = count(random, 60)
    found["layout"] = random.choice(["triangles", "grid"])
    if random.random() < 0.4:
        found["polhodes"] = {"count": count(random, 40), "seed": random.randrange(100)}
    found["separatrix"] = random.random() < 0.5
    found["points"] = 8 + count(random, 2000)
    return found


def starts(random: Random) -> Question:
    return {
        "body": body(random), "energy": number(random, 0.01, 50.0), "count": count(random, 5000),
        "seed": random.randrange(100),
    }  # fmt: skip


def wobble(random: Random) -> Question:
    shape = random.choice([{"period": number(random, 1.0, 1000.0)}, {"ellipticity": number(random, 1.001, 2.0)}])
    return shape | {"day": random.choice(["sidereal", "solar"])}


def comparison(random: Random) -> Question:
    found = turning(random) | {"times": times(random, 60, 3.0), "repeats": random.choice([0, 0, 0, 1])}
    if random.random() < 0.9:
        several = [method(random, 3.0) for _ in range(random.randint(1, 6))]
        found["methods"] = [*several, *random.choice([[], [{"kind": "closed-form"}]])]
    return found


def of_scene(random: Random, found: Question, outputs: tuple[str, ...], most: int) -> Question:
    """Return a question about a scene with or without times and outputs."""
    timed = random.random() < 0.7
    if timed:
        found["times"] = times(random, most, random.choice([1.0, 5.0, 50.0]))
    if random.random() < 0.3:
        choice = [name for name in outputs if timed or name != "trajectory"]
        found["outputs"] = random.sample(choice, random.randint(1, len(choice)))
    return found


def shafts(random: Random) -> Question:
    pair = lambda low, high: [number(random, low, high), number(random, low, high)]  # noqa: E731
    found: Question = {
        "masses": random.choice([pair(0.1, 5.0), [2.0, 2.0]]), "radii": pair(0.01, 0.5),
        "slopes": random.choice([pair(0.1, 1.4), [0.5, 0.5]]),
        "gravity": random.choice([9.81, number(random, 0.5, 20.0)]),
    }  # fmt: skip
    optional: Question = {
        "inertia_factors": random.choice([[0.5, 0.5], [1.0, 0.5], [0.0, 0.5]]),
        "positions": pair(0.1, 3.0),
        "velocities": random.choice([[0.0, 0.0], pair(-2.0, 2.0)]),
        "spins": pair(-10.0, 10.0),
        "wound": pair(0.1, 5.0),
        "slope_lengths": pair(3.0, 10.0),
        "restitution": random.choice([0.0, 0.5, 0.8, 1.0]),
        "friction": {"static": [0.4, 0.5], "kinetic": random.choice([[0.3, 0.2], [0.0, 0.0]])},
    }
    for name, value in optional.items():
        if random.random() < (0.9 if name == "positions" else 0.4):
            found[name] = value
    return found


def rod(random: Random) -> Question:
    radius = number(random, 0.5, 5.0)
    found: Question = {
        "hole_radius": radius, "length": radius * random.uniform(0.2, 1.9), "mass": number(random),
        "gravity": random.choice([9.81, number(random, 0.5, 20.0)]),
    }  # fmt: skip
    if random.random() < 0.6:
        found["angle"] = random.choice([0.0, number(random, -0.3, 0.3), number(random, -3.0, 3.0)])
        found["angular_velocity"] = random.choice([0.0, number(random, -5.0, 5.0)])
    if random.random() < 0.4:
        found["inertia_factor"] = random.choice([0.25, 0.0, 1 / 3])
    if random.random() < 0.4:
        found["hole"] = "cylinder"
    return found


def chain(random: Random) -> Question:
    length = number(random, 0.5, 5.0)
    return {
        "masses": random.choice([[0.0, 0.0], [number(random), number(random)], [1.0, 1.0]]),
        "slopes": random.choice([[0.5, 0.5], [number(random, 0.0, 1.5), number(random, 0.0, 1.5)]]),
        "gravity": random.choice([9.81, number(random, 0.5, 20.0)]),
        "length": length,
        "linear_density": random.choice([0.0, number(random)]),
        "position": random.choice([0.5 * length, length * random.random()]),
        "velocity": random.choice([0.0, number(random, -2.0, 2.0)]),
    }


def over_a_peg(random: Random) -> Question:
    """Return a heavy chain over a peg, along a slope and hanging, with a mass at one end."""
    slope, lengths = random.choice([0.0, number(random, 0.0, 1.5)]), [number(random), number(random)]
    bodies = {
        "p": {"mass": number(random), "at": [f"-{lengths[0]}*cos({slope})", f"-{lengths[0]}*sin({slope})"]},
        "q": {"mass": 0, "at": [0, -lengths[1]]},
    }
    link = {"kind": "chain", "through": ["p", [0, 0], "q"], "density": number(random)}
    found: Question = {"gravity": [0, -9.81], "bodies": bodies, "connections": [link]}
    return found | ({"times": times(random, 300, 1.0)} if random.random() < 0.6 else {})


def described(random: Random) -> Question:
    """Return a scene of points: falling, on rods, on springs or on a chain over a peg, in the plane or in space."""
    gravity = random.choice([[0, -9.81], [0, -9.81], [0, 0, -9.81]])
    held = random.choice(["rods", "springs", "nothing", "a chain"])
    if held == "a chain":
        return over_a_peg(random)
    bodies: Question = {}
    connections: list[Question] = []
    at, before = [0.0] * len(gravity), "ground"
    for i in range(1 + count(random, 3)):
        at = [x + random.choice([-1, 1]) * number(random, 0.2, 1.0) for x in at]
        bodies[f"p{i}"] = {"mass": number(random), "at": at}
        if held == "nothing" and random.random() < 0.5:
            bodies[f"p{i}"]["velocity"] = [number(random, -3.0, 3.0) for _ in at]
        ends: Question = {"a": f"p{i}", "b": [0] * len(at) if before == "ground" else before}
        if held == "rods":
            connections.append({"kind": "rod", **ends})
        elif held == "springs":
            stiffness, rest = number(random, 5.0, 50.0), random.choice([0, number(random)])
            connections.append({"kind": "spring", **ends, "stiffness": stiffness, "rest_length": rest})
        before = f"p{i}"
    found: Question = {"gravity": gravity, "bodies": bodies, "connections": connections}
    if random.random() < 0.6:
        found["times"] = times(random, 300, 1.0)
        found["accuracy"] = random.choice([1e-9, 1e-6])
    if random.random() < 0.3:
        # Equilibria of several bodies are not foreseen.
        known = ["accelerations", "forces", "energy", *(["equilibria"] if len(bodies) == 1 else [])]
        found["outputs"] = random.sample(known, random.randint(1, 3))
    return found


def digits(random: Random) -> int:
    return random.choice([16, 20, 30, 50, random.randint(16, 150)])


def certified_trajectory(random: Random) -> Question:
    found = turning(random, mesh=False) | {"times": times(random, 200), "digits": digits(random)}
    if random.random() < 0.3:
        found["attitude"] = random.choice(HALF_TURNS)
    if random.random() < 0.3:
        found["outputs"] = random.sample(["time", "angular_velocity", "attitude"], random.randint(1, 3))
    return found


def certified_surface(random: Random) -> Question:
    inside = {"energy": number(random, 0.01, 50.0)}
    found = turning(random, mesh=False)
    if random.random() < 0.5:
        found = {"body": found["body"]} | inside
    if random.random() < 0.4:
        found["resolution"] = count(random, 10)
    if random.random() < 0.4:
        found["layout"] = random.choice(["triangles", "grid"])
        found.setdefault("resolution", 5)
    if random.random() < 0.4:
        found["polhodes"] = {"count": count(random, 8), "seed": random.randrange(100)}
    found["separatrix"] = random.random() < 0.5
    return found | {"points": 8 + count(random, 60), "digits": digits(random)}


def certified_described(random: Random) -> Question:
    drawn = described(random)
    found = {name: drawn[name] for name in ("gravity", "bodies", "connections", "let", "numbers") if name in drawn}
    if random.random() < 0.7:
        found["times"] = [round(random.uniform(-0.02, 0.02), 3) for _ in range(random.randint(1, 4))]
    if random.random() < 0.3:
        found["outputs"] = random.sample(["accelerations", "forces", "energy", "trajectory"], random.randint(1, 3))
    return found | {"digits": random.choice([16, 20, 28])}


def questions_of(outputs: Mapping[str, tuple[str, ...]]) -> dict[str, Callable[[Random], Question]]:
    """Return what draws a question, by path; `outputs` are those of each scene."""
    scenes = {"unwinding-shafts": shafts, "rod-in-hole": rod, "chain-on-wedge": chain}

    def scene(name: str) -> Callable[[Random], Question]:
        def draw(random: Random) -> Question:
            found = of_scene(random, scenes[name](random), outputs[name], 3000)
            found |= {"round": random.choice(["meaningful", 4])} if random.random() < 0.3 else {}
            return found | ({"method": method(random, 50.0)} if random.random() < 0.3 else {})

        return draw

    def certified_scene(name: str) -> Callable[[Random], Question]:
        return lambda random: of_scene(random, scenes[name](random), outputs[name], 100) | {"digits": digits(random)}

    bodies = lambda random: {"body": body(random)}  # noqa: E731
    exact = lambda random: turning(random, mesh=False) | {"digits": digits(random)}  # noqa: E731

    def exact_stability(random: Random) -> Question:
        return stability(random) | {"body": body(random, mesh=False), "digits": digits(random)}

    return {
        "/v1/bodies/mass-properties": bodies,
        "/v1/rotation/trajectory": trajectory,
        "/v1/rotation/ensemble": ensemble,
        "/v1/rotation/precession": precession,
        "/v1/rotation/stability": stability,
        "/v1/rotation/energy-ellipsoid": surface,
        "/v1/rotation/initial-states": starts,
        "/v1/rotation/wobble": wobble,
        "/v1/work-precision": comparison,
        "/v1/certified/rotation/trajectory": certified_trajectory,
        "/v1/certified/rotation/precession": exact,
        "/v1/certified/rotation/stability": exact_stability,
        "/v1/certified/rotation/energy-ellipsoid": certified_surface,
        "/v1/scenes": described,
        "/v1/certified/scenes": certified_described,
        **{f"/v1/scenes/{name}": scene(name) for name in scenes},
        **{f"/v1/certified/scenes/{name}": certified_scene(name) for name in scenes},
    }
