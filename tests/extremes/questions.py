"""Extreme questions to every endpoint. An endpoint that is not here fails the suite: it has no extremes."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from itertools import cycle, product
from math import log10, nextafter, pi, sqrt
from typing import Any

from core.multibody.solve import OUTPUTS
from service.routes.certified.answers import ONLY_ORDINARY
from service.routes.examples import examples
from tests.contracts.test_bodies import SPECIMENS
from tests.extremes.asking import Asked
from tests.extremes.motions import SUBNORMAL, Motion, motions

Named = Iterator[tuple[str, Asked]]

MOTIONS = tuple(motions())
LARGEST = 1.7976931348623157e308
RIGHT_ANGLE = 1.5707963267948966
SIZES = (0.0, SUBNORMAL, 1e-300, 1e-150, 1e-16, 1e16, 1e150, LARGEST)
MATRIX_OF_METHODS: tuple[Callable[[float], Asked], ...] = (
    lambda turn: {"kind": "explicit-euler", "step": turn / 20},
    lambda turn: {"kind": "runge-kutta-4", "step": turn / 20},
    lambda turn: {"kind": "implicit-midpoint", "step": turn / 20},
    lambda turn: {"kind": "symmetric-splitting", "step": turn / 20},
    lambda turn: {"kind": "dormand-prince-853", "tolerance": 1e-6},
    lambda turn: {"kind": "lsoda", "tolerance": 1e-6},
    lambda turn: {"kind": "radau", "tolerance": 1e-6},
)


STARTS = [
    list(motion.rates)
    for motion in MOTIONS
    if motion.moments == (1.0, 2.0, 3.0) and motion.rates[0] and 1e-200 < max(map(abs, motion.rates)) < 10.0
    if min(map(abs, motion.rates)) > 1e-250
]
"""On either side of one body's separatrix."""


def turn_of(motion: Motion) -> float:
    """Return about the time of a radian, within the range of doubles (s)."""
    fastest = max(map(abs, motion.rates))
    return min(1e300, 1.0 / fastest) if fastest > 1e-300 else 1.0


def trajectories() -> Named:
    for motion in MOTIONS:
        turn = turn_of(motion)
        far = 1e9 * turn if turn < 1e290 else turn
        yield motion.name, motion.question | {"times": [0.0, turn, -3 * turn, 1e3 * turn, turn]}
        with_attitude = {"times": [turn, -turn, 0.0], "attitude": [1.0, 2.0, 0.5, 0.0], "round": "meaningful"}
        yield f"{motion.name}, attitude", motion.question | with_attitude | {"accuracy": 0.5}
        uncertain = {"times": {"start": -far, "stop": far, "count": 3}, "input_uncertainty": 1e-3, "round": 6}
        yield f"{motion.name}, far", motion.question | uncertain | {"accuracy": 0.5}
    handle = next(motion for motion in MOTIONS if motion.name.startswith("inside the separatrix by 0.1"))
    for name, times in {
        "the smallest times": [SUBNORMAL, -SUBNORMAL, 0.0],
        "the largest time": [LARGEST],
        "one time many times": [1.0] * 50,
        "a span of one": {"start": 1.0, "stop": 1e10, "count": 1},
        "a span beyond doubles": {"start": -LARGEST, "stop": LARGEST, "count": 2},
        "a span of nothing": {"start": 2.0, "stop": 2.0, "count": 3},
        "1e9 samples": {"start": 0.0, "stop": 1.0, "count": 10**9},
    }.items():
        yield name, handle.question | {"times": times}
        for method in ({"kind": "explicit-euler", "step": SUBNORMAL}, {"kind": "lsoda", "tolerance": 1e-12}):
            yield f"{name}, {method['kind']}", handle.question | {"times": times, "method": method}
    for quaternion in ([SUBNORMAL, 0.0, 0.0, 0.0], [LARGEST, LARGEST, 0.0, -LARGEST], [0.0, 0.0, 0.0, 0.0]):
        yield f"attitude {quaternion}", handle.question | {"times": [1.0], "attitude": quaternion}
    for motion in MOTIONS[::5]:
        for make in MATRIX_OF_METHODS:
            method, turn = make(turn_of(motion)), turn_of(motion)
            yield f"{motion.name}, {method['kind']}", motion.question | {"times": [turn, -turn], "method": method}
    for name, question in bodies():
        # What is derived of a body may leave the range of doubles where the body does not.
        if name.endswith((f"number 0 is {LARGEST:g}", "all by 1e-150", "all by 1e+150", "all by 1e+16")):
            yield name, question | {"angular_velocity": [0.3, -0.8, 0.5], "times": [1.0], "accuracy": 0.1}


def ensembles() -> Named:
    for motion in MOTIONS:
        starts = [list(motion.rates), [0.0, 0.0, 0.0], list(motion.rates)]
        times = [0.0, turn_of(motion), -turn_of(motion)]
        yield motion.name, {"body": motion.question["body"], "angular_velocities": starts, "times": times}
    body = {"kind": "principal-moments", "moments": [1.0, 2.0, 3.0]}
    for energy in (SUBNORMAL, 1e-300, 1e300, LARGEST):
        sample = {"energy": energy, "count": 3, "seed": 2**63 - 1}
        yield f"energy {energy:g}", {"body": body, "sample": sample, "times": [1.0, 0.0], "round": "meaningful"}
    yield "every start of a body", {"body": body, "angular_velocities": STARTS, "times": [1.0, -1e9], "round": 3}


def precessions() -> Named:
    for motion in MOTIONS:
        yield motion.name, motion.question
    for motion in MOTIONS[::4]:
        turn = turn_of(motion)
        method = {"kind": "runge-kutta-4", "step": turn / 10}
        measure = {"method": method, "duration": 10 * turn, "samples": 100, "tolerance": 0.1 / turn}
        yield f"{motion.name}, measured", motion.question | {"measure": measure}
    for steps in range(1, 14):
        # A method that blows up, stopped at every stage of it.
        method = {"kind": "explicit-euler", "step": 4.0}
        measure = {"method": method, "duration": 4.0 * steps, "samples": max(3, steps + 1), "tolerance": 0.1}
        question = {"body": {"kind": "principal-moments", "moments": [1.0, 2.0, 3.0]}, "angular_velocity": [1.0] * 3}
        yield f"{steps} steps of a method that blows up", question | {"measure": measure}


def stabilities() -> Named:
    for motion in MOTIONS:
        rate = max(motion.rates, key=abs)
        yield motion.name, {"body": motion.question["body"], "rate": rate}
        disturbance = [motion.rates[0], motion.rates[2]]
        disturbed = {"body": motion.question["body"], "rate": rate, "disturbance": disturbance}
        yield f"{motion.name}, disturbed", disturbed


def certified_trajectories() -> Named:
    for motion in MOTIONS[::3]:
        yield motion.name, motion.question | {"times": [turn_of(motion), -1.0], "digits": 17}


def certified_precessions() -> Named:
    for motion in MOTIONS[::3]:
        yield motion.name, motion.question | {"digits": 17}


def certified_stabilities() -> Named:
    for motion in MOTIONS[::3]:
        yield motion.name, {"body": motion.question["body"], "rate": motion.rates[0], "digits": 17}


def certified_ellipsoids() -> Named:
    for motion in MOTIONS[::6]:
        yield motion.name, motion.question | CURVES | {"digits": 17}


def certified(scene: Callable[[], Named]) -> Callable[[], Named]:
    """Return what yields every tenth question about a scene, to a few digits."""

    def questions() -> Named:
        for name, question in [*scene()][::10]:
            yield name, {key: value for key, value in question.items() if key not in ONLY_ORDINARY} | {"digits": 17}

    return questions


CURVES: Asked = {"resolution": 2, "points": 8, "separatrix": True}


def ellipsoids() -> Named:
    for motion in MOTIONS:
        yield motion.name, motion.question | CURVES
    for motion in MOTIONS[::2]:
        for energy in (1e-300, 1.0, 1e300):
            grid = {"layout": "grid", "polhodes": {"count": 2}, "energy": energy}
            yield f"{motion.name}, {energy:g} J", {"body": motion.question["body"]} | CURVES | grid
    body = {"kind": "principal-moments", "moments": [1.0, 2.0, 3.0]}
    for resolution, points in ((1, 8), (0, 8), (10**9, 8), (4, 10**9), (40, 20_000)):
        yield f"{resolution} by {points}", {"body": body, "energy": 1.0, "resolution": resolution, "points": points}


def starts() -> Named:
    for motion in MOTIONS:
        for energy in (SUBNORMAL, 1e-300, 1.0, 1e300, LARGEST):
            body = motion.question["body"]
            yield f"{motion.name}, {energy:g} J", {"body": body, "energy": energy, "count": 2, "seed": 1}


def wobbles() -> Named:
    lengths = (SUBNORMAL, nextafter(1.0, 0.0), 1.0, nextafter(1.0, 2.0), 1 + 1e-8, 430.0, nextafter(1e8, 0), 1e8, 1e300)
    for field, day, value in product(("period", "ellipticity"), ("sidereal", "solar"), (*lengths, LARGEST)):
        yield f"{field} {value!r}, {day}", {field: value, "day": day}


def comparisons() -> Named:
    for motion in MOTIONS[::2]:
        turn = turn_of(motion)
        methods = [{"kind": "closed-form"}, *(make(turn) for make in MATRIX_OF_METHODS[:5])]
        yield motion.name, motion.question | {"times": [turn, -turn], "methods": methods}
    body = {"kind": "principal-moments", "moments": [1.0, 2.0, 3.0]}
    for steps in range(1, 14):
        blown = [{"kind": "explicit-euler", "step": 4.0}, {"kind": "runge-kutta-4", "step": 8.0}]
        question = {"body": body, "angular_velocity": [1.0, 1.0, 1.0], "times": [8.0 * steps], "methods": blown}
        yield f"{steps} steps of methods that blow up", question


def bodies() -> Named:
    """Yield every kind of body with each of its numbers at every extreme, and with all of them there at once."""
    for motion in MOTIONS:
        yield motion.name, {"body": motion.question["body"]}
    for kind, specimen in SPECIMENS.items():
        plain = in_json(specimen)
        for size in SIZES:
            for k in range(sum(1 for _ in numbers(plain))):
                body = json.loads(json.dumps(plain))
                container, key = list(numbers(body))[k]
                container[key] = size
                yield f"{kind}, number {k} is {size:g}", {"body": body}
            body = json.loads(json.dumps(plain))
            for container, key in numbers(body):
                container[key] = max(-LARGEST, min(LARGEST, container[key] * size))
            yield f"{kind}, all by {size:g}", {"body": body}


def in_json(value: Any) -> Any:
    if is_dataclass(value):
        given = {entry.name: getattr(value, entry.name) for entry in fields(value)}
        return {name: in_json(entry) for name, entry in given.items() if entry is not None}
    if hasattr(value, "tolist"):
        return value.tolist()
    return [in_json(entry) for entry in value] if isinstance(value, tuple) else value


def numbers(node: Any) -> Iterator[tuple[Any, Any]]:
    """Yield container and key of every real number of a document."""
    for key in list(node) if isinstance(node, dict) else range(len(node)) if isinstance(node, list) else ():
        if isinstance(node[key], float):
            yield node, key
        else:
            yield from numbers(node[key])


SHAFTS: Asked = {
    "masses": [2.0, 1.0], "radii": [0.1, 0.2], "slopes": [0.5, 0.9], "gravity": 9.81, "positions": [1.0, 1.5],
    "wound": [0.5, 0.8], "times": [0.0, 0.05, 0.3],
}  # fmt: skip
ROD: Asked = {"hole_radius": 1.0, "length": 1.0, "mass": 1.0, "gravity": 9.81, "times": [0.0, 0.1, 3.0]}
CHAIN: Asked = {
    "masses": [1.0, 1.2], "slopes": [0.6, 0.8], "gravity": 9.81, "length": 2.0, "linear_density": 0.5,
    "position": 1.0, "velocity": 0.1, "times": [0.0, 0.01, 0.3],
}  # fmt: skip
FACES = (0.0, SUBNORMAL, 1e-300, 1e-150, 1e-16, 1e-8, 0.5, nextafter(RIGHT_ANGLE, 0.0), RIGHT_ANGLE)


def shafts() -> Named:
    for a, b in product(FACES, repeat=2):
        yield f"slopes {a!r} and {b!r}", SHAFTS | {"slopes": [a, b]}
    for ratio, gravity in product((1e-300, 1e-12, 1e12, 1e300), (1e-300, 1e-30, 9.81, 1e30, 1e300)):
        times = [0.0, 0.3 * sqrt(9.81 / gravity)]
        yield (
            f"masses 1 to {ratio:g}, g {gravity:g}",
            SHAFTS
            | {
                "masses": [ratio, 1.0],
                "gravity": gravity,
                "times": times,
            },
        )
    for radius, factor in product((1e-300, 1e-12, 1.0, 1e12, 1e300), (0.0, SUBNORMAL, 1e-300, 1e-12, 1e12, 1e300)):
        yield (
            f"radius {radius:g}, factor {factor:g}",
            SHAFTS
            | {
                "radii": [radius, 0.2],
                "inertia_factors": [factor, 0.5],
            },
        )
    for opening, restitution in product((1e-300, 1e-16, 1e-15, 1e-12, 1e-6, 1.0, 1e150), (0.0, 1e-300, 0.5, 1.0)):
        for sign in (1.0, -1.0):
            jerked = {"velocities": [0.1, 0.2], "spins": [1.0 + sign * opening, 1.0], "restitution": restitution}
            yield f"string opening at {sign * opening:g}, e {restitution:g}", SHAFTS | jerked
    for roughness in (0.0, 1e-300, 1e-12, 0.3, 1.0, 1e12, 1e300):
        friction = {"kinetic": [roughness, roughness], "static": [roughness, roughness]}
        yield f"friction {roughness:g}", SHAFTS | {"friction": friction}
    yield "nothing wound", SHAFTS | {"wound": [0.0, 0.0]}
    yield "at the apex", SHAFTS | {"positions": [0.0, 0.0]}


def rods() -> Named:
    lengths = (SUBNORMAL, 1e-300, 1e-150, 1e-12, 1.0, 2 * (1 - 1e-12), nextafter(2.0, 0.0), 2.0)
    for length, angle, rate in product(lengths, (None, 0.0, 1e-300, -1e-8, 0.5, pi), (0.0, 1e-300, 3.0, 1e6, -1e150)):
        question = ROD | {"length": length, "angular_velocity": rate, "hole": "cylinder"}
        yield f"length {length!r}, angle {angle}, rate {rate:g}", question | ({} if angle is None else {"angle": angle})
    for size, gravity, mass in product((1e-300, 1e-150, 1.0, 1e150, 1e300), (1e-300, 1.0, 1e300), (1e-300, 1e300)):
        scaled = {"hole_radius": size, "length": size, "gravity": gravity, "mass": mass}
        yield f"size {size:g}, g {gravity:g}, mass {mass:g}", ROD | scaled
    for k, above in product((2, 10, 30, 45, 52), (True, False)):
        # Least rate at the bottom to turn over: 2 sqrt(g/l_eff), l_eff = (a^2 - l^2/6)/k, k = sqrt(4a^2 - l^2)/2.
        limit = 2 * sqrt(9.81 * sqrt(0.75) / (1 - 1 / 6))
        rate = limit * (1 + 2.0**-k if above else 1 - 2.0**-k)
        over = {"hole": "cylinder", "angle": 0.0, "angular_velocity": rate, "times": [0.1, 5.0, 100.0]}
        yield f"turning over {'' if above else 'not '}by 2^-{k}", ROD | over


def chains() -> Named:
    densities = (0.0, SUBNORMAL, 1e-300, 1e-100, 1e-16, 0.5, 1e8, 1e100, 1e300)
    places = (0.0, SUBNORMAL, 1e-300, 1e-12, 1.0, 2 - 1e-12, nextafter(2.0, 0.0), 2.0)
    for density, place, velocity in product(densities, places, (0.0, 1e-300, -1e-8, 1.0, -1e150)):
        question = CHAIN | {"linear_density": density, "position": place, "velocity": velocity}
        yield f"density {density:g}, position {place!r}, velocity {velocity:g}", question
    for first, second, density in product((0.0, SUBNORMAL, 1e-12, 1e12, 1e300), (0.0, 1.0, 1e300), (0.0, 1e-300, 1.0)):
        yield (
            f"masses {first:g} and {second:g}, density {density:g}",
            CHAIN
            | {
                "masses": [first, second],
                "linear_density": density,
            },
        )
    for a, b in product(FACES, repeat=2):
        yield f"slopes {a!r} and {b!r}", CHAIN | {"slopes": [a, b]}
    for length, gravity in product((1e-300, 1e-150, 1e150, 1e300), (1e-300, 1.0, 1e300)):
        scaled = {"length": length, "position": length / 2, "gravity": gravity, "velocity": 0.0}
        yield f"length {length:g}, g {gravity:g}", CHAIN | scaled


def described() -> Named:
    for name, example in examples()["described_scene"].items():
        scene = {key: value for key, value in example.question.items() if key not in ("times", "outputs")}
        times: Asked = {"times": [0.0, 0.3, -0.1]}
        for factor in (1e-300, 1e-150, 1e-12, 1e12, 1e150, 1e300):
            yield f"{name}, g by {factor:g}", scene | times | {"gravity": [x * factor for x in scene["gravity"]]}
            for kind, powers in {
                "masses": {"mass": 1, "inertia": 1, "moments": 1},
                "lengths": {"at": 1, "radius": 1, "places": 1, "inertia": 2, "moments": 2},
                "one mass": {"mass": 1},
            }.items():
                bodies = {one: resized(body, powers, factor) for one, body in scene["bodies"].items()}
                few = dict(list(bodies.items())[:1]) if kind == "one mass" else bodies
                yield f"{name}, {kind} by {factor:g}", scene | times | {"bodies": scene["bodies"] | few}
        for far in (SUBNORMAL, -1e9, 1e150, LARGEST):
            yield f"{name}, at {far:g}", scene | {"times": [far]}
        # While it moves: of what has ended before there is no sample that could be wrong.
        yield f"{name}, nothing tolerated", scene | times | {"accuracy": 1e-300}
        yield f"{name}, everything", scene | times | {"outputs": list(OUTPUTS)}
    point = {"mass": 1, "at": [3, -4]}
    rod = {"kind": "rod", "a": "p", "b": [0, 0]}
    pendulum: Asked = {"gravity": [0, -9.81], "bodies": {"p": point}, "connections": [rod], "times": [1.0]}
    yield "by polar coordinates", pendulum | {"bodies": {"p": point | {"at": {"polar": [5, {"degrees": 90}]}}}}
    yield "upright", pendulum | {"bodies": {"p": point | {"at": [0, 5]}}}
    for rate in ("2*sqrt(49.05)", "2*sqrt(49.05)*(1 - 1e-12)", "2*sqrt(49.05)*(1 + 1e-12)"):
        over = {"at": [0, -5], "velocity": [rate, 0]}
        yield f"beside its separatrix at {rate}", pendulum | {"bodies": {"p": point | over}, "times": [1.0, 100.0]}
    for text in ("1e400", "1e-400", "1/3", "sqrt(2)", "1/(1 - 1)", "(" * 50, "x", "9" * 200, "9" * 201):
        yield f"mass {text[:10]}, {len(text)}", pendulum | {"bodies": {"p": point | {"mass": text}}}
    yield "a thousand connections", pendulum | {"connections": [rod] * 1000}
    yield "a hundred bodies", {"bodies": {f"p{i}": {"mass": 1, "at": [i, 0]} for i in range(100)}, "times": [1.0]}
    yield "more", {"bodies": {f"p{i}": {"mass": 1, "at": [i, 0]} for i in range(101)}}
    yield "massless", pendulum | {"bodies": {"p": point | {"mass": 0}}}
    link = {"kind": "chain", "through": ["p", [0, 0], "q"], "density": 1}
    hung: Asked = pendulum | {"bodies": {"p": point, "q": {"mass": 0, "at": [0, -2]}}, "connections": [link]}
    yield "a chain whose end is bare", hung
    for factor in (SUBNORMAL, 1e-300, 1e-12, 1e12, 1e300, LARGEST):
        yield f"a chain of the density {factor:g}", hung | {"connections": [link | {"density": factor}]}
        yield f"a chain at {factor:g}", hung | {"times": [factor, -factor]}
    yield "to itself", pendulum | {"connections": [rod | {"b": "p"}]}
    yield "twice", pendulum | {"connections": [rod, rod]}


def resized(body: Asked, powers: Mapping[str, int], factor: float) -> Asked:
    """Return a body with some of its numbers multiplied by powers of a factor."""

    def times(value: Any, by: float) -> Any:
        if isinstance(value, dict):
            return {name: times(entry, by) for name, entry in value.items()}
        return [times(entry, by) for entry in value] if isinstance(value, list) else value * by

    scaled = {name: 10.0 ** max(-300.0, min(300.0, power * log10(factor))) for name, power in powers.items()}
    return body | {name: times(body[name], by) for name, by in scaled.items() if name in body}


def plans() -> Named:
    """Yield plans of what is not asked elsewhere: whatever is asked there is planned there too."""
    yield "of nothing", {"path": "/v1/nothing", "request": {}}
    yield "of a plan", {"path": "/v1/plan", "request": {}}
    yield "of no question", {"path": "/v1/rotation/trajectory", "request": None}


CLAIMED: dict[str, tuple[Callable[[], Named], int, tuple[str, ...]]] = {
    "/v1/rotation/precession": (precessions, 7, ("/period", "/flip_interval", "/body_rate", "/axis", "/tumbles")),
    "/v1/rotation/stability": (stabilities, 7, ("/equilibria/1/eigenvalues", "/equilibria/0/moment", "/flip/interval")),
    "/v1/rotation/trajectory": (trajectories, 19, ("/angular_velocity", "/attitude/1", "/energy")),
    "/v1/bodies/mass-properties": (bodies, 5, ("/principal/axes", "/principal/moments", "/inertia/about_origin")),
    "/v1/rotation/wobble": (wobbles, 2, ("/ellipticity", "/asymmetry", "/period")),
    "/v1/scenes/rod-in-hole": (rods, 9, ("/angular_velocity_at_horizontal", "/period", "/trajectory/forces")),
    "/v1/scenes/unwinding-shafts": (shafts, 17, ("/tension", "/accelerations", "/phases/0/kind")),
    "/v1/scenes": (described, 5, ("/period", "/accelerations/p/linear")),
}
"""By endpoint: its extreme questions, which of them are assessed, and what is claimed."""


def assessments() -> Named:
    claims: tuple[Any, ...] = (
        0.0,
        SUBNORMAL,
        -LARGEST,
        1.0,
        None,
        True,
        "center",
        [0.0, 1.0, LARGEST],
        [[1.0] * 3] * 3,
    )
    for path, (asked, share, pointers) in CLAIMED.items():
        for name, question in list(asked())[::share]:
            submissions = [{pointer: {"value": value, "unit": "1"} for pointer in pointers} for value in claims]
            submissions += [{pointer: {"value": value} for pointer in pointers} for value in claims]
            submissions += [{pointer: {"value": [1.0], "times": [LARGEST]} for pointer in pointers}]
            yield f"{path}, {name}", {"question": {"path": path, "request": question}, "submissions": submissions}


def variants() -> Named:
    for path, (asked, share, _) in CLAIMED.items():
        # Described scenes are varied within the magnitudes that are promised for bodies.
        small, large = (1e-150, 1e150) if path == "/v1/scenes" else (SUBNORMAL, LARGEST)
        ranges: tuple[dict[str, Any], ...] = (
            {"min": small, "max": large, "distribution": "log-uniform"},
            {"min": -large, "max": large},
            {"min": max(small, 1e-300), "max": min(large, 1e300), "digits": 1},
            {"values": [0.0, small, large]},
        )
        # Each question in the next of the ranges: more draws of each cost as much as all else in this module.
        # The condition of each figure is found by many answers, of which those at the farthest times are the dearest.
        near = [(name, question) for name, question in asked() if not name.endswith(f"at {LARGEST:g}")]
        for (name, question), vary in zip(near[:: 3 * share], cycle(ranges), strict=False):
            if pointer := _first_number(question):
                yield (
                    f"{path}, {name}, {vary}",
                    {
                        "question": {"path": path, "request": question},
                        "vary": {pointer: vary},
                        "seed": 0,
                        "count": 1,
                        "draws": 2,
                    },
                )


SINGLE = {
    "/v1/rotation/stability": "/equilibria/0/moment",
    "/v1/rotation/trajectory": "/angular_velocity/0/0",
    "/v1/bodies/mass-properties": "/principal/moments/0",
}
"""A number of the answers of some endpoints whose first claims are arrays."""


def findings() -> Named:
    until: tuple[dict[str, Any], ...] = ({"equals": 0.0}, {"largest": True}, {"infinite": True}, {"changes": True})
    ends = ([0.0, LARGEST / 2], [-1e150, 1e150], [SUBNORMAL, 1.0], [1.0, 2.0])
    for path, (asked, share, pointers) in CLAIMED.items():
        for (name, question), wanted, between in zip(
            list(asked())[:: 40 * share], cycle(until), cycle(ends), strict=False
        ):
            if pointer := _first_number(question):
                yield (
                    f"{path}, {name}, {between}, {wanted}",
                    {
                        "question": {"path": path, "request": question},
                        "vary": {"pointer": pointer, "between": between},
                        "until": {"figure": SINGLE.get(path, pointers[0]), **wanted},
                    },
                )


def studies() -> Named:
    ranges: tuple[dict[str, Any], ...] = (
        {"min": SUBNORMAL, "max": LARGEST, "distribution": "log-uniform", "count": 3},
        {"min": -LARGEST, "max": LARGEST, "count": 3},
        {"values": [0.0, SUBNORMAL, LARGEST]},
        {"mean": 0.0, "deviation": LARGEST},
    )
    for path, (asked, share, pointers) in CLAIMED.items():
        for (name, question), vary in zip(list(asked())[:: 9 * share], cycle(ranges), strict=False):
            drawn = {"design": "random", "count": 5, "seed": 0} if "mean" in vary else {}
            if pointer := _first_number(question):
                yield (
                    f"{path}, {name}, {vary}",
                    {
                        "question": {"path": path, "request": question},
                        "vary": [{"pointer": pointer, **vary}],
                        "quantities": [pointers[0]],
                    }
                    | drawn,
                )
    spin = {"body": {"kind": "principal-moments", "moments": [1.0, 2.0, 3.0]}, "angular_velocity": [0.0, 1.0, 0.1]}
    for count in (0, 1, 10**7, 10**18):
        yield (
            f"{count} members",
            {
                "question": {"path": "/v1/rotation/precession", "request": spin},
                "vary": [{"pointer": "/body/moments/0", "min": 1.0, "max": 2.0, "count": count}],
                "quantities": ["/period"],
            },
        )


def fits() -> Named:
    """Yield a throw whose places are measured, of all sizes, and data that say nothing, or too little."""
    times = [0.0, 0.1, 0.2, 0.3, 0.5]
    for power in (-300, -160, -3, 0, 160, 300):
        size = 10.0**power
        places = [size * (3.0 * t - 4.905 * t * t) for t in times]
        for name, changes in {
            "one deviation": {"standard_deviations": {"y": 0.01 * size}},
            "an estimated one": {},
            "a tiny one": {"standard_deviations": {"y": 1e-300}},
            "a huge one": {"standard_deviations": {"y": 1e300}},
        }.items():
            yield f"a throw of size 1e{power}, {name}", _fit(times, places, size, **changes)
    for name, places in {
        "zeros": [0.0] * 5,
        "one value": [1.0] * 5,
        "the largest": [1.7e308, -1.7e308, 1.7e308, 0.0, 1.0],
        "the least": [5e-324, 0.0, -5e-324, 0.0, 0.0],
    }.items():
        yield f"places that are {name}", _fit(times, places, 1.0)
        yield f"places that are {name}, with a deviation", _fit(times, places, 1.0, standard_deviations={"y": 0.1})
    for name, other in {
        "far away": [1e300, -1e300, 1e9, -1e9, 0.0],
        "before the start": [-1.0, -2.0, -3.0, -0.5, 0.0],
    }.items():
        yield f"times that are {name}", _fit(other, [1.0, 2.0, 3.0, 4.0, 5.0], 1.0)


def _fit(times: list[float], places: list[float], size: float, **data: Any) -> Asked:
    request = {
        "gravity": [0, "-g"],
        "let": {"g": 9.0 * size, "v": 2.0 * size},
        "bodies": {"p": {"mass": 1, "at": [0, 0], "velocity": [0, "v"]}},
    }
    measured = {"columns": {"t": times, "y": places}, "times": "t", "figures": {"y": "p.position.y"}}
    return {
        "question": {"path": "/v1/scenes", "request": request},
        "data": measured | data,
        "unknown": [{"pointer": "/let/g"}, {"pointer": "/let/v"}],
    }


def _first_number(value: Any, pointer: str = "") -> str | None:
    """Return the pointer of the first number of a request."""
    if isinstance(value, dict | list):
        entries = value.items() if isinstance(value, dict) else enumerate(value)
        return next((found for key, one in entries if (found := _first_number(one, f"{pointer}/{key}"))), None)
    return pointer if isinstance(value, int | float) and not isinstance(value, bool) else None


def documents() -> Named:
    """Yield a chain with a keyframe, with a mass, an arm, a moment and a rate of every size."""
    inertial = '<inertial pos="0 {1!r} 0.1" mass="{0!r}" diaginertia="{2!r} {2!r} {2!r}"/>'
    inner = '<body pos="{1!r} 0 -1"><joint axis="0 1 0" stiffness="{0!r}"/>' + inertial + "</body>"
    text = '<mujoco><worldbody><body euler="10 20 30"><joint/>' + inertial + inner + "</body></worldbody>"
    text += '<keyframe><key qvel="{3!r} 1"/></keyframe></mujoco>'
    for size in SIZES:
        for k in range(4):
            given = [size if i == k else 1.0 for i in range(4)]
            yield f"number {k} is {size:g}", {"document": text.format(*given)}


def exports() -> Named:
    for name, question in [*described()][::4]:
        scene = {key: value for key, value in question.items() if key in ("gravity", "bodies", "connections", "let")}
        yield name, scene | {"format": "mjcf"}


QUESTIONS: dict[str, Callable[[], Named]] = {
    "/v1/bodies/mass-properties": bodies,
    "/v1/rotation/trajectory": trajectories,
    "/v1/rotation/ensemble": ensembles,
    "/v1/rotation/precession": precessions,
    "/v1/rotation/stability": stabilities,
    "/v1/rotation/energy-ellipsoid": ellipsoids,
    "/v1/rotation/initial-states": starts,
    "/v1/rotation/wobble": wobbles,
    "/v1/work-precision": comparisons,
    "/v1/scenes/unwinding-shafts": shafts,
    "/v1/scenes/rod-in-hole": rods,
    "/v1/scenes/chain-on-wedge": chains,
    "/v1/certified/rotation/trajectory": certified_trajectories,
    "/v1/certified/rotation/precession": certified_precessions,
    "/v1/certified/rotation/stability": certified_stabilities,
    "/v1/certified/rotation/energy-ellipsoid": certified_ellipsoids,
    "/v1/certified/scenes": certified(described),
    "/v1/certified/scenes/unwinding-shafts": certified(shafts),
    "/v1/certified/scenes/rod-in-hole": certified(rods),
    "/v1/certified/scenes/chain-on-wedge": certified(chains),
    "/v1/scenes": described,
    "/v1/scenes/import": documents,
    "/v1/scenes/export": exports,
    "/v1/plan": plans,
    "/v1/assessments": assessments,
    "/v1/variants": variants,
    "/v1/find": findings,
    "/v1/studies": studies,
    "/v1/fits": fits,
}
