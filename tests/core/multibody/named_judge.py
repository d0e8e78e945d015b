"""Named scenes with events, described anew: unwinding shafts, smooth and rough, a rod in its hole, a chain on a wedge.

    python -m tests.core.multibody.named_judge 1000

The named scenes have closed forms of their own, and share no code with described ones. Whatever differs is printed; the
figures are written to benchmarks/results/named_scenes.json.
"""

from __future__ import annotations

import json
import multiprocessing
import sys
from collections import Counter
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from core.multibody.answer import SceneSolution
from core.multibody.solve import solve_scene
from core.scenes.chain_on_wedge import ChainOnWedge
from core.scenes.friction import Friction
from core.scenes.rod_in_hole import RodInHole
from core.scenes.unwinding_shafts import UnwindingShafts
from core.systems.trajectory import MotionEvent
from tests.core.multibody.random_scenes import decimal
from tests.core.multibody.worked_examples import column, read

TARGET = Path(__file__).parents[3] / "benchmarks" / "results" / "named_scenes.json"
OWN = 2e-15
"""Relative error of the named scenes' samples."""
END = 1.5
"""Until when shafts are compared (s)."""
FAINT = 1e-7
"""Share of the largest impulse of a motion below which a jerk, and what happens until jerks end, is not compared: both
leave out the last of infinitely many jerks, and not the same ones."""


def exactly(number: float) -> str:
    """Return a double as a formula: numerals in formulas are decimals, and a decimal of a double is another number."""
    return "({}/{})".format(*number.as_integer_ratio())


def shafts(named: UnwindingShafts) -> dict[str, Any]:
    """Return the same scene in bodies and connections, the apex at the origin."""
    bodies, connections = {}, []
    assert named.positions is not None
    for i, (name, side) in enumerate((("one", -1), ("two", 1))):
        mass, radius, slope = (exactly(pair[i]) for pair in (named.masses, named.radii, named.slopes))
        x, v, w = exactly(named.positions[i]), exactly(named.velocities[i]), named.spins[i]
        bodies[name] = {
            "mass": mass,
            "radius": radius,
            "inertia": f"{mass}*{radius}*{radius}/2",
            "at": [
                f"{side}*({x}*cos({slope}) + {radius}*sin({slope}))",
                f"{radius}*cos({slope}) - {x}*sin({slope})",
            ],
            "velocity": [f"{side}*({v})*cos({slope})", f"-({v})*sin({slope})"],
            "angular_velocity": -side * w,
        }
        if named.friction is None:
            rail = {"at": [f"{side}*{radius}*sin({slope})", f"{radius}*cos({slope})"], "slope": f"{-side}*{slope}"}
            connections.append({"kind": "track", "name": f"face-{name}", "place": name, "on": rail})
        else:
            law = [named.friction.static[i], named.friction.kinetic[i]]
            face = {"at": [0, 0], "slope": f"{-side}*{slope}"}
            connections.append({"kind": "contact", "name": f"face-{name}", "place": name, "on": face, "friction": law})
    string = {
        "kind": "string",
        "name": "s",
        "through": ["one", [0, 0], "two"],
        "sides": {"one": "below", "two": "below"},
        "restitution": named.restitution,
    }
    return {
        # Named scenes take their numbers as doubles.
        "numbers": "doubles",
        "gravity": [0, -named.gravity],
        "bodies": bodies,
        "connections": [*connections, string],
    }


def random_shafts(seed: int, *, rough: bool = False) -> UnwindingShafts:
    random = np.random.default_rng(seed)
    drawn = UnwindingShafts(
        masses=(decimal(random, 0.5, 4), decimal(random, 0.5, 4)),
        radii=(decimal(random, 0.05, 0.3), decimal(random, 0.05, 0.3)),
        slopes=(decimal(random, 0.2, 1.2), decimal(random, 0.2, 1.2)),
        gravity=9.81,
        positions=(50.0, 50.0),
        wound=(40.0, 40.0),
        velocities=(decimal(random, -1, 2), decimal(random, -1, 2)),
        spins=(decimal(random, -10, 20), decimal(random, -10, 20)),
        restitution=(0.0, 0.3, 0.7)[seed % 3],
        friction=None
        if not rough
        else Friction(
            static=(decimal(random, 0.2, 0.6), decimal(random, 0.2, 0.6)),
            kinetic=(decimal(random, 0.05, 0.2), decimal(random, 0.05, 0.2)),
        ),
    )
    return drawn


def require_same_shafts(named: UnwindingShafts, described: dict[str, Any] | None = None) -> SceneSolution:
    """Raise `AssertionError` unless described shafts move as named ones; return the answer about the described."""
    times = np.linspace(0.0, END, 16)
    theirs = named.answer(times)
    assert theirs.trajectory is not None
    # After hundreds of jerks less may be known than is asked for by default; it is compared with what is stated.
    answer = solve_scene(read(described or shafts(named)), times, accuracy=1e-6)
    assert answer.problem is None, answer.problem
    _require_same_events(named, theirs.figures, answer)
    for i, (name, side) in enumerate((("one", -1), ("two", 1))):
        down = np.array([side * np.cos(named.slopes[i]), -np.sin(named.slopes[i])])
        place = column(answer, f"{name}.position")
        expected = place.values[0] + (theirs.trajectory["positions"][:, i] - 50.0)[:, None] * down
        away = float(np.linalg.norm(place.values - expected, axis=1).max())
        assert away <= place.error + OWN * 60, (name, away, place.error)
        spin = column(answer, f"{name}.angular_velocity")
        away = float(np.abs(spin.values + side * theirs.trajectory["spins"][:, i]).max())
        assert away <= spin.error + 1e-13, (name, "spin", away, spin.error)
    return answer


def _require_same_events(named: UnwindingShafts, figures: Any, answer: SceneSolution) -> None:
    """Raise unless jerks, what they do, and the ends of slips are the same, one by one, in both directions."""
    jerks = [event for event in answer.events if event.kind == "taut"]
    settles = [event for event in answer.events if event.kind == "settle"]
    largest = max((event.impulses["normal"] for event in jerks), default=0.0)
    told = [event for event in figures["events"] if event["time"] <= END]
    faint = _faint(jerks, settles, largest)

    def seen(time: float) -> bool:
        return not any(low <= time <= high for low, high in faint)

    def find(time: float, among: list[MotionEvent]) -> None:
        near = min(among, key=lambda event: abs(event.time - time), default=None)
        assert near is not None, ("not described", time)
        assert abs(near.time - time) <= near.error + 1e-14 * time, ("another time", near, time)

    ends = [event for event in answer.events if event.kind in ("roll", "stick", "slip")]
    for event in told:
        if event["kind"] == "jerks-accumulate":
            find(event["time"], settles)
        elif seen(event["time"]):
            find(event["time"], {"jerk": jerks, "slip-ends": ends}[event["kind"]])
    jerked = {event.time for event in jerks}
    for event in ends:
        # A jerk that makes something slip or turns its slip about is one event of the named scene.
        if seen(event.time) and event.time not in jerked:
            own = [one["time"] for one in told if one["kind"] == "slip-ends"]
            away = min((abs(time - event.time) for time in own), default=np.inf)
            assert away <= event.error + 1e-14 * event.time, ("not named", event)
    _require_same_impulses(named, figures["phases"], jerks, settles, largest, seen)
    # At every jerk the string of the named scene is as long as its way: for a moment, where it jerks on.
    assert named.positions is not None
    listed = [event for event in jerks if seen(event.time)]
    if listed:
        samples = named.answer(np.array([event.time for event in listed])).trajectory
        assert samples is not None
        slack = samples["unwound"].sum(axis=1) - (samples["positions"] - named.positions).sum(axis=1)
        assert np.abs(slack).max() <= 1e-13 * np.abs(samples["positions"]).max(), ("slack", float(np.abs(slack).max()))


def _faint(jerks: list[MotionEvent], settles: list[MotionEvent], largest: float) -> list[tuple[float, float]]:
    """Return the times of jerks that are faint, each up to the next jerk or the end of infinitely many."""
    found = []
    for event, after in zip(jerks, [*jerks, None][1:], strict=True):
        if event.impulses["normal"] <= FAINT * largest:
            # What is left of a sequence of jerks lasts some times as long as since the last that is not faint.
            last = max((one.time for one in jerks if one.impulses["normal"] > FAINT * largest), default=0.0)
            until = [one.time for one in (*settles, *([after] if after else [])) if one.time >= event.time]
            reach = max(min(until, default=event.time), event.time + 1e-5 * max(event.time - last, 1.0))
            found.append((event.time * (1 - 1e-14), reach * (1 + 1e-14)))
    return found


def _require_same_impulses(
    named: UnwindingShafts,
    phases: list[Any],
    jerks: list[MotionEvent],
    settles: list[MotionEvent],
    largest: float,
    seen: Callable[[float], bool],
) -> None:
    """Raise unless the jerks within every phase of the named scene have its impulse."""
    for phase in phases:
        start, end = phase["start"], phase["end"]
        if end > END or not (seen(start) and (seen(end) or any(abs(end - one.time) < 1e-9 for one in settles))):
            continue
        within = [event for event in jerks if start * (1 - 1e-14) <= event.time < end * (1 - 1e-14)]
        total = sum(event.impulses["normal"] for event in within)
        if within and any(abs(end - one.time) <= 1e-13 for one in settles):
            # After the jerks that are listed follow infinitely many, each less by the restitution.
            total += within[-1].impulses["normal"] * named.restitution / (1.0 - named.restitution)
        assert abs(total - phase["impulse"]) <= 1e-12 * largest, ("impulse", total, phase)


def rod(named: RodInHole) -> dict[str, Any]:
    """Return the rod with both ends in a round hollow."""
    assert named.angle is not None
    assert named.angular_velocity is not None
    figures = named.hole_radius, named.length, named.angle, named.angular_velocity
    a, length, angle, rate = (exactly(x) for x in figures)
    share, mass = exactly(named.inertia_factor), exactly(named.mass)
    return {
        "numbers": "doubles",
        "gravity": [0, -named.gravity],
        "let": {
            "k": f"sqrt((2*{a} - {length})*(2*{a} + {length}))/2",
            "c": f"cos({angle})",
            "s": f"sin({angle})",
        },
        "bodies": {
            "rod": {
                "mass": named.mass,
                "inertia": f"{share}*{mass}*{length}*{length}",
                "at": ["k*s", "-k*c"],
                "velocity": [f"k*c*({rate})", f"k*s*({rate})"],
                "angle": angle,
                "angular_velocity": rate,
                "places": {"a": [f"-{length}/2", 0], "b": [f"{length}/2", 0]},
            }
        },
        "connections": [
            {"kind": "contact", "name": end, "place": f"rod.{end}", "on": {"at": [0, 0], "radius": f"-{a}"}}
            for end in "ab"
        ],
    }


def random_rod(seed: int) -> RodInHole:
    random = np.random.default_rng(seed)
    radius = decimal(random, 0.5, 2)
    return RodInHole(
        hole_radius=radius,
        length=float(f"{radius * random.uniform(0.3, 1.8):.4g}"),
        mass=decimal(random, 0.5, 3),
        gravity=9.81,
        angle=decimal(random, -2.5, 2.5),
        angular_velocity=decimal(random, -6, 6),
        inertia_factor=decimal(random, 0.05, 0.25),
        hole="cylinder",
    )


def require_same_rod(named: RodInHole) -> SceneSolution:
    """Raise `AssertionError` unless the described rod turns and leaves the wall as the named one."""
    times = np.linspace(0.0, 2.0, 11)
    theirs = named.answer(times)
    assert theirs.trajectory is not None
    answer = solve_scene(read(rod(named)), times, ("trajectory",))
    told = next((event for event in theirs.figures["events"] if event["time"] >= 0.0), None)
    if told is not None and told["time"] == 0.0:
        assert answer.phases is not None
        assert answer.phases[0].states[told["kind"][4]] == "open", told
        return answer
    mine = next((event for event in answer.events if event.kind == "lift-off"), None)
    if told is None or told["time"] > 2.0:
        assert mine is None, mine
    else:
        assert mine is not None, told
        assert abs(mine.time - told["time"]) <= mine.error + 1e-14 * max(1.0, told["time"]), (mine, told)
        assert told["kind"] == f"end-{mine.name}-leaves-wall", (mine, told)
    count = len(theirs.trajectory["angle"])
    angle = column(answer, "rod.angle")
    away = float(np.abs(angle.values[:count] - theirs.trajectory["angle"]).max())
    assert away <= angle.error + 4 * OWN * max(1.0, float(np.abs(angle.values).max())), (away, angle.error)
    return answer


def chain(named: ChainOnWedge) -> dict[str, Any]:
    """Return the chain over the origin with a body at each end, of mass 0 where the end is bare."""
    bodies: dict[str, Any] = {}
    first = exactly(named.position)
    lengths = first, f"({exactly(named.length)} - {first})"
    for i, (name, side) in enumerate((("one", -1), ("two", 1))):
        x, v, slope = lengths[i], exactly((1, -1)[i] * named.velocity), exactly(named.slopes[i])
        bodies[name] = {
            "mass": named.masses[i],
            "at": [f"{side}*{x}*cos({slope})", f"-{x}*sin({slope})"],
            "velocity": [f"{side}*({v})*cos({slope})", f"-({v})*sin({slope})"],
        }
    link = {"kind": "chain", "name": "c", "through": ["one", [0, 0], "two"], "density": named.linear_density}
    gravity = [0, -named.gravity]
    return {"numbers": "doubles", "gravity": gravity, "bodies": bodies, "connections": [link]}


def random_chain(seed: int) -> ChainOnWedge:
    random = np.random.default_rng(seed)
    length = decimal(random, 0.5, 5)
    return ChainOnWedge(
        masses=(_end_mass(random), _end_mass(random)),
        slopes=(decimal(random, 0, 1.55), decimal(random, 0.05, 1.55)),
        gravity=9.81,
        length=length,
        linear_density=decimal(random, 0.05, 3),
        position=float(f"{length * random.uniform(0.05, 0.95):.4g}"),
        velocity=decimal(random, -4, 4) if random.random() < 0.7 else 0.0,
    )


def _end_mass(random: np.random.Generator) -> float:
    return 0.0 if random.random() < 0.3 else decimal(random, 0.05, 3)


def require_same_chain(named: ChainOnWedge, described: dict[str, Any] | None = None) -> SceneSolution:
    """Raise `AssertionError` unless the described chain slides, lifts off and ends as the named one."""
    times = np.linspace(0.0, 2.0, 11)
    theirs = named.answer(times)
    assert theirs.trajectory is not None
    answer = solve_scene(
        read(described or chain(named)), times, ("accelerations", "forces", "energy", "trajectory", "forces-in-time")
    )
    assert answer.accelerations is not None
    assert answer.energy is not None
    told = next((event for event in theirs.figures["events"] if 0.0 <= event["time"] <= 2.0), None)
    if told is None:
        assert answer.ended is None, answer.ended
    else:
        mine = answer.ended
        assert mine is not None, told
        kind, name = {"lift-off": ("lift-off", "c")}.get(told["kind"], ("end-of-chain", f"c.{told['kind'][5]}"))
        assert (mine.kind, mine.name) == (kind, name), (mine, told)
        assert abs(mine.time - told["time"]) <= mine.error + 2.0**-52 * told["time"], (mine, told)
        assert mine.error <= 1e-12, mine
        lifts = theirs.figures["lift_off"]
        assert lifts["occurs"] == (kind == "lift-off")
    start = np.linalg.norm(answer.accelerations["one"].linear)
    assert abs(start - abs(theirs.figures["acceleration"])) <= 4e-15 * max(start, 1.0)
    assert abs(answer.energy.total - theirs.figures["energy"]["total"]) <= 4e-15 * abs(answer.energy.potential)
    found, count = theirs.trajectory, len(theirs.trajectory["position"])
    assert answer.trajectory is not None
    assert len(answer.trajectory.time) == count
    down = [np.array([side * np.cos(s), -np.sin(s)]) for side, s in zip((-1, 1), named.slopes, strict=True)]
    lengths = found["position"], named.length - found["position"]
    for name, way, length, sign in zip(("one", "two"), down, lengths, (1, -1), strict=True):
        place, rate = column(answer, f"{name}.position"), column(answer, f"{name}.velocity")
        away = float(np.linalg.norm(place.values - length[:, None] * way, axis=1).max(initial=0.0))
        assert away <= place.error + 2 * OWN * named.length, (name, away, place.error)
        away = float(np.linalg.norm(rate.values - sign * found["velocity"][:, None] * way, axis=1).max(initial=0.0))
        fastest = float(np.abs(found["velocity"]).max(initial=0.0))
        assert away <= rate.error + 2 * OWN * fastest, (name, "velocity", away, rate.error)
    pull = column(answer, "c.tension")
    away = float(np.abs(pull.values - found["apex_tension"]).max(initial=0.0))
    assert away <= pull.error + 2 * OWN * float(np.abs(pull.values).max(initial=0.0)), ("tension", away, pull.error)
    return answer


JUDGES: dict[str, Callable[[int], SceneSolution]] = {
    "shafts": lambda seed: require_same_shafts(random_shafts(seed)),
    "rough shafts": lambda seed: require_same_shafts(random_shafts(seed, rough=True)),
    "rod": lambda seed: require_same_rod(random_rod(seed)),
    "chain": lambda seed: require_same_chain(random_chain(seed)),
}


def judged_seed(kind: str, seed: int) -> Counter[str]:
    """Return whether the scene of a seed differs, and how many events it has."""
    try:
        events = JUDGES[kind](seed).events
    except Exception as fault:
        sys.stdout.write(f"{kind} {seed} {type(fault).__name__}: {str(fault)[:300]}\n")
        sys.stdout.flush()
        return Counter({"differ": 1})
    return Counter({"with events" if events else "without": 1, "events": len(events)})


def main(count: int, *kinds: str) -> None:
    """Judge random scenes of every kind, or of some, print what differs, and write how many agree."""
    results = json.loads(TARGET.read_text(encoding="utf-8")) if TARGET.exists() else {}
    for kind in kinds or JUDGES:
        with multiprocessing.Pool() as pool:
            each = pool.map(partial(judged_seed, kind), range(count), chunksize=5)
        found = sum(each, Counter[str]())
        sys.stdout.write(f"{kind}: {dict(found)}\n")
        results[kind] = {"seeds": f"0 to {count - 1}", "differ": 0, **found}
        if count >= 1000:
            TARGET.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(int(sys.argv[1]), *sys.argv[2:])
