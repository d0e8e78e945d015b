"""Rows give the same array and the same refusal for an array as for the list of its entries."""

from typing import Any

import numpy as np
import pytest

from core.errors import InvalidParameter
from core.quantities import Quantity
from core.rows import Rows

PLACES = Rows(3, Quantity("m"), at_most=4)
MASSES = Rows(0, Quantity("kg", above=0))
INDICES = Rows(3, Quantity("1", at_least=0), whole=True)


@pytest.mark.parametrize(
    ("rows", "array"),
    [
        (PLACES, np.arange(6.0).reshape(2, 3)),
        (PLACES, np.asfortranarray(np.arange(9.0).reshape(3, 3))),
        (PLACES, np.arange(6, dtype=np.int64).reshape(2, 3)),
        (PLACES, np.arange(6, dtype=np.float32).reshape(2, 3) / 3),
        (MASSES, np.array([0.5, 2.0])),
        (INDICES, np.arange(6, dtype=np.uint8).reshape(2, 3)),
    ],
)
def test_an_array_is_stored_as_a_copy_equal_to_its_list(rows: Rows, array: Any) -> None:
    kept, listed = rows.read((), array), rows.read((), array.tolist())
    assert (kept.dtype, kept.shape, kept.tobytes()) == (listed.dtype, listed.shape, listed.tobytes())
    assert kept.flags.c_contiguous
    assert not kept.flags.writeable
    assert not np.shares_memory(kept, array)


@pytest.mark.parametrize(
    ("rows", "array"),
    [
        (PLACES, np.zeros((2, 2))),
        (PLACES, np.zeros(3)),
        (PLACES, np.zeros((5, 3))),
        (PLACES, np.zeros((0, 3))),
        (PLACES, np.array([[0.0, 1.0, 2.0], [0.0, np.nan, 2.0]])),
        (PLACES, np.array([[0.0, 1.0, 2.0], [0.0, 1.0, np.inf]])),
        (PLACES, np.array([[True, False, True]])),
        (PLACES, np.array([["1", "2", "3"]])),
        (PLACES, np.array([[1j, 0, 0]])),
        (MASSES, np.array([1.0, 0.0])),
        (MASSES, np.ones((2, 3))),
        (INDICES, np.array([[0, 1, -1]])),
        (INDICES, np.array([[0.0, 1.0, 2.0]])),
        (INDICES, np.array([[0, 1, 2**63]], dtype=np.uint64)),
    ],
)
def test_an_array_is_refused_as_its_list_is(rows: Rows, array: Any) -> None:
    with pytest.raises(InvalidParameter) as kept:
        rows.read(("x",), array)
    with pytest.raises(InvalidParameter) as listed:
        rows.read(("x",), array.tolist())
    assert (kept.value.path, kept.value.rule) == (listed.value.path, listed.value.rule)


def test_a_number_is_no_list() -> None:
    with pytest.raises(InvalidParameter, match="be a list"):
        PLACES.read(("x",), np.array(1.0))
