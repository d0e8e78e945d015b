"""Small systems of the plane and of space with other kinds of connections: welds, parabolas, pulleys, rims, drives."""

from __future__ import annotations

from collections.abc import Callable

from tests.oracles.plain_engine.comparison.drawing import Draw, Json, Unit


def rims(draw: Draw) -> Unit:
    """Return two discs on a smooth floor or in the air, one of which runs at the other."""
    a, b = draw.name("a"), draw.name("b")
    bodies: Json = {}
    height = draw.one((0, 0.02, 0.12))
    for name, x, y, v in ((a, -0.3, 0.1, 2), (b, 0.1, 0.1 + height, 0)):
        bodies[name] = {"mass": draw.mass(), "inertia": 0.005, "radius": 0.1, "at": draw.at(x, y), "velocity": [v, 0]}
        bodies[name]["angular_velocity"] = draw.one((0, 0, 5))
    found = Unit(bodies, [{"kind": "contact", "name": draw.name("pair"), "a": a, "b": b, **draw.rough()}], [a])
    if height == 0 and draw.chance(0.5):
        for name in bodies:
            floor = {"kind": "contact", "name": f"floor-{name}", "place": name, "on": {"at": draw.at(0, 0)}}
            found.connections.append(floor)
    return found


def round_on_round(draw: Draw) -> Unit:
    """Return a disc that rolls on a circle or inside it."""
    c, s, _ = draw.one((("0.8", "0.6", ""), ("0.6", "0.8", ""), ("1", "0", ""), ("sqrt(3)/2", "1/2", "")))
    p, inside = draw.name("disc"), draw.chance(0.6)
    reach = "0.8" if inside else "1.2"
    sign = "-" if inside else ""
    body: Json = {
        "mass": draw.mass(),
        "inertia": 0.02,
        "radius": 0.2,
        "at": draw.at(f"{reach}*({s})", f"{sign}{reach}*({c})"),
    }
    on = {"at": draw.at(0, 0), "radius": -1 if inside else 1}
    if draw.chance(0.5):
        return Unit({p: body}, [{"kind": "rolling", "name": draw.name("roll"), "place": p, "on": on}], [p])
    body |= {"velocity": [0, 0], "angular_velocity": draw.one((0, 0, 4))}
    return Unit({p: body}, [{"kind": "contact", "name": draw.name("face"), "place": p, "on": on, **draw.rough()}], [p])


def welded(draw: Draw) -> Unit:
    """Return a rod on a hinge with a body welded to its end."""
    c, s, angle = draw.direction()
    rod, lump = draw.name("rod"), draw.name("lump")
    m = draw.mass()
    bodies: Json = {
        rod: {"mass": m, "inertia": f"{m}/12", "at": draw.at(f"({c})/2", f"({s})/2"), "angle": angle},
        lump: {"mass": draw.mass(), "at": draw.at(c, s)},
    }
    bodies[rod]["places"] = {"top": [-0.5, 0], "end": [0.5, 0]}
    if draw.chance(0.5):
        bodies[lump] |= {"inertia": 0.01, "angle": draw.one((0, angle, "pi/3"))}
    weld = {"kind": "weld", "name": draw.name("weld"), "a": lump, "b": f"{rod}.end"}
    hinge = {"kind": "pin", "name": draw.name("hinge"), "a": f"{rod}.top", "b": draw.at(0, 0)}
    return Unit(bodies, [hinge, weld], [lump])


def on_a_parabola(draw: Draw) -> Unit:
    """Return a bead on a parabola."""
    p, x = draw.name("bead"), draw.one((0, 0.3, 0.6, -1))
    body: Json = {"mass": draw.mass(), "at": draw.at(x, f"({x})^2/2")}
    if x == 0:
        body["velocity"] = [draw.one((0, 1, 2)), 0]
    on = {"at": draw.at(0, 0), "curvature": 1}
    return Unit({p: body}, [{"kind": "track", "name": draw.name("wire"), "place": p, "on": on}], [p])


def tackle(draw: Draw) -> Unit:
    """Return a load on a loop of a string, with a weight at its end."""
    load, weight = draw.name("load"), draw.name("weight")
    bodies: Json = {
        load: {"mass": draw.mass(), "at": draw.at(0, -1)},
        weight: {"mass": draw.mass(), "at": draw.at(0.4, -0.8)},
    }
    through = [draw.at(0, 0), load, draw.at(0.2, 0), draw.at(0.4, 0), weight]
    if draw.chance(0.5):
        through = [draw.at(0, 0), load, draw.at(0, 0), draw.at(0.4, 0), weight]
    return Unit(bodies, [{"kind": "string", "name": draw.name("rope"), "through": through}], [load])


def driven(draw: Draw) -> Unit:
    """Return a rod that a motor turns, with a pendulum at its end."""
    rod, bob, rate = draw.name("rod"), draw.name("bob"), draw.one((1, 2, -3))
    bodies: Json = {
        rod: {"mass": 1, "inertia": "1/12", "at": draw.at(0.5, 0), "places": {"top": [-0.5, 0], "end": [0.5, 0]}},
        bob: {"mass": draw.mass(), "at": draw.at(1, -1)},
    }
    connections: list[Json] = [
        {"kind": "pin", "name": draw.name("hinge"), "a": f"{rod}.top", "b": draw.at(0, 0)},
        {"kind": "motor", "name": draw.name("motor"), "a": rod, "rate": rate},
        {"kind": draw.one(("rod", "spring")), "name": draw.name("link"), "a": bob, "b": f"{rod}.end"},
    ]
    if connections[2]["kind"] == "spring":
        connections[2]["stiffness"] = 20
    return Unit(bodies, connections, [bob])


def pushed(draw: Draw) -> Unit:
    """Return a block that a constant force pushes along a rough floor, or tips."""
    p, m = draw.name("crate"), draw.mass()
    half = draw.one((0.2, 0.5))
    body: Json = {"mass": m, "inertia": f"{m}/6", "at": draw.at(0, 0.5), "velocity": [0, 0], "angular_velocity": 0}
    body["places"] = {"l": [-half, -0.5], "r": [half, -0.5], "top": [0, 0.5], "side": [-half, 0]}
    law: Json = {"friction": draw.one((0.1, 0.3, 0.5, 0.75))}
    contacts = [
        {"kind": "contact", "name": draw.name(f"on-{k}"), "place": f"{p}.{k}", "on": {"at": draw.at(0, 0)}, **law}
        for k in "lr"
    ]
    force = {"kind": "force", "name": draw.name("push"), "place": f"{p}.{draw.one(('top', 'side'))}"}
    push = draw.one((1, 3, 5, 10))
    return Unit({p: body}, [*contacts, {**force, "force": [f"{m}*{push}", 0]}], [f"{p}.top"])


def plank(draw: Draw) -> Unit:
    """Return a block that slides on a plank, which slides on the floor."""
    a, b = draw.name("plank"), draw.name("block")
    bodies: Json = {
        a: {"mass": draw.mass(), "at": draw.at(0, 0), "velocity": [0, 0]},
        b: {"mass": draw.mass(), "at": draw.at(0, 0), "velocity": [draw.one((0, 1, 2)), 0]},
    }
    connections = [
        {"kind": "contact", "name": draw.name("floor"), "place": a, "on": {"at": draw.at(0, 0)}, **draw.rough()},
        {
            "kind": "contact",
            "name": draw.name("top"),
            "place": b,
            "on": {"at": a},
            "friction": draw.one((0.1, 0.3, 0.5)),
        },
    ]
    return Unit(bodies, connections, [b])


def bridge(draw: Draw) -> Unit:
    """Return four equal links between two supports, or a body that is held twice."""
    if draw.chance(0.5):
        p, m = draw.name("beam"), draw.mass()
        body: Json = {"mass": m, "inertia": f"{m}/3", "at": draw.at(0, 0), "places": {"l": [-1, 0], "r": [1, 0]}}
        rods = [
            {"kind": "rod", "name": draw.name(f"rod-{k}"), "a": f"{p}.{k}", "b": draw.at(x, 1)}
            for k, x in (("l", -1), ("r", 1))
        ]
        if draw.chance(0.5):
            body["places"]["m"] = [0, 0]
            rods.append({"kind": "rod", "name": draw.name("rod-m"), "a": f"{p}.m", "b": draw.at(0, 1)})
        return Unit({p: body}, rods, [p])
    names = [draw.name(f"k{i}") for i in range(3)]
    bodies: Json = {
        names[0]: {"mass": 1, "at": draw.at(0.6, -0.8)},
        names[1]: {"mass": draw.mass(), "at": draw.at(1.6, -0.8)},
        names[2]: {"mass": 1, "at": draw.at(2.6, -0.8)},
    }
    ends = [draw.at(0, 0), *names[:2], draw.at(2, 0)]
    bodies.pop(names[2])
    bodies[names[1]]["at"] = draw.at(1.4, -0.8)
    rods = [{"kind": "rod", "name": draw.name(f"r{i}"), "a": ends[i], "b": ends[i + 1]} for i in range(3)]
    return Unit(bodies, rods, [names[0]])


def ball_in_a_round(draw: Draw) -> Unit:
    """Return a ball of space that rolls in a hollow, on a cylinder's inside, or on a turntable."""
    p, m, r = draw.name("ball"), draw.mass(), 0.1
    body: Json = {"mass": m, "moments": [f"2/5*{m}*{r}^2"] * 3, "radius": r}
    where = [f"{draw.x}", 0, 0]
    choice = draw.one(("sphere", "cylinder", "turntable"))
    if choice == "turntable":
        body |= {"at": [f"{draw.x} + 0.5", 0, r], "velocity": [0, draw.one((0, 0.5)), 0]}
        on: Json = {"at": where, "normal": [0, 0, 1], "rate": draw.one((0, 2))}
    else:
        body |= {"at": [f"{draw.x} + 0.9*0.6", 0, "-0.9*0.8"], "velocity": [0, draw.one((0, 1)), 0]}
        on = {"at": where, "radius": -1} if choice == "sphere" else {"at": where, "radius": -1, "direction": [0, 1, 0]}
    return Unit({p: body}, [{"kind": "rolling", "name": draw.name("roll"), "place": p, "on": on}], [p])


def twisted(draw: Draw) -> Unit:
    """Return a body of space under a constant torque, free or welded to a point."""
    p = draw.name("body")
    body: Json = {
        "mass": 1,
        "moments": [0.1, 0.2, 0.15],
        "at": [f"{draw.x}", 0, 0],
        "angular_velocity": [0, 0, draw.one((0, 2))],
    }
    torque = {
        "kind": "torque",
        "name": draw.name("twist"),
        "body": p,
        "torque": draw.one(([0, 0, 0.1], [0.1, 0, 0.2], [0, "sin(3*t)/5", 0])),
    }
    return Unit({p: body}, [torque], [p])


def strung(draw: Draw) -> Unit:
    """Return two points of space on one string over a ring, or on a rod and a string."""
    a, b = draw.name("a"), draw.name("b")
    bodies: Json = {
        a: {"mass": draw.mass(), "at": [f"{draw.x} + 0.6", 0, "-0.8"], "velocity": [0, draw.one((0, 1)), 0]},
        b: {"mass": draw.mass(), "at": [f"{draw.x}", 0, "-1"], "velocity": [0, 0, 0]},
    }
    if draw.chance(0.5):
        through = [a, [f"{draw.x}", 0, 0], b]
        return Unit(bodies, [{"kind": "string", "name": draw.name("cord"), "through": through}], [a])
    cords = [{"kind": "string", "name": f"cord-{k}", "through": [k, [f"{draw.x}", 0, 0]]} for k in (a, b)]
    return Unit(bodies, cords, [a])


def chain(draw: Draw) -> Unit:
    """Return a heavy chain over a peg, with or without bodies at its ends, of which one may lie on a face.

    It is tied to nothing: beside contacts and jerks a chain is refused, as it is documented.
    """
    a, b = draw.name("front"), draw.name("back")
    c, s, _ = draw.one((("1", "0", ""), ("0.8", "0.6", ""), ("sqrt(1/2)", "sqrt(1/2)", ""), ("0", "1", "")))
    reach = draw.one((0.5, 1, 1))
    bodies: Json = {
        a: {"mass": draw.one((0, 0, 1, 2)), "at": draw.at(0, draw.one((-1, -0.5)))},
        b: {"mass": draw.one((0, 0, 1, 2)), "at": draw.at(f"-{reach}*({c})", f"-{reach}*({s})")},
    }
    through = [a, draw.at(0, 0), b]
    heavy = {"kind": "chain", "name": draw.name("chain"), "through": through, "density": draw.one((0.8, 1, 2))}
    return Unit(bodies, [heavy])


def in_a_row(draw: Draw) -> Unit:
    """Return two or three equal beads on one wire that meet one after another, or in an order that is given."""
    count, e = draw.one((2, 3, 3)), draw.one((0, 0.5, 1, 1))
    names = [draw.name(f"row{i}") for i in range(count)]
    near = 0.4 if draw.chance(0.5) else 0.2
    m, v = draw.mass(), draw.one((1, 2, 3))
    found = Unit(ends=[names[-1]])
    for i, name in enumerate(names):
        where = draw.at(near * i - (near if i == 0 else 0), 0)
        found.bodies[name] = {"mass": m, "radius": 0.1, "inertia": 0.01, "at": where, "velocity": [0 if i else v, 0]}
        found.bodies[name]["angular_velocity"] = 0
        slide = {"kind": "slider", "name": f"on-{name}", "a": name, "b": draw.at(0, 0), "slope": 0}
        found.connections.append(slide)
    for i in range(count - 1):
        meets = {"kind": "contact", "name": draw.name(f"pair{i}"), "a": names[i], "b": names[i + 1], "restitution": e}
        found.connections.append(meets | ({"order": i + 1} if near == 0.2 else {}))
    return found


def on_two_supports(draw: Draw) -> Unit:
    """Return a bar that falls level on two edges or on one, or leans over an edge."""
    p, m = draw.name("bar"), draw.mass()
    body: Json = {"mass": m, "inertia": f"{m}/3", "at": draw.at(0, draw.one((0.2, 0.05))), "velocity": [0, 0]}
    body |= {"angular_velocity": 0, "places": {"l": [-1, 0], "r": [1, 0]}}
    law = draw.rough()
    ends = draw.one(("lr", "lr", "l"))
    contacts = [
        {"kind": "contact", "name": draw.name(f"on-{end}"), "place": f"{p}.{end}", "on": {"at": draw.at(0, 0)}, **law}
        for end in ends
    ]
    return Unit({p: body}, contacts, [f"{p}.r"])


def scissors(draw: Draw) -> Unit:
    """Return a square of four rods between points, with one rod more than holds it, that swings from a corner."""
    names = [draw.name(f"c{i}") for i in range(3)]
    side = "sqrt(1/2)"
    spots = (draw.at(f"-({side})", f"-({side})"), draw.at(0, f"-2*({side})"), draw.at(side, f"-({side})"))
    bodies: Json = {name: {"mass": 1 if i != 1 else draw.mass(), "at": spots[i]} for i, name in enumerate(names)}
    v = draw.speed()
    bodies[names[1]]["velocity"] = [v, 0]
    pairs = [(names[0], draw.at(0, 0)), (names[2], draw.at(0, 0)), (names[1], names[0]), (names[1], names[2])]
    if draw.chance(0.7):
        pairs.append((names[0], names[2]))
    if draw.chance(0.4):
        pairs.append((names[1], draw.at(0, 0)))
    rods = [{"kind": "rod", "name": draw.name(f"side{i}"), "a": a, "b": b} for i, (a, b) in enumerate(pairs)]
    return Unit(bodies, rods, [names[1]])


def pushed_in_space(draw: Draw) -> Unit:
    """Return a body of space with a lump welded to it, or a block on a plane, that a constant force pushes."""
    p, lump, m = draw.name("body"), draw.name("lump"), draw.mass()
    body: Json = {"mass": m, "moments": [f"{m}/10", f"{m}/5", f"3*{m}/20"], "at": [f"{draw.x}", 0, 0]}
    body |= {"places": {"end": [0.5, 0, 0]}, "angular_velocity": [0, 0, draw.one((0, 0, 2))], "velocity": [0, 0, 0]}
    push = draw.one(([1, 0, 0], [0, 3, 0], [0.6, 0.8, 0]))
    force = {"kind": "force", "name": draw.name("push"), "place": f"{p}.end", "force": push}
    if draw.chance(0.5):
        heavy = {lump: {"mass": draw.mass(), "at": [f"{draw.x} + 0.5", 0, 0]}}
        weld = {"kind": "weld", "name": draw.name("weld"), "a": lump, "b": f"{p}.end"}
        return Unit({p: body} | heavy, [weld, force], [p])
    on = {"at": [f"{draw.x}", 0, 0], "normal": [0, 0, 1]}
    floor = {"kind": "contact", "name": draw.name("floor"), "place": p, "on": on, **draw.rough()}
    point = {"mass": m, "at": [f"{draw.x}", 0, 0], "velocity": [draw.speed(), draw.speed(), 0]}
    return Unit({p: point}, [floor, force | {"place": p}], [p])


PLANE: tuple[Callable[[Draw], Unit], ...] = (
    chain,
    in_a_row,
    on_two_supports,
    scissors,
    rims,
    round_on_round,
    welded,
    on_a_parabola,
    tackle,
    driven,
    pushed,
    plank,
    bridge,
)
SPACE: tuple[Callable[[Draw], Unit], ...] = (ball_in_a_round, twisted, strung, pushed_in_space)
