"""The tree of errors: as its page draws it, with data that survives being seen from outside."""

from __future__ import annotations

import inspect
import math
import re

import pytest

from core import errors
from core.errors import (
    LARGEST_COUNT,
    AccuracyUnreachable,
    BudgetExceeded,
    InvalidParameter,
    MechanicsError,
    NotApplicable,
    OpenMesh,
    UnphysicalInertia,
)

CLASSES = [c for _, c in inspect.getmembers(errors, inspect.isclass) if c.__module__ == errors.__name__]


def drawn() -> dict[str, str | None]:
    """Return the parent of every class in the drawing of the module's docstring."""
    parents: dict[str, str | None] = {}
    above: list[tuple[int, str]] = []
    for indent, name in re.findall(r"^( *)[*-] (\w+)", errors.__doc__ or "", re.MULTILINE):
        above = [entry for entry in above if entry[0] < len(indent)]
        parents[name] = above[-1][1] if above else None
        above.append((len(indent), name))
    return parents


def test_the_drawing_is_the_tree() -> None:
    found = {c.__name__: c.__bases__[0].__name__ if c is not MechanicsError else None for c in CLASSES}
    assert drawn() == found
    assert issubclass(InvalidParameter, ValueError)


@pytest.mark.parametrize("kind", [InvalidParameter, UnphysicalInertia, OpenMesh])
def test_a_fault_seen_from_an_enclosing_object(kind: type[InvalidParameter]) -> None:
    fault = kind(("moments", 1), "be greater than 0", remedy="give a positive one")
    outside = fault.inside("bodies", 2)
    assert type(outside) is kind
    assert outside.path == ("bodies", 2, "moments", 1)
    assert str(outside) == outside.detail == "bodies/2/moments/1 must be greater than 0"
    assert (outside.rule, outside.remedy) == (fault.rule, fault.remedy)
    assert fault.path == ("moments", 1)


def test_a_name_alone_is_one_step() -> None:
    assert InvalidParameter("step", "be finite").path == ("step",)


def test_errors_carry_their_figures() -> None:
    unreachable = AccuracyUnreachable(1e-18, 3.2e-15, "doubles end there")
    assert (unreachable.requested, unreachable.achievable, unreachable.path) == (1e-18, 3.2e-15, ("accuracy",))
    assert "1e-18 was asked for" in unreachable.detail
    beyond = AccuracyUnreachable(None, 2.0, "nothing is left", path=("times",))
    assert "asked for" not in beyond.detail
    assert "2 is all that can be reached" in beyond.detail
    over = BudgetExceeded("samples", 11, 10, remedy="ask for fewer")
    assert (over.what, over.needed, over.limit, over.path, over.remedy) == ("samples", 11, 10, (), "ask for fewer")
    assert over.detail == "11 samples are needed and 10 are allowed"
    assert AccuracyUnreachable(None, math.inf, "all is lost").detail == "none can be reached: all is lost"
    for count in (10**400, math.inf):
        beyond_count = BudgetExceeded("steps", count, 10)
        assert (beyond_count.needed, type(beyond_count.needed)) == (LARGEST_COUNT, int)
        assert beyond_count.detail == "1000000000000000000 steps are needed and 10 are allowed"
    assert NotApplicable("no such method", path=("kind",)).remedy is None
