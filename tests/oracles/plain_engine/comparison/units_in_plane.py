"""Small systems of the plane, as textbooks have them."""

from __future__ import annotations

from collections.abc import Callable

from tests.oracles.plain_engine.comparison.drawing import Draw, Json, Unit
from tests.oracles.plain_engine.comparison.units_of_points import loop, pair, pendulum, slack


def block(draw: Draw) -> Unit:
    """Return a point on a slope: on a track, on a contact, or held by a spring as well."""
    c, s, angle = draw.direction()
    p, v = draw.name("block"), draw.speed()
    body: Json = {"mass": draw.mass(), "at": draw.at(0, 0), "velocity": [f"{v}*({c})", f"{v}*({s})"]}
    on = {"at": draw.at(0, 0), "slope": angle}
    found = Unit({p: body}, [], [p])
    if draw.chance(0.3):
        found.connections.append({"kind": "track", "name": draw.name("slope"), "place": p, "on": on})
    else:
        found.connections.append({"kind": "contact", "name": draw.name("slope"), "place": p, "on": on, **draw.rough()})
    if draw.chance(0.4):
        anchor = draw.at(f"-1.5*({c})", f"-1.5*({s})")
        spring: Json = {
            "kind": "spring",
            "name": draw.name("spring"),
            "a": p,
            "b": anchor,
            "stiffness": draw.one((5, 10, 40)),
        }
        if draw.chance(0.5):
            spring["rest_length"] = draw.one((1, 1.2, 2))
        found.connections.append(spring)
    return found


def disc(draw: Draw) -> Unit:
    """Return a disc or ring on a slope, which rolls, or slips and rolls, or is dropped on it."""
    c, s, angle = draw.direction()
    if c == "0":
        c, s, angle = "1", "0", "0"
    p, radius, mass, v = draw.name("disc"), draw.one((0.1, 0.5, 1)), draw.mass(), draw.speed()
    height = draw.one((0, 0, 0, 0.3))
    body: Json = {
        "mass": mass,
        "inertia": f"{mass}*{radius}^2*{draw.one(('1/2', '1', '2/5'))}",
        "radius": radius,
        "at": draw.at(f"-({radius + height})*({s})", f"({radius + height})*({c})"),
        "velocity": [f"{v}*({c})", f"{v}*({s})"],
    }
    on = {"at": draw.at(0, 0), "slope": angle}
    if draw.chance(0.3) and not height:
        return Unit({p: body}, [{"kind": "rolling", "name": draw.name("roll"), "place": p, "on": on}], [p])
    body["angular_velocity"] = draw.one((0, 0, 3, -10, f"-({v})/{radius}"))
    contact = {"kind": "contact", "name": draw.name("floor"), "place": p, "on": on, **draw.rough()}
    return Unit({p: body}, [contact], [p])


def ladder(draw: Draw) -> Unit:
    """Return a rod against a floor and a wall, each rough or smooth."""
    c, s, angle = draw.one((("0.28", "0.96", "acos(0.28)"), ("0.6", "0.8", "acos(0.6)"), ("1/2", "sqrt(3)/2", "pi/3")))
    p, mass = draw.name("ladder"), draw.mass()
    body: Json = {
        "mass": mass,
        "inertia": draw.one((f"{mass}/12", f"{mass}/10", f"{mass}/3")),
        "at": draw.at(f"-({c})/2", f"({s})/2"),
        "angle": angle,
        "places": {"foot": [-0.5, 0], "head": [0.5, 0]},
    }
    floor = {
        "kind": "contact",
        "name": draw.name("floor"),
        "place": f"{p}.foot",
        "on": {"at": draw.at(0, 0)},
        **draw.rough(),
    }
    on = {"at": draw.at(0, 0), "slope": {"degrees": 90}}
    wall = {"kind": "contact", "name": draw.name("wall"), "place": f"{p}.head", "on": on, **draw.rough()}
    return Unit({p: body}, [floor, wall], [p])


def bar(draw: Draw) -> Unit:
    """Return a bar on two or three places of a floor, on which it rests, slides or tips."""
    p, mass, v = draw.name("bar"), draw.mass(), draw.speed()
    places = {"l": [-1, -0.2], "r": [1, -0.2]} | ({"m": [0, -0.2]} if draw.chance(0.4) else {})
    drop = draw.one((0, 0, 0, 0.2))
    body: Json = {
        "mass": mass,
        "inertia": f"{mass}/3",
        "at": draw.at(0, 0.2 + drop),
        "velocity": [v, 0],
        "angular_velocity": 0,
        "places": {**places, "top": [0, 0.2]},
    }
    law = draw.rough()
    contacts = [
        {"kind": "contact", "name": draw.name(f"on-{spot}"), "place": f"{p}.{spot}", "on": {"at": draw.at(0, 0)}, **law}
        for spot in places
    ]
    return Unit({p: body}, contacts, [f"{p}.top"])


def ball(draw: Draw) -> Unit:
    """Return a point or a disc that is thrown or dropped above a floor."""
    p, radius = draw.name("ball"), draw.one((None, 0.1))
    body: Json = {"mass": draw.mass(), "at": draw.at(0, draw.one((0.5, 1, 1.25)))}
    body["velocity"] = [draw.one((0, 0, 1)), draw.one((0, 0, 2, -1))]
    law = draw.rough()
    if radius is not None:
        body |= {"radius": radius, "inertia": f"2/5*{body['mass']}*{radius}^2", "angular_velocity": draw.one((0, 5))}
    contact = {"kind": "contact", "name": draw.name("floor"), "place": p, "on": {"at": draw.at(0, 0)}, **law}
    return Unit({p: body}, [contact], [p])


def atwood(draw: Draw) -> Unit:
    """Return two masses on a string over a wheel or smooth pegs."""
    a, b, wheel = (draw.name(x) for x in ("a", "b", "wheel"))
    low, high = draw.one(((-1, -1), (-1, -0.6), (-0.8, -1)))
    bodies: Json = {
        a: {"mass": draw.mass(), "at": draw.at(-0.1, low)},
        b: {"mass": draw.mass(), "at": draw.at(0.1, high)},
    }
    cord = draw.name("cord")
    if draw.chance(0.5):
        bodies[wheel] = {"mass": 1, "radius": 0.1, "inertia": 0.005, "at": draw.at(0, 0)}
        connections: list[Json] = [
            {"kind": "pin", "name": draw.name("axle"), "a": wheel, "b": draw.at(0, 0)},
            {"kind": "string", "name": cord, "through": [a, wheel, b], "sides": {wheel: ["left", "right"]}},
        ]
    else:
        pegs = [draw.at(-0.1, 0), draw.at(0.1, 0)]
        connections = [{"kind": "string", "name": cord, "through": [a, *pegs, b]}]
    found = Unit(bodies, connections, [b])
    if draw.chance(0.3):
        floor = {"kind": "contact", "name": draw.name("floor"), "place": b, "on": {"at": draw.at(0, -1.2)}}
        found.connections.append(floor)
    return found


def double_pendulum(draw: Draw) -> Unit:
    """Return two rods that are pinned to one another and to the ground, level, hanging or folded."""
    c, s, angle = draw.turned()
    one, two = draw.name("one"), draw.name("two")
    m = draw.mass()
    half = 0.5
    first: Json = {"mass": m, "inertia": f"{m}/12", "at": draw.at(f"{half}*({c})", f"{half}*({s})"), "angle": angle}
    first["places"] = {"top": [-half, 0], "end": [half, 0]}
    # It hangs, or both are in one line, stretched or folded.
    middle, way = draw.one(
        (
            ((c, f"({s}) - {half}"), "-pi/2"),
            ((f"1.5*({c})", f"1.5*({s})"), angle),
            ((f"{half}*({c})", f"{half}*({s})"), f"{angle} + pi"),
        )
    )
    second: Json = {"mass": m, "inertia": f"{m}/12", "at": draw.at(*middle), "angle": way}
    second["places"] = {"top": [-half, 0], "end": [half, 0]}
    pins = [
        {"kind": "pin", "name": draw.name("hinge"), "a": f"{one}.top", "b": draw.at(0, 0)},
        {"kind": "pin", "name": draw.name("knee"), "a": f"{two}.top", "b": f"{one}.end"},
    ]
    if draw.chance(0.3):
        pins.append(
            {"kind": "torsion-spring", "name": draw.name("twist"), "a": two, "b": one, "stiffness": draw.one((1, 5))}
        )
    if draw.chance(0.2):
        pins.append(
            {"kind": "damper", "name": draw.name("rub"), "a": two, "b": one, "measure": "turn", "coefficient": 0.1}
        )
    return Unit({one: first, two: second}, pins, [f"{two}.end"])


def gears(draw: Draw) -> Unit:
    """Return two pinned wheels that roll on one another, in some cases redundantly or driven by a spring."""
    a, b = draw.name("g"), draw.name("h")
    r, q = draw.one((0.1, 0.2)), draw.one((0.1, 0.3))
    spin = draw.one((0, 0, 2, -3))
    bodies: Json = {
        a: {"mass": 1, "inertia": f"{r}^2/2", "radius": r, "at": draw.at(0, 0), "angular_velocity": spin},
        b: {"mass": 1, "inertia": f"{q}^2/2", "radius": q, "at": draw.at(f"{r} + {q}", 0)},
    }
    bodies[a]["places"] = {"rim": [0, r]}
    connections: list[Json] = [
        {"kind": "pin", "name": draw.name("axle-g"), "a": a, "b": draw.at(0, 0)},
        {"kind": "pin", "name": draw.name("axle-h"), "a": b, "b": draw.at(f"{r} + {q}", 0)},
        {"kind": "rolling", "name": draw.name("mesh"), "a": a, "b": b},
    ]
    if draw.chance(0.4):
        connections.append(
            {"kind": "torsion-spring", "name": draw.name("twist"), "a": b, "stiffness": draw.one((0.1, 1))}
        )
    if draw.chance(0.3):
        connections.append({"kind": "torque", "name": draw.name("drive"), "body": a, "torque": 0.05})
    return Unit(bodies, connections, [f"{a}.rim"])


def cart(draw: Draw) -> Unit:
    """Return a pendulum on a cart on rails."""
    c, s, _ = draw.turned()
    k, p = draw.name("cart"), draw.name("bob")
    bodies: Json = {
        k: {"mass": draw.mass(), "at": draw.at(0, 0), "velocity": [draw.speed(), 0]},
        p: {"mass": draw.mass(), "at": draw.at(s, f"-({c})")},
    }
    connections: list[Json] = [
        {"kind": "track", "name": draw.name("rails"), "place": k, "on": {"at": draw.at(0, 0)}},
        {"kind": "rod", "name": draw.name("rod"), "a": p, "b": k},
    ]
    if draw.chance(0.4):
        buffer = {
            "kind": "contact",
            "name": draw.name("buffer"),
            "place": k,
            "on": {"at": draw.at(0.3, 0), "slope": {"degrees": 90}},
        }
        connections.append({**buffer, **({"restitution": draw.one((0, 0.5, 1))} if draw.chance(0.5) else {})})
    return Unit(bodies, connections, [p])


def wedge(draw: Draw) -> Unit:
    """Return a block on a wedge that slides on the floor."""
    c, s, angle = draw.one(
        (("0.8", "0.6", "atan(3/4)"), ("sqrt(3)/2", "1/2", "pi/6"), ("sqrt(1/2)", "sqrt(1/2)", "pi/4"))
    )
    w, p = draw.name("wedge"), draw.name("block")
    mass = draw.mass()
    bodies: Json = {
        w: {"mass": draw.mass(), "at": draw.at(0, 0), "velocity": [0, 0]},
        p: {"mass": mass, "at": draw.at(c, s), "velocity": [0, 0]},
    }
    on = {"at": w, "slope": angle}
    connections: list[Json] = [
        {"kind": "slider", "name": draw.name("floor"), "a": w, "b": draw.at(0, 0), "slope": 0},
        {"kind": "contact", "name": draw.name("face"), "place": p, "on": on, **draw.rough()},
    ]
    return Unit(bodies, connections, [p])


def stop(draw: Draw) -> Unit:
    """Return a rod on a hinge with a stop."""
    c, s, angle = draw.direction()
    p, mass = draw.name("rod"), draw.mass()
    body: Json = {"mass": mass, "inertia": f"{mass}/12", "at": draw.at(f"({c})/2", f"({s})/2"), "angle": angle}
    body |= {"places": {"top": [-0.5, 0], "end": [0.5, 0]}, "angular_velocity": draw.one((0, 0, 1, -2))}
    limit: Json = {"kind": "contact", "name": draw.name("stop"), "measure": "turn", "a": p}
    limit["at_least"] = draw.one((f"{angle}", f"({angle}) - pi/6", "-pi/2", "-2"))
    if limit["at_least"] == "-pi/2" and angle == "-(pi/2)":
        limit["at_least"] = "-2"
    if draw.chance(0.5):
        limit["restitution"] = draw.one((0, 0.5, 1))
    return Unit(
        {p: body},
        [{"kind": "pin", "name": draw.name("hinge"), "a": f"{p}.top", "b": draw.at(0, 0)}, limit],
        [f"{p}.end"],
    )


def paddle(draw: Draw) -> Unit:
    """Return a paddle that a motor turns, and a point that it may meet."""
    k, m = draw.name("paddle"), draw.name("m")
    rate = draw.one((1, 2, 3))
    bodies: Json = {
        k: {"mass": 1, "inertia": 0.1, "at": draw.at(0, 0), "angular_velocity": rate},
        m: {"mass": draw.mass(), "at": draw.at(1, draw.one((0.5, 1))), "velocity": [0, 0]},
    }
    connections: list[Json] = [
        {"kind": "pin", "name": draw.name("axle"), "a": k, "b": draw.at(0, 0)},
        {"kind": "motor", "name": draw.name("motor"), "a": k, "rate": rate},
        {"kind": "contact", "name": draw.name("blade"), "place": m, "on": {"at": k}, **draw.rough()},
    ]
    return Unit(bodies, connections, [m])


UNITS: tuple[Callable[[Draw], Unit], ...] = (
    pendulum,
    block,
    disc,
    ladder,
    bar,
    ball,
    atwood,
    loop,
    double_pendulum,
    gears,
    cart,
    wedge,
    stop,
    paddle,
    pair,
    slack,
)
