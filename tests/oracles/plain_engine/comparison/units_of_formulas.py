"""Small systems with formulas: what is driven by the time, relations of places and angles, forces of several pieces."""

from __future__ import annotations

from collections.abc import Callable

from tests.oracles.plain_engine.comparison.drawing import Draw, Json, Unit

SHAKES = ("sin(3*t)/5", "(1 - cos(4*t))/10", "t^2/4", "-sin(2*t)/2")
"""How supports move (m), from zero on."""


def shaken(draw: Draw) -> Unit:
    """Return a pendulum on a support that moves, of a point or a bar."""
    c, s, angle = draw.turned()
    p, along = draw.name("bob"), draw.one(SHAKES)
    support = [f"{draw.x} + {along}", "0"] if draw.chance(0.5) else [f"{draw.x}", along]
    if draw.chance(0.5):
        rod = {"kind": draw.one(("rod", "rod", "spring")), "name": draw.name("rod"), "a": p, "b": support}
        if rod["kind"] == "spring":
            rod |= {"stiffness": draw.one((10, 40)), "rest_length": draw.one((1, 0.5))}
        return Unit({p: {"mass": draw.mass(), "at": draw.at(s, f"-({c})")}}, [rod], [p])
    m = draw.mass()
    bar: Json = {"mass": m, "inertia": f"{m}/12", "at": draw.at(f"({c})/2", f"({s})/2"), "angle": angle}
    bar["places"] = {"top": [-0.5, 0], "end": [0.5, 0]}
    hinge = {"kind": "pin", "name": draw.name("hinge"), "a": f"{p}.top", "b": support}
    return Unit({p: bar}, [hinge], [f"{p}.end"])


def turned_by_time(draw: Draw) -> Unit:
    """Return a crank whose turn, or its rate, is a formula of time, with a slider or a pendulum at its end."""
    crank, p = draw.name("crank"), draw.name("load")
    bodies: Json = {crank: {"mass": 1, "inertia": "1/48", "at": draw.at(0.25, 0)}}
    bodies[crank]["places"] = {"top": [-0.25, 0], "end": [0.25, 0]}
    how = draw.one(
        ({"drive": "sin(2*t)"}, {"drive": "t^2"}, {"drive": "2*t"}, {"rate": "2*cos(t)"}, {"rate": "3*t - 1"})
    )
    connections: list[Json] = [
        {"kind": "pin", "name": draw.name("hinge"), "a": f"{crank}.top", "b": draw.at(0, 0)},
        {"kind": "motor", "name": draw.name("motor"), "a": crank, **how},
        {"kind": draw.one(("rod", "rod", "spring", "damper")), "name": draw.name("link"), "a": p, "b": f"{crank}.end"},
    ]
    connections[2] |= {"spring": {"stiffness": 20}, "damper": {"coefficient": 2}}.get(connections[2]["kind"], {})
    if draw.chance(0.5):
        bodies[p] = {"mass": draw.mass(), "at": draw.at(1.5, 0)}
        on = {"at": draw.at(0, 0)}
        connections.append({"kind": "track", "name": draw.name("rail"), "place": p, "on": on})
    else:
        bodies[p] = {"mass": draw.mass(), "at": draw.at(0.5, -1)}
    return Unit(bodies, connections, [p])


def winched(draw: Draw) -> Unit:
    """Return a load on a rod or string whose length is a formula of time, that swings, or is pushed along a rail."""
    p, by = draw.name("load"), draw.one(("1 + sin(2*t)/5", "1 - t/4", "1 + t^2/2", "sqrt(1 + t)"))
    c, s, _ = draw.direction()
    body: Json = {"mass": draw.mass(), "at": draw.at(s, f"-({c})")}
    if draw.chance(0.4):
        string: Json = {"kind": "string", "name": draw.name("winch"), "through": [p, draw.at(0, 0)], "drive": by}
        if draw.chance(0.6):
            string["restitution"] = draw.one((0, 0.5))
        return Unit({p: body}, [string], [p])
    rod = {"kind": "rod", "name": draw.name("winch"), "a": p, "b": draw.at(0, 0), "drive": by}
    if draw.chance(0.4):
        q = draw.name("bob")
        bodies = {p: {**body, "at": draw.at(1, 0)}, q: {"mass": draw.mass(), "at": draw.at(1, -1)}}
        rail = {"kind": "track", "name": draw.name("rail"), "place": p, "on": {"at": draw.at(0, 0)}}
        return Unit(bodies, [rod, rail, {"kind": "rod", "name": draw.name("hangs"), "a": q, "b": p}], [q])
    return Unit({p: body}, [rod], [p])


def slid(draw: Draw) -> Unit:
    """Return a carriage whose place on its guide is a formula of time, with a pendulum or a mass on a spring."""
    k, p = draw.name("carriage"), draw.name("bob")
    c, s, angle = draw.direction()
    by = draw.one(("sin(2*t)/2", "t^2/2", "(1 - cos(3*t))/4", "t"))
    guide = {"kind": "slider", "name": draw.name("guide"), "a": k, "b": draw.at(0, 0), "drive": by}
    if draw.chance(0.5):
        guide["slope"] = angle
    bodies: Json = {
        k: {"mass": draw.mass(), "at": draw.at(0, 0)},
        p: {"mass": draw.mass(), "at": draw.at(s, f"-({c})")},
    }
    link: Json = {"kind": draw.one(("rod", "spring")), "name": draw.name("link"), "a": p, "b": k}
    if link["kind"] == "spring":
        link["stiffness"] = 20
    return Unit(bodies, [guide, link], [p])


def lifted(draw: Draw) -> Unit:
    """Return a block on a table that time moves, which it may leave and meet again."""
    lift, p = draw.name("lift"), draw.name("block")
    by = draw.one(("sin(5*t)/4", "(cos(6*t) - 1)/5", "t/2", "-t^2"))
    support = [f"{draw.x}", f"{by} - 1"]
    bodies: Json = {
        lift: {"mass": 1, "at": draw.at(0, -1)},
        p: {"mass": draw.mass(), "at": draw.at(0, draw.one((-1, -1, -0.8)))},
    }
    slide = {"kind": "slider", "name": draw.name("guide"), "a": p, "b": draw.at(0, 0), "slope": {"degrees": 90}}
    hold = {"kind": "pin", "name": draw.name("hold"), "a": lift, "b": support}
    law = {"restitution": draw.one((0, 0.5))} if draw.chance(0.5) else {}
    top = {"kind": "contact", "name": draw.name("top"), "place": p, "on": {"at": lift}, **law}
    return Unit(bodies, [slide, hold, top], [p])


def related_wheels(draw: Draw) -> Unit:
    """Return two wheels whose turns a relation ties, with a weight or a torque, or one that drives a rack."""
    a, b, p = draw.name("wheel"), draw.name("gear"), draw.name("rack")
    wheel: Json = {"mass": 1, "inertia": draw.one((0.01, 0.02)), "at": draw.at(0, 0)}
    held: Json = {"kind": "pin", "name": draw.name("axle"), "a": a, "b": draw.at(0, 0)}
    bodies: Json = {a: wheel | {"angular_velocity": draw.one((0, 0, 2))}}
    turning = {"kind": "torque", "name": draw.name("twist"), "body": a, "torque": draw.one((0.1, 0, "sin(3*t)/5"))}
    if draw.chance(0.5):
        bodies[b] = {"mass": 2, "inertia": 0.05, "at": draw.at(1, 0)}
        ratio = draw.one((f"2*{a}.angle + 5*{b}.angle", f"{a}.angle - {b}.angle", f"{a}.angle - 3*{b}.angle"))
        relation = {"kind": "relation", "name": draw.name("mesh"), "of": ratio}
        held_b = {"kind": "pin", "name": draw.name("axle-b"), "a": b, "b": draw.at(1, 0)}
        spring = {"kind": "torsion-spring", "name": draw.name("coil"), "a": b, "stiffness": 0.3, "rest_angle": 0.5}
        return Unit(bodies, [held, held_b, relation, turning, *([spring] if draw.chance(0.5) else [])], [])
    bodies[p] = {"mass": draw.mass(), "at": draw.at(0.1, -0.5)}
    guide = {"kind": "track", "name": draw.name("guide"), "place": p, "on": {"at": draw.at(0.1, 0)}}
    guide["on"] |= {"slope": {"degrees": 90}}
    law = draw.one((f"{p}.y + 1/2", f"{p}.y + 1/2", f"2*{p}.y + 1"))
    equals = draw.one((f"{a}.angle/10", f"{a}.angle/10", f"-{a}.angle/5", f"{a}.angle^3/30 + {a}.angle/10"))
    relation = {"kind": "relation", "name": draw.name("mesh"), "of": law, "equals": equals}
    return Unit(bodies, [held, guide, relation, turning], [p])


def on_a_curve(draw: Draw) -> Unit:
    """Return a bead on a curve that a relation gives, or two on a line whose places one ties; it may move with time."""
    p, q, x = draw.name("bead"), draw.name("other"), f"({draw.name('bead')}.x - {draw.x})"
    of, at = draw.one(
        (
            (f"{p}.y - {x}^2/2", (0.6, "0.18")),
            (f"{p}.y - {x}^3/3 + {x}", (0, "0")),
            (f"{x}^2 + 4*{p}.y^2 - 1", (0.6, "-0.4")),
            (f"{x}*{p}.y + 1/2", (1, "-0.5")),
            (f"{p}.y - sin(3*{x})/5", (0, "0")),
            (f"{p}.y - exp(-{x})/2", (0, "1/2")),
            (f"sqrt({x}^2 + {p}.y^2) - {x}/2 - 1", (0, "-1")),
        )
    )
    bodies: Json = {p: {"mass": draw.mass(), "at": draw.at(*at)}}
    found = Unit(bodies, [{"kind": "relation", "name": draw.name("curve"), "of": of, "equals": 0}], [p])
    if draw.chance(0.3):
        found.connections[0]["equals"] = draw.one(("t^2/8", "sin(t)^2/10"))
    if draw.chance(0.4):
        bodies[q] = {"mass": draw.mass(), "at": draw.at(at[0], f"{at[1]} - 1")}
        found.connections.append({"kind": "rod", "name": draw.name("hangs"), "a": q, "b": p})
    return found


def in_pieces(draw: Draw) -> Unit:
    """Return a point, free or on a rod, under a force of several pieces, and a floor in some cases."""
    p, c, s = draw.name("p"), *draw.direction()[:2]
    body: Json = {"mass": draw.mass(), "at": draw.at(s, f"-({c})")}
    along, up = draw.one(
        (
            ("min(t, 1/8)", "0"),
            ("if(t - 1/4, 3, 0)", "0"),
            (f"-3*max(0, x - {draw.x})", "0"),
            ("0", "-10*min(0, y + 1)"),
            ("-abs(vx)*vx/3", "-abs(vy)*vy/3"),
            (f"sign(x - {draw.x} - 1/5)", "0"),
            ("if(vy, 1, -1)", "0"),
        )
    )
    force = {"kind": "force", "name": draw.name("push"), "place": p, "force": [along, up]}
    found = Unit({p: body}, [force], [p])
    if draw.chance(0.6):
        found.connections.append({"kind": "rod", "name": draw.name("rod"), "a": p, "b": draw.at(0, 0)})
    else:
        body["velocity"] = [draw.speed(), draw.speed()]
        floor = {"kind": "contact", "name": draw.name("floor"), "place": p, "on": {"at": draw.at(0, -1.5)}}
        found.connections.append(floor | draw.rough())
    return found


def strap(draw: Draw) -> Unit:
    """Return a stone on a strap that pulls where it is longer than at rest, or against a fence that pushes back."""
    p = draw.name("stone")
    body: Json = {"mass": draw.mass(), "at": draw.at(0.3, -0.4), "velocity": [draw.speed(), draw.speed()]}
    law, rest = draw.one(
        (("max(0, 30*stretch)", 0.6), ("if(stretch, 20*stretch, 5*stretch)", 0.5), ("min(4, 20*stretch)", 0.2))
    )
    pull = {"kind": "spring", "name": draw.name("strap"), "a": p, "b": draw.at(0, 0), "rest_length": rest, "law": law}
    return Unit({p: body}, [pull], [p])


def shaken_in_space(draw: Draw) -> Unit:
    """Return a point of space on a rod, or a body on a ball joint, whose support moves."""
    p, by = draw.name("bob"), draw.one(SHAKES)
    support = draw.one(([f"{draw.x} + {by}", "0", "0"], [f"{draw.x}", by, "0"], [f"{draw.x}", by, by]))
    c, s, _ = draw.direction()
    if draw.chance(0.5):
        body: Json = {"mass": draw.mass(), "at": [f"{draw.x} + ({s})", "0", f"-({c})"]}
        return Unit({p: body}, [{"kind": "rod", "name": draw.name("rod"), "a": p, "b": support}], [p])
    body = {"mass": 1, "moments": ["1/10", "1/5", "3/20"], "at": [f"{draw.x}", 0, "-0.5"], "places": {"p": [0, 0, 0.5]}}
    return Unit({p: body}, [{"kind": "ball-joint", "name": draw.name("joint"), "a": f"{p}.p", "b": support}], [p])


def on_a_surface(draw: Draw) -> Unit:
    """Return a point of space on a surface that a relation gives, or on a rod that grows with time."""
    p, x = draw.name("bead"), f"({draw.name('bead')}.x - {draw.x})"
    of, z = draw.one(
        (
            (f"{p}.z - ({x}^2 + {p}.y^2)/2", "0.18"),
            (f"{p}.z - {x}*{p}.y", "0"),
            (f"{x}^2 + {p}.y^2/4 + {p}.z^2 - 1", "-0.8"),
        )
    )
    body: Json = {"mass": draw.mass(), "at": [f"{draw.x} + 0.6", 0, z]}
    if draw.chance(0.3):
        by = draw.one(("1 + t/4", "1 + sin(2*t)/5"))
        winch = {"kind": "rod", "name": draw.name("winch"), "a": p, "b": [f"{draw.x}", 0, 0], "drive": by}
        return Unit({p: body | {"at": [f"{draw.x} + 0.6", 0, "-0.8"]}}, [winch], [p])
    if draw.chance(0.25):
        helix = [(f"{p}.x - {draw.x}", f"cos(3*{p}.z)"), (f"{p}.y", f"sin(3*{p}.z)")]
        turns = [
            {"kind": "relation", "name": draw.name(f"helix{k}"), "of": of, "equals": to}
            for k, (of, to) in enumerate(helix)
        ]
        return Unit({p: body | {"at": [f"{draw.x} + 1", 0, 0]}}, turns, [p])
    relation = {"kind": "relation", "name": draw.name("surface"), "of": of, "equals": 0}
    if draw.chance(0.25):
        relation["equals"] = "t^2/8"
    return Unit({p: body}, [relation], [p])


PLANE: tuple[Callable[[Draw], Unit], ...] = (
    shaken,
    turned_by_time,
    winched,
    slid,
    lifted,
    related_wheels,
    on_a_curve,
    in_pieces,
    strap,
)
SPACE: tuple[Callable[[Draw], Unit], ...] = (shaken_in_space, on_a_surface)
