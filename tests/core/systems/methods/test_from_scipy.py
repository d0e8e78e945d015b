"""SciPy's methods: in units of the motion, within the budget, failing aloud."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

from core.errors import BudgetExceeded, InvalidParameter, NotApplicable
from core.systems.budget import Budget
from core.systems.methods import Lsoda, Radau
from core.work import WorkLimitReached, work_limit
from core.work_precision import default_methods
from service.routes.catalogues import methods
from tests.core.systems.systems import counting, explosion, oscillator, stiff


@pytest.mark.parametrize("method", [Lsoda, Radau])
def test_the_budget_ends_a_run(method: type) -> None:
    system = counting()
    with pytest.raises(BudgetExceeded) as refused:
        method(1e-8).integrate(system, np.array([100.0]), Budget(evaluations=500))
    # One more evaluation is made beforehand, to see that the start is in range.
    assert system.parameters[0] <= 501
    assert refused.value.needed > 500


@pytest.mark.parametrize("method", [Lsoda, Radau])
def test_a_stiff_motion_takes_few_steps(method: type) -> None:
    system, times = stiff(1e6), np.linspace(0, 10, 11)
    run = method(1e-6).integrate(system, times)
    # Inside its longest steps Radau's interpolant of order three is off, as it is in SciPy itself.
    assert np.abs(run.states - system.exact.sample(times))[-1] < 1e-5
    assert run.work.evaluations < 3000


@pytest.mark.parametrize("method", [Lsoda, Radau])
def test_a_solution_that_ceases_to_exist_is_reported(method: type) -> None:
    with pytest.raises((InvalidParameter, BudgetExceeded)):
        method(1e-8).integrate(explosion(), np.array([2.0]), Budget(evaluations=100_000))


@pytest.mark.parametrize("method", [Lsoda, Radau])
@pytest.mark.parametrize("rate", [1e-140, 1e-3, 1e140])
def test_the_unit_of_time_changes_no_evaluation(method: type, rate: float) -> None:
    # A power of two, so that the numbers are the same but for their exponents.
    unit = 2.0 ** np.round(np.log2(rate))
    one = method(1e-6).integrate(oscillator(), np.linspace(0, 16, 9))
    other = method(1e-6).integrate(oscillator(rate=unit, velocity=0.0), np.linspace(0, 16, 9) / unit)
    assert other.states[:, 0] == pytest.approx(one.states[:, 0], abs=1e-3)


def test_a_tolerance_that_scipy_would_raise_silently_is_refused() -> None:
    with pytest.raises(InvalidParameter, match="tolerance must be at least"):
        Lsoda(1e-15)


def test_scipy_is_not_imported_before_it_is_needed() -> None:
    code = "import sys, core.systems.solve; sys.exit('scipy.integrate' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


@pytest.fixture
def no_scipy(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [name for name in sys.modules if name.split(".")[0] == "scipy"] + ["scipy", "scipy.integrate"]:
        monkeypatch.setitem(sys.modules, name, None)


@pytest.mark.usefixtures("no_scipy")
def test_without_scipy_its_methods_are_refused_and_not_listed() -> None:
    with pytest.raises(NotApplicable, match="SciPy is not installed") as refused:
        Lsoda(1e-6).integrate(oscillator(), np.array([1.0]))
    assert (refused.value.path, refused.value.remedy) == (
        ("kind",),
        "install polhode[scipy], or use dormand-prince-853",
    )
    assert not Radau.is_installed()
    listed = {entry["kind"] for entry in methods()}
    assert "dormand-prince-853" in listed
    assert not {"lsoda", "radau"} & listed
    assert not {"lsoda", "radau"} & {method.kind for method in default_methods(oscillator(), np.array([1.0]))}


def test_importing_scipy_counts_as_work(monkeypatch: pytest.MonkeyPatch) -> None:
    """An event loop would wait for it."""
    monkeypatch.delitem(sys.modules, "scipy.integrate", raising=False)
    with pytest.raises(WorkLimitReached), work_limit(10_000):
        Lsoda(1e-6).integrate(oscillator(), np.array([1.0]))
    assert "scipy.integrate" not in sys.modules
