"""What an audit finds: a law that an answer does not keep."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from core.errors import SelfCheckFailed
from core.multibody.audit.placement import Numbers
from core.multibody.audit.samples import Samples

ROUNDING = 2.0**-45
"""Share of its terms to which a residual is known that is formed of a few dozen doubles, each rounded."""

NOISE = 2.0**-100
"""Share of the largest forces and places to which what vanishes is solved for: in pairs of doubles."""

MARGIN = 2.0
"""Times what the stated errors of the inputs change a residual by, to first order."""


@dataclass(frozen=True)
class Failure:
    """A law that does not hold.

    Attributes
    ----------
    law : str
    connection : str
        Or body.
    time : float
        From the start (s).
    residual, allowed : float
        What is left over, and what the stated errors allow, in the same unit.
    """

    law: str
    connection: str
    time: float
    residual: float
    allowed: float

    @property
    def ratio(self) -> float:
        """How many times larger the residual is than what is allowed."""
        return self.residual / self.allowed if self.allowed > 0.0 else np.inf


NOT_COMPARED = (
    "numbers are so large or small that their powers are no doubles: the answer is not checked against the laws of "
    "mechanics"
)


@dataclass(frozen=True)
class Verdict:
    """What the audit says of an answer.

    Attributes
    ----------
    failure : Failure or None
        The worst law that it does not keep; None where it keeps all that are checked.
    compared : bool
        False where the numbers of a scene or motion have powers that are no doubles, so that nothing could be.
    """

    failure: Failure | None = None
    compared: bool = True

    @property
    def noticed(self) -> tuple[str, ...]:
        """What is said of it to the client, in sentences."""
        return () if self.compared else (NOT_COMPARED,)


def require(failure: Failure | None) -> None:
    """Raise `SelfCheckFailed` for a law that an answer does not keep."""
    if failure is not None:
        raise SelfCheckFailed(failure.law, failure.connection, failure.time, failure.residual, failure.allowed)


Residual = Callable[[Samples], Numbers]
"""From samples to what should be zero, shape (n,) or (n, k), behind a first axis that perturbed samples have."""


class Ledger:
    """Compares residuals with what stated errors allow, and keeps the worst failure.

    Parameters
    ----------
    rounding : float
        Share of their terms to which residuals are known apart from stated errors.
    """

    def __init__(self, rounding: float = ROUNDING) -> None:
        self.rounding = rounding
        self.worst: Failure | None = None
        self.checked = 0

    def compare(self, law: str, connection: str, times: Numbers, residual: Numbers, allowed: Numbers | float) -> None:
        """Compare the sizes of residuals at some times with what is allowed, shapes (n,)."""
        self.checked += 1
        size = np.abs(residual)
        if not (size <= allowed).all():
            bound = np.broadcast_to(np.asarray(allowed, dtype=np.float64), size.shape)
            beyond = ~(size <= bound)
            with np.errstate(divide="ignore", invalid="ignore"):
                ratio = np.where(beyond, np.where(bound > 0.0, size / bound, np.inf), 0.0)
            k = int(np.argmax(np.where(np.isnan(ratio), np.inf, ratio)))
            found = Failure(law, connection, float(times[k]), float(size[k]), float(bound[k]))
            if self.worst is None or not found.ratio <= self.worst.ratio:
                self.worst = found

    def hold(
        self,
        law: str,
        connection: str,
        samples: Samples,
        residual: Residual,
        size: Numbers | float,
        *,
        value: Numbers,
        bodies: tuple[str, ...] = (),
        forces: tuple[str, ...] = (),
        rows: Numbers | None = None,
        one_sided: bool = False,
    ) -> None:
        """Require a residual to vanish within the stated errors of bodies and forces.

        Parameters
        ----------
        residual : callable
            Of samples, shape (n,) or (n, k).
        size : ndarray, shape (n,), or float
            Of its terms.
        value : ndarray
            The residual of the samples.
        rows : ndarray of bool, shape (n,), optional
            Samples at which it should vanish, all if omitted.
        one_sided : bool
            Whether it may be larger than zero.
        """
        self.checked += 1
        found = np.abs(np.minimum(value, 0.0) if one_sided else value)
        floor = self.rounding * np.asarray(size, dtype=np.float64)
        beyond = ~((found if found.ndim == 1 else found.max(axis=1)) <= floor)
        if rows is not None:
            beyond &= rows
        if not beyond.any():
            return
        where = np.flatnonzero(beyond)
        some, found = samples.at(where), found[where].reshape(len(where), -1)
        allowed = np.reshape(floor[where] if floor.ndim else floor, (-1, 1))
        allowed = allowed + propagated(some, bodies, forces, residual)
        k = np.argmax(found - allowed, axis=1)
        own = np.arange(len(k))
        self.compare(law, connection, some.times, found[own, k], allowed[own, k])


def propagated(samples: Samples, bodies: tuple[str, ...], forces: tuple[str, ...], residual: Residual) -> Numbers:
    """Return by how much the stated errors change a residual to first order, shape (n, k)."""
    perturbed = samples.perturbed(tuple(dict.fromkeys(bodies)), forces)
    values = components(residual(perturbed), perturbed)
    changes: Numbers = MARGIN * np.abs(values[1:] - values[:1]).sum(axis=0)
    return changes


def components(values: Numbers, samples: Samples) -> Numbers:
    """Return numbers of samples, or vectors of them, with one axis behind those of the samples."""
    return values if values.ndim > samples.leading else values[..., None]
