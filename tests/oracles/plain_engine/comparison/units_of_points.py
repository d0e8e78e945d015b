"""Small systems of one or two points of the plane."""

from __future__ import annotations

from tests.oracles.plain_engine.comparison.drawing import Draw, Json, Unit


def pendulum(draw: Draw) -> Unit:
    """Return a point on a rod or a string, in half of all cases against a wall or a floor."""
    c, s, _ = draw.turned()
    p, length, v = draw.name("p"), draw.one((0.5, 1, 1, 2)), draw.speed()
    # The angle is that with the downward vertical; at 90 degrees it starts level.
    x, y = f"{length}*({s})", f"-{length}*({c})"
    body: Json = {"mass": draw.mass(), "at": draw.at(x, y)}
    if v or draw.chance(0.3):
        body["velocity"] = [f"{v}*({c})", f"{v}*({s})"]
    kind = draw.one(("rod", "rod", "string"))
    holds: Json = {"kind": kind, "name": draw.name("cord")}
    holds |= {"a": p, "b": draw.at(0, 0)} if kind == "rod" else {"through": [p, draw.at(0, 0)]}
    if kind == "string" and draw.chance(0.5):
        holds["restitution"] = draw.one((0, 0.5))
    found = Unit({p: body}, [holds], [p])
    if draw.chance(0.4):
        # A wall below the support: from the other side it would be passed at the start.
        wall = {"at": draw.at(0, 0), "slope": {"degrees": 90 if s.startswith("-") else -90}}
        if s not in ("0", "-(0)"):
            contact = {"kind": "contact", "name": draw.name("wall"), "place": p, "on": wall, **draw.rough()}
            found.connections.append(contact)
    return found


def loop(draw: Draw) -> Unit:
    """Return a point in a loop, or on a hump that it leaves."""
    inside = draw.chance(0.5)
    p = draw.name("stone")
    if inside:
        v = draw.one((1, 2, 3, 4, 5, 6, "sqrt(35)", 7))
        body: Json = {"mass": draw.mass(), "at": draw.at(0, -1), "velocity": [v, 0]}
    else:
        c, s = draw.one((("0.8", "0.6"), ("0.96", "0.28"), ("1", "0")))
        v = draw.one((0, 0, 0.5, 1))
        body = {"mass": draw.mass(), "at": draw.at(s, c), "velocity": [f"{v}*({c})", f"-{v}*({s})"]}
    on = {"at": draw.at(0, 0), "radius": -1 if inside else 1}
    return Unit({p: body}, [{"kind": "contact", "name": draw.name("loop"), "place": p, "on": on, **draw.rough()}], [p])


def pair(draw: Draw) -> Unit:
    """Return two points that attract one another, by gravitation, a spring or a charge."""
    a, b = draw.name("a"), draw.name("b")
    v = draw.one((0, 0.5, 1))
    bodies: Json = {
        a: {"mass": draw.mass(), "at": draw.at(-0.5, 1), "velocity": [0, v]},
        b: {"mass": draw.mass(), "at": draw.at(0.5, 1), "velocity": [0, f"-{v}"]},
    }
    law: Json = draw.one(
        (
            {"kind": "gravitation", "constant": 1},
            {"kind": "inverse-square", "strength": draw.one((1, -1))},
            {"kind": "spring", "stiffness": 10},
            {"kind": "spring", "stiffness": 10, "rest_length": 0},
            {"kind": "rod"},
            {"kind": "damper", "coefficient": 2},
        )
    )
    found = Unit(bodies, [{**law, "name": draw.name("law"), "a": a, "b": b}], [a])
    if draw.chance(0.4):
        for body in (a, b):
            floor = {"kind": "contact", "name": f"floor-{body}", "place": body, "on": {"at": draw.at(0, 0)}}
            found.connections.append(floor)
    return found


def slack(draw: Draw) -> Unit:
    """Return a stone on a string that is longer than its way, and becomes taut; in some cases over a peg."""
    p = draw.name("stone")
    body: Json = {"mass": draw.mass(), "at": draw.at(0.3, -0.4), "velocity": [draw.speed(), 0]}
    through = [p, draw.at(0, 0)]
    cord: Json = {"kind": "string", "name": draw.name("cord"), "through": through, "length": draw.one((0.5, 0.8, 1))}
    if cord["length"] == 0.5 or draw.chance(0.5):
        # It is taut at the start: what a velocity that jerks it does is described with a restitution only.
        cord["restitution"] = draw.one((0, 0.5))
    return Unit({p: body}, [cord], [p])
