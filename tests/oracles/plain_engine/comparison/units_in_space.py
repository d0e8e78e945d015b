"""Small systems of space."""

from __future__ import annotations

from collections.abc import Callable

from tests.oracles.plain_engine.comparison.drawing import Draw, Json, Unit

OBLIQUE = ([0.6, 0.8, 0], [0.6, 0, 0.8], [1, 0, 0], [0, 0, 1], [1, 1, 1], [0.36, 0.48, 0.8])
"""Directions, some of which are no axes."""
AXES = (
    None,
    None,
    [[0.8, 0.6, 0], [-0.6, 0.8, 0], [0, 0, 1]],
    [[0.8, 0, -0.6], [0, 1, 0], [0.6, 0, 0.8]],
    [[0, 1, 0], [-1, 0, 0], [0, 0, 1]],
)


def _at(draw: Draw, x: object, y: object, z: object) -> list[str]:
    return [f"{draw.x} + ({x})", f"{y}", f"{z}"]


def _rigid(draw: Draw, at: list[str]) -> Json:
    m = draw.mass()
    moments = draw.one((["1/10", "1/10", "1/10"], ["1/10", "2/10", "3/20"], ["1/12", "1/12", "1/100"]))
    body: Json = {"mass": m, "moments": [f"{m}*{x}" for x in moments], "at": at}
    axes = draw.one(AXES)
    if axes is not None:
        body["axes"] = axes
    return body


def spherical_pendulum(draw: Draw) -> Unit:
    """Return a point on a rod or a sphere."""
    c, s, _ = draw.turned()
    p, v = draw.name("p"), draw.speed()
    body: Json = {
        "mass": draw.mass(),
        "at": _at(draw, s, 0, f"-({c})"),
        "velocity": [f"{v}*({c})", draw.speed(), f"{v}*({s})"],
    }
    if draw.chance(0.5):
        holds: Json = {"kind": "rod", "name": draw.name("rod"), "a": p, "b": _at(draw, 0, 0, 0)}
    else:
        holds = {"kind": "track", "name": draw.name("bowl"), "place": p, "on": {"at": _at(draw, 0, 0, 0), "radius": 1}}
    return Unit({p: body}, [holds], [p])


def on_a_line(draw: Draw) -> Unit:
    """Return a point, or a place of a body, on an oblique line."""
    d = draw.one(OBLIQUE)
    p = draw.name("bead")
    if draw.chance(0.5):
        body: Json = {"mass": draw.mass(), "at": _at(draw, 0, 0, 0)}
        on = {"at": _at(draw, 0, 0, 0), "direction": d}
        return Unit({p: body}, [{"kind": "track", "name": draw.name("line"), "place": p, "on": on}], [p])
    body = _rigid(draw, _at(draw, 0, 0, 0))
    body.pop("axes", None)
    body["places"] = {"p": [0.5, 0, 0]}
    on = {"at": _at(draw, 0.5, 0, 0), "direction": d}
    return Unit({p: body}, [{"kind": "track", "name": draw.name("line"), "place": f"{p}.p", "on": on}], [p])


def sliding_block(draw: Draw) -> Unit:
    """Return a point on a rough or smooth plane, level or inclined."""
    p = draw.name("block")
    normal = draw.one(([0, 0, 1], [0, 0, 1], [0.6, 0, 0.8], [0, -0.6, 0.8]))
    n = [float(x) for x in normal]
    v = [draw.speed(), draw.speed()]
    if n == [0, 0, 1]:
        velocity: list[float] = [v[0], v[1], 0]
    elif n[0]:
        velocity = [0.8 * v[0], v[1], -0.6 * v[0]]
    else:
        velocity = [v[0], 0.8 * v[1], 0.6 * v[1]]
    body: Json = {"mass": draw.mass(), "at": _at(draw, 0, 0, 0), "velocity": [round(x, 6) for x in velocity]}
    on = {"at": _at(draw, 0, 0, 0), "normal": normal}
    contact = {"kind": "contact", "name": draw.name("plane"), "place": p, "on": on, **draw.rough()}
    return Unit({p: body}, [contact], [p])


def rolling_ball(draw: Draw) -> Unit:
    """Return a ball that slips and rolls on a plane, or is dropped on it with spin."""
    p, r = draw.name("ball"), 0.1
    m = draw.mass()
    height = draw.one((0, 0, 0, 0.3))
    body: Json = {"mass": m, "moments": [f"2/5*{m}*{r}^2"] * 3, "radius": r, "at": _at(draw, 0, 0, r + height)}
    body["velocity"] = [draw.speed(), draw.speed(), 0]
    if draw.chance(0.3) and not height:
        on = {"at": _at(draw, 0, 0, 0), "normal": [0, 0, 1]}
        return Unit({p: body}, [{"kind": "rolling", "name": draw.name("roll"), "place": p, "on": on}], [p])
    body["angular_velocity"] = [draw.one((0, 0, 5)), draw.one((0, -10)), draw.one((0, 3))]
    on = {"at": _at(draw, 0, 0, 0), "normal": [0, 0, 1]}
    return Unit({p: body}, [{"kind": "contact", "name": draw.name("floor"), "place": p, "on": on, **draw.rough()}], [p])


def hinged(draw: Draw) -> Unit:
    """Return a body on a hinge whose axis is oblique, or on a ball joint."""
    p = draw.name("body")
    body = _rigid(draw, _at(draw, 0, 0, 0))
    body["places"] = {"p": [0, 0, 0.5]}
    axes = body.get("axes", [[1, 0, 0], [0, 1, 0], [0, 0, 1]])
    where = [0.5 * axes[2][k] for k in range(3)]
    joint: Json = {
        "kind": draw.one(("pin", "ball-joint")),
        "name": draw.name("hinge"),
        "a": f"{p}.p",
        "b": _at(draw, *where),
    }
    if joint["kind"] == "pin" and draw.chance(0.7):
        joint["axis"] = draw.one(OBLIQUE)
    elif draw.chance(0.5):
        body["angular_velocity"] = [draw.one((0, 1)), draw.one((0, 2)), draw.one((0, 5, 20))]
    return Unit({p: body}, [joint], [p])


def thrown(draw: Draw) -> Unit:
    """Return a body that is thrown, with or without a floor for one of its ends."""
    p = draw.name("body")
    body = _rigid(draw, _at(draw, 0, 0, 1))
    body |= {"velocity": [draw.speed(), 0, draw.speed()], "places": {"l": [-0.4, 0, 0], "r": [0.4, 0, 0]}}
    body["angular_velocity"] = [draw.one((0, 1)), draw.one((0, 2)), draw.one((0, 0, 3))]
    found = Unit({p: body}, [], [p])
    if draw.chance(0.5):
        law = {"restitution": draw.one((0, 0.5, 1))} if draw.chance(0.5) else {}
        for end in "lr":
            on = {"at": _at(draw, 0, 0, 0), "normal": [0, 0, 1]}
            found.connections.append(
                {"kind": "contact", "name": draw.name(f"floor-{end}"), "place": f"{p}.{end}", "on": on, **law}
            )
    return found


def table(draw: Draw) -> Unit:
    """Return a table on four legs that rests or slides."""
    p = draw.name("table")
    legs = {"f0": [0.5, 0.3, -0.5], "f1": [-0.5, 0.3, -0.5], "f2": [-0.5, -0.3, -0.5], "f3": [0.5, -0.3, -0.5]}
    body: Json = {"mass": 10, "moments": [1, 1.5, 2], "at": _at(draw, 0, 0, 0.5), "places": legs}
    body["velocity"] = [draw.one((0, 0, 1)), draw.one((0, 0.5)), 0]
    body["angular_velocity"] = [0, 0, 0]
    law: Json = {"friction": draw.one((0.1, 0.3))} if draw.chance(0.6) else {}
    contacts = [
        {
            "kind": "contact",
            "name": draw.name(f"on-{leg}"),
            "place": f"{p}.{leg}",
            "on": {"at": [0, 0, 0], "normal": [0, 0, 1]},
            **law,
        }
        for leg in legs
    ]
    return Unit({p: body}, contacts, [p])


def balls(draw: Draw) -> Unit:
    """Return two balls that fly at one another."""
    a, b = draw.name("a"), draw.name("b")
    bodies: Json = {
        a: {"mass": draw.mass(), "radius": 0.1, "at": _at(draw, -0.5, 0, 1), "velocity": [1, 0, 0]},
        b: {
            "mass": draw.mass(),
            "radius": 0.1,
            "at": _at(draw, 0.5, draw.one((0, 0.1, 0.12)), 1),
            "velocity": [-1, 0, 0],
        },
    }
    contact = {"kind": "contact", "name": draw.name("pair"), "a": a, "b": b, "restitution": draw.one((0, 0.5, 1))}
    return Unit(bodies, [contact], [a])


def slider(draw: Draw) -> Unit:
    """Return a body that slides along an oblique line without turning, with a spring or a pendulum on it."""
    k, p = draw.name("slide"), draw.name("bob")
    d = draw.one(OBLIQUE)
    body = _rigid(draw, _at(draw, 0, 0, 0)) if draw.chance(0.5) else {"mass": draw.mass(), "at": _at(draw, 0, 0, 0)}
    bob: Json = {"mass": draw.mass(), "at": _at(draw, 0, 0, -1), "velocity": [0, draw.speed(), 0]}
    connections: list[Json] = [
        {"kind": "slider", "name": draw.name("rail"), "a": k, "b": _at(draw, 0, 0, 0), "direction": d},
        {"kind": draw.one(("rod", "spring")), "name": draw.name("link"), "a": p, "b": k},
    ]
    if connections[1]["kind"] == "spring":
        connections[1]["stiffness"] = 20
        bob.pop("velocity")
    elif d in ([0, 0, 1],):
        bob.pop("velocity")
    return Unit({k: body, p: bob}, connections, [p])


UNITS: tuple[Callable[[Draw], Unit], ...] = (
    spherical_pendulum,
    on_a_line,
    sliding_block,
    rolling_ball,
    hinged,
    thrown,
    table,
    balls,
    slider,
)
