"""Tensors of described bodies against the principal moments that numpy finds."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.balls import precision
from core.errors import InvalidParameter
from core.multibody.algebra.polynomials import BITS
from core.multibody.language.body import SceneBody
from core.multibody.language.inertia import inertia_of
from core.multibody.language.numerals import Numerals


def read(tensor: Any) -> Any:
    with precision(BITS):
        return inertia_of("a", SceneBody(mass=1, at=(0, 0, 0), tensor=tensor), Numerals.of({}), 3)


def turned(moments: Any, seed: int) -> Any:
    axes, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    tensor = axes @ np.diag(moments) @ axes.T
    return ((tensor + tensor.T) / 2).tolist()


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("moments", [(1, 2, 3.001), (-0.01, 1, 1), (-1, 1, 3), (-1, -1, 2)])
def test_tensors_that_matter_cannot_have_are_refused_whatever_their_axes(moments: Any, seed: int) -> None:
    with pytest.raises(InvalidParameter, match="tensor must be") as fault:
        read(turned(moments, seed))
    assert fault.value.path == ("bodies", "a", "tensor")


def test_a_tensor_of_which_the_diagonal_alone_is_possible_is_refused() -> None:
    with pytest.raises(InvalidParameter, match="no principal moment exceeds"):
        read([[1, 2, 0], [2, 1, 0], [0, 0, 1]])


@pytest.mark.parametrize("scale", [1e-200, 1.0, 1e200])
@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("moments", [(1, 2, 3), (0, 1, 1), (1, 1, 1), (0.5, 0.6, 0.7)])
def test_plates_rods_and_balls_are_read_whatever_their_axes(moments: Any, seed: int, scale: float) -> None:
    read(turned(np.multiply(moments, scale), seed))
