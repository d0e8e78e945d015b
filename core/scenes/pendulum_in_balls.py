"""The pendulum at any precision: the closed form of `core.scenes.pendulum` in ball arithmetic."""

from __future__ import annotations

from collections.abc import Callable

from flint import arb

from core.elliptic.ball_functions import EllipticFunctions, split
from core.scenes.enclosure import ONE, ZERO, Ball, angle_of
from core.scenes.pendulum import Pendulum


def pendulum_in_balls(given: Pendulum) -> Callable[[Ball], tuple[Ball, Ball, Ball, Ball]]:
    """Return sine and cosine of half the angle, the rate, and the angle over whole turns, as functions of time."""
    regime, way, w0 = given.regime, given.direction, given.frequency
    if regime == "rest":
        return lambda time: (ZERO, ONE, ZERO, ZERO)
    root = given.m.sqrt()
    speed = w0 * root if regime == "rotation" else w0
    if regime == "separatrix":
        start = (way * given.sine / given.cosine).asinh()

        def on_separatrix(time: Ball) -> tuple[Ball, Ball, Ball, Ball]:
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

    def swinging(time: Ball) -> tuple[Ball, Ball, Ball, Ball]:
        sn, cn, dn = functions.at(z0 + frequency * time)
        sine = root * sn
        return sine, dn, 2 * w0 * root * cn, 2 * angle_of(sine, dn)

    def turning(time: Ball) -> tuple[Ball, Ball, Ball, Ball]:
        n, r = split(z0 + frequency * time)
        sn, cn, dn = functions.near(r)
        parity = -1 if n % 2 else 1
        angle = 2 * way * (angle_of(sn, cn) + n * arb.pi())
        return way * parity * sn, parity * cn, way * 2 * w0 * root * dn, angle

    return swinging if regime == "libration" else turning
