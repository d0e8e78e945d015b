"""The constrained scenes to any number of digits.

The set-up of a scene (forces, accelerations, events) always uses ball arithmetic. Here it uses the precision that the
digits need, and the trajectory, which is otherwise sampled in doubles, is evaluated in balls as well.

A quantity that is zero to within the precision (the velocity of a line of contact at rest, the time between two
simultaneous events) counts as zero if at least 320 bits do not distinguish it from zero. A result that vanishes to
twice the requested digits, relative to the terms of the difference that gives it, is written ``"0e-60"``.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from fractions import Fraction
from types import NoneType, UnionType
from typing import Any, Literal, NamedTuple, TypeVar, Union, get_args, get_origin, get_type_hints

from flint import arb

from core.balls import Undetermined
from core.digits.adaptive_precision import bits_for, check_digits, until_determined, working_bits
from core.digits.decimals import decimal, place_of
from core.digits.exact_inputs import Number, enclosed, exact, exact_numbers
from core.errors import InvalidParameter, Path, inside_field
from core.notices import Notice
from core.scenes.enclosure import BITS
from core.scenes.named_scene import NamedScene
from core.systems.system import Model

LARGEST = Fraction(10**300)
"""Largest magnitude of a parameter, so that the scenes can check the range as a double."""

SceneType = TypeVar("SceneType", bound=NamedScene)


class CertifiedScene(NamedTuple):
    """Answer to a question about a scene: `core.scenes.named_scene.NamedSceneSolution` with decimal numerals.

    Columns of the trajectory are lists; ``time`` has the requested times at which the motion exists, as given.
    """

    model: Model
    figures: Mapping[str, Any]
    trajectory: Mapping[str, list[Any]] | None
    ended: str | None
    warnings: tuple[Notice, ...]


def exact_scene(kind: type[SceneType], parameters: Mapping[str, Any]) -> SceneType:
    """Return a scene whose parameters are rational numbers, given as doubles or decimal strings.

    A parameter that is left out has the exact value of its default: the inertia factor of a uniform rod is one twelfth.

    Raises
    ------
    InvalidParameter
        As for the scene itself, and for strings that are not numbers.
    """
    known = {field.name for field in fields(kind)}
    for name in parameters:
        if name not in known:
            raise InvalidParameter(name, f"be a parameter of this scene: one of {sorted(known - {'kind'})}")
    hints = get_type_hints(kind)
    converted = {name: _exactly(value, hints[name], (name,)) for name, value in parameters.items()}
    return kind(**{**kind.exact_defaults, **converted})


def certified_scene(
    scene: NamedScene,
    digits: int,
    times: Sequence[Number] | None = None,
    outputs: frozenset[str] | None = None,
) -> CertifiedScene:
    """Compute the requested outputs with so many significant digits.

    Parameters
    ----------
    scene : NamedScene
        Its parameters are doubles or fractions, both taken as exact.
    digits : int
        From 16 to 1000.
    times : sequence of n numbers, optional
        Times of the trajectory, in any order (s).
    outputs : frozenset of str, optional
        Names of outputs of the scene; by default all, the trajectory only if times are given.

    Raises
    ------
    InvalidParameter
        For unknown outputs, digits outside 16 to 1000, or times before the beginning of the motion.
    NotApplicable
        If the motion is determined only after rounding: velocities that agree with a taut string only to rounding.
    BudgetExceeded
        If the question would print more digits than allowed.
    """
    check_digits(digits, 8 * len(times or ()))
    instants = None if times is None else exact_numbers(times, ("times",))
    for i, instant in enumerate(instants or ()):
        if abs(instant) > LARGEST:
            raise InvalidParameter(("times", i), "have a magnitude of at most 1e300 s")
    wanted = scene.wanted(outputs, timed=instants is not None)
    first = max(BITS, bits_for(digits))
    return until_determined(lambda: _Question(scene, digits, first, instants, wanted).answer(times), first)


@dataclass(frozen=True)
class _Question:
    scene: NamedScene
    digits: int
    first_bits: int
    instants: tuple[Fraction, ...] | None
    wanted: frozenset[str]

    def answer(self, given: Sequence[Number] | None) -> CertifiedScene:
        # A scene caches its constants; a copy computes them again, at the current precision.
        scene: Any = replace(self.scene)
        last = None if self.instants is None else max((*self.instants, Fraction(0)))
        horizon = float("inf") if last is None else float(last)
        bound = None if last is None else enclosed(last)
        found = scene.outline(self.wanted, horizon, lambda time: bound is None or not time > bound, self._written)
        fault = None if found.motion is None else scene.inexact(found.motion)
        if fault is not None:
            raise fault
        trajectory = None
        if found.motion is not None and "trajectory" in self.wanted and given is not None:
            trajectory = self._trajectory([enclosed(t) for t in self.instants or ()], found.motion, given)
        return CertifiedScene(found.model, found.figures, trajectory, found.ended, scene.notices(self.wanted))

    def _trajectory(self, points: Sequence[arb], motion: Any, given: Sequence[Number]) -> Mapping[str, list[Any]]:
        existing = []
        for i, point in enumerate(points):
            if point < arb(motion.valid_from):
                raise InvalidParameter(
                    ("times", i),
                    f"be at least {motion.valid_from:.17g} s",
                    remedy="the model does not hold earlier; start from an earlier state",
                )
            if motion.end is None or not point > motion.end.time:
                existing.append(i)
        columns: dict[str, list[Any]] = {"time": [given[i] for i in existing]}
        for i in existing:
            for name, value in motion.at(points[i]).items():
                columns.setdefault(name, []).append(self._written(value))
        return columns

    def _written(self, value: Any, path: Path = ()) -> Any:
        """Return a value with every ball in it, at any depth, as a numeral."""
        if isinstance(value, arb):
            return self._numeral(value)
        if isinstance(value, Mapping):
            return {key: self._written(entry) for key, entry in value.items()}
        if isinstance(value, (tuple, list)):
            return [self._written(entry) for entry in value]
        return value

    def _numeral(self, ball: arb) -> str:
        try:
            return decimal(ball, self.digits)
        except Undetermined:
            if working_bits() >= 2 * self.first_bits and ball.is_finite() and not (ball > 0 or ball < 0):
                return f"0e{place_of(ball.abs_upper()) + 1}"
            raise


def _exactly(value: Any, hint: Any, path: tuple[str | int, ...]) -> Any:
    """Return a parameter of a type of core's with every number in it as a rational number."""
    hints = [
        part for part in (get_args(hint) if get_origin(hint) in (Union, UnionType) else (hint,)) if part is not NoneType
    ]
    kind = hints[0]
    if value is None or get_origin(kind) is Literal:
        return value
    if is_dataclass(kind) and isinstance(value, Mapping):
        inner = get_type_hints(kind)
        parts = {name: _exactly(entry, inner.get(name, float), (*path, name)) for name, entry in value.items()}
        with inside_field(*path):
            return kind(**parts)  # type: ignore[operator]
    if isinstance(value, (tuple, list)):
        return tuple(_exactly(entry, float, (*path, i)) for i, entry in enumerate(value))
    number = exact(value, path)
    if abs(number) > LARGEST or 0 < abs(number) < 1 / LARGEST:
        raise InvalidParameter(path, "be zero or have a magnitude between 1e-300 and 1e300")
    return number
