"""Units of all fields of all kinds: what a field's number cannot be in is refused, and its own unit is taken."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import MISSING, fields
from typing import Any, get_type_hints

import pytest

from core.errors import InvalidParameter
from core.multibody.language.body import SceneBody
from core.multibody.language.declared_units import check_units, declared_units
from core.multibody.language.kinds import KINDS
from core.multibody.language.reading import scene_from
from core.multibody.language.units import unit_of

SI = (
    "kg",
    "m",
    "s",
    "N",
    "m/s",
    "rad",
    "rad/s",
    "N/m",
    "N m",
    "J/s",
    "kg/m",
    "N s/m",
    "N m s",
    "N m^2",
    "1/m",
    "m/s^2",
)

UNITS = {
    "pin": {"a": "m", "b": "m", "axis": "1"},
    "ball-joint": {"a": "m", "b": "m"},
    "weld": {"a": "m", "b": "m"},
    "slider": {
        **{"a": "m", "b": "m", "slope": "rad", "direction": "1", "drive": "m"},
        **{"friction": "1", "length": "m", "width": "m"},
    },
    "cylindrical": {"a": "m", "b": "m", "axis": "1"},
    "screw": {"a": "m", "b": "m", "axis": "1", "pitch": "m"},
    "universal": {"a": "m", "b": "m", "axes": "1"},
    "rod": {"a": "m", "b": "m", "length": "m", "drive": "m"},
    "relation": {},
    "rolling": {"on.at": "m", "on.radius": "m", "on.slope": "rad", "on.normal": "1", "on.rate": "rad/s"},
    "track": {
        "place": "m",
        "on.at": "m",
        "on.slope": "rad",
        "on.curvature": "1/m",
        "on.direction": "1",
        "friction": "1",
    },
    "contact": {
        **{"place": "m", "a": "m", "b": "m", "on.at": "m", "on.radius": "m", "at_least": "rad", "at_most": "rad"},
        **{"friction": "1", "restitution": "1", "tangential_restitution": "1", "order": "1"},
    },
    "string": {
        **{
            "through": "m",
            "length": "m",
            "drive": "m",
            "restitution": "1",
            "order": "1",
            "friction": "1",
            "turns": "1",
        },
    },
    "chain": {"through": "m", "density": "kg/m", "length": "m"},
    "spring": {"a": "m", "b": "m", "stiffness": "N/m", "rest_length": "m"},
    "torsion-spring": {"stiffness": "N m", "rest_angle": "rad"},
    "gravitation": {"constant": "N m^2/kg^2"},
    "inverse-square": {"a": "m", "b": "m", "strength": "N m^2"},
    "damper": {"a": "m", "b": "m", "coefficient": "N s/m"},
    "motor": {"rate": "rad/s", "drive": "rad"},
    "spinning-frame": {"rate": "rad/s", "at": "m"},
    "force": {"place": "m", "force": "N"},
    "torque": {"torque": "N m"},
    "field": {"acceleration": "m/s^2", "force": "N"},
    "impulse": {"place": "m", "impulse": "N s", "at": "s"},
}
for _kind in UNITS.keys() - {"chain", "spinning-frame", "impulse"}:
    UNITS[_kind] |= {"from": "s", "until": "s"}
"""The units of the language's document (docs/describing-scenes.md), written by hand from it."""

BODY = {
    **{"mass": "kg", "at": "m", "velocity": "m/s", "inertia": "kg m^2", "moments": "kg m^2", "tensor": "kg m^2"},
    **{"radius": "m", "angle": "rad", "axes": "1", "angular_velocity": "rad/s", "places.tip": "m"},
    **{f"shape.{size}": "m" for size in ("radius", "width", "height", "depth", "length", "at", "corners", "semi_axes")},
}

WITHOUT_NUMBERS = {
    "name",
    "measure",
    "impacts",
    "inside",
    "sides",
    "slips",
    "of",
    "equals",
    "law",
    "about",
    "in_",
    "kind",
}
"""Fields of words, and the two sides of a relation, whose dimension is that of its formula."""

NAMES = {"rolling": {"place", "a", "b"}, "torsion-spring": {"a", "b"}, "gravitation": {"a", "b"}, "motor": {"a", "b"}}
NAMES |= {"torque": {"body"}, "field": {"on"}, "impulse": {"body"}}
"""Fields that name bodies."""


def cases() -> Iterator[Any]:
    """Yield kind, field, measure and unit."""
    for kind, units in UNITS.items():
        for field, unit in units.items():
            yield pytest.param(kind, field, None, unit, id=f"{kind}-{field}")
    yield pytest.param("damper", "coefficient", "turn", "N m s", id="damper-of-a-turn")
    yield pytest.param("contact", "at_least", "turn", "rad", id="stop")


def described(cls: type[Any], field: str, value: object, measure: str | None = None) -> dict[str, Any]:
    """Return a description with one number: of the body `m`, or of a connection."""
    name, _, inner = field.partition(".")
    given: dict[str, Any] = {} if measure is None else {"measure": measure}
    given[name] = {inner: value} if inner else value
    if cls is SceneBody:
        return {"bodies": {"m": {"at": [0, 0], **given}}}
    for entry in fields(cls):
        if entry.name != name and entry.default is MISSING and entry.default_factory is MISSING:
            given[entry.name] = {} if entry.name == "on" else "m"
    return {"bodies": {"m": {"mass": 1, "at": [0, 0]}}, "connections": [{"kind": cls.kind, **given}]}


def check(cls: type[Any], field: str, measure: str | None, unit: str, where: tuple[Any, ...]) -> None:
    """Units of the field's dimension are taken; all others are refused, in a number, a vector and a list of vectors."""
    dimension = unit_of(unit, ()).dimension
    for one in (unit, *SI):
        number = {"value": 1, "unit": one}
        shapes: tuple[tuple[Any, tuple[int, ...]], ...] = (
            (number, ()),
            ([0, number], (1,)),
            ([[0, 0], [number]], (1, 0)),
        )
        for written, inner in shapes:
            description = described(cls, field, written, measure)
            if unit_of(one, ()).dimension == dimension:
                scene_from(description)
                continue
            with pytest.raises(InvalidParameter) as refused:
                scene_from(description)
            assert refused.value.path == (*where, *field.split("."), *inner, "unit")
            assert re.fullmatch(f'be a unit of .*, unlike "{re.escape(one)}"', refused.value.rule)
            named = refused.value.rule[len("be a unit of ") : -len(f', unlike "{one}"')]
            assert unit_of(named, ()).dimension == dimension
            assert f"give the number in {named}" in str(refused.value.remedy)


@pytest.mark.parametrize(("kind", "field", "measure", "unit"), list(cases()))
def test_the_fields_of_connections(kind: str, field: str, measure: str | None, unit: str) -> None:
    check(KINDS[kind], field, measure, unit, ("connections", 0))


@pytest.mark.parametrize("field", BODY)
def test_the_fields_of_bodies(field: str) -> None:
    check(SceneBody, field, None, BODY[field], ("bodies", "m"))


def test_gravity() -> None:
    scene = {"bodies": {"m": {"mass": 1, "at": [0, 0]}}}
    scene_from({**scene, "gravity": [0, {"value": 1, "unit": "km/h^2"}]})
    with pytest.raises(InvalidParameter) as refused:
        scene_from({**scene, "gravity": [0, {"value": 1, "unit": "N"}]})
    assert refused.value.path == ("gravity", 1, "unit")


@pytest.mark.parametrize("kind", KINDS)
def test_every_field_declares_its_unit_or_has_no_number(kind: str) -> None:
    named = {entry.name for entry in fields(KINDS[kind])} - NAMES.get(kind, set()) - WITHOUT_NUMBERS
    declared = declared_units(KINDS[kind])  # type: ignore[arg-type]
    # A word of Python's has a sign behind it as the name of a field.
    assert set(declared) == named
    assert {name.rstrip("_") for name in named} == {field.partition(".")[0] for field in UNITS[kind]}


def test_every_field_of_a_body_declares_its_unit() -> None:
    assert set(declared_units(SceneBody)) == set(get_type_hints(SceneBody)) - {"body"}


def test_polar_vectors_have_a_distance_and_an_angle() -> None:
    polar = [{"value": 3, "unit": "ft"}, {"value": 30, "unit": "deg"}]
    check_units(SceneBody(at={"polar": polar}), ())
    with pytest.raises(InvalidParameter) as refused:
        check_units(SceneBody(at={"polar": polar[::-1]}), ())
    assert refused.value.path == ("at", "polar", 0, "unit")
    with pytest.raises(InvalidParameter) as refused:
        check_units(SceneBody(at={"polar": [1, {"value": 3, "unit": "ft"}]}), ())
    assert refused.value.path == ("at", "polar", 1, "unit")


def test_places_may_have_any_name() -> None:
    check_units(SceneBody(at=[0, 0], places={"value": [1, 0], "unit": [0, 1], "polar": [1, 1]}), ())


def test_the_faults_of_all_parts_are_found_at_once() -> None:
    wrong = {"value": 1, "unit": "s"}
    springs = [{"kind": "spring", "a": "m", "b": [0, 0], "stiffness": wrong} for _ in range(2)]
    with pytest.raises(InvalidParameter) as refused:
        scene_from({"gravity": [0, wrong], "bodies": {"m": {"mass": wrong, "at": [1, 0]}}, "connections": springs})
    paths = [refused.value.path, *(one.path for one in refused.value.further)]
    assert paths == [
        ("gravity", 1, "unit"),
        ("bodies", "m", "mass", "unit"),
        ("connections", 0, "stiffness", "unit"),
        ("connections", 1, "stiffness", "unit"),
    ]


@pytest.mark.parametrize("entry", ["mass", "inertia", "at", "velocity", "angular_velocity"])
def test_degrees_are_refused_where_no_angle_belongs(entry: str) -> None:
    degrees: Any = {"degrees": 30}
    value = [0, degrees] if entry in ("at", "velocity") else degrees
    with pytest.raises(InvalidParameter, match="be a unit of") as fault:
        check_units(SceneBody(**{"mass": 1, "at": (0, 0), entry: value}), ("bodies", "a"))
    assert fault.value.path[:3] == ("bodies", "a", entry)
    assert fault.value.path[-1] == "degrees"


@pytest.mark.parametrize("angle", [{"degrees": 30}, {"value": 30, "unit": "deg"}])
def test_a_coefficient_of_friction_is_no_angle(angle: Any) -> None:
    track = KINDS["track"](name="t", place="a", on={"slope": angle}, friction=angle)  # type: ignore[call-arg]
    with pytest.raises(InvalidParameter, match="be a unit of 1") as fault:
        check_units(track, ("connections", 0))
    assert fault.value.path[:3] == ("connections", 0, "friction")
