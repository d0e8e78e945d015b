"""Every error that the mechanics raises on purpose, as one tree.

* MechanicsError
  - InvalidParameter (ValueError)
      - UnphysicalInertia
      - OpenMesh
  - NotApplicable
  - AccuracyUnreachable
  - BudgetExceeded

Each error carries data, not only a sentence: where the fault is, which rule it breaks, what would mend it.
The service turns the tree into HTTP answers in one table; nothing here knows a status code.
"""

from __future__ import annotations

Path = tuple[str | int, ...]


class MechanicsError(Exception):
    """Base class of every error raised on purpose.

    Attributes
    ----------
    detail : str
        One sentence for the person who asked.
    path : tuple of str and int
        Where the fault is, as steps into the question; empty when it is nowhere in particular.
    remedy : str or None
        What would mend it.
    """

    def __init__(self, detail: str, *, path: Path = (), remedy: str | None = None) -> None:
        super().__init__(detail)
        self.detail, self.path, self.remedy = detail, path, remedy


class InvalidParameter(MechanicsError, ValueError):
    """A parameter lies outside the range in which the model means anything.

    Parameters
    ----------
    path : str, or tuple of str and int
        The parameter, as steps from the object that is being built: ``("moments", 1)``.
    rule : str
        What the parameter must do, completing the sentence "moments/1 must ...".
    remedy : str, optional
        What would mend it.
    """

    def __init__(self, path: str | Path, rule: str, *, remedy: str | None = None) -> None:
        steps = (path,) if isinstance(path, str) else path
        super().__init__(f"{'/'.join(map(str, steps))} must {rule}", path=steps, remedy=remedy)
        self.rule = rule

    def inside(self, *outer: str | int) -> InvalidParameter:
        """Return the same fault seen from an enclosing object."""
        return type(self)((*outer, *self.path), self.rule, remedy=self.remedy)


class UnphysicalInertia(InvalidParameter):
    """No distribution of positive mass has this tensor of inertia."""


class OpenMesh(InvalidParameter):
    """The triangles do not enclose a volume."""


class NotApplicable(MechanicsError):
    """The method or model that was asked for does not exist for this system."""


class AccuracyUnreachable(MechanicsError):
    """No method at hand reaches the accuracy that was asked for.

    Parameters
    ----------
    requested : float or None
        Largest error of any sample, relative to the motion's largest norm, that was asked for; None where the question
        is beyond any accuracy.
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
        super().__init__(
            f"{asked}{achievable:.3g} {'is all that ' if requested is None else ''}can be reached: {reason}",
            path=path,
            remedy=remedy,
        )
        self.requested, self.achievable = requested, achievable


class BudgetExceeded(MechanicsError):
    """The question needs more work than one question may have.

    Parameters
    ----------
    what : str
        What is counted: ``"samples"``, ``"evaluations"``.
    needed, limit : int
        The count needed and the count allowed.
    """

    def __init__(self, what: str, needed: int, limit: int, *, path: Path = (), remedy: str | None = None) -> None:
        super().__init__(f"{needed} {what} are needed and {limit} are allowed", path=path, remedy=remedy)
        self.what, self.needed, self.limit = what, needed, limit
