"""Euler's equations, and the attitude's beside them, in the forms that integrators take.

State: the angular velocity x, y, z, after it the quaternion a, b, c, d (body to space) where the attitude is asked for.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
from numba import cfunc, njit, types

from benchmarks.peers.cases import Case
from core.arrays import Floats
from core.systems.system import VECTOR_FIELD


@njit(inline="always")
def _fill(y: Any, c: Any, out: Any) -> None:
    out[0] = c[0] * y[1] * y[2]
    out[1] = c[1] * y[2] * y[0]
    out[2] = c[2] * y[0] * y[1]


@njit(inline="always")
def _fill_with_attitude(y: Any, c: Any, out: Any) -> None:
    _fill(y, c, out)
    out[3] = -0.5 * (y[4] * y[0] + y[5] * y[1] + y[6] * y[2])
    out[4] = 0.5 * (y[3] * y[0] + y[5] * y[2] - y[6] * y[1])
    out[5] = 0.5 * (y[3] * y[1] + y[6] * y[0] - y[4] * y[2])
    out[6] = 0.5 * (y[3] * y[2] + y[4] * y[1] - y[5] * y[0])


def initial_state(case: Case) -> Floats:
    """Return the state at t = 0."""
    return np.array((*case.start, 1.0, 0.0, 0.0, 0.0) if case.attitude else case.start)


def answer(case: Case, states: Floats) -> Floats:
    """Return the part of the states, shape (n, k), that was asked for."""
    return states[:, 3:] if case.attitude else states


@cache
def array_function(case: Case) -> Callable[[float, Floats], Floats]:
    """Return a compiled function (t, y) -> y', an array, as SciPy wants it."""
    fill, n, c = _fill_with_attitude if case.attitude else _fill, 7 if case.attitude else 3, case.coefficients

    @njit
    def slope(t: float, y: Floats) -> Floats:
        out = np.empty(n)
        fill(y, c, out)
        return out

    return slope  # type: ignore[no-any-return]


@cache
def vector_field(attitude: bool) -> Any:
    """Return a compiled function (t, y, coefficients, y' to be filled in), as this project's integrators want it."""
    fill = _fill_with_attitude if attitude else _fill

    @njit(VECTOR_FIELD, error_model="numpy")
    def field(t: float, y: Floats, c: Floats, out: Floats) -> None:
        fill(y, c, out)

    return field


@cache
def c_function(attitude: bool) -> Any:
    """Return a C function (t, y, y' to be filled in, coefficients), as libraries of C and Fortran want it."""
    fill = _fill_with_attitude if attitude else _fill
    pointer = types.CPointer(types.double)

    @cfunc(types.void(types.double, pointer, pointer, pointer), error_model="numpy")
    def function(t: float, y: Any, out: Any, c: Any) -> None:
        fill(y, c, out)

    return function


@cache
def c_function_output_first(attitude: bool) -> Any:
    """Return a C function (y' to be filled in, t, y, coefficients), as CyRK wants it."""
    fill = _fill_with_attitude if attitude else _fill
    pointer = types.CPointer(types.double)

    @cfunc(types.void(pointer, types.double, pointer, pointer), error_model="numpy")
    def function(out: Any, t: float, y: Any, c: Any) -> None:
        fill(y, c, out)

    return function
