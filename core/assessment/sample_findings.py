"""What is found about samples of a motion that are not right, with the feedback on them."""

from __future__ import annotations

from dataclasses import dataclass

from core.assessment.feedback.languages import Sentence


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
    def sentence(self) -> Sentence | None:
        """The time from which the samples are wrong; None if that is the start."""
        if self.within_until is None or self.within_until == 0.0:
            return None
        crossed = self.separatrix_crossed
        if crossed is not None and abs(crossed) >= abs(self.within_until):
            return Sentence("samples-separatrix", {"until": self.within_until, "crossed": crossed})
        return Sentence("samples-until", {"until": self.within_until})


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
    def sentence(self) -> Sentence:
        """The method that the samples come from."""
        if self.tolerance is not None:
            return Sentence("samples-of-solver", {"method": self.method, "tolerance": self.tolerance})
        if self.step is not None:
            return Sentence("samples-of-method", {"method": self.method, "step": self.step})
        return Sentence("samples-rounded")
