"""The exceptions of core.

* MechanicsError
  - InvalidParameter (ValueError)
      - SlackAtStart
      - PlacesDisagree
      - UnphysicalInertia
      - OpenMesh
  - NotApplicable
  - AccuracyUnreachable
  - BudgetExceeded
  - SelfCheckFailed

Each error carries data besides its message: the path of the faulty field, the rule and a remedy. The service maps the
classes to HTTP responses in one table; no status code appears here.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from math import isfinite

Path = tuple[str | int, ...]

LARGEST_COUNT = 10**18
"""Counts above this are reported as this: what matters is that they are out of reach, and every JSON reader has it."""


def pointer_of(path: Iterable[str | int]) -> str:
    """Return steps as an RFC 6901 JSON pointer."""
    return "".join("/" + str(step).replace("~", "~0").replace("/", "~1") for step in path)


class MechanicsError(Exception):
    """Base class of the exceptions of core.

    Attributes
    ----------
    detail : str
        One sentence for the user.
    path : tuple of str and int
        Path of the faulty field in the question; empty if no field is at fault.
    remedy : str or None
        How to correct the question.
    """

    def __init__(self, detail: str, *, path: Path = (), remedy: str | None = None) -> None:
        super().__init__(detail)
        self.detail, self.path, self.remedy = detail, path, remedy


class InvalidParameter(MechanicsError, ValueError):
    """A parameter is outside its admissible range.

    Parameters
    ----------
    path : str, or tuple of str and int
        Path of the parameter from the object under construction: ``("moments", 1)``.
    rule : str
        The rule, completing the sentence "moments/1 must ...".
    remedy : str, optional
        How to correct the parameter.
    further : sequence of InvalidParameter
        Faults of other parts of the same document.
    """

    def __init__(
        self, path: str | Path, rule: str, *, remedy: str | None = None, further: Iterable[InvalidParameter] = ()
    ) -> None:
        steps = (path,) if isinstance(path, str) else path
        super().__init__(f"{'/'.join(map(str, steps))} must {rule}", path=steps, remedy=remedy)
        self.rule, self.further = rule, tuple(further)

    def inside(self, *outer: str | int) -> InvalidParameter:
        """Return the same error with the path from an enclosing object."""
        further = [fault.inside(*outer) for fault in self.further]
        return type(self)((*outer, *self.path), self.rule, remedy=self.remedy, further=further)


class SlackAtStart(InvalidParameter):
    """A string is longer than its way: the scene begins with it slack."""


class PlacesDisagree(InvalidParameter):
    """The places of bodies do not satisfy a connection."""


class UnphysicalInertia(InvalidParameter):
    """No distribution of positive mass has this tensor of inertia."""


class OpenMesh(InvalidParameter):
    """The triangles do not enclose a volume."""


class NotApplicable(MechanicsError):
    """The requested method or model does not exist for this system."""


class AccuracyUnreachable(MechanicsError):
    """No available method reaches the requested accuracy.

    Parameters
    ----------
    requested : float or None
        Requested largest error of any sample, relative to the motion's largest norm; None if the question cannot be
        answered at any accuracy.
    achievable : float
        The error that can be reached.
    """

    def __init__(
        self,
        requested: float | None,
        achievable: float,
        reason: str,
        *,
        path: Path = ("accuracy",),
        remedy: str | None = None,
    ) -> None:
        asked = "" if requested is None else f"an error of at most {requested:.3g} was asked for and "
        reached = f"{achievable:.3g} {'is all that ' if requested is None else ''}" if isfinite(achievable) else "none "
        super().__init__(f"{asked}{reached}can be reached: {reason}", path=path, remedy=remedy)
        self.requested, self.achievable = requested, achievable


class BudgetExceeded(MechanicsError):
    """The question needs more work than the budget allows.

    Parameters
    ----------
    what : str
        What is counted: ``"samples"``, ``"evaluations"``.
    needed, limit : int
        The count needed and the count allowed. A count above `LARGEST_COUNT` is reported as that.
    """

    def __init__(self, what: str, needed: float, limit: int, *, path: Path = (), remedy: str | None = None) -> None:
        self.what, self.needed, self.limit = what, int(min(needed, LARGEST_COUNT)), limit
        super().__init__(f"{self.needed} {what} are needed and {limit} are allowed", path=path, remedy=remedy)


@contextmanager
def inside_field(*steps: str | int) -> Iterator[None]:
    """Prefix the path of every fault with the field of the question to which it belongs."""
    try:
        yield
    except InvalidParameter as fault:
        raise fault.inside(*steps) from fault.__cause__
    except MechanicsError as fault:
        fault.path = (*steps, *fault.path)
        raise


class SelfCheckFailed(MechanicsError):
    """An answer does not keep a law of mechanics within its stated errors: it is wrong, and not the question's fault.

    Parameters
    ----------
    law : str
    connection : str
        Or body; empty where the law is that of the whole scene.
    time : float
        From the start (s).
    residual, allowed : float
        What is left over of the law, and what the stated errors allow, in the same unit.
    """

    def __init__(self, law: str, connection: str, time: float, residual: float, allowed: float) -> None:
        of = f' of "{connection}"' if connection else ""
        super().__init__(
            f"the answer did not pass the check against its description, and is withheld: {law}{of} at {time:.6g} s "
            f"is off by {residual:.3g}, where its stated errors allow {allowed:.3g}",
            remedy="the description is not at fault; report the request with its id",
        )
        self.law, self.connection, self.time = law, connection, time
        self.residual, self.allowed = residual, allowed
