"""The state of a scene at one time, in balls of the current precision."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from flint import arb

from core.certified.decimals import Undetermined
from core.certified.elliptic_functions import ONE, EllipticFunctions, split
from core.errors import NotApplicable
from core.scenes.answer import ConstrainedSystem, Motion
from core.scenes.bounces import Sequence
from core.scenes.chain_motion import ChainMotion, Slide
from core.scenes.enclosure import Balls, exact_pair
from core.scenes.pendulum import Pendulum
from core.scenes.rod_motion import RodMotion
from core.scenes.string_phases import Phase
from core.scenes.string_samples import ShaftMotion
from core.scenes.string_state import State
from core.scenes.unwinding_shafts import UnwindingShafts

Sample = Mapping[str, Any]
Sampler = Callable[[arb], Sample]


def sampler(scene: ConstrainedSystem, motion: Motion) -> Sampler:
    """Return the motion of a scene as a function of time, with values named as the scene's columns."""
    if isinstance(motion, RodMotion):
        return _rod(motion)
    if isinstance(motion, ChainMotion):
        return _chain(motion.slide)
    if isinstance(motion, ShaftMotion) and isinstance(scene, UnwindingShafts):
        return _shafts(motion, exact_pair(scene.radii))
    raise NotApplicable("this scene has no closed form in ball arithmetic", path=("digits",))


def _rod(motion: RodMotion) -> Sampler:
    swing = pendulum(motion.pendulum)
    c1, c2, c3 = motion.rod.coefficients

    def at(time: arb) -> Sample:
        sine, cosine, rate, angle = swing(time)
        # A square as a product: the library returns NaN for the power of a ball that contains zero.
        total = c1 * (cosine - sine) * (cosine + sine) + c2 * rate * rate
        difference = 2 * c3 * sine * cosine
        forces = ((total + difference) / 2, (total - difference) / 2)
        return {"angle": angle, "angular_velocity": rate, "forces": forces}

    return at


def pendulum(given: Pendulum) -> Callable[[arb], tuple[arb, arb, arb, arb]]:
    """Return sine and cosine of half the angle, the rate, and the angle over whole turns, as functions of time."""
    regime, way, w0 = given.regime, given.direction, given.frequency
    if regime == "rest":
        return lambda time: (arb(0), arb(1), arb(0), arb(0))
    root = given.m.sqrt()
    speed = w0 * root if regime == "rotation" else w0
    if regime == "separatrix":
        start = (way * given.sine / given.cosine).asinh()

        def on_separatrix(time: arb) -> tuple[arb, arb, arb, arb]:
            u = start + speed * time
            tanh, sech = u.tanh(), u.sech()
            # atan(sinh u), the Gudermannian, without the cancellation of 1 - tanh.
            return way * tanh, sech, way * 2 * w0 * sech, way * 2 * u.sinh().atan()

        return on_separatrix
    if regime == "libration":
        functions = EllipticFunctions(given.m, given.m1)
        u0 = functions.argument(given.sine / root, given.rate / (2 * w0 * root), given.cosine)
    else:
        functions = EllipticFunctions(1 / given.m, -given.m1 / given.m)
        u0 = functions.argument(way * given.sine, given.cosine, abs(given.rate) / (2 * w0 * root))
    half = 2 * functions.quarter
    z0, frequency = u0 / half, speed / half

    def swinging(time: arb) -> tuple[arb, arb, arb, arb]:
        sn, cn, dn = functions.at(z0 + frequency * time)
        sine = root * sn
        return sine, dn, 2 * w0 * root * cn, 2 * arb.atan2(sine, dn)

    def turning(time: arb) -> tuple[arb, arb, arb, arb]:
        n, r = split(z0 + frequency * time)
        sn, cn, dn = functions.near(r)
        parity = -1 if n % 2 else 1
        angle = 2 * way * (arb.atan2(sn, cn) + n * arb.pi())
        return way * parity * sn, parity * cn, way * 2 * w0 * root * dn, angle

    return swinging if regime == "libration" else turning


def _chain(slide: Slide) -> Sampler:
    k, x0, v0, a0 = slide.rate, slide.position, slide.velocity, slide.acceleration

    def at(time: arb) -> Sample:
        if k.is_zero():
            x, v = x0 + time * (v0 + a0 * time / 2), v0 + a0 * time
        else:
            sinh, cosh = (k * time).sinh_cosh()
            half = (k * time / 2).sinh()
            x, v = x0 + v0 * sinh / k + 2 * a0 * half * half / (k * k), v0 * cosh + a0 * sinh / k
        return {"position": x, "velocity": v, "apex_tension": slide.tension(x)}

    return at


def _shafts(motion: ShaftMotion, radii: Balls) -> Sampler:
    phases = motion.phases.phases

    def at(time: arb) -> Sample:
        here = phases[0]
        for phase in phases[1:]:
            if not phase.start.time > time:
                here = phase
        state = _within(here, time - here.start.time)
        found = {
            "positions": state.positions,
            "velocities": state.velocities,
            "spins": (state.rates[0] / radii[0], state.rates[1] / radii[1]),
            "unwound": state.unwound,
        }
        return found if here.drive.tension is None else {**found, "tension": here.drive.tension}

    return at


def _within(phase: Phase, elapsed: arb) -> State:
    """Return the state at a time after the start of a phase; in a sequence of jerks, in the arc between two of them."""
    if phase.sequence is None:
        return phase.start.after(phase.drive, elapsed)
    sequence = phase.sequence
    n = _arcs(sequence, elapsed / sequence.first)
    if phase.last_arc is not None:
        n = min(n, phase.last_arc)
    S = sequence.sum(n)
    return sequence.at(S).after(phase.drive, elapsed - sequence.first * S)


def _arcs(sequence: Sequence, firsts: arb) -> int:
    """Return the number of arcs completed after a time in units of the first arc's duration."""
    e = sequence.restitution
    count = firsts if sequence.limit is None else (ONE - (1 - e) * firsts).log() / e.log()
    if not count.is_finite():
        raise Undetermined
    whole = count.floor().unique_fmpz()
    if whole is None:
        raise Undetermined
    return max(0, int(whole))
