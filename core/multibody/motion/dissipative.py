"""The motion of a part in which something decays: by its Taylor series, or by collocation while that is far faster."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from core.arrays import Floats
from core.multibody.equations.packed import two_to
from core.multibody.motion.collocated import collocated, pieces_of_steps
from core.multibody.motion.numerical import ALIKE_MARGIN, Numerical
from core.multibody.motion.run import Run
from core.multibody.motion.series_run import integrate
from core.multibody.motion.stiff import limiting_decay, rates_of_decay
from core.multibody.table.table import Table

STIFF_SHARE = 1.0
"""Share of the largest difference that each coordinate may miss: steps of collocation that are short for other reasons
leave both runs as wrong as one another."""


def dissipates(table: Table) -> bool:
    """Return whether anything may decay: there are dampers, formulas or friction.

    Friction that turns with its slip is not followed by collocation: its lines depend on rates.
    """
    if any(row.slide for row in table.rows):
        return False
    return bool(table.damping or table.acting or any(row.drag for row in table.rows))


@dataclass
class Dissipative(Numerical):
    """A part in which something may decay.

    Attributes
    ----------
    stiff : bool or None
        Whether the time after the start is followed by collocation; None while nothing has limited its series.
    """

    stiff: bool | None = None
    _coupled: str = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Keep why there is no closed form."""
        self._coupled = self.why

    def run(self, kind: str, end: float) -> Run:
        """Return steps to a time in the units of the arrays: "doubles", "reference", "fine" or "check"."""
        if end > 0.0 and self._turns_out_stiff(self.rates_at_start, end):
            self._runs.clear()
        found = super().run(kind, end)
        if not found.given_up:
            return found
        # Runs by another method differ by their errors, and are made anew.
        self._runs.clear()
        return self.run(kind, end)

    def followed(self, kind: str, end: float, since: Run | None = None) -> Run:
        """Take steps to a time wherever rows keep their rank."""
        if end <= 0.0 or not self.stiff:
            return integrate(self.table, self.arrays, self.units, kind, end, since, self._turns_out_stiff_on_the_way)
        found = collocated(self.table, self.arrays, self.units, kind, end, since)
        if not found.singular:
            return found
        # Steps have become too short, as they do at a singular place, which series come closer to.
        self.stiff, self.name, self.why, self._turns = False, Numerical.name, self._coupled, ""
        return replace(found, singular=False, given_up=True)

    def _turns_out_stiff_on_the_way(self, q: Floats, v: Floats, end: float, steps: float) -> bool:
        """Return whether it does where what is at the start does not say how many steps all of the time takes."""
        undecided = end > 0.0 and self.stiff is None
        return undecided and self._turns_out_stiff(rates_of_decay(self.arrays, q, v), end, steps)

    def _turns_out_stiff(self, rates: Floats | None, end: float, steps: float | None = None) -> bool:
        """Return whether the motion up to a time is stiff, and was not known to be; it is taken note of."""
        decay = limiting_decay(rates, end, steps) if self.stiff is None else None
        if decay is None:
            return False
        fast = decay * two_to(-self.units.time)
        limited = f"what decays at {fast:.3g} 1/s would limit the steps of its Taylor series, and not the motion"
        self.stiff, self.name, self.why = True, "collocation", f"{self._coupled}; {limited}"
        return True

    def margins(self, kind: str) -> tuple[float, float]:
        """Return what differences are widened by; see `Numerical.margins`."""
        return (STIFF_SHARE, ALIKE_MARGIN) if self.stiff else super().margins(kind)

    def steps_about(
        self, times: Floats, reach: Floats, kind: str, order: int
    ) -> tuple[tuple[Floats, Floats], Floats, Floats] | None:
        """Return the polynomials of its own steps about times, where the motion is stiff."""
        end = float(np.max(times + reach)) * two_to(-self.units.time)
        # A search may reach far beyond the first event: a motion that is not stiff is not followed for it.
        if reach[0] <= 0.0 or not (self.stiff or limiting_decay(self.rates_at_start, end)):
            return None
        run = self.run(kind, end)
        return pieces_of_steps(run, self.arrays.group, self.units, times, reach, order) if self.stiff else None
