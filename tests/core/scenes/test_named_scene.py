"""What all scenes share: numbers that no double holds, more digits where they cancel, refusals."""

from __future__ import annotations

from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest

from core.errors import AccuracyUnreachable, InvalidParameter
from core.scenes.chain_on_wedge import ChainOnWedge
from core.scenes.rod_in_hole import RodInHole
from core.scenes.unwinding_shafts import UnwindingShafts
from tests.core.scenes.oracles import relative

SHAFTS = UnwindingShafts((2.0, 3.0), (0.1, 0.2), (0.6, 0.9), 9.81, positions=(5.0, 5.0))
ROD = RodInHole(1.0, 1.0, 1.0, 9.81)


def test_a_number_that_no_double_holds_is_left_out_with_a_warning() -> None:
    answer = replace(ROD, mass=1e308, hole_radius=1e10, length=1e10).answer()
    assert answer.figures["energy"]["potential"] is None
    assert "outside-double-range" in {notice.code for notice in answer.warnings}
    assert answer.figures["period"] is not None
    tiny = replace(ROD, mass=1e-300, gravity=1e-20).answer(np.array([0.0, 1.0]))
    assert tiny.figures["forces_at_release"] == [None, None]
    assert tiny.trajectory is not None
    assert "forces" not in tiny.trajectory.columns


def test_cancellation_beyond_the_first_precision_is_met_with_more_digits() -> None:
    answer = replace(ROD, length=1e-250, inertia_factor=1e300).answer(
        outputs=frozenset({"contact", "equivalent_length"})
    )
    assert answer.accuracy.error <= 2.0**-52
    with mp.workdps(900):
        length = mp.mpf(1e-250)
        k = mp.sqrt(1 - length**2 / 4)
        assert relative(answer.figures["equivalent_length"], (k * k + mp.mpf(1e300) * length**2) / k) < 2e-16
    near = replace(SHAFTS, masses=(1e200, 1e-200), slopes=(0.3, 0.9)).answer(outputs=frozenset({"accelerations"}))
    with mp.workdps(900):
        a, b = (mp.mpf(9.81) * mp.sin(mp.mpf(s)) for s in (0.3, 0.9))
        M1, M2 = mp.mpf(1e200), mp.mpf(1e-200)
        tension = (a + b) * M1 * M2 / (3 * (M1 + M2))
        assert relative(near.figures["accelerations"][0], a - tension / M1) < 2e-16
        assert relative(near.figures["accelerations"][1], b - tension / M2) < 2e-16


def test_samples_beyond_the_range_of_doubles_are_refused() -> None:
    with pytest.raises(InvalidParameter, match="range of double"):
        SHAFTS.answer(np.array([1e200]))


def test_an_accuracy_that_cannot_be_had_is_refused_with_what_can() -> None:
    with pytest.raises(AccuracyUnreachable) as refusal:
        SHAFTS.answer(np.array([1.0]), accuracy=1e-18)
    assert 0 < refusal.value.achievable < 1e-13
    assert SHAFTS.answer(np.array([1.0]), accuracy=refusal.value.achievable).accuracy.how == "closed form"


def test_an_unsampled_chain_costs_no_samples() -> None:
    chain = ChainOnWedge((1.0, 2.0), (0.5, 0.6), 9.81, 3.0, 0.7, 1.0)
    assert chain.answer().work.samples == 0
    assert chain.answer(np.linspace(0, 100, 11)).work.samples < 11


def test_errors_of_figures_bound_the_distance_from_closed_forms() -> None:
    """At 50 digits: Atwood's machine with a heavy string, the pendulum's quadrature, two unwinding cylinders."""
    chain = ChainOnWedge((1.0, 1.2), (0.6, 0.8), 9.81, 2.0, 0.5, 0.7).answer()
    shafts = replace(SHAFTS, wound=(0.5, 0.8)).answer()
    rod = ROD.answer()
    with mp.workdps(50):
        a, b = (mp.mpf(9.81) * mp.sin(mp.mpf(slope)) for slope in (0.6, 0.8))
        mass = mp.mpf(1.0) + mp.mpf(1.2) + mp.mpf(1.0)
        x = mp.mpf(0.7)
        pull = (1 + x / 2) * a - (mp.mpf(1.2) + (2 - x) / 2) * b
        depth = mp.sqrt(mp.mpf(3)) / 2
        length = (depth**2 + mp.mpf(1 / 12)) / depth
        g1, g2 = (mp.mpf(9.81) * mp.sin(mp.mpf(slope)) for slope in (0.6, 0.9))
        tension = (g1 + g2) / (3 * (mp.mpf(1) / 2 + mp.mpf(1) / 3))
        exact = [
            (chain, "acceleration", pull / mass),
            (chain, "growth_rate", mp.sqrt((a + b) / 2 / mass)),
            (rod, "equivalent_length", length),
            (rod, "angular_velocity_at_horizontal", mp.sqrt(mp.mpf(9.81) / length)),
            (rod, "period", 4 * mp.sqrt(length / mp.mpf(9.81)) * mp.ellipk(mp.mpf(1) / 4)),
            (shafts, "tension", tension),
        ]
        for answer, name, value in exact:
            distance = abs(mp.mpf(answer.figures[name]) - value)
            assert distance <= mp.mpf(answer.errors[name]) <= distance + 2.0**-60, name


def test_every_figure_that_is_a_number_states_its_error() -> None:
    answer = replace(SHAFTS, wound=(0.5, 0.8)).answer(np.array([2.0]))
    objects = {"energy", "phases", "events"}
    assert set(answer.errors) == set(answer.figures) - objects
    assert answer.errors["friction_forces"] is None
    assert np.shape(answer.errors["accelerations"]) == (2,)
    assert set(answer.figures["energy"]["errors"]) == {"kinetic", "potential", "total"}
    assert all(set(phase["errors"]) == {"start", "end", "impulse", "dissipated"} for phase in answer.figures["phases"])
    assert all(event["error"] >= 0.0 for event in answer.figures["events"])
    lift_off = ChainOnWedge((1.0, 1.2), (0.6, 0.8), 9.81, 2.0, 0.5, 0.7).answer().figures["lift_off"]
    assert lift_off == {"occurs": False, "time": None, "error": None}
