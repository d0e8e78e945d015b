"""Angular velocity along a torque-free motion at any times, compiled: a few nanoseconds a sample at any horizon."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from core.compiled import fma, kernel
from core.double_double import two_prod
from core.elliptic.functions import half_parity, separatrix_at, sin_cos_quarter, sinh_cosh, split_phase, theta_parts
from core.rotation.closed_form.circulation import PERIODIC
from core.rotation.closed_form.constants_of_motion import ConstantsOfMotion, Weights


@kernel()
def quotient(above: float, over: float, lost: float) -> float:
    """Return above * over (1 + lost): one reciprocal serves three quotients, each as if divided."""
    near = above * over
    return fma(near, lost, near)


@kernel(inline="always")
def about_quarter(
    odd: bool, sign: float, S: float, C: float, D3: float, D4: float, weights: Weights
) -> tuple[float, float, float]:
    """Return the components along c, b, d near a quarter period, from the parts of the theta functions there.

    Near the separatrix, where the theta functions are those of the complementary nome, `C` and `D4` change places.
    """
    # Taken out before they are chosen from, so that choosing is no branch.
    c_even, b_even, d_even, c_odd, b_odd, d_odd = weights
    below = D3 if odd else D4
    over = 1.0 / below
    lost = fma(-over, below, 1.0)
    signed = sign * over
    return (
        quotient((c_odd if odd else c_even) * (S if odd else C), signed, lost),
        quotient((b_odd if odd else b_even) * (C if odd else S), signed, lost),
        quotient((d_odd if odd else d_even) * (D4 if odd else D3), over, lost),
    )


@kernel()
def _circular(
    motion: ConstantsOfMotion,
    times: NDArray[np.float64],
    oc: NDArray[np.float64],
    ob: NDArray[np.float64],
    od: NDArray[np.float64],
) -> None:
    lat = motion.lattice
    for i in range(times.size):
        t = motion.time_scale * times[i]
        n, r, r_tail = split_phase(motion.rate, motion.rate_tail, t, motion.start, motion.start_tail)
        odd, sign = half_parity(n + motion.start_quarter)
        s, c = sin_cos_quarter(r, r_tail)
        S, C, D3, D4 = theta_parts(True, lat.nome, 0.0, s, c)
        oc[i], ob[i], od[i] = about_quarter(odd, sign, S, C, D3, D4, motion.weights)


@kernel()
def _hyperbolic(
    motion: ConstantsOfMotion,
    times: NDArray[np.float64],
    oc: NDArray[np.float64],
    ob: NDArray[np.float64],
    od: NDArray[np.float64],
) -> None:
    lat = motion.lattice
    for i in range(times.size):
        t = motion.time_scale * times[i]
        n, r, r_tail = split_phase(motion.rate, motion.rate_tail, t, motion.start, motion.start_tail)
        odd, sign = half_parity(n + motion.start_quarter)
        xh, xl = two_prod(r, lat.scale)
        s, c = sinh_cosh(xh, xl + fma(r, lat.scale_tail, r_tail * lat.scale))
        S, C, D3, D4 = theta_parts(False, lat.nome, lat.root_nome, s, c)
        oc[i], ob[i], od[i] = about_quarter(odd, sign, S, D4, D3, C, motion.weights)


@kernel()
def _separatrix(
    motion: ConstantsOfMotion,
    times: NDArray[np.float64],
    oc: NDArray[np.float64],
    ob: NDArray[np.float64],
    od: NDArray[np.float64],
) -> None:
    for i in range(times.size):
        t = motion.time_scale * times[i]
        xh, xl = two_prod(motion.rate, t)
        xl = fma(motion.rate_tail, t, xl)
        yh = xh + motion.start
        z = yh - xh
        yl = (xh - (yh - z)) + (motion.start - z) + xl + motion.start_tail
        tanh, sech = separatrix_at(yh, yl)
        oc[i] = motion.A_c * sech
        ob[i] = motion.A_b * tanh
        od[i] = motion.A_d * sech


@kernel()
def sample_components(
    motion: ConstantsOfMotion,
    times: NDArray[np.float64],
    oc: NDArray[np.float64],
    ob: NDArray[np.float64],
    od: NDArray[np.float64],
) -> None:
    """Fill `oc`, `ob`, `od`, shape (n,), with the components along the axes c, b, d of a motion that turns."""
    if motion.regime == PERIODIC:
        if motion.lattice.circular:
            _circular(motion, times, oc, ob, od)
        else:
            _hyperbolic(motion, times, oc, ob, od)
    else:
        _separatrix(motion, times, oc, ob, od)


@kernel()
def turn_into_body(axes: NDArray[np.float64], out: NDArray[np.float64]) -> None:
    """Replace principal components, shape (3, n), by those in body axes; columns of `axes` are the principal axes."""
    x, y, z = out[0], out[1], out[2]
    a, b, c = axes[0, 0], axes[0, 1], axes[0, 2]
    d, e, f = axes[1, 0], axes[1, 1], axes[1, 2]
    g, h, i = axes[2, 0], axes[2, 1], axes[2, 2]
    for n in range(x.size):
        p, q, r = x[n], y[n], z[n]
        x[n] = fma(a, p, fma(b, q, c * r))
        y[n] = fma(d, p, fma(e, q, f * r))
        z[n] = fma(g, p, fma(h, q, i * r))


@kernel()
def largest_magnitude(times: NDArray[np.float64]) -> float:
    """Return max |t|; infinite if any entry is not finite."""
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    odd = 0.0
    whole = times.size - times.size % 4
    # Four independent maxima, because one would wait for itself at every entry.
    for i in range(0, whole, 4):
        w, x, y, z = abs(times[i]), abs(times[i + 1]), abs(times[i + 2]), abs(times[i + 3])
        odd += ((w - w) + (x - x)) + ((y - y) + (z - z))
        a, b, c, d = (w if w > a else a), (x if x > b else b), (y if y > c else c), (z if z > d else d)
    for i in range(whole, times.size):
        w = abs(times[i])
        odd += w - w
        a = w if w > a else a
    return max(a, b, c, d) if odd == 0.0 else np.inf
