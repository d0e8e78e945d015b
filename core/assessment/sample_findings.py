"""What is found about samples of a motion that are not right, with sentences for who submitted them."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class SampleErrors:
    """How wrong samples are.

    Attributes
    ----------
    largest : float
        Largest norm of the error (rad/s).
    final : float
        At the time farthest from the start (rad/s).
    within_until : float or None
        First time, outwards from the start, at which the error is beyond the tolerance (s); None if at none.
    energy_drift, angular_momentum_drift : float or None
        Largest relative change against the start; None at rest.
    phase_lag : float or None
        By how much the samples are late (s), negative if they are early: the shift of the motion that is nearest to
        them; None if no shift leaves less than half of the error.
    separatrix_crossed : float or None
        First time, outwards from the start, at which samples that end up elsewhere circle another axis than the motion
        (s).
    """

    largest: float
    final: float
    within_until: float | None
    energy_drift: float | None
    angular_momentum_drift: float | None
    phase_lag: float | None
    separatrix_crossed: float | None

    @property
    def sentence(self) -> str:
        """Since when the samples are wrong, for who submitted them; empty if they are from the start."""
        if self.within_until is None or self.within_until == 0.0:
            return ""
        until = f"The samples are right until t = {self.within_until:.3g} s"
        crossed = self.separatrix_crossed
        if crossed is not None and abs(crossed) >= abs(self.within_until):
            return f"{until}, then lost at the separatrix: from t = {crossed:.3g} s they circle another axis."
        return f"{until}."


@dataclass(frozen=True)
class Consistent:
    """A method by which the samples come out, confirmed by running it.

    Attributes
    ----------
    method : str
        Kind, or the solver's name, or "exact" for samples whose error is that of their rounding.
    step : float or None
        Length of the steps (s); None for a solver that chooses them.
    tolerance : float or None
        Relative, of a solver.
    unexplained : float
        Largest norm of the difference that is left (rad/s).
    """

    method: str
    step: float | None
    tolerance: float | None
    unexplained: float

    @property
    def sentence(self) -> str:
        """What the samples are, for who submitted them."""
        if self.tolerance is not None:
            return (
                f"The samples are those of an adaptive method ({self.method}) at a tolerance of {self.tolerance:.0e}."
            )
        if self.step is not None:
            return f"The samples are those of {self.method} with a step of {self.step:.6g} s."
        return "The samples are right to the digits that they have, which are fewer than the tolerance needs."
