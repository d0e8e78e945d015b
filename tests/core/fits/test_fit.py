"""Fits against certified values, linear theory and data made with known numbers."""

from __future__ import annotations

import json
import sys
from typing import Any

import numpy as np
import pytest
from scipy.stats import binom

from core.errors import InvalidParameter, MechanicsError, NotApplicable
from core.fits.comparison import compared
from core.fits.fit import Data, Fit, fit
from core.fits.losses import Robust
from core.fits.observations import Measured
from core.fits.unknowns import Nuisance, Prior, Unknown
from core.fits.wording import combination
from tests.core.fits.sources import BODIES, DECAY, THROW, column, data, source

TIMES = np.linspace(0.0, 1.0, 21)
TRUE = {"g": 9.81, "v": 4.0, "h": 0.5}
THREE = [Unknown("/let/g"), Unknown("/let/v"), Unknown("/let/h")]


def thrown(seed: int, deviation: float = 0.02) -> Any:
    exact = TRUE["h"] + TRUE["v"] * TIMES - 0.5 * TRUE["g"] * TIMES**2
    return exact + deviation * np.random.default_rng(seed).normal(size=len(TIMES))


def fitted(seed: int, unknown: list[Unknown] | None = None, deviation: float | None = 0.02, **more: Any) -> Fit:
    return fit(source(), THROW, data(TIMES, deviation, y=thrown(seed)), unknown or THREE, **more)


# NIST Statistical Reference Datasets, nonlinear regression (public domain), Misra1a and BoxBOD:
# y = b1 (1 - exp(-b2 x)), each from its first, distant start; certified values, their standard deviations, and the
# residual sum of squares.
MISRA = (
    [77.6, 114.9, 141.1, 190.8, 239.9, 289.0, 332.8, 378.4, 434.8, 477.3, 536.8, 593.1, 689.1, 760.0],
    [10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02, 44.82, 50.76, 55.05, 61.01, 66.40, 75.47, 81.78],
)
BOX = ([1.0, 2.0, 3.0, 5.0, 7.0, 10.0], [109.0, 149.0, 149.0, 191.0, 213.0, 224.0])


@pytest.mark.parametrize(
    ("rows", "start", "values", "errors", "squares"),
    [
        (MISRA, (500.0, 1e-4), (238.94212918, 5.5015643181e-4), (2.7070075241, 7.2668688436e-6), 0.12455138894),
        (BOX, (1.0, 1.0), (213.80940889, 0.54723748542), (12.354515176, 0.10455993237), 1168.0088766),
    ],
)
def test_certified_values(rows: Any, start: Any, values: Any, errors: Any, squares: float) -> None:
    times, seen = map(np.array, rows)
    unknown = [Unknown("/let/b1", start=start[0]), Unknown("/let/b2", start=start[1])]
    found = fit(source(), DECAY, data(times, figures={"y": "p.position.x"}, y=seen), unknown)
    known = found.statistics
    assert np.all(np.abs(found.values - values) <= known.model_error)
    assert known.model_error == pytest.approx(np.zeros(2), abs=2e-5 * np.array(errors)[0])
    assert known.standard_errors == pytest.approx(np.array(errors), rel=1e-6)
    assert known.chi_squared == pytest.approx(squares, rel=1e-9)
    assert known.probability is None
    assert known.deviation**2 == pytest.approx(squares / known.degrees_of_freedom, rel=1e-9)


def test_a_linear_question_is_linear_least_squares() -> None:
    found, design = fitted(1), np.stack([-0.5 * TIMES**2, TIMES, np.ones_like(TIMES)], axis=1) / 0.02
    covariance = np.linalg.inv(design.T @ design)
    assert found.values == pytest.approx(covariance @ design.T @ thrown(1) / 0.02, rel=1e-8)
    assert found.statistics.covariance == pytest.approx(covariance, rel=1e-6)
    assert found.statistics.degrees_of_freedom == 18
    assert found.residuals[:, 0] @ found.residuals[:, 0] / 0.02**2 == pytest.approx(found.statistics.chi_squared)
    # Starting at 1000 times the value leads to the same.
    assert fitted(1, [Unknown("/let/g", start=1e4), *THREE[1:]]).values == pytest.approx(found.values, rel=1e-7)


TOP: dict[str, Any] = {
    "body": {"kind": "principal-moments", "moments": [1.0, 1.0, 1.2]},
    "angular_velocity": [1.0, 0.0, 10.0],
    "times": [0.0],
}
"""A symmetric body: its angular velocity turns about its axis, w = (cos k t, sin k t, 10) with k = 10 (C - 1)."""
RATE = [Unknown("/body/moments/2")]


def turned(times: Any, rate: float, seed: int, deviation: float) -> Data:
    noise = deviation * np.random.default_rng(seed).normal(size=(2, len(times)))
    columns = {"x": np.cos(rate * times) + noise[0], "y": np.sin(rate * times) + noise[1]}
    return data(times, deviation, {"x": "angular_velocity.x", "y": "angular_velocity.y"}, **columns)


def test_intervals_hold_the_true_numbers_as_often_as_they_say() -> None:
    # A few dozen sets; a thousand are run by benchmarks/coverage_of_fits.py.
    asked, within, sets = source(BODIES), np.zeros(2), 40
    for seed in range(sets):
        unknown = [*RATE, Unknown("/angular_velocity/0"), Unknown("/angular_velocity/1")]
        found = fit(asked, TOP, turned(TIMES, 2.1, seed, 0.05), unknown)
        away = np.abs(found.values - [1.21, 1.0, 0.0])
        within += [np.mean(away <= found.statistics.standard_errors), np.mean(away <= found.statistics.half_widths)]
    for share, count in zip((0.6827, 0.95), within, strict=True):
        low, high = binom.interval(0.999, sets, share)
        assert low <= count <= high


def test_a_prior_counts_as_one_measurement() -> None:
    prior = Prior(9.81, 0.001)
    found = fitted(2, [Unknown("/let/g", prior=prior), *THREE[1:]])
    free = fitted(2)
    assert abs(found.values[0] - 9.81) < 0.002
    assert found.statistics.standard_errors[0] == pytest.approx(0.001, rel=1e-2)
    assert found.statistics.degrees_of_freedom == free.statistics.degrees_of_freedom + 1


def test_what_the_data_do_not_determine_is_named() -> None:
    found = fitted(3, [*THREE, Unknown("/bodies/p/mass")])
    assert found.statistics.determined.tolist() == [True, True, True, False]
    (lost,) = found.statistics.undetermined
    assert lost.uncertainty is None
    assert "/bodies/p/mass by +1 % changes nothing" in combination(lost, found.names)
    assert found.statistics.standard_errors[:3] == pytest.approx(fitted(3).statistics.standard_errors, rel=1e-5)
    # Moments of inertia of a free body: their ratios alone.
    body = {"kind": "principal-moments", "moments": [3.0, 2.0, 1.5]}
    request: dict[str, Any] = {"body": body, "angular_velocity": [0.3, 2.0, 0.1], "times": [0.0]}
    seen = np.array(source(BODIES).answer(json.dumps(request | {"times": TIMES.tolist()}))["angular_velocity"])
    columns = {name: seen[:, k] for k, name in enumerate("xyz")}
    figures = {name: f"angular_velocity.{name}" for name in "xyz"}
    moments = [Unknown(f"/body/moments/{k}", start=1.1 * body["moments"][k]) for k in range(3)]  # type: ignore[operator]
    found = fit(source(BODIES), request, data(TIMES, 0.01, figures, **columns), moments)
    (ratio,) = found.statistics.undetermined
    assert ratio.direction == pytest.approx(np.ones(3), rel=1e-5)
    assert not found.statistics.determined.any()
    assert found.values / found.values[0] == pytest.approx(np.array([3.0, 2.0, 1.5]) / 3.0, rel=1e-6)


def test_a_combination_that_is_known_poorly_is_told_with_its_error() -> None:
    late = fit(source(), THROW, data(TIMES[:3], 5.0, y=thrown(4)[:3]), [Unknown("/let/g")])
    (poor,) = late.statistics.undetermined
    assert poor.uncertainty is not None
    assert poor.uncertainty > 1.0
    assert "not told from none" in combination(poor, late.names)


def test_outliers_count_little_under_a_robust_loss() -> None:
    seen = thrown(5)
    seen[[4, 11]] += [1.0, -0.6]
    plain, cauchy = (
        fit(source(), THROW, data(TIMES, 0.02, y=seen), THREE, robust=one) for one in (None, Robust("cauchy"))
    )
    truth = np.array(list(TRUE.values()))
    assert {4, 11} <= set(cauchy.statistics.outliers)
    assert len(cauchy.statistics.outliers) == 2
    assert np.all(np.abs(cauchy.values - truth) < 4.0 * cauchy.statistics.standard_errors)
    assert np.any(np.abs(plain.values - truth) > 4.0 * plain.statistics.standard_errors)
    assert plain.statistics.probability == pytest.approx(0.0, abs=1e-12)


def test_further_unknowns_have_to_earn_their_place() -> None:
    first = fitted(6)
    no_height = fitted(6, THREE[:2])
    with_mass = fitted(6, [*THREE, Unknown("/bodies/p/mass")])
    found = compared(first, no_height)
    assert found.earns
    assert "further unknown of the first question" in found.why
    assert not compared(first, with_mass).earns
    estimated = compared(fitted(6, deviation=None), fitted(6, THREE[:2], deviation=None))
    assert estimated.earns


def test_a_frequency_is_found_across_its_many_minima() -> None:
    times = np.linspace(0.0, 20.0, 81)
    asked = turned(times, 5.0, 8, 0.02)
    by_ranges = fit(source(BODIES), TOP, asked, [Unknown("/body/moments/2", between=(1.05, 1.95))])
    by_early_rows = fit(source(BODIES), TOP, asked, [Unknown("/body/moments/2", start=1.35)])
    for found in (by_ranges, by_early_rows):
        assert abs(found.values[0] - 1.5) < 5.0 * found.statistics.standard_errors[0]
        assert found.statistics.probability is not None
        assert found.statistics.probability > 1e-3
    assert not by_ranges.at_ends
    beside = fit(source(BODIES), TOP, asked, [Unknown("/body/moments/2", between=(1.505, 1.51))])
    assert beside.at_ends == ("/body/moments/2",)
    assert beside.values[0] == pytest.approx(1.505, abs=1e-8)


def test_the_instrument_is_found_with_the_motion() -> None:
    times = np.linspace(0.2, 1.2, 40)
    place = column(THROW, times + 0.1, "p.position", TRUE)
    cosine, sine = np.cos(0.05), np.sin(0.05)
    seen = place @ np.array([[cosine, sine], [-sine, cosine]]).T
    noise = 0.002 * np.random.default_rng(9).normal(size=(2, 40))
    columns = {"x": 1.5 * seen[:, 0] + noise[0], "y": 1.5 * seen[:, 1] + noise[1] + 0.3}
    figures = {"x": "p.position.x", "y": "p.position.y"}
    nuisance = [Nuisance("offset", "y"), Nuisance("frame", ("x", "y")), Nuisance("scale", ("y", "x"))]
    nuisance.append(Nuisance("time shift", ("x", "y")))
    request = THROW | {"let": TRUE}
    found = fit(source(), request, data(times, 0.002, figures, **columns), [Unknown("/let/v", start=3.0)], nuisance)
    assert found.names[1:] == ("/nuisance/0", "/nuisance/1", "/nuisance/2", "/nuisance/3")
    away = np.abs(found.values - [4.0, 0.3, 0.05, 1.5, 0.1])
    assert np.all(away <= 4.0 * found.statistics.standard_errors)
    assert np.all(found.statistics.standard_errors < 0.05)


def test_the_errors_of_a_coarse_method_count_in() -> None:
    request = THROW | {"method": {"kind": "explicit-euler", "step": 0.1}}
    found = fit(source(), request, data(TIMES, 0.02, y=thrown(10)), THREE)
    exact = fitted(10)
    away = np.abs(found.values - exact.values)
    assert np.all(away <= found.statistics.model_error + exact.statistics.model_error)
    assert np.any(away > 3.0 * exact.statistics.standard_errors)
    assert np.all(found.statistics.half_widths >= found.statistics.model_error)


@pytest.mark.parametrize(
    ("unknown", "path"),
    [
        ([Unknown("/let/q")], ("unknown", 0, "pointer")),
        ([Unknown("/let/g"), Unknown("/let/g")], ("unknown", 1, "pointer")),
        ([Unknown("/gravity/1")], ("unknown", 0, "start")),
        ([Unknown("/bodies")], ("unknown", 0, "pointer")),
        ([Unknown(f"/let/{name}") for name in "gvh"], ("data", "columns")),
    ],
)
def test_what_cannot_be_found_is_refused(unknown: list[Unknown], path: tuple[Any, ...]) -> None:
    with pytest.raises(InvalidParameter) as refusal:
        fit(source(), THROW, data(TIMES[:2], 0.1, y=thrown(1)[:2]), unknown)
    assert refusal.value.path == path


def test_without_scipy_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "scipy.optimize", None)
    with pytest.raises(NotApplicable) as refusal:
        fitted(1)
    assert "polhode[scipy]" in str(refusal.value.remedy)


def test_data_in_any_order_and_figures_that_a_request_rounds() -> None:
    order = np.random.default_rng(0).permutation(len(TIMES))
    shuffled = fit(source(), THROW | {"round": 3}, data(TIMES[order], 0.02, y=thrown(1)[order]), THREE)
    assert shuffled.values == pytest.approx(fitted(1).values, rel=1e-9)
    twice = np.concatenate([TIMES, TIMES])
    doubled = fit(source(), THROW, data(twice, 0.02, y=np.concatenate([thrown(1), thrown(1)])), THREE)
    assert doubled.values == pytest.approx(shuffled.values, rel=1e-9)
    assert doubled.statistics.standard_errors == pytest.approx(
        shuffled.statistics.standard_errors / np.sqrt(2), rel=1e-6
    )


def test_figures_without_times_and_questions_without_answers() -> None:
    pendulum = {
        "gravity": [0, "-g"],
        "let": {"g": 9.0},
        "bodies": {"p": {"mass": 1, "at": [0.6, -0.8]}},
        "connections": [{"kind": "rod", "a": "p", "b": [0, 0]}],
    }
    measured = Measured({"T": [2.13, None, 2.11, 2.12]}, None, ("T",), {"T": 0.01}, {})
    found = fit(source(), pendulum, Data(measured, {"T": "/period"}), [Unknown("/let/g")])
    # The period at 0.6435 rad is 2 pi sqrt(1/g) 1.02647 (a complete elliptic integral).
    assert found.values[0] == pytest.approx((2.0 * np.pi * 1.0265 / 2.12) ** 2, rel=1e-3)
    assert found.data.left_out == [1]
    with pytest.raises(MechanicsError):
        fit(source(), pendulum, Data(measured, {"T": "/period"}), [Unknown("/bodies/p/mass", start=-1.0)])
