"""Against the independent oracle (Landen's ladder, Euler's angles, R_J; no theta functions) on all of its cases."""

import time
from fractions import Fraction

import pytest
from mpmath import mp, mpf

from core.bodies.exact import rotated, rotation
from core.bodies.exact_mass import ExactMass
from core.certified.free_rotation import CertifiedRotation
from core.errors import BudgetExceeded, InvalidParameter
from tests.core.bodies.exact_tensors import of_tensor
from tests.drawn import sampled
from tests.oracles.cases import Case, cases
from tests.oracles.free_rotation import (
    flip_interval,
    largest_rate,
    period,
    reference_angular_velocity,
    reference_attitude,
)

CASES = sampled(cases(), __name__)
START = (1.0, 2.0, -3.0, 0.5)
T_HANDLE = ("837.2", "714", "437.7"), ("1", "10", "1")


def distance(found: list[list[str]], true: list) -> mpf:
    return max(abs(mpf(x) - y) for row, want in zip(found, true, strict=True) for x, y in zip(row, want, strict=True))


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_forty_digits_of_every_case(case: Case):
    motion = CertifiedRotation.of_moments(case.moments, case.angular_velocity)
    rates, attitudes = motion.trajectory(case.times, 42, START)
    with mp.workdps(60):
        size = largest_rate(case.moments, case.angular_velocity, 50) or mpf(1)
        want = reference_angular_velocity(case.moments, case.angular_velocity, case.times, 46)
        assert distance(rates, want) <= mpf("1e-41") * size
        assert abs(mpf(motion.largest_rate(42)) - size) <= mpf("1e-41") * size or motion.regime == "rest"
        assert (
            distance(attitudes, reference_attitude(case.moments, case.angular_velocity, case.times, START, 46)) < 1e-41
        )
        for found, true in ((motion.period(42), period), (motion.flip_interval(42), flip_interval)):
            wanted = true(case.moments, case.angular_velocity, 46)
            assert (found is None) == (wanted is None)
            if found is not None and wanted is not None:
                assert abs(mpf(found) - wanted) <= mpf("1e-41") * wanted


@pytest.mark.parametrize("case", CASES[::23], ids=lambda case: case.name)
def test_fewer_digits_are_more_digits_rounded(case: Case):
    motion = CertifiedRotation.of_moments(case.moments, case.angular_velocity)
    many, few = motion.trajectory(case.times, 200), motion.trajectory(case.times, 17)
    for precise, rough in zip(many[0] + many[1], few[0] + few[1], strict=True):
        for x, y in zip(precise, rough, strict=True):
            if y.startswith("0e"):
                assert abs(Fraction(x)) <= Fraction(y.replace("0e", "1e"))
                continue
            exponent = mp.floor(mp.log10(abs(mpf(y)))) if float(y) else 0
            assert abs(Fraction(x) - Fraction(y)) <= Fraction(51, 100) * Fraction(10) ** (int(exponent) - 16)


@pytest.mark.parametrize(
    ("moments", "rates", "digits"),
    [
        (*T_HANDLE, 1000),
        (("1", "2", "3"), ("1e-150", "1", "1e-150"), 200),
        (("14", "21", "24"), ("6", "-2", "7"), 1000),
    ],
    ids=["T-handle", "near the separatrix", "separatrix"],
)
def test_a_thousand_digits(moments, rates, digits):
    exact_moments, exact_rates = [Fraction(x) for x in moments], [Fraction(x) for x in rates]
    times = [Fraction("7.7")]
    motion = CertifiedRotation.of_moments(moments, rates)
    found, turned = motion.trajectory(["7.7"], digits)
    more = digits + 10
    with mp.workdps(more + 10):
        wanted = reference_angular_velocity(exact_moments, exact_rates, times, more)
        assert distance(found, wanted) < mpf(10) ** (3 - digits)
        attitudes = reference_attitude(exact_moments, exact_rates, times, digits=more)
        assert distance(turned, attitudes) < mpf(10) ** (1 - digits)


def test_a_decimal_string_is_exact():
    as_text = CertifiedRotation.of_moments(["0.1", "0.2", "0.25"], ["0.3", "1", "0.1"])
    as_doubles = CertifiedRotation.of_moments([0.1, 0.2, 0.25], [0.3, 1.0, 0.1])
    first, second = (motion.angular_velocity(["1.1"], 30)[0] for motion in (as_text, as_doubles))
    assert [x[:14] for x in first] == [x[:14] for x in second]
    assert first != second
    tenths = [Fraction(x) for x in ("0.1", "0.2", "0.25")], [Fraction(x) for x in ("0.3", "1", "0.1")]
    with mp.workdps(50):
        assert distance([first], reference_angular_velocity(*tenths, [Fraction("1.1")], 40)) < mpf("1e-29")


def test_the_start_and_what_never_changes_are_exact():
    motion = CertifiedRotation.of_moments([1, 2, 3], [0.1, 0, 1e-300])
    assert motion.angular_velocity([0.0], 20) == [["0.10000000000000000555", "0", "1.0000000000000000251e-300"]]
    assert motion.attitude([0.0], 20) == [["1.0000000000000000000", "0", "0", "0"]]
    steady = CertifiedRotation.of_moments([1, 2, 3], ["0", "0.5", "0"])
    assert steady.angular_velocity([0, 5, "-1e9"], 16) == [["0", "0.5000000000000000", "0"]] * 3
    assert steady.attitude(["2"], 16)[0] == ["0.8775825618903727", "0", "0.4794255386042030", "0"]
    rest = CertifiedRotation.of_moments([1, 2, 3], [0, 0, 0])
    assert rest.attitude([5], 16, [0, 0, 0, 2]) == [["0", "0", "0", "1.000000000000000"]]
    assert rest.period(16) is None


@pytest.mark.parametrize("turn", [(1, 2, -3, 4), (5, 0, 0, 3)], ids=["oblique", "about x"])
@pytest.mark.parametrize(
    ("moments", "rates"),
    [
        ((1, 2, 3), ("0.1", "1", "0.1")),
        ((3, 1, 2), ("-1", "0.2", "0.3")),
        ((1, 1, 2), ("0.3", "0.4", "-0.5")),
        ((1, 2, 2), ("0.3", "0.4", "-0.5")),
        ((14, 21, 24), (6, "-0.3", 7)),
        ((2, 2, 2), (1, 2, 3)),
    ],
)
def test_oblique_axes_change_the_description_not_the_motion(moments, rates, turn):
    times = ["0.7", "-3", "1e6"]
    plain = CertifiedRotation.of_moments(moments, rates)
    matrix = rotation(turn)
    tensor = rotated(plain.inertia.tensor, matrix)
    w = [Fraction(x) for x in rates]
    seen = CertifiedRotation.of(of_tensor(tensor), [sum(r * x for r, x in zip(row, w, strict=True)) for row in matrix])
    rates_plain, attitudes = plain.trajectory(times, 60, (1, 0, 0, 0))
    rates_seen, attitudes_seen = seen.trajectory(times, 50, (1, 0, 0, 0))
    for a, b in zip(rates_plain, rates_seen, strict=True):
        for k in range(3):
            want = sum(matrix[k][j] * Fraction(a[j]) for j in range(3))
            assert abs(Fraction(b[k]) - want) < Fraction(1, 10**48)
    # The body turns as much, about an axis that is turned with the description.
    for p, q in zip(attitudes, attitudes_seen, strict=True):
        assert abs(Fraction(p[0]) - Fraction(q[0])) < Fraction(1, 10**49)
        for k in range(3):
            want = sum(matrix[k][j] * Fraction(p[j + 1]) for j in range(3))
            assert abs(Fraction(q[k + 1]) - want) < Fraction(1, 10**49)
    assert plain.period(30) == seen.period(30)
    assert plain.regime == seen.regime


def test_irrational_moments_conserve_energy_and_momentum_in_space():
    tensor = [["2", "1", "1"], ["1", "3", "0.5"], ["1", "0.5", "4"]]
    motion = CertifiedRotation.of(of_tensor(tensor), ["0.1", "1", "0.3"])
    assert motion.inertia.rational_moments is None
    exact = [[Fraction(x) for x in row] for row in tensor]
    for w, q in zip(*motion.trajectory(["0.5", "-20", "1e9"], 60), strict=True):
        rates, (a, b, c, d) = [Fraction(x) for x in w], [Fraction(x) for x in q]
        momentum = [sum(i * x for i, x in zip(row, rates, strict=True)) for row in exact]
        assert abs(sum(m * x for m, x in zip(momentum, rates, strict=True)) - motion.start.twice_energy) < Fraction(
            1, 10**57
        )
        turned = [sum(r * m for r, m in zip(row, momentum, strict=True)) for row in rotation_of(a, b, c, d)]
        for x, y in zip(turned, motion.start.momentum, strict=True):
            assert abs(x - y) < Fraction(1, 10**56)
    assert motion.energy(16) == "1.970000000000000"


def rotation_of(w: Fraction, x: Fraction, y: Fraction, z: Fraction) -> list[list[Fraction]]:
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]


def test_digits_near_a_sign_change_are_digits_of_the_component():
    # At half the flip interval the middle component passes through zero; the nearest double time is not that instant.
    motion = CertifiedRotation.of_moments([1.0, 2.0, 3.0], [1.0, 0.0, 0.5])
    flip = motion.flip_interval(60)
    assert flip is not None
    near = float(flip)
    (row,) = motion.angular_velocity([near], 50)
    assert abs(float(row[1])) < 1e-15
    slope = Fraction(1 - 3, 2) * -1  # I2 w2' = (I3 - I1) w1 w3, and after half a period w1 has changed its sign
    expected = float((Fraction(near) - Fraction(flip)) * -slope * Fraction(1, 2))
    assert float(row[1]) == pytest.approx(expected, rel=1e-9)
    (text,) = motion.angular_velocity([flip], 16)
    assert abs(float(text[1])) < 1e-58


@pytest.mark.parametrize(
    ("ask", "path"),
    [
        (lambda m: m.angular_velocity([1.0], 15), ("digits",)),
        (lambda m: m.angular_velocity([1.0, "x"], 20), ("times", 1)),
        (lambda m: m.angular_velocity([float("inf")], 20), ("times", 0)),
        (lambda m: m.attitude([1.0], 20, (0, 0, 0, 0)), ("attitude",)),
        (lambda m: m.attitude([1.0], 20, (1, 0, 0)), ("attitude",)),
        (lambda m: m.attitude([1.0], 20, (1, 0, 0, "?")), ("attitude", 3)),
        (lambda m: CertifiedRotation.of(m.inertia, [1, 2, None]), ("angular_velocity", 2)),
    ],
)
def test_what_is_refused(ask, path):
    with pytest.raises(InvalidParameter) as caught:
        ask(CertifiedRotation.of_moments(*T_HANDLE))
    assert caught.value.path == path


def test_matter_along_a_line_turns_across_itself_or_not_at_all():
    line = ExactMass.of_point_masses("0.5", [("0.1", 0, 0), ("0.3", 0, 0)]).of_motion
    across = CertifiedRotation.of(line, ["0", "0.3", "0.4"])
    assert (across.regime, across.energy(16), across.model.regime) == (
        "steady",
        "0.001250000000000000",
        "steady rotation",
    )
    assert across.attitude(["2"], 16)[0] == ["0.8775825618903727", "0", "0.2876553231625218", "0.3835404308833624"]
    assert CertifiedRotation.of(line, [0, 0, 0]).regime == "rest"
    for along in (["1", 0, 0], ["1e-300", "0.3", "0.4"]):
        with pytest.raises(InvalidParameter) as caught:
            CertifiedRotation.of(line, along)
        assert caught.value.path == ("body",)


def test_far_out_on_the_separatrix_there_is_only_the_middle_axis():
    motion = CertifiedRotation.of_moments([14, 21, 24], [6, 1, 7])
    rates, attitudes = motion.trajectory(["10", "1e9", "-1e300"], 20)
    assert [float(x) for x in rates[0]] == pytest.approx([0, 9, 0], abs=1e-5)
    assert len(rates[0][0]) == len("1.2345678901234567890e-9")
    # 0.51 units of the last of 20 digits is all that is left of the way to the axis.
    assert rates[1] == ["0e-2040", "9.0000000000000000000", "0e-2040"]
    assert rates[2] == ["0e-2040", "-9.0000000000000000000", "0e-2040"]
    for row in attitudes:
        assert abs(sum(Fraction(q) ** 2 for q in row) - 1) < Fraction(1, 10**18)


def test_work_is_counted():
    with pytest.raises(BudgetExceeded) as caught:
        CertifiedRotation.of_moments(*T_HANDLE).angular_velocity([0.0] * 40_000, 30)
    assert caught.value.needed == 3_600_000


def test_a_thousand_samples_at_thirty_digits_are_quick():
    motion = CertifiedRotation.of_moments(*T_HANDLE)
    times = [0.002 * k for k in range(1000)]
    started = time.process_time()
    motion.angular_velocity(times, 30)
    # 10000 in a second, with a margin for a slow machine.
    assert time.process_time() - started < 0.3
