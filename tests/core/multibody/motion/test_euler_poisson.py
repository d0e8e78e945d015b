from __future__ import annotations

import numpy as np
import pytest

from core.balls import precision
from core.multibody.algebra.polynomials import BITS
from core.multibody.motion.euler_poisson import EulerPoisson
from core.multibody.motion.modelling import modelled
from core.multibody.solve import solve_scene
from tests.core.multibody.judge import judged, numerical
from tests.core.multibody.random_scenes import top
from tests.core.multibody.worked_examples import column, read


@pytest.mark.parametrize("seed", range(12))
def test_the_motion_is_that_of_the_table_in_pairs(seed):
    """The table has nine direction cosines under six measures, here with a series of order 40."""
    description = top(np.random.default_rng(seed), symmetric=False)
    with precision(BITS):
        ((_, motion),) = modelled(read(description)).whole.parts
        assert isinstance(motion, EulerPoisson)
        (table,) = numerical(description)
        for t in np.random.default_rng(seed).uniform(-2, 2, 2):
            q, v = judged(table, float(t))
            for finer, rounding, least in ((False, 2.0**-66, 1e-17), (True, 2.0**-90, 1e-23)):
                found = motion.states(np.array([t]), finer=finer)
                for value, error, right in ((found.q, found.q_error, q), (found.v, found.v_error, v)):
                    true = np.abs((value[0, :, 0] - right[:, 0]) + (value[0, :, 1] - right[:, 1]))
                    size = np.abs(right[:, 0]).max()
                    assert np.all(true <= 1.02 * error[0] + rounding * size), (seed, t, finer, true, error)
                    assert np.all(true <= least * size)


def test_at_the_start_it_has_the_velocity_that_is_given():
    description = top(np.random.default_rng(1), symmetric=False)
    answer = solve_scene(read(description), [0.0])
    assert column(answer, "top.angular_velocity").values[0] == pytest.approx(
        description["bodies"]["top"]["angular_velocity"], rel=1e-15
    )


def test_backwards_from_later_leads_to_the_start():
    description = top(np.random.default_rng(3), symmetric=False)
    first = solve_scene(read(description), [-1.5, 1.5], ["trajectory", "energy", "energy-in-time"])
    energy = column(first, "energy.kinetic").values + column(first, "energy.potential").values
    assert energy == pytest.approx(first.energy.total, rel=1e-14)
    assert first.trajectory.accuracy.error < 1e-14
