"""The double kernels against ball arithmetic: the named cases and some of the random and extreme ones."""

import statistics

import pytest

from tests.core.certified.judge import UNIT_ROUNDOFF, Verdict, judged, motions, report, tightness
from tests.oracles.cases import Case

COUNT = 400


@pytest.fixture(scope="module")
def verdicts() -> list[Verdict]:
    found = [judged(case, family) for family, case in motions(COUNT)]
    return [verdict for verdict in found if verdict is not None]


def test_nothing_is_refused(verdicts):
    assert len(verdicts) == len(list(motions(COUNT)))


def test_no_statement_of_error_is_below_the_true_error(verdicts):
    assert [verdict for verdict in verdicts if verdict.caught] == []


def test_worst_errors_of_the_double_kernels(verdicts):
    # Over a hundred thousand motions the worst are 4.93 and 10.81 (benchmarks/results/judge.json).
    assert max(v.error for v in verdicts) <= 5 * UNIT_ROUNDOFF
    assert max(v.attitude_error or 0.0 for v in verdicts) <= 12 * UNIT_ROUNDOFF
    assert statistics.median(v.error for v in verdicts) <= 1.6 * UNIT_ROUNDOFF


def test_statements_are_not_idle(verdicts):
    ratios = [v.stated / v.error for v in verdicts if v.error > UNIT_ROUNDOFF / 8]
    assert statistics.median(ratios) <= 6


def test_the_comparison_finds_wrong_results():
    case = Case("a body of another shape", (1.0, 2.0, 3.0), (0.1, 1.0, 0.1), (0.0, 3.0))
    fair = judged(case)
    assert fair is not None
    assert not fair.caught
    overstated = Verdict(fair.name, fair.family, fair.error, fair.error / 2, None, None)
    assert overstated.caught
    assert tightness([(3.0, 1.0), (2.0, 1.0), (9.0, 1e-20)])["least"] == 2.0
    assert report([overstated], 0)["statements below the true error"] == [case.name]
