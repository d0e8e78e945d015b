"""The energy ellipsoid, the polhodes on it and the separatrix, to any number of digits."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction

from flint import arb, fmpq

from core.bodies.exact import tensor_pairs
from core.bodies.exact_inertia import ExactInertia
from core.bodies.mass_properties import MassProperties
from core.certified.directions import floor_of_directions
from core.certified.free_rotation import CertifiedRotation, Rows
from core.digits.adaptive_precision import bits_for, check_digits, each_determined, until_determined
from core.digits.decimals import DEEPEST, decimal, decimal_of_fraction, decimals, floor_below
from core.digits.exact_inputs import Number, enclosed, exact, exact_numbers, nearest
from core.errors import InvalidParameter
from core.rotation.exact_start import Balls, dot, principal_axes
from core.rotation.surfaces.initial_states import initial_states
from core.rotation.surfaces.polhodes import check_count
from core.rotation.turning_motion import TurningMotion


@dataclass(frozen=True)
class CertifiedPolhode:
    """One curve; the fields are those of `core.rotation.surfaces.polhodes.Polhode`.

    Attributes
    ----------
    regime : str
        Of the motion that draws it.
    closed : bool
        Whether the last point is the first; a steady rotation draws a single point.
    angular_momentum : str
        Magnitude, the same at every point (kg m^2/s).
    points : list of rows of 3 str
        In body axes (rad/s).
    """

    regime: str
    closed: bool
    angular_momentum: str
    points: Rows


@dataclass(frozen=True)
class CertifiedEllipsoid:
    """The surface w.I.w = 2E.

    Every point that is returned lies on it to its last digit but one, and a polhode's points lie on |I w|^2 = L^2 as
    well.

    Attributes
    ----------
    inertia : ExactInertia
    twice_energy : Fraction
        2E (J).
    """

    inertia: ExactInertia
    twice_energy: Fraction

    def __post_init__(self) -> None:
        self.inertia.require_extent()

    @classmethod
    def of(cls, inertia: ExactInertia, energy: Number) -> CertifiedEllipsoid:
        """Return the ellipsoid of a body at an energy greater than 0 (J)."""
        twice = 2 * exact(energy, "energy")
        if twice <= 0:
            raise InvalidParameter("energy", "be greater than 0 J")
        return cls(inertia, twice)

    def drawn_starts(self, count: int, seed: int) -> list[list[float]]:
        """Return the starts of `core.rotation.surfaces.initial_states`: doubles, whose directions alone are meant."""
        body = MassProperties(*tensor_pairs(self.inertia.tensor))
        starts: list[list[float]] = initial_states(body, nearest(self.twice_energy / 2), count, seed).tolist()
        return starts

    @classmethod
    def through(cls, inertia: ExactInertia, angular_velocity: Sequence[Number]) -> CertifiedEllipsoid:
        """Return the ellipsoid on which an angular velocity, shape (3,), lies."""
        rotation = CertifiedRotation.of(inertia, angular_velocity)
        if not rotation.start.twice_energy:
            raise InvalidParameter("angular_velocity", "not be zero: at rest there is no energy surface")
        return cls(inertia, rotation.start.twice_energy)

    def energy(self, digits: int) -> str:
        """Return E (J)."""
        return decimal_of_fraction(self.twice_energy / 2, check_digits(digits))

    def semi_axes(self, digits: int) -> list[str]:
        """Return sqrt(2E/I), along the body axes where these are principal, else in ascending order of moments."""
        check_digits(digits)
        return until_determined(lambda: decimals(self.semi_axis_balls(), digits), bits_for(digits))

    def semi_axis_balls(self) -> Balls:
        """Return the semi-axes at the current precision."""
        if self.inertia.diagonal:
            x, y, z = (enclosed(self.twice_energy / self.inertia.tensor[k][k]).sqrt() for k in range(3))
        else:
            x, y, z = ((enclosed(self.twice_energy) / i).sqrt() for i in principal_axes(self.inertia).moments)
        return x, y, z

    def axes(self, digits: int) -> Rows:
        """Return the axes to which the semi-axes belong as the columns of a matrix, in body axes."""
        check_digits(digits)
        floor = floor_of_directions(digits)
        return until_determined(lambda: [decimals(row, digits, floor) for row in self.axis_balls()], bits_for(digits))

    def axis_balls(self) -> tuple[Balls, Balls, Balls]:
        """Return the rows of that matrix at the current precision."""
        if self.inertia.diagonal:
            x, y, z = ((arb(k == 0), arb(k == 1), arb(k == 2)) for k in range(3))
            return x, y, z
        return principal_axes(self.inertia).axes

    def floor_of_points(self, largest: arb, digits: int) -> int:
        """Return the last place that is printed of points of which the farthest is at `largest`.

        Along principal axes it is known which components vanish, and the others are given far deeper.
        """
        return floor_below(largest, digits) - (DEEPEST if self.inertia.diagonal else 0)

    def polhode(self, angular_velocity: Sequence[Number], count: int, digits: int) -> CertifiedPolhode:
        """Return the polhode in the direction of an angular velocity as `count` points and the first again.

        The angular velocity is scaled to the energy of this surface, which scales its polhode with it. The points are
        those of `core.rotation.surfaces.polhodes`: even steps of the amplitude, along with the motion where it is
        periodic. On the separatrix they are those of the whole ellipse, of which the motion draws one half.

        Raises
        ------
        InvalidParameter, BudgetExceeded
            For a count below 8 or above 100000, digits outside 16 to 1000, or an angular velocity of zero.
        """
        check_count(count)
        check_digits(digits, 3 * count)
        rotation = CertifiedRotation.of(self.inertia, angular_velocity)
        own = rotation.start.twice_energy
        if not own:
            raise InvalidParameter("angular_velocity", "not be zero: at rest there is no energy surface")
        ratio = self.twice_energy / own
        squared = rotation.start.squared_momentum * ratio
        momentum = until_determined(lambda: decimal(enclosed(squared).sqrt(), digits), bits_for(digits))
        regime = rotation.model.regime
        if not rotation.turns:
            start = exact_numbers(angular_velocity, ("angular_velocity",), 3)

            def point() -> list[str]:
                if ratio == 1:
                    return [decimal_of_fraction(w, digits) for w in start]
                scale = enclosed(ratio).sqrt()
                return [decimal(scale * enclosed(w), digits) for w in start]

            return CertifiedPolhode(regime, False, momentum, [until_determined(point, bits_for(digits))])

        def evaluators() -> Callable[[int], list[str]]:
            motion, scale = TurningMotion(rotation.start), enclosed(ratio).sqrt()
            floor = self.floor_of_points(scale * motion.largest_rate, digits)

            def at(i: int) -> list[str]:
                sine, cosine = arb.sin_cos_pi_fmpq(fmpq(2 * i, count))
                along = cosine if motion.separatrix else (cosine * cosine + motion.m1 * sine * sine).sqrt()
                frame = (motion.A_c * cosine, motion.side * motion.A_b * sine, motion.A_d * along)
                x, y, z = motion.in_body(frame)
                return decimals((scale * x, scale * y, scale * z), digits, floor)

            return at

        points = each_determined(evaluators, count, bits_for(digits))
        return CertifiedPolhode(regime, True, momentum, [*points, list(points[0])])

    def separatrix(self, count: int, digits: int) -> tuple[CertifiedPolhode, ...]:
        """Return the separatrix: two ellipses that cross at the middle axis, none if moments are equal.

        From L^2 = 2E B: A_b^2 = 2E/B, A_a^2 = 2E (C - B)/(A (C - A)), A_c^2 = 2E (B - A)/(C (C - A)).
        """
        check_count(count)
        check_digits(digits, 6 * count)
        if self.inertia.equal_moments > 1:
            return ()
        bits = bits_for(digits)

        def momentum_on_it() -> str:
            return decimal((enclosed(self.twice_energy) * principal_axes(self.inertia).moments[1]).sqrt(), digits)

        momentum = until_determined(momentum_on_it, bits)

        def curve(side: int) -> CertifiedPolhode:
            def evaluators() -> Callable[[int], list[str]]:
                state = principal_axes(self.inertia)
                (low, middle, high), (ab, bc, ac), twice = state.moments, state.gaps, enclosed(self.twice_energy)
                a, b = (twice * bc / (low * ac)).sqrt(), (twice / middle).sqrt()
                c = side * (twice * ab / (high * ac)).sqrt()
                floor = self.floor_of_points((a * a + b * b + c * c).sqrt(), digits)

                def at(i: int) -> list[str]:
                    sine, cosine = arb.sin_cos_pi_fmpq(fmpq(2 * i, count))
                    along = (a * cosine, b * sine, c * cosine)
                    return decimals([dot(row, along) for row in state.axes], digits, floor)

                return at

            points = each_determined(evaluators, count, bits)
            return CertifiedPolhode("separatrix", True, momentum, [*points, list(points[0])])

        return curve(1), curve(-1)
