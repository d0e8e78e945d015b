"""Eight doubles at a time, against each of them alone."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.compiled import fma, kernel
from core.double_double import dd_add, dd_mul
from core.lanes import WIDTH, alike, lanes_at, put_lanes

eights = st.lists(st.floats(-1e50, 1e50), min_size=WIDTH, max_size=WIDTH).map(np.array)


@kernel()
def _eight(a, b, out):
    x, y = lanes_at(a, 0), lanes_at(b, 0)
    for k, value in enumerate((x + y, x - y, x * y, x / alike(3.0), -x, fma(x, y, alike(-1.0)))):
        put_lanes(out, WIDTH * k, value)
    ph, pl = dd_mul(x, alike(1e-20), y, x)
    sh, sl = dd_add(ph, pl, x, y)
    put_lanes(out, 6 * WIDTH, sh)
    put_lanes(out, 7 * WIDTH, sl)


@kernel()
def _each(a, b, out):
    for i in range(WIDTH):
        x, y = a[i], b[i]
        out[0, i], out[1, i], out[2, i], out[3, i], out[4, i] = x + y, x - y, x * y, x / 3.0, -x
        out[5, i] = fma(x, y, -1.0)
        ph, pl = dd_mul(x, 1e-20, y, x)
        out[6, i], out[7, i] = dd_add(ph, pl, x, y)


@kernel()
def _of_every_second(a, out):
    put_lanes(out, 0, lanes_at(a, 0))


@given(eights, eights)
def test_eight_at_a_time_have_the_digits_of_each_alone(a: np.ndarray, b: np.ndarray) -> None:
    eight, each = np.empty((8, WIDTH)), np.empty((8, WIDTH))
    _eight(a, b, eight)
    _each(a, b, each)
    np.testing.assert_array_equal(eight, each)


def test_lanes_are_read_from_contiguous_arrays_alone() -> None:
    with pytest.raises(TypeError, match="contiguous"):
        _of_every_second(np.zeros(2 * WIDTH)[::2], np.zeros(WIDTH))
