from fractions import Fraction

import pytest
from mpmath import mp, mpf

from core.bodies.exact_inertia import ExactInertia
from core.certified.energy_ellipsoid import CertifiedEllipsoid
from core.certified.free_rotation import CertifiedRotation
from core.errors import BudgetExceeded, InvalidParameter
from tests.core.bodies.exact_tensors import of_tensor

OBLIQUE = of_tensor([[2, 1, 0], [1, 3, 1], [0, 1, 5]])
TURNED_COIN = of_tensor([["1.5", "0.5", 0], ["0.5", "1.5", 0], [0, 0, 1]])
STARTS = [
    (ExactInertia.of_moments([1, 2, 3]), ("0.1", "1", "0.1")),
    (ExactInertia.of_moments([3, 1, 2]), ("0.1", "-1", "0.1")),
    (ExactInertia.of_moments([1, 1, 2]), ("0.1", "-1", "0.1")),
    (ExactInertia.of_moments([14, 21, 24]), (6, -1, 7)),
    (ExactInertia.of_moments([1, 2, 3]), ("1e-300", "1", "1e-300")),
    (ExactInertia.of_moments(["1e-200", "1", "1"]), ("1e90", "1e-5", "0.3")),
    (OBLIQUE, ("0.3", "-1", "0.2")),
    (TURNED_COIN, ("0.3", "-1", "0.2")),
]


def quadrics(inertia: ExactInertia, point: list[str]) -> tuple[Fraction, Fraction]:
    """Return w.I.w and |I w|^2."""
    w = [Fraction(x) for x in point]
    m = [sum(i * x for i, x in zip(row, w, strict=True)) for row in inertia.tensor]
    return sum((x * y for x, y in zip(m, w, strict=True)), Fraction(0)), sum((x * x for x in m), Fraction(0))


def test_semi_axes():
    surface = CertifiedEllipsoid.of(ExactInertia.of_moments([2, "0.5", 8]), 1)
    assert surface.semi_axes(16) == ["1.000000000000000", "2.000000000000000", "0.5000000000000000"]
    assert surface.axes(16) == [
        ["1.000000000000000", "0", "0"],
        ["0", "1.000000000000000", "0"],
        ["0", "0", "1.000000000000000"],
    ]
    surface = CertifiedEllipsoid.of(OBLIQUE, "0.7")
    with mp.workdps(40):
        moments, columns = mp.eigsy(mp.matrix([[2, 1, 0], [1, 3, 1], [0, 1, 5]]))
        axes = surface.axes(30)
        for k, axis in enumerate(surface.semi_axes(30)):
            assert abs(mpf(axis) - mp.sqrt(mpf("1.4") / moments[k])) < mpf("1e-29")
            along = sum(mpf(axes[i][k]) * columns[i, k] for i in range(3))
            assert abs(abs(along) - 1) < mpf("1e-29")


@pytest.mark.parametrize(("inertia", "rates"), STARTS)
@pytest.mark.parametrize("energy", [None, "0.7"])
def test_points_lie_on_both_ellipsoids(inertia, rates, energy):
    """Energy and angular momentum are the two quadrics of which a polhode is the intersection."""
    own = CertifiedEllipsoid.through(inertia, rates)
    surface = own if energy is None else CertifiedEllipsoid.of(inertia, energy)
    curve = surface.polhode(rates, 9, 50)
    assert curve.closed
    assert curve.points[0] == curve.points[-1]
    assert len({tuple(p) for p in curve.points}) == 9
    momentum = Fraction(curve.angular_momentum) ** 2
    start = quadrics(inertia, [str(x) for x in rates])
    assert abs(momentum / (start[1] * surface.twice_energy / start[0]) - 1) < Fraction(1, 10**48)
    for point in curve.points:
        twice, squared = quadrics(inertia, point)
        assert abs(twice / surface.twice_energy - 1) < Fraction(1, 10**47)
        assert abs(squared / momentum - 1) < Fraction(1, 10**47)


@pytest.mark.parametrize(("inertia", "rates"), [STARTS[0], STARTS[1], STARTS[6]])
def test_a_closed_polhode_is_gone_round_in_the_direction_of_the_motion(inertia, rates):
    """At a quarter and at half of a period from its first point the motion has reached the matching points."""
    points = CertifiedEllipsoid.through(inertia, rates).polhode(rates, 8, 60).points
    period = Fraction(CertifiedRotation.of(inertia, rates).period(60) or 0)
    again = CertifiedRotation.of(inertia, points[0])
    for row, point in zip(again.angular_velocity([period / 4, period / 2], 20), points[2:5:2], strict=True):
        for x, y in zip(row, point, strict=True):
            assert abs(Fraction(x) - Fraction(y)) < Fraction(1, 10**17)


def test_extreme_points_are_exact_where_the_points_are_a_multiple_of_four():
    surface = CertifiedEllipsoid.through(ExactInertia.of_moments([1, 2, 3]), ("0.1", "1", "0.5"))
    points = surface.polhode(("0.1", "1", "0.5"), 12, 20).points
    assert [points[3][0], points[9][0], points[0][1], points[6][1]] == ["0"] * 4
    assert points[3][1] == points[9][1].lstrip("-")


def test_a_steady_rotation_draws_one_point():
    surface = CertifiedEllipsoid.of(ExactInertia.of_moments([1, 2, 3]), 4)
    curve = surface.polhode([0, 5, 0], 8, 20)
    assert (curve.closed, curve.points) == (False, [["0", "2.0000000000000000000", "0"]])
    assert curve.angular_momentum == "4.0000000000000000000"


@pytest.mark.parametrize("inertia", [ExactInertia.of_moments([14, 24, 21]), OBLIQUE], ids=["diagonal", "oblique"])
def test_the_separatrix_is_on_both_ellipsoids_and_crosses_at_the_middle_axis(inertia):
    surface = CertifiedEllipsoid.of(inertia, "0.7")
    curves = surface.separatrix(12, 50)
    with mp.workdps(60):
        tensor = mp.matrix([[mpf(x.numerator) / x.denominator for x in row] for row in inertia.tensor])
        middle = sorted(mp.eigsy(tensor, eigvals_only=True))[1]
        assert abs(mpf(curves[0].angular_momentum) - mp.sqrt(mpf("1.4") * middle)) < mpf("1e-48")
    for curve in curves:
        for point in curve.points:
            twice, squared = quadrics(inertia, point)
            assert abs(twice / surface.twice_energy - 1) < Fraction(1, 10**47)
            assert abs(squared - Fraction(curve.angular_momentum) ** 2) < Fraction(1, 10**45)
    assert curves[0].points[3] == curves[1].points[3]
    assert curves[0].points[9] == curves[1].points[9]
    assert curves[0].points[1] != curves[1].points[1]


def test_equal_moments_leave_no_separatrix():
    assert CertifiedEllipsoid.of(TURNED_COIN, 1).separatrix(8, 16) == ()


@pytest.mark.parametrize(
    ("ask", "error", "path"),
    [
        (lambda i: CertifiedEllipsoid.of(i, 0), InvalidParameter, ("energy",)),
        (lambda i: CertifiedEllipsoid.of(i, "x"), InvalidParameter, ("energy",)),
        (lambda i: CertifiedEllipsoid.through(i, [0, 0, 0]), InvalidParameter, ("angular_velocity",)),
        (lambda i: CertifiedEllipsoid.of(i, 1).polhode([0, 0, 0], 8, 16), InvalidParameter, ("angular_velocity",)),
        (lambda i: CertifiedEllipsoid.of(i, 1).polhode([0, 1, 1], 7, 16), InvalidParameter, ("points",)),
        (lambda i: CertifiedEllipsoid.of(i, 1).separatrix(8, 15), InvalidParameter, ("digits",)),
        (lambda i: CertifiedEllipsoid.of(i, 1).polhode([0, 1, 1], 10**6, 16), BudgetExceeded, ("points",)),
        (lambda i: CertifiedEllipsoid.of(i, 1).polhode([0, 1, 1], 10**5, 16), BudgetExceeded, ("digits",)),
        (
            lambda i: CertifiedEllipsoid.of(of_tensor([[1, 0, 0], [0, 1, 0], [0, 0, 0]]), 1),
            InvalidParameter,
            ("body",),
        ),
    ],
)
def test_what_is_refused(ask, error, path):
    with pytest.raises(error) as caught:
        ask(ExactInertia.of_moments([1, 2, 3]))
    assert caught.value.path == path
