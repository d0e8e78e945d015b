"""The free rotation of a rigid body to any number of digits, each of them proven."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from flint import arb

from core.bodies.exact_inertia import ExactInertia
from core.digits.adaptive_precision import bits_for, check_digits, each_determined, until_determined
from core.digits.decimals import DEEPEST, FLOOR_IN_DIGITS, decimal, decimal_of_fraction, decimals, floor_below
from core.digits.exact_inputs import Number, enclosed, exact_numbers
from core.errors import InvalidParameter
from core.notices import Notice
from core.rotation.exact_start import ExactStart, Regime
from core.rotation.regimes import NAME, steady_model, triaxial_model
from core.rotation.stability.classification import UNSTABLE_SPINS, unstable_axis
from core.rotation.turning_motion import QuaternionBalls, TurningMotion, product
from core.systems.system import Model

Rows = list[list[str]]
IDENTITY = (1, 0, 0, 0)


@dataclass(frozen=True)
class CertifiedRotation:
    """A body that turns freely, its inertia and its start taken as exact.

    Every numeral that is returned has the number of significant digits asked for and differs from the true value by at
    most 0.51 units of its last digit. ``"0"`` is exactly zero. Components are given as far as twice so many digits
    below the largest norm: one that vanishes to there, exactly or not, reads ``"0e-60"``. Along principal axes, where
    it is known which components vanish, angular velocities go 2000 places deeper.

    Attributes
    ----------
    inertia : ExactInertia
    angular_velocity_at_start : tuple of 3 fractions
        In body axes, at t = 0 (rad/s).
    """

    inertia: ExactInertia
    angular_velocity_at_start: tuple[Fraction, Fraction, Fraction]

    def __post_init__(self) -> None:
        if self.inertia.is_line and any(self.angular_velocity_at_start):
            across = any(self.start.momentum) and self.regime == "steady"
            if not across:
                raise InvalidParameter(
                    "body",
                    "have three moments of inertia greater than 0 to rotate freely",
                    remedy="give a body with extent in at least two directions, or let a line of matter turn across "
                    "itself",
                )

    @classmethod
    def of(cls, inertia: ExactInertia, angular_velocity: Sequence[Number]) -> CertifiedRotation:
        """Return the motion that starts with an angular velocity given as doubles or decimal strings, shape (3,)."""
        x, y, z = exact_numbers(angular_velocity, ("angular_velocity",), 3)
        return cls(inertia, (x, y, z))

    @classmethod
    def of_moments(cls, moments: Sequence[Number], angular_velocity: Sequence[Number]) -> CertifiedRotation:
        """Return the motion of a body given by its principal moments along the body axes."""
        return cls.of(ExactInertia.of_moments(moments), angular_velocity)

    @cached_property
    def start(self) -> ExactStart:
        """The start, and what it decides exactly."""
        return ExactStart(self.inertia, self.angular_velocity_at_start)

    @property
    def regime(self) -> Regime:
        """Which branch of the solution holds."""
        return self.start.regime

    @property
    def turns(self) -> bool:
        """Whether the angular velocity changes."""
        return self.regime in ("periodic", "separatrix")

    @property
    def model(self) -> Model:
        """The branch of the solution that holds, and why."""
        name, equal = NAME, self.inertia.equal_moments
        if self.regime == "rest":
            return Model(name, "rest", "the angular velocity is zero", 0)
        if self.regime == "steady":
            return steady_model(equal > 1 and not self.inertia.is_line, equal == 3, self.instability)
        if self.regime == "separatrix":
            why = "L^2 = 2 E I_middle exactly: the motion tends to the middle axis, by hyperbolic functions"
            return Model(name, "separatrix", why, 1)
        if equal == 2:
            why = "two moments are equal: sine and cosine about the axis of the third"
            return Model(name, "regular precession", why, 1)
        return triaxial_model(self.start.side > 0)

    @property
    def instability(self) -> str | None:
        """Why a steady spin is unstable; None where it is stable, where nothing turns and where the spin changes."""
        side = self.start.middle_side if self.regime == "steady" and not self.inertia.is_line else 1
        if side > 0 or self.inertia.equal_moments == 3:
            return None
        return UNSTABLE_SPINS["saddle" if side < 0 else "degenerate"]

    @property
    def warnings(self) -> tuple[Notice, ...]:
        """What an answer about this motion has to say beside its figures; paths lead from the question."""
        return () if self.instability is None else (unstable_axis(self.instability),)

    def angular_velocity(self, times: Sequence[Number], digits: int) -> Rows:
        """Return the angular velocity in body axes, n rows of 3 numerals.

        Each component has its own `digits` significant digits, also next to a change of its sign. Along principal axes
        some precision always tells it from zero: at t = 0 the components are the given rational numbers, and at any
        other time a component that is not identically zero is a transcendental number (Schneider; Lindemann where the
        functions are elementary).

        Parameters
        ----------
        times : sequence of n numbers
            Measured from the start, of either sign, in any order (s).
        digits : int
            From 16 to 1000.

        Raises
        ------
        InvalidParameter
            For digits outside 16 to 1000, or times that are no numbers.
        BudgetExceeded
            For more digits than one question may have.
        """
        return [row[0] for row in self._rows(times, digits, None)]

    def attitude(self, times: Sequence[Number], digits: int, attitude: Sequence[Number] = IDENTITY) -> Rows:
        """Return unit quaternions [w, x, y, z], body to space, n rows of 4 numerals, continuous in time from t = 0.

        Parameters
        ----------
        attitude : sequence of 4 numbers
            At t = 0; any length but zero, normalised here.
        """
        return self.trajectory(times, digits, attitude)[1]

    def trajectory(
        self, times: Sequence[Number], digits: int, attitude: Sequence[Number] = IDENTITY
    ) -> tuple[Rows, Rows]:
        """Return `angular_velocity` and `attitude` at once, at less cost than one after the other."""
        given = exact_numbers(attitude, ("attitude",), 4)
        if not any(given):
            raise InvalidParameter(
                "attitude", "not be zero", remedy="give a unit quaternion [w, x, y, z]; [1, 0, 0, 0] is no turn"
            )
        rows = self._rows(times, digits, given)
        return [row[0] for row in rows], [row[1] for row in rows]

    def _rows(self, times: Sequence[Number], digits: int, attitude: Sequence[Fraction] | None) -> list[Rows]:
        """Return for each time the numerals of the angular velocity and, if one is given, of the attitude."""
        check_digits(digits, (3 if attitude is None else 7) * len(times))
        instants = exact_numbers(times, ("times",))
        start = [decimal_of_fraction(w, digits) for w in self.angular_velocity_at_start]
        if not self.turns and attitude is None:
            return [[list(start)] for _ in instants]

        def steady() -> Callable[[int], Rows]:
            q0 = _normalised(attitude or IDENTITY)
            points = [enclosed(t) for t in instants]
            floor = -FLOOR_IN_DIGITS * digits
            return lambda i: [list(start), decimals(product(q0, self._steady_turn(points[i])), digits, floor)]

        def turning() -> Callable[[int], Rows]:
            motion = TurningMotion(self.start)
            points = [enclosed(t) for t in instants]
            floor = floor_below(motion.largest_rate, digits)
            if self.inertia.diagonal:
                floor -= DEEPEST
            q0 = _normalised(attitude or IDENTITY)
            turned = None if attitude is None else motion.attitudes(q0)

            def row(i: int) -> Rows:
                phase = motion.phase(points[i])
                v = motion.in_frame(phase)
                rates = decimals(motion.in_body(v), digits, floor) if instants[i] else list(start)
                if turned is None:
                    return [rates]
                q = turned(phase, v) if instants[i] else q0
                return [rates, decimals(q, digits, -FLOOR_IN_DIGITS * digits)]

            return row

        bits = self._bits(digits, instants)
        return each_determined(turning if self.turns else steady, len(instants), bits)

    def _steady_turn(self, time: arb) -> QuaternionBalls:
        square = sum((w * w for w in self.angular_velocity_at_start), Fraction(0))
        if square == 0:
            return arb(1), arb(0), arb(0), arb(0)
        rate = enclosed(square).sqrt()
        sin, cos = (rate * time / 2).sin_cos()
        x, y, z = (sin * enclosed(w) / rate for w in self.angular_velocity_at_start)
        return cos, x, y, z

    def energy(self, digits: int) -> str:
        """Return the kinetic energy (J)."""
        return decimal_of_fraction(self.start.twice_energy / 2, check_digits(digits))

    def angular_momentum(self, digits: int) -> str:
        """Return the magnitude of the angular momentum (kg m^2/s)."""
        return self._number(lambda: enclosed(self.start.squared_momentum).sqrt(), digits)

    def period(self, digits: int) -> str | None:
        """Return the period of the angular velocity in the body, 4K/p (s); None if it has none."""
        return self._number(lambda: _of(self.start).period, digits) if self.regime == "periodic" else None

    def flip_interval(self, digits: int) -> str | None:
        """Return the time between sign changes of the middle component, 2K/p (s); None where no such axis is left."""
        if self.regime != "periodic" or self.inertia.equal_moments > 1:
            return None
        return self._number(lambda: 1 / _of(self.start).frequency, digits)

    def middle_axis_tilt(self, digits: int) -> tuple[str, str] | None:
        """Return the least and largest angle between the middle axis and the angular momentum (rad).

        The middle axis points along the positive side of the body axis that it is nearest to. None without such an axis
        and at rest.
        """
        if self.regime == "rest" or self.inertia.equal_moments > 1:
            return None
        straight = self._number(arb.pi, digits)
        if self.regime == "separatrix":
            return "0", straight
        if self.regime == "periodic":
            return (
                self._number(lambda: _of(self.start).least_tilt, digits),
                self._number(lambda: arb.pi() - _of(self.start).least_tilt, digits),
            )
        if self.start.middle_side > 0:
            across = self._number(lambda: arb.pi() / 2, digits)
            return across, across
        # The first of the largest components; equal ones are a tie between body axes, which either resolves alike.
        spin = max(self.angular_velocity_at_start, key=abs)
        return ("0", "0") if spin > 0 else (straight, straight)

    @property
    def tumbles(self) -> bool:
        """Whether the middle axis turns over, from within 45 degrees of the angular momentum to 45 of its opposite."""
        if not self.turns or self.inertia.equal_moments > 1:
            return False
        return self.regime == "separatrix" or self.start.tilts_below_45_degrees()

    def largest_rate(self, digits: int) -> str:
        """Return the largest norm of the angular velocity in the whole motion (rad/s)."""
        if self.turns:
            return self._number(lambda: _of(self.start).largest_rate, digits)
        square = sum((w * w for w in self.angular_velocity_at_start), Fraction(0))
        return self._number(lambda: enclosed(square).sqrt(), digits)

    def _number(self, evaluate: Callable[[], arb | None], digits: int) -> str:
        check_digits(digits)

        def written() -> str:
            ball = evaluate()
            assert ball is not None
            return decimal(ball, digits)

        return until_determined(written, self._bits(digits, ()))

    def _bits(self, digits: int, times: Sequence[Fraction]) -> int:
        """Return a first working precision: a phase that has k bits before the point loses as many behind it."""
        farthest = max((abs(t) for t in times), default=Fraction(0))
        if farthest == 0:
            return bits_for(digits)
        # p and the rate of precession are at most the largest rate times the ratio of the moments.
        fastest = max(abs(w) for w in self.angular_velocity_at_start)
        radians = farthest * fastest
        magnitude = radians.numerator.bit_length() - radians.denominator.bit_length() + 2
        return bits_for(digits, magnitude)


def _of(start: ExactStart) -> TurningMotion:
    return TurningMotion(start)


def _normalised(quaternion: Sequence[Fraction | int]) -> QuaternionBalls:
    exact = [Fraction(x) for x in quaternion]
    norm = enclosed(sum((x * x for x in exact), Fraction(0))).sqrt()
    w, x, y, z = (enclosed(entry) / norm for entry in exact)
    return w, x, y, z
