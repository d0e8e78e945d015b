"""Forces that keep their value for all the time of a motion with constant accelerations."""

from __future__ import annotations

import numpy as np
import pytest
from flint import arb

from core.balls import precision
from core.multibody.algebra.polynomials import BITS, ONE, ZERO
from core.multibody.equations.expansion import Expansion
from core.multibody.language.reading import scene_from
from core.multibody.motion.modelling import modelled
from core.multibody.phases.smooth_motion import smooth_motion
from core.multibody.phases.uniform_pieces import steady_forces
from core.multibody.solve import solve_scene
from core.multibody.table.connection_effects import Force
from core.multibody.table.table import Row, Table

WEIGHTS = {
    "gravity": [0, -10],
    "bodies": {"left": {"mass": 1, "at": [0, "1/3"]}, "right": {"mass": 3, "at": [1, 1]}},
    "connections": [{"kind": "string", "through": ["left", [0, 3], [1, 3], "right"]}],
}


def test_the_tension_of_a_string_that_is_drawn_in_straight_is_steady() -> None:
    # The multiplier of a part of the string is the tension over its length, and changes.
    scene = scene_from(WEIGHTS)
    with precision(BITS):
        phase = smooth_motion(modelled(scene), np.array([0.25])).phases[0]
        measures = phase.models[0].described.measures
        steady = steady_forces(measures.table, phase.exact_motions[0], measures.forces)
    assert [force.name for force in measures.forces] == ["string-1.tension"]
    assert steady == [True]
    assert not phase.constant_forces
    tensions = solve_scene(scene, [0.0, 0.1, 0.2], ["forces-in-time"]).trajectory
    assert tensions is not None
    # 2 m M g/(m + M) of Atwood's machine.
    assert tensions.columns["string-1.tension"].values == pytest.approx(15.0, rel=1e-14)


@pytest.mark.parametrize("pulled", [True, False])
def test_what_holds_a_body_is_steady_unless_what_pulls_it_moves(pulled: bool) -> None:
    # The second coordinate is held at zero, and a spring pulls it by as much as the first one has moved.
    table = Table(["x", "y"], ["m", "m"], {(0, 0): ONE, (1, 1): ONE}, rows=[Row.held("wall", {(1,): ONE})])
    table.q, table.v = [arb(2), ZERO], [ONE, ZERO]
    if pulled:
        table.add_stiffness(1, 0, arb(5))
    else:
        table.add_load(1, arb(-10))
    motion = Expansion(
        [[*both, ZERO, ZERO, ZERO] for both in zip(table.q, table.v, strict=True)], [[arb(10), ZERO, ZERO]]
    )
    assert steady_forces(table, motion, [Force("wall", "N", [(0, {(): ONE})])]) == [not pulled]
    # What depends on the place by itself is not steady.
    assert steady_forces(table, motion, [Force("spring", "N", of_state={(0,): arb(5)})]) == [False]
