"""What the model of an answer claims of the motion: that it rests, or that its accelerations do not change."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from core.multibody.answer import SceneSolution
from core.multibody.audit.failure import NOISE, Ledger
from core.multibody.audit.newton import Acceleration
from core.multibody.audit.placement import Numbers
from core.multibody.audit.samples import SPIN, VELOCITY, Samples

REST, UNIFORM = "rest", "constant acceleration"
"""Names of the models that are compared."""


def check_claims(
    ledger: Ledger,
    answer: SceneSolution,
    samples: Samples,
    gains: Mapping[str, Acceleration] | None,
    typical: tuple[float, float],
) -> None:
    """Compare the velocities and spins of a motion with what its model claims of them.

    Parameters
    ----------
    samples : Samples
        Of which the first is that of the start.
    gains : mapping of str to Acceleration, or None
        At the start, where they are answered.
    typical : tuple of two floats
        A speed (m/s) and a spin (rad/s) that the forces of the scene would make: what vanishes is known beside them.
    """
    if answer.phases:
        for phase in answer.phases:
            if phase.model == REST:
                begin = phase.start + (phase.errors.get("start") or 0.0)
                resting = (samples.times > begin) & (samples.times < (np.inf if phase.end is None else phase.end))
                _check(ledger, REST, samples.at(resting), {}, typical)
        return
    names = {part.name for part in answer.model.apart}
    if names == {REST}:
        _check(ledger, REST, samples, {}, typical)
    elif names == {UNIFORM} and gains is not None:
        _check(ledger, UNIFORM, samples, gains, typical)


def _check(
    ledger: Ledger,
    model: str,
    samples: Samples,
    gains: Mapping[str, Acceleration],
    typical: tuple[float, float],
) -> None:
    """Require that rates are those of the start and grow by accelerations that do not change; none without them."""
    if not len(samples.times):
        return
    for law, name, rate, gain, error in _rates(samples, gains):
        gained = 0.0 if gain is None else samples.times[:, None] * gain.reshape(1, -1)
        off = np.abs(rate - (0.0 if gain is None else rate[:1]) - gained).max(axis=1)
        size = np.abs(rate).max() + np.abs(gained).max()
        known = 2.0 * error + ledger.rounding * size + NOISE * typical[0 if law == "velocity" else 1]
        ledger.compare(f"{law} of the model {model}", name, samples.times, off, known)


def _rates(
    samples: Samples, gains: Mapping[str, Acceleration]
) -> Iterator[tuple[str, str, Numbers, Numbers | None, Numbers]]:
    for name, twist in samples.motion.items():
        gain, errors = gains.get(name), samples.errors[name]
        yield "velocity", name, twist.velocity, None if gain is None else gain.linear, errors[:, VELOCITY]
        if twist.spin is not None:
            spin = twist.spin.reshape(len(samples.times), -1)
            yield "spin", name, spin, None if gain is None else gain.angular, errors[:, SPIN]
