"""Numbers, vectors and places as they are written in a description."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from typing import Annotated, Any

from core.multibody.language.declared_units import Measured, Members

Number = int | float | str | Decimal | Fraction | Mapping[str, Any]
"""A decimal, a formula over names in ``let``, ``{"degrees": number}``, or ``{"value": number, "unit": text}``."""

Vector = Sequence[Number] | Mapping[str, Any]
"""A list of two or three numbers, or in the plane ``{"polar": [distance, angle]}``."""

Place = Annotated[str | Vector, Measured("m")]
"""``"body"`` (its centre of mass), ``"body.place"``, or a point of the ground."""

Length = Annotated[Number, Measured("m")]
"""A number in metres."""

Angle = Annotated[Number, Measured("rad")]
"""A number in radians."""

Ratio = Annotated[Number, Measured("1")]
"""A number without a dimension."""

Acceleration = Annotated[Vector, Measured("m/s^2")]
"""A vector in metres per second squared."""

Direction = Annotated[Vector, Measured("1")]
"""A vector of which the length does not matter."""

Surface = Annotated[
    Mapping[str, Any],
    Members(
        {"at": "m", "slope": "rad", "radius": "m", "curvature": "1/m", "normal": "1", "direction": "1", "rate": "rad/s"}
    ),
]
"""A line, face, circle, sphere, parabola or plane by its place and size."""

GROUND = "ground"
"""The name of what does not move."""
