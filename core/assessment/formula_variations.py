"""Variations of a question at which a formula has to agree with a figure: its numbers, drawn anew from a seed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import islice
from random import Random
from typing import Any, NamedTuple

from core.assessment.propagation import changed, numbers_of
from core.errors import Path

VARIATIONS = 20
"""Changed questions at which a formula has to agree, beside the question itself."""

MOST_LOOKED_AT = 60
"""Numbers of a request that are changed one by one, to find those that depend on others."""

ALONE = 1.125
"""By how much a number is changed alone."""


class Variation(NamedTuple):
    """Parameters by name, and the figure that belongs to them."""

    parameters: Mapping[str, float]
    figure: float


Parameters = Mapping[str, tuple[Path, float, str]]
"""Path, value and unit of numbers of a request, by name."""

Find = Callable[[Path], Any]
"""Finds the value at a path of an answer, None where there is none."""

Varied = tuple[dict[str, float], Find]
"""Parameters by name, and what finds figures of the answer to the question with these."""


def drawn(
    request: Any, parameters: Parameters, tied: Sequence[Path], evaluate: Callable[[Any], Find]
) -> Iterator[Varied]:
    """Yield the parameters of a question and of its variations, each with what finds figures of its answer.

    Parameters
    ----------
    request : Any
        As it was sent.
    parameters : mapping
        That are varied, by up to 25 %.
    tied : sequence of path
        Numbers that are not changed alone; those of one magnitude change together, whether they are parameters or not.
    evaluate : callable
        Asks a changed question.
    """
    chance = Random(0)
    numbers = dict(numbers_of(request, zeros=True))
    for k in range(1 + 3 * VARIATIONS):
        # Numbers that have to be equal are, in the last third.
        shares: dict[Any, float] = {}
        values, changes = {}, {}
        for name, (place, value, _) in parameters.items():
            together = [one for one in tied if abs(numbers[one]) == abs(value)] if place in tied else [place]
            group = (place[:-1], value) if k > 2 * VARIATIONS else (place, value)
            share = shares.setdefault(abs(value) if place in tied else group, chance.uniform(0.75, 1.25))
            values[name] = value if k == 0 else value * share
            changes.update({one: numbers[one] if k == 0 else numbers[one] * share for one in together})
        yield values, evaluate(changed(request, changes))


def tied_numbers(request: Any, path: Path, evaluate: Callable[[Any], Find]) -> tuple[Path, ...]:
    """Return the numbers of a request without which another number has no sense.

    Such are the slope of a plane and the direction in which a block on it is: with one of them changed alone, there is
    no figure.

    Parameters
    ----------
    request : Any
    path : path
        Of the figure.
    evaluate : callable
        Asks a changed question.
    """
    numbers = islice(numbers_of(request), MOST_LOOKED_AT)
    return tuple(
        place for place, value in numbers if type(evaluate(changed(request, {place: value * ALONE}))(path)) is not float
    )
