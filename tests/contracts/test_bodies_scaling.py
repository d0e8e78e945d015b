"""Every body in smaller and larger units: each field is scaled by the unit that its own annotation states."""

from __future__ import annotations

from dataclasses import fields, replace
from types import NoneType, UnionType
from typing import Annotated, Any, Union, get_args, get_origin, get_type_hints

import numpy as np
import pytest

from core.bodies.composite import Part
from core.quantities import Quantity
from core.rows import Rows
from tests.contracts.test_bodies import SPECIMENS

POWERS = {"m": (1, 0), "kg": (0, 1), "kg m^-3": (-3, 1), "kg m^2": (2, 1), "1": (0, 0)}
"""Powers of length and of mass in each unit."""


def in_units(value: Any, hint: Any, length: int, mass: int) -> Any:
    """Return the value of a field in units smaller by 2^length and 2^mass."""
    if value is None or isinstance(value, (str, bool)):
        return value
    if isinstance(value, Part):
        place = get_type_hints(Part, include_extras=True)["position"]
        return replace(value, body=whole(value.body, length, mass), position=in_units(value.position, place, length, 0))
    arguments = get_args(hint)
    if get_origin(hint) in (Union, UnionType):
        # Of one mass or a list of masses, and of a quantity or none.
        listed = isinstance(value, np.ndarray)
        options = [h for h in arguments if h is not NoneType and (rows_of(h) is not None) == listed]
        return in_units(value, options[0], length, mass)
    if get_origin(hint) is Annotated:
        rows = rows_of(hint)
        quantity = rows.quantity if rows else next((m for m in hint.__metadata__ if isinstance(m, Quantity)), None)
        if rows and rows.whole:
            return value
        if quantity is None:
            return in_units(value, arguments[0], length, mass)
        of_length, of_mass = POWERS[quantity.unit]
        return np.ldexp(value, of_length * length + of_mass * mass).tolist()
    hints = arguments[:1] * len(value) if arguments[-1] is ... else arguments
    return tuple(in_units(x, h, length, mass) for x, h in zip(value, hints, strict=True))


def rows_of(hint: Any) -> Rows | None:
    return next((mark for mark in getattr(hint, "__metadata__", ()) if isinstance(mark, Rows)), None)


def whole(body: Any, length: int, mass: int) -> Any:
    hints = get_type_hints(type(body), include_extras=True)
    return replace(body, **{f.name: in_units(getattr(body, f.name), hints[f.name], length, mass) for f in fields(body)})


@pytest.mark.parametrize("kind", SPECIMENS)
@pytest.mark.parametrize(
    ("length", "mass"),
    [(332, 0), (-332, 0), (0, 332), (0, -332), (166, 332), (-166, -332), (332, 300), (-332, -280), (10, -100)],
)
def test_scaling_laws_hold_bit_for_bit(kind: str, length: int, mass: int) -> None:
    # Powers of two up to 1e100 round nothing, as long as no tail leaves the range of doubles.
    body = SPECIMENS[kind]
    if getattr(body, "density", None) is not None and abs(mass - 3 * length) > 1000:
        # A density would leave it where the mass does not.
        body = replace(body, density=None, mass=body.mass_properties().mass)
    own, found = body.mass_properties(), whole(body, length, mass).mass_properties()
    for name in ("inertia", "inertia_tail"):
        assert (getattr(found, name) == np.ldexp(getattr(own, name), 2 * length + mass)).all()
    assert (found.principal.moments == np.ldexp(own.principal.moments, 2 * length + mass)).all()
    assert np.abs(found.principal.axes - own.principal.axes).max() < 1e-15
    assert found.symmetry == own.symmetry
    assert found.validity.physical
    if own.mass is not None and own.center_of_mass is not None:
        assert found.mass == np.ldexp(own.mass, mass)
        assert (found.center_of_mass == np.ldexp(own.center_of_mass, length)).all()
