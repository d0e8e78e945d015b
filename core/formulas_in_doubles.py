"""Formulas evaluated in doubles."""

from __future__ import annotations

import math
import operator

from core.formulas import FUNCTIONS, Arithmetic

DOUBLES = Arithmetic[float](
    float,
    lambda: math.pi,
    operator.truediv,
    math.pow,
    {name: abs if name == "abs" else getattr(math, name) for name in FUNCTIONS}
    | {
        "atan2": math.atan2,
        "min": min,
        "max": max,
        "sign": lambda x: float((x > 0) - (x < 0)),
        "if": lambda condition, then, otherwise: then if condition > 0 else otherwise,
    },
)
"""An arithmetic that raises `ValueError`, `ZeroDivisionError` or `OverflowError` where there is no value."""
