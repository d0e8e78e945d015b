"""Bodies that touch with the whole of their shapes: boxes, polygons, capsules and discs."""

from __future__ import annotations

from collections.abc import Callable

from tests.oracles.plain_engine.comparison.drawing import Draw, Json, Unit

BOX = {"kind": "box", "width": 0.4, "height": 0.2}
SHAPES: tuple[Json, ...] = (
    BOX,
    BOX,
    {"kind": "box", "width": 0.2, "height": 0.2},
    {"kind": "polygon", "corners": [[-0.2, -0.1], [0.2, -0.1], [0, 0.2]]},
    {"kind": "capsule", "radius": 0.05, "length": 0.3},
    {"kind": "disc", "radius": 0.1},
)


def dropped(draw: Draw) -> Unit:
    """Return a shape that falls on a floor or a slope, level or askew, or slides on it."""
    p, shape = draw.name("shape"), draw.one(SHAPES)
    body: Json = {"mass": draw.mass(), "shape": shape, "at": draw.at(0, draw.one((0.3, 0.5)))}
    body |= {"angle": draw.one((0, 0, "0.3", "pi/2", "acos(4/5)")), "velocity": [draw.speed(), draw.one((0, -1))]}
    body["angular_velocity"] = draw.one((0, 0, 2))
    if draw.chance(0.3) and shape["kind"] == "box":
        body |= {
            "at": draw.at(0, f"{shape['height']}/2"),
            "angle": 0,
            "angular_velocity": 0,
            "velocity": [draw.speed(), 0],
        }
    floor = {"kind": "contact", "name": draw.name("floor"), "place": p, "on": {"at": draw.at(0, 0)}, **draw.rough()}
    return Unit({p: body}, [floor], [p])


def struck(draw: Draw) -> Unit:
    """Return two shapes in flight that meet, of which one may hang on a rod."""
    a, b = draw.name("first"), draw.name("second")
    bodies: Json = {
        a: {"mass": draw.mass(), "shape": draw.one(SHAPES), "at": draw.at(-0.5, 0), "velocity": [2, 0]},
        b: {"mass": draw.mass(), "shape": draw.one(SHAPES), "at": draw.at(0.2, draw.one((0, 0.05, 0.1)))},
    }
    bodies[a] |= {"angle": draw.one((0, "pi/6", 0.2)), "angular_velocity": draw.one((0, 0, 3))}
    bodies[b]["angle"] = draw.one((0, "pi/2", "pi/4", "acos(3/5)"))
    connections: list[Json] = [{"kind": "contact", "name": draw.name("meet"), "a": a, "b": b, **draw.rough()}]
    if draw.chance(0.3):
        connections.append({"kind": "rod", "name": draw.name("hangs"), "a": b, "b": draw.at(0.2, 1)})
    else:
        bodies[b]["velocity"] = [draw.one((0, -1)), 0]
    return Unit(bodies, connections, [b])


def stacked(draw: Draw) -> Unit:
    """Return a box that slides along a plank, on a guide or on a floor, and may fall over its end."""
    a, b = draw.name("plank"), draw.name("box")
    bodies: Json = {
        a: {"mass": draw.mass(), "shape": {"kind": "box", "width": 1, "height": 0.1}, "at": draw.at(0, 0.05)},
        b: {"mass": draw.mass(), "shape": BOX, "at": draw.at(draw.one((0, 0.4, -0.25)), 0.2)},
    }
    bodies[a] |= {"velocity": [0, 0], "angular_velocity": 0}
    bodies[b] |= {"velocity": [draw.one((0, 1, 2)), 0], "angular_velocity": 0}
    top: Json = {"kind": "contact", "name": draw.name("top"), "a": b, "b": a, "friction": draw.one((0.1, 0.3, 0.4))}
    below: Json = {"kind": "slider", "name": draw.name("guide"), "a": a, "b": draw.at(0, 0.05), "slope": 0}
    if draw.chance(0.2):
        # A load on four corners, of which two carry it, takes the plain engine long.
        top["friction"] = 0
        below = {
            "kind": "contact",
            "name": draw.name("floor"),
            "place": a,
            "on": {"at": draw.at(0, 0)},
            "friction": 0.3,
        }
    return Unit(bodies, [below, top], [b])


def shape_in_space(draw: Draw) -> Unit:
    """Return a box, a capsule or a ball of space that falls on a plane, or two balls that meet."""
    p = draw.name("shape")
    shape = draw.one(
        (
            {"kind": "box", "width": 0.4, "height": 0.2, "depth": 0.3},
            {"kind": "capsule", "radius": 0.05, "length": 0.3},
            {"kind": "ball", "radius": 0.1},
        )
    )
    body: Json = {"mass": draw.mass(), "shape": shape, "at": [f"{draw.x}", 0, 0.5], "velocity": [draw.speed(), 0, -1]}
    body["angular_velocity"] = [draw.one((0, 1)), draw.one((0, 2)), draw.one((0, 3))]
    on = {"at": [f"{draw.x}", 0, 0], "normal": draw.one(([0, 0, 1], [0.6, 0, 0.8]))}
    law: Json = {"restitution": draw.one((0, 0.5, 1))}
    if shape["kind"] != "capsule":
        # Friction would turn what is round in space, and does so with balls alone.
        law |= draw.rough()
    return Unit({p: body}, [{"kind": "contact", "name": draw.name("floor"), "place": p, "on": on, **law}], [p])


PLANE: tuple[Callable[[Draw], Unit], ...] = (dropped, dropped, struck, stacked)
SPACE: tuple[Callable[[Draw], Unit], ...] = (shape_in_space,)
