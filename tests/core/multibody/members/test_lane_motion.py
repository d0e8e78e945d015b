"""Lanes in which one member after another is followed."""

from __future__ import annotations

import numpy as np
import pytest

from core.arrays import Floats, Integers
from core.balls import precision
from core.multibody.algebra.polynomials import BITS
from core.multibody.language.reading import scene_from
from core.multibody.members.lane_doubles import follow_in_doubles
from core.multibody.members.lane_motion import Follow
from core.multibody.members.lane_pairs import follow_in_pairs
from core.multibody.members.lane_table import LaneForm
from core.multibody.members.plan import Plans
from core.multibody.members.recorded_balls import Varied
from tests.core.multibody.members.scenes import double_pendulum, with_numbers

PLACES = (("let", "a"), ("let", "b"))
MEMBERS = 20
RUNS = [(follow_in_doubles, 24, 2.0**-56), (follow_in_pairs, 28, 2.0**-72)]


@pytest.fixture(scope="module")
def tables() -> tuple[LaneForm, Floats]:
    """Return the form of the tables of double pendulums, and the numbers of some."""
    plans = Plans(scene_from(with_numbers(double_pendulum(), PLACES, [Varied(), Varied()])), PLACES)
    rows = []
    with precision(BITS):
        for k in range(MEMBERS):
            found = plans.of([0.5 + 2.0**-5 * k, 1.0])
            assert found is not None
            _, setup, outputs = found
            rows.append(setup.numbers.filled(np.array([outputs]))[0])
    return setup.form, np.array(rows)


def ran(follow: Follow, order: int, tolerance: float, form: LaneForm, rows: Floats) -> tuple[Floats, Integers]:
    """Return where members are in the end, and who reached it."""
    count = len(rows)
    times = np.full((count, 1), 2.0)
    q, v, reached = np.zeros((count, 1, form.n, 2)), np.zeros((count, 1, form.n, 2)), np.zeros(count, dtype=np.int64)
    seen, turns = np.zeros((count, 0, 2, form.n + 1)), np.zeros((count, 1, 0), dtype=np.int64)
    follow(form, rows, times[:, 0].copy(), order, tolerance, times, seen, q, v, turns, reached)
    return q, reached


@pytest.mark.parametrize(("follow", "order", "tolerance"), RUNS)
def test_what_has_no_inverse_takes_nothing_from_the_member_after_it(
    follow: Follow, order: int, tolerance: float, tables: tuple[LaneForm, Floats]
) -> None:
    """Bodies without a mass, in every lane: what is left of them in a lane is no number."""
    form, rows = tables
    sound, _ = ran(follow, order, tolerance, form, rows)
    broken = rows.copy()
    lost = np.arange(MEMBERS) < 12
    broken[lost, form.mass : form.load] = 0.0
    found, reached = ran(follow, order, tolerance, form, broken)
    assert reached.tolist() == (~lost).astype(int).tolist()
    assert np.array_equal(found[~lost], sound[~lost])
