"""Designs: members are a function of design and seed, whatever the stretches in which they are asked for."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import kstest, qmc

from core.errors import InvalidParameter
from core.studies.designs import BLOCK, MOST_MEMBERS, Design
from core.studies.study_input import StudyInput

A = StudyInput(pointer="/a", min=0.0, max=1.0, count=3)
B = StudyInput(pointer="/b", values=(10.0, 20.0))
U = StudyInput(pointer="/u", min=0.0, max=1.0)
V = StudyInput(pointer="/v", min=0.0, max=1.0)

DESIGNS = (
    Design(
        (StudyInput(pointer="/a", min=0.0, max=1.0, count=131), StudyInput(pointer="/b", min=0.0, max=1.0, count=97))
    ),
    Design((StudyInput(pointer="/a", min=0.0, max=1.0, count=10_000),), "zip"),
    Design((U, V), "random", 3 * BLOCK - 100, 7),
    Design((U, V), "sobol", 10_000, 7),
)


def test_a_product_has_every_combination_the_last_input_varying_fastest() -> None:
    design = Design((A, B))
    assert (design.shape, design.members) == ((3, 2), 6)
    assert design.numbers(0, 6).tolist() == [list(row) for row in product((0.0, 0.5, 1.0), (0.0, 1.0))]
    assert design.levels(0).tolist() == [0.0, 0.5, 1.0]


def test_zip_takes_levels_side_by_side() -> None:
    design = Design((A, StudyInput(pointer="/c", min=5.0, max=7.0, count=3)), "zip")
    assert design.numbers(0, 3).tolist() == [[0.0, 5.0], [0.5, 6.0], [1.0, 7.0]]


@pytest.mark.parametrize("design", DESIGNS, ids=lambda design: design.kind)
@given(data=st.data())
@settings(max_examples=10, deadline=None)
def test_any_stretch_has_the_members_of_the_whole(design: Design, data: Any) -> None:
    start = data.draw(st.integers(0, design.members - 1))
    stop = data.draw(st.integers(start + 1, min(design.members, start + 5000)))
    whole = design.numbers(0, design.members)
    assert design.numbers(start, stop).tobytes() == whole[start:stop].tobytes()


def test_seeds_give_other_members_and_equal_seeds_the_same() -> None:
    first, again, other = (Design((U, V), "random", 100, seed).numbers(0, 100) for seed in (1, 1, 2))
    assert first.tobytes() == again.tobytes()
    assert not (first == other).any()


def test_random_members_are_independent_and_uniform() -> None:
    """Kolmogorov-Smirnov of each input, and the correlation of neighbours, at three deviations."""
    drawn = Design((U, V), "random", 3 * BLOCK, 5).numbers(0, 3 * BLOCK)
    assert kstest(drawn[:, 0], "uniform").pvalue > 1e-3
    assert kstest(drawn[:, 1], "uniform").pvalue > 1e-3
    most = 3.0 / np.sqrt(len(drawn))
    assert abs(np.corrcoef(drawn[:, 0], drawn[:, 1])[0, 1]) < most
    assert abs(np.corrcoef(drawn[1:, 0], drawn[:-1, 0])[0, 1]) < most


def test_sobol_points_fill_the_square_better_than_random_ones() -> None:
    points, drawn = (Design((U, V), kind, 1024, 3).numbers(0, 1024) for kind in ("sobol", "random"))
    assert qmc.discrepancy(points) < 0.1 * qmc.discrepancy(drawn)


@pytest.mark.parametrize(
    ("arguments", "path"),
    [
        (((A, U),), ("vary", 1, "count")),
        (((A, B), "zip"), ("vary", 1)),
        (((A, B), "product", 5), ("count",)),
        (((A, B), "product", None, 0), ("seed",)),
        (((U,), "random"), ("count",)),
        (((A,), "random", 5), ("vary", 0, "count")),
        (((U,), "sobol", MOST_MEMBERS + 1), ("count",)),
        (((StudyInput(pointer="/a", min=0.0, max=1.0, count=1_000_000),) * 20,), ("vary",)),
    ],
)
def test_inputs_that_do_not_fit_the_design_are_refused(arguments: Any, path: Any) -> None:
    with pytest.raises(InvalidParameter) as fault:
        Design(*arguments)
    assert fault.value.path == path
