"""From the description of a string or a chain to its definition."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from core.multibody.audit.bodies import Path, Reader
from core.multibody.audit.chains import ChainDefinition
from core.multibody.audit.coefficients import touch_of
from core.multibody.audit.definition import Definition
from core.multibody.audit.definition_of import definition_of
from core.multibody.audit.driven import DrivenString
from core.multibody.audit.formula_definitions import value_or_formula
from core.multibody.audit.placement import length
from core.multibody.audit.string_runs import StringPoint, StringRun, run_of
from core.multibody.audit.strings import RubbingString, StringDefinition
from core.multibody.language.strings import Chain, String


@definition_of.register
def string(connection: String, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a string."""
    knots: list[StringPoint] = []
    sides: list[tuple[str, ...]] = []
    for i, entry in enumerate(connection.through):
        place, radius = reader.place(entry, (*path, "through", i)), reader.rim(entry)
        slips = not isinstance(entry, str) or entry in connection.slips or connection.friction is not None
        knots.append(StringPoint(place, radius, None if slips or not radius else place.body))
        given = connection.sides.get(entry, ()) if isinstance(entry, str) else ()
        sides.append((given,) if isinstance(given, str) else tuple(given))
    runs: list[StringRun] = []
    given = None if connection.length is None else reader.number(connection.length, (*path, "length"))
    ends = [0, *(i for i in range(1, len(knots) - 1) if knots[i].drum is not None), len(knots) - 1]
    for number, (first, last) in enumerate(pairwise(ends)):
        pairs = tuple(
            (sides[i][-1] if sides[i] else None, sides[i + 1][0] if sides[i + 1] else None)
            for i in range(first, last)
        )  # fmt: skip
        part = name if len(ends) == 2 else f"{name}.{number + 1}"
        runs.append(run_of(part, tuple(knots[first : last + 1]), pairs, given, reader.start))
    bodies = tuple(dict.fromkeys(body for knot in knots for body in knot.place.bodies))
    touch = touch_of(reader, name, path, connection.restitution)
    if connection.drive is not None:
        drive = value_or_formula(reader, connection.drive, {}, (*path, "drive"))
        return DrivenString(name, bodies, tuple(runs), touch, drive)
    if connection.friction is None:
        return StringDefinition(name, bodies, tuple(runs), touch)
    # With a wrap theta the ratio of tensions exp(mu theta) is one of their difference to their mean.
    (run,) = runs
    ways = [part.direction(reader.start)[1] for part in run.parts]
    wrap = sum(float(np.arctan2(np.linalg.norm(u - w), np.linalg.norm(u + w))) * 2.0 for u, w in pairwise(ways))
    drum = knots[1].place.body if knots[1].radius else None
    if drum is not None:
        # Around a drum it may wind by more than half a turn: in the sense in which the drum is on its side.
        (u, w), sense = ways, -run.parts[0].senses[1]
        wrap = float(np.arctan2(sense * (u[0] * w[1] - u[1] * w[0]), u @ w)) % (2.0 * np.pi)
    if connection.turns is not None:
        wrap += 2.0 * np.pi * reader.number(connection.turns, (*path, "turns"))
    rough = touch_of(reader, name, path, connection.restitution, connection.friction)
    shares = [2.0 * np.tanh(mu * wrap / 2.0) for mu in (rough.static, rough.kinetic)]
    touch = replace(touch, static=shares[0], kinetic=shares[1], friction=(f"{name}.friction",))
    shortest = min(float(part.direction(reader.start)[0]) for part in run.parts)
    return RubbingString(name, bodies, (run,), touch, drum, shortest)


@definition_of.register
def chain(connection: Chain, reader: Reader, name: str, path: Path) -> Definition:
    """Return the definition of a chain."""
    first, peg, last = (reader.place(entry, (*path, "through", i)) for i, entry in enumerate(connection.through))
    between = [end.at(reader.start) - peg.at(reader.start) for end in (first, last)]
    sizes = [float(length(d)) for d in between]
    ways = [tuple((d / size).tolist()) for d, size in zip(between, sizes, strict=True)]
    pulls = [float(np.dot(reader.gravity, way)) for way in ways]
    given = connection.length
    size = sum(sizes) if given is None else reader.number(given, (*path, "length"))
    density = reader.number(connection.density, (*path, "density"))
    bodies = (*first.bodies, *last.bodies)
    fall = float(np.dot(reader.gravity, peg.offset))
    ends, both = (first, last), (ways[0], ways[1])
    return ChainDefinition(name, bodies, ends, peg.offset, both, density, size, (pulls[0], pulls[1]), fall)
