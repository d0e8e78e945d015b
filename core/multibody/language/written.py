"""Numbers, vectors and places as they are written in a description."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from typing import Any

Number = int | float | str | Decimal | Fraction | Mapping[str, Any]
"""A decimal, a formula over names in ``let``, ``{"degrees": number}``, or ``{"value": number, "unit": text}``."""

Vector = Sequence[Number] | Mapping[str, Any]
"""A list of two or three numbers, or in the plane ``{"polar": [distance, angle]}``."""

Place = str | Vector
"""``"body"`` (its centre of mass), ``"body.place"``, or a point of the ground."""

GROUND = "ground"
"""The name of what does not move."""
