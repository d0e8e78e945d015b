"""Units of numbers against the definitions of the International System and of the international yard and pound."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import pint
import pytest

from core.errors import InvalidParameter
from core.multibody.language.numerals import Numerals
from core.multibody.language.reading import scene_from
from core.multibody.language.units import LONGEST_UNIT, unit_of
from core.multibody.solve import solve_scene

EXACT = {
    "kg": "1", "g": "1/1000", "t": "1000", "cm": "1/100", "um": "1/1000000", "km/h": "5/18", "N/cm": "100",
    "kN/mm": "1000000", "g cm^2": "1/10000000", "kg*m^2": "1", "m s^-2": "1", "1/min": "1/60", "in": "127/5000",
    "ft": "381/1250", "mi/h": "1397/3125", "lb": "45359237/100000000", "%": "1/100", "MPa mm**2": "1", "N m/rad": "1",
}  # fmt: skip


@pytest.mark.parametrize("unit", EXACT)
def test_factors_are_exact(unit: str) -> None:
    found = unit_of(unit, ())
    assert found.turns == 0
    assert Fraction(int(found.fraction.p), int(found.fraction.q)) == Fraction(EXACT[unit])


@pytest.mark.parametrize(
    "unit", ["lbf", "lbf*ft", "deg/s", "rpm", "rev/min", "N*m/deg", "kJ", "hPa*m^2", "mW/Hz", "g/cm^3", "lb*ft^2"]
)
def test_other_units_are_those_of_pint(unit: str) -> None:
    registry: Any = pint.UnitRegistry()
    known = registry(unit.replace("rev", "revolution").replace("deg", "degree")).to_base_units()
    assert float(unit_of(unit, ()).factor) == pytest.approx(known.magnitude, rel=1e-13)
    powers = dict(known.dimensionality)
    assert unit_of(unit, ()).dimension == tuple(int(powers.get(f"[{one}]", 0)) for one in ("mass", "length", "time"))


@pytest.mark.parametrize("unit", ["", "kg^", "/s", "kg m^0", "kgg", "2 m", "m^^2", "x" * (LONGEST_UNIT + 1), 3, None])
def test_what_is_no_unit_is_refused(unit: object) -> None:
    with pytest.raises(InvalidParameter) as refused:
        Numerals.of({"k": {"value": 1, "unit": unit}}, "decimals")
    assert refused.value.path == ("let", "k", "unit")


def scene(**body: Any) -> dict[str, Any]:
    spring = {"kind": "spring", "a": "m", "b": [0, 0], "stiffness": {"value": "0.1", "unit": "N/cm"}, "rest_length": 0}
    return {
        "let": {"out": {"value": 50, "unit": "cm"}},
        "bodies": {"m": {"mass": {"value": 500, "unit": "g"}, "at": ["out", 0], **body}},
        "connections": [spring],
    }


def test_a_scene_in_units() -> None:
    """10 N/m on 0.5 kg; 36 km/h are 10 m/s."""
    found = solve_scene(scene_from(scene(velocity=[{"value": 36, "unit": "km/h"}, 0])), outputs=("energy",))
    assert found.energy is not None
    assert (found.energy.kinetic, found.energy.potential) == (25.0, 1.25)
    assert found.model.apart[0].modes[0].frequency == pytest.approx(math.sqrt(20), rel=1e-15)


def test_degrees_are_as_exact_as_those_of_angles() -> None:
    track = {"kind": "track", "place": "m", "on": {"at": [0, 0], "slope": {"value": 30, "unit": "deg"}}}
    given = {"gravity": [0, -10], "bodies": {"m": {"mass": 1, "at": [0, 0]}}, "connections": [track]}
    found = solve_scene(scene_from(given), outputs=("accelerations",))
    assert found.accelerations is not None
    assert found.accelerations["m"].linear[1] == -2.5


@pytest.mark.parametrize(
    ("body", "pointer", "rule"),
    [
        ({"mass": {"value": 1, "unit": "m"}}, ("mass", "unit"), 'be a unit of kg, unlike "m"'),
        ({"at": [{"value": 1, "unit": "s"}, 0]}, ("at", 0, "unit"), "be a unit of m"),
        ({"mass": {"value": {"value": 1, "unit": "g"}, "unit": "kg"}}, ("mass", "value"), "be a number or a formula"),
        ({"mass": {"value": 1}}, ("mass",), '"unit": text'),
    ],
)
def test_a_unit_that_a_field_cannot_have_is_refused(body: dict[str, Any], pointer: tuple[Any, ...], rule: str) -> None:
    with pytest.raises(InvalidParameter) as refused:
        solve_scene(scene_from(scene(**body)))
    assert refused.value.path == ("bodies", "m", *pointer)
    assert rule in refused.value.rule
