"""Random scenes of up to four contacts, slack strings and stops, judged by what no motion may do.

    python -m tests.core.multibody.contact_judge 1000 0

judges 1000 scenes from seed 0 on, in as many processes as there are processors. Nothing overlaps, nothing gains energy,
all works together are the change of kinetic energy, no string is longer than it is, no friction is stronger than its
cone allows, and the answer of a mirrored scene in other units is the same within the stated errors. The figures are
written to benchmarks/results/contact_scenes.json: a run from seed 0 on begins them anew, and one from the seed that
follows theirs extends them.
"""

from __future__ import annotations

import json
import multiprocessing
import sys
import time
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from core.errors import MechanicsError
from core.multibody.answer import SceneSolution
from core.multibody.solve import solve_scene
from core.systems.trajectory import MotionEvent
from tests.core.multibody.random_scenes import decimal
from tests.core.multibody.worked_examples import read

TARGET = Path(__file__).parents[3] / "benchmarks" / "results" / "contact_scenes.json"
OUTPUTS = ("trajectory", "forces-in-time", "energy", "energy-in-time", "work-in-time")
END = 2.0
SLIGHT = 1e-9
"""Share of the largest impulse of a contact below which its bounces, and what follows them, are not compared."""
APART = 1e-6
"""Share of the largest impulse of contacts that bounce in turn down to which impacts are told apart in any units."""
OFTEN, LAST = 3, 24
"""Impacts of a contact, among so many of the last events, by which it bounces in turn with others."""
LENGTH = 4.0
"""By how much the mirrored scene is larger, a power of two."""

Scene = dict[str, Any]


def discs(random: np.random.Generator) -> Scene:
    """Return one or two discs above a floor between walls or on a slope."""
    count = int(random.integers(1, 3))
    bodies: Scene = {}
    connections: list[Scene] = []
    friction = _friction(random)
    for k in range(count):
        radius = decimal(random, 0.1, 0.3)
        mass = decimal(random, 0.5, 3)
        bodies[f"d{k}"] = {
            "mass": mass,
            "inertia": float(f"{mass * radius * radius * random.uniform(0.3, 1):.4g}"),
            "radius": radius,
            "at": [decimal(random, -0.8, -0.4) if k == 0 else decimal(random, 0.4, 0.8), decimal(random, 0.4, 1.5)],
            "velocity": [decimal(random, -2, 2), decimal(random, -2, 2)],
            "angular_velocity": decimal(random, -10, 10),
        }
        connections.append(_contact(random, f"floor{k}", f"d{k}", {"at": [0, 0], "slope": _slope(random)}, friction))
    if count == 2:
        connections.append({"kind": "contact", "name": "pair", "a": "d0", "b": "d1", **_law(random, friction)})
    else:
        wall = {"at": [1.2, 0], "slope": {"degrees": 90}}
        connections.append(_contact(random, "wall", "d0", wall, friction))
    return {"gravity": [0, -9.81], "bodies": bodies, "connections": connections}


def rod_on_floor(random: np.random.Generator) -> Scene:
    """Return a rod whose two ends may touch a floor."""
    half, mass = decimal(random, 0.3, 0.8), decimal(random, 0.5, 3)
    friction = _friction(random)
    places = {"left": [-half, 0], "right": [half, 0]}
    rod = {
        "mass": mass,
        "inertia": float(f"{mass * half * half / 3:.4g}"),
        "at": [0, decimal(random, 0.9, 1.4)],
        "angle": decimal(random, -1.4, 1.4),
        "velocity": [decimal(random, -2, 2), decimal(random, -2, 2)],
        "angular_velocity": decimal(random, -5, 5),
        "places": places,
    }
    floor = {"at": [0, 0]}
    return {
        "gravity": [0, -9.81],
        "bodies": {"rod": rod},
        "connections": [_contact(random, end, f"rod.{end}", floor, friction) for end in places],
    }


def block_on_spring(random: np.random.Generator) -> Scene:
    """Return a block that a spring pulls along a rough slope, and that may leave it."""
    slope = decimal(random, -0.6, 0.6)
    along = decimal(random, -0.5, 0.5)
    return {
        "gravity": [0, -9.81],
        "let": {"c": f"cos({slope})", "s": f"sin({slope})"},
        "bodies": {
            "block": {
                "mass": decimal(random, 0.5, 2),
                "at": [f"{along}*c", f"{along}*s"],
                "velocity": [f"({decimal(random, -3, 3)})*c", "0"] if random.random() < 0 else None,
            }
        },
        "connections": [
            _contact(random, "slope", "block", {"at": [0, 0], "slope": slope}, True),
            {
                "kind": "spring",
                "a": "block",
                "b": ["2*c", "2*s"],
                "stiffness": decimal(random, 5, 60),
                "rest_length": 1.6,
            },
        ],
    }


def pendulum_on_string(random: np.random.Generator) -> Scene:
    """Return a stone on a string that becomes slack, above a floor that it may reach."""
    angle = decimal(random, -1.5, 1.5)
    rate = decimal(random, 2, 7)
    string = {"kind": "string", "name": "s", "through": ["stone", [0, 0]], "restitution": _restitution(random)}
    floor = _contact(random, "floor", "stone", {"at": [0, decimal(random, -2, -1.2)]}, False)
    return {
        "gravity": [0, -9.81],
        "let": {"x": f"sin({angle})", "y": f"-cos({angle})"},
        "bodies": {"stone": {"mass": 1, "at": ["x", "y"], "velocity": [f"-y*{rate}", f"x*{rate}"]}},
        "connections": [string, floor] if random.random() < 0.5 else [string],
    }


def atwood_with_floor(random: np.random.Generator) -> Scene:
    """Return two masses on a string over a wheel, one of which lands on a floor."""
    return {
        "gravity": [0, -9.81],
        "bodies": {
            "a": {"mass": decimal(random, 0.5, 1.5), "at": [-0.1, -1.0]},
            "b": {"mass": decimal(random, 1.6, 3), "at": [0.1, decimal(random, -0.8, -0.4)]},
            "wheel": {"mass": 0.5, "radius": 0.1, "inertia": 0.0025, "at": [0, 0]},
        },
        "connections": [
            {"kind": "pin", "a": "wheel", "b": [0, 0]},
            {
                "kind": "string",
                "name": "s",
                "through": ["a", "wheel", "b"],
                "sides": {"wheel": ["left", "right"]},
                "restitution": _restitution(random),
            },
            _contact(random, "floor", "b", {"at": [0, -1.2]}, False),
        ],
    }


def rod_pendulum_with_stop(random: np.random.Generator) -> Scene:
    """Return a rod on a hinge with a stop, or above an edge."""
    half, angle = decimal(random, 0.3, 0.6), decimal(random, -1.2, 0.2)
    rod = {
        "mass": decimal(random, 0.5, 2),
        "inertia": decimal(random, 0.05, 0.2),
        "at": [f"{half}*cos({angle})", f"{half}*sin({angle})"],
        "angle": angle,
        "angular_velocity": decimal(random, -4, 4),
        "places": {"top": [-half, 0]},
    }
    stop = {
        "kind": "contact",
        "name": "stop",
        "measure": "turn",
        "a": "rod",
        "at_most": decimal(random, 0.3, 0.8),
        "restitution": _restitution(random),
    }
    return {
        "gravity": [0, -9.81],
        "bodies": {"rod": rod},
        "connections": [{"kind": "pin", "name": "h", "a": "rod.top", "b": [0, 0]}, stop],
    }


def disc_in_bowl(random: np.random.Generator) -> Scene:
    """Return a disc in a hollow, sliding, rolling or leaving it."""
    radius, mass, angle = decimal(random, 0.05, 0.2), decimal(random, 0.5, 2), decimal(random, -2.5, 2.5)
    rate = decimal(random, -6, 6)
    return {
        "gravity": [0, -9.81],
        "let": {"x": f"(1 - {radius})*sin({angle})", "y": f"-(1 - {radius})*cos({angle})"},
        "bodies": {
            "disc": {
                "mass": mass,
                "inertia": float(f"{mass * radius * radius / 2:.4g}"),
                "radius": radius,
                "at": ["x", "y"],
                "velocity": [f"-y*({rate})", f"x*({rate})"],
                "angular_velocity": decimal(random, -20, 20),
            }
        },
        "connections": [_contact(random, "bowl", "disc", {"at": [0, 0], "radius": -1}, _friction(random))],
    }


def block_on_plank(random: np.random.Generator) -> Scene:
    """Return a block on a plank that slides on a floor."""
    return {
        "gravity": [0, -9.81],
        "bodies": {
            "plank": {
                "mass": decimal(random, 1, 5),
                "inertia": 1,
                "at": [0, 0],
                "velocity": [decimal(random, -2, 2), 0],
            },
            "block": {"mass": decimal(random, 0.5, 2), "at": [0, 0], "velocity": [decimal(random, -3, 3), 0]},
        },
        "connections": [
            {"kind": "slider", "a": "plank", "b": [0, 0], "slope": 0},
            _contact(random, "top", "block", {"at": "plank"}, True),
            _contact(random, "wall", "block", {"at": [1.5, 0], "slope": {"degrees": 90}}, False),
        ],
    }


def rod_in_corner(random: np.random.Generator) -> Scene:
    """Return a rod whose two ends may touch a floor and a wall, in a corner."""
    scene = rod_on_floor(random)
    friction = "friction" in scene["connections"][0]
    for end in ("left", "right"):
        wall = {"at": [decimal(random, 0.9, 1.3), 0], "slope": {"degrees": 90}}
        scene["connections"].append(_contact(random, f"wall-{end}", f"rod.{end}", wall, friction))
    return scene


def discs_in_corner(random: np.random.Generator) -> Scene:
    """Return two discs that may touch a floor, a wall and one another."""
    while True:
        scene = discs(random)
        if len(scene["bodies"]) == 2:
            break
    friction = "friction" in scene["connections"][0]
    scene["connections"].append(_contact(random, "wall", "d1", {"at": [1.3, 0], "slope": {"degrees": 90}}, friction))
    return scene


def box_on_floor(random: np.random.Generator) -> Scene:
    """Return a box that falls onto its corners."""
    width, height, mass = decimal(random, 0.2, 0.6), decimal(random, 0.2, 0.6), decimal(random, 0.5, 3)
    corners = {"a": [-width, -height], "b": [width, -height], "c": [width, height], "d": [-width, height]}
    box = {
        "mass": mass,
        "inertia": float(f"{mass * (width * width + height * height) / 3:.4g}"),
        "at": [0, decimal(random, 0.9, 1.4)],
        "angle": decimal(random, -1.4, 1.4),
        "velocity": [decimal(random, -2, 2), decimal(random, -2, 2)],
        "angular_velocity": decimal(random, -5, 5),
        "places": corners,
    }
    friction, floor = _friction(random), {"at": [0, 0], "slope": _slope(random)}
    return {
        "gravity": [0, -9.81],
        "bodies": {"rod-box": box},
        "connections": [_contact(random, corner, f"rod-box.{corner}", floor, friction) for corner in corners],
    }


KINDS: tuple[Callable[[np.random.Generator], Scene], ...] = (
    discs,
    rod_on_floor,
    block_on_spring,
    pendulum_on_string,
    atwood_with_floor,
    rod_pendulum_with_stop,
    disc_in_bowl,
    block_on_plank,
    rod_in_corner,
    discs_in_corner,
    box_on_floor,
)


def any_scene(seed: int, kinds: Sequence[Callable[[np.random.Generator], Scene]] = KINDS) -> Scene:
    """Return the scene of a seed, the kinds in turn."""
    found = kinds[seed % len(kinds)](np.random.default_rng(seed))
    for body in found["bodies"].values():
        for name in [name for name, value in body.items() if value is None]:
            del body[name]
    return found


def _friction(random: np.random.Generator) -> bool:
    return bool(random.random() < 0.7)


def _restitution(random: np.random.Generator) -> float:
    return 0.0 if random.random() < 0.4 else decimal(random, 0.1, 0.9)


def _slope(random: np.random.Generator) -> float:
    return 0.0 if random.random() < 0.5 else decimal(random, -0.4, 0.4)


def _law(random: np.random.Generator, friction: bool) -> Scene:
    law: Scene = {"restitution": _restitution(random)}
    if friction:
        sliding = decimal(random, 0.05, 0.9)
        law["friction"] = sliding if random.random() < 0.5 else [round(sliding * 1.25, 6), sliding]
    return law


def _contact(random: np.random.Generator, name: str, place: str, on: Scene, friction: bool) -> Scene:
    return {"kind": "contact", "name": name, "place": place, "on": on, **_law(random, friction)}


def solved(scene: Scene, count: int = 41) -> SceneSolution:
    return solve_scene(read(scene), np.linspace(0.0, END, count), OUTPUTS, 1e-6)


def require_physical(answer: SceneSolution, scene: Scene) -> None:
    """Raise `AssertionError` for what no motion may do."""
    motion = answer.trajectory
    assert motion is not None
    for name, one in motion.columns.items():
        assert np.isfinite(one.values).all(), name
    for connection in scene["connections"]:
        if connection["kind"] != "contact" or f"{connection['name']}.normal" not in motion.columns:
            continue
        push = motion.columns[f"{connection['name']}.normal"]
        assert np.all(push.values >= -push.error), (connection["name"], "pulls")
        if "friction" in connection:
            mu = connection["friction"]
            rub = motion.columns.get(f"{connection['name']}.friction")
            if rub is not None:
                cone = (mu[0] if isinstance(mu, list) else mu) * push.values
                assert np.all(np.abs(rub.values) <= cone + 2 * (rub.error + push.error)), (connection["name"], "cone")
    _require_apart(answer, scene)
    if len(motion.time) > 1:
        kinetic, potential = motion.columns["energy.kinetic"], motion.columns["energy.potential"]
        total = kinetic.values + potential.values
        assert np.all(np.diff(total) <= 4 * (kinetic.error + potential.error)), "energy"
        lost = sum(event.energy_loss for event in answer.events)
        assert lost >= 0
        works = [one for name, one in motion.columns.items() if name.endswith(".work")]
        assert answer.energy is not None
        determined = all(
            f"{connection['name']}.impacts.work" in motion.columns
            for connection in scene["connections"]
            if connection["kind"] == "contact"
        )
        left = kinetic.values - answer.energy.kinetic - sum(one.values for one in works)
        assert not determined or np.all(np.abs(left) <= 2 * kinetic.error + sum(one.error for one in works)), (
            "balance",
            left,
        )


def _require_apart(answer: SceneSolution, scene: Scene) -> None:
    motion = answer.trajectory
    assert motion is not None
    for connection in scene["connections"]:
        if connection["kind"] == "string" and len(connection["through"]) == 2:
            stone = motion.columns["stone.position"]
            assert np.all(np.linalg.norm(stone.values, axis=1) <= 1 + 4 * stone.error + 1e-15)
        if connection["kind"] != "contact":
            continue
        if "a" in connection and "b" in connection:
            a, b = (motion.columns[f"{connection[k]}.position"] for k in "ab")
            reach = sum(scene["bodies"][connection[k]]["radius"] for k in "ab")
            assert np.all(np.linalg.norm(a.values - b.values, axis=1) >= reach - 4 * (a.error + b.error))
        elif connection.get("measure") == "turn":
            turn = motion.columns[f"{connection['a']}.angle"]
            assert np.all(turn.values <= connection["at_most"] + turn.error)
        else:
            _require_on_its_side(answer, scene, connection)


def _require_on_its_side(answer: SceneSolution, scene: Scene, connection: Scene) -> None:
    motion = answer.trajectory
    assert motion is not None
    body, _, spot = connection["place"].partition(".")
    place = motion.columns[f"{body}.position"]
    at, error = place.values, place.error
    if spot:
        xi = scene["bodies"][body]["places"][spot]
        turn = motion.columns[f"{body}.angle"]
        c, s = np.cos(turn.values), np.sin(turn.values)
        at = at + np.stack([c * xi[0] - s * xi[1], s * xi[0] + c * xi[1]], axis=1)
        error += (abs(xi[0]) + abs(xi[1])) * (turn.error + 4e-16)
    radius = 0.0 if spot else scene["bodies"][body].get("radius", 0.0)
    on = connection["on"]
    base = on["at"] if not isinstance(on["at"], str) else motion.columns[f"{on['at']}.position"].values
    d = at - np.asarray(base)
    if "radius" in on:
        gap = (-on["radius"] - radius) - np.linalg.norm(d, axis=1)
    else:
        slope = on.get("slope", 0.0)
        slope = np.radians(slope["degrees"]) if isinstance(slope, dict) else slope
        gap = -np.sin(slope) * d[:, 0] + np.cos(slope) * d[:, 1] - radius
    assert np.all(gap >= -4 * error - 1e-15), (connection["name"], "penetrates", float(gap.min()), error)


def mirrored(scene: Scene) -> Scene:
    """Return a scene seen in a mirror, in units in which every length is `LENGTH` times as large."""
    found = json.loads(json.dumps(scene))

    def scaled(x: Any, factor: float) -> Any:
        return f"({factor})*({x})" if isinstance(x, str) else factor * x

    def vector(v: Any, factor: float = LENGTH) -> Any:
        return [scaled(v[0], -factor), scaled(v[1], factor)]

    found["gravity"] = vector(found["gravity"])
    for body in found["bodies"].values():
        body["at"] = vector(body["at"])
        for name in ("velocity",):
            if name in body:
                body[name] = vector(body[name])
        for name, factor in (("radius", LENGTH), ("inertia", LENGTH**2), ("angular_velocity", -1.0)):
            if name in body:
                body[name] = scaled(body[name], factor)
        if "angle" in body:
            body["angle"] = f"pi - ({body['angle']})"
        body["places"] = {
            name: [scaled(v[0], LENGTH), scaled(v[1], -LENGTH)] for name, v in body.get("places", {}).items()
        }
    sides = {"left": "right", "right": "left"}
    for connection in found["connections"]:
        for name in ("b",):
            if isinstance(connection.get(name), list):
                connection[name] = vector(connection[name])
        if "on" in connection:
            on = connection["on"]
            if isinstance(on["at"], list):
                on["at"] = vector(on["at"])
            if "radius" in on:
                on["radius"] = LENGTH * on["radius"]
            else:
                # A line that is free on its left has in the mirror the slope of the opposite direction turned about.
                slope = on.get("slope", 0.0)
                on["slope"] = {"degrees": -slope["degrees"]} if isinstance(slope, dict) else -slope
                if isinstance(slope, dict):
                    on["slope"] = {"degrees": 270} if slope["degrees"] == 90 else on["slope"]
        if "rest_length" in connection:
            connection["rest_length"] = scaled(connection["rest_length"], LENGTH)
        if "at_most" in connection:
            connection["at_least"] = f"pi - ({connection.pop('at_most')})"
        if "through" in connection:
            connection["through"] = [vector(p) if isinstance(p, list) else p for p in connection["through"]]
            connection["sides"] = {name: [sides[x] for x in both] for name, both in connection.get("sides", {}).items()}
    return found


def noticeable(events: Sequence[MotionEvent]) -> list[MotionEvent]:
    """Return the events before contacts that bounce in turn come to rest below what is known of them."""
    largest: dict[str, float] = {}
    found = []
    for event in events:
        push = event.impulses.get("normal", 0.0)
        largest[event.name] = max(largest.get(event.name, 0.0), push)
        if 0.0 < push < SLIGHT * largest[event.name]:
            break
        found.append(event)
    return found


def told_apart(answer: SceneSolution) -> float:
    """Return until when the impacts of contacts that bounce in turn are told apart.

    Infinitely many come before a time that they do not reach. Where two of them are closer than they are known, which
    comes first is undecided: how many there are before depends on the rounding, and so on the units.
    """
    if answer.ended is None or answer.ended.kind != "simultaneous-impacts":
        return np.inf
    for name in answer.ended.name.split(", "):
        pushes = [event.impulses["normal"] for event in answer.events if event.name == name and event.impulses]
        recent = [event for event in answer.events[-LAST:] if event.name == name and event.impulses]
        if len(recent) < OFTEN or pushes[-1] > APART * max(pushes):
            return np.inf
    return answer.ended.time


def require_same(answer: SceneSolution, other: SceneSolution) -> float:
    """Raise unless the answer of the mirrored scene is the same within the errors; return the largest difference."""
    if {"event-limit", "lost-event"} & {one.ended.kind for one in (answer, other) if one.ended is not None}:
        # How far a scene is followed that bounces without end depends on its units.
        return 0.0
    until = min(told_apart(answer), told_apart(other))
    mine, their = ([e for e in noticeable(one.events) if e.time < until] for one in (answer, other))
    assert Counter((e.kind, e.name) for e in mine) == Counter((e.kind, e.name) for e in their), "events"
    for one, two in zip(
        sorted(mine, key=lambda e: (e.time, e.name)),
        sorted(their, key=lambda e: (e.time, e.name)),
        strict=True,
    ):
        assert abs(one.time - two.time) <= one.error + two.error, (one, two)
    first, second = answer.trajectory, other.trajectory
    assert first is not None
    assert second is not None
    worst = 0.0
    for name, column in first.columns.items():
        theirs = second.columns[name]
        values = np.array(theirs.values)
        factor = {"m": LENGTH, "m/s": LENGTH, "J": LENGTH**2, "N": LENGTH, "N m": LENGTH**2}.get(column.unit, 1.0)
        values = values / factor
        if column.values.ndim == 2:
            values = values * [-1, 1]
        elif name.endswith(".angle") and "rod" in name:
            values = np.pi - values
        elif column.unit.startswith("rad") or name.endswith((".friction", ".moment")) or name in ("h.x", "stop.torque"):
            values = -values
        if name in ("stop.torque",) or name.endswith(".friction"):
            # Signs of slip depend on the direction of the face.
            values, mine = np.abs(values), np.abs(column.values)
        else:
            mine = column.values
        apart = np.abs(mine - values) if mine.ndim == 1 else np.linalg.norm(mine - values, axis=1)
        # Angles are turned by pi in doubles, too.
        allowed = column.error + theirs.error / factor + (1e-15 if "angle" in name else 0.0)
        assert np.all(apart <= allowed), (name, float(apart.max()), column.error)
        worst = max(worst, float(np.max(apart, initial=0.0)) / max(column.error, 1e-300))
    return worst


def judged(scene: Scene) -> str:
    """Judge one scene and return how it ended."""
    answer = solved(scene)
    require_physical(answer, scene)
    other = solved(mirrored(scene))
    require_same(answer, other)
    return "horizon" if answer.ended is None else answer.ended.kind


def judged_seed(seed: int) -> tuple[str, str, float]:
    """Return how the scene of a seed ended, what is wrong with it, and how long that took (s)."""
    begun = time.perf_counter()
    ended, fault = "", ""
    try:
        ended = judged(any_scene(seed))
    except MechanicsError as refusal:
        ended = f"refused: {type(refusal).__name__}"
        sys.stdout.write(f"{seed} {KINDS[seed % len(KINDS)].__name__} refused {refusal}\n")
    except Exception as wrong:
        fault = f"{type(wrong).__name__}: {wrong}"[:300]
        sys.stdout.write(f"{seed} {KINDS[seed % len(KINDS)].__name__} {fault}\n")
    sys.stdout.flush()
    return ended, fault, time.perf_counter() - begun


def main(count: int, first: int = 0) -> None:
    """Judge, write and print."""
    before = json.loads(TARGET.read_text(encoding="utf-8")) if first and TARGET.exists() else {}
    extended = before.get("scenes", 0) == first
    with multiprocessing.Pool() as pool:
        each = pool.map(judged_seed, range(first, first + count), chunksize=5)
    ends = Counter(ended for ended, _, _ in each if ended)
    faults = {str(first + k): fault for k, (_, fault, _) in enumerate(each) if fault}
    took = [seconds for _, _, seconds in each]
    sys.stdout.write(f"{dict(ends)}, {len(faults)} faults; median {np.median(took):.3g} s, ")
    sys.stdout.write(f"worst {max(took):.3g} s at {first + int(np.argmax(took))}\n")
    if extended:
        result = {
            "scenes": first + count,
            "ended": dict(Counter(before.get("ended", {})) + ends),
            "faults": before.get("faults", {}) | faults,
        }
        TARGET.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(*(int(x) for x in sys.argv[1:]))
