"""How uncertain inputs change the constants of a free motion: first-order derivatives, summed in size, compiled.

With d the circled axis, c the other extreme, b the middle, s = 1 for d the largest moment and -1 for the smallest,
every gap g_jk = |I_j - I_k| changes by s (dI_j - dI_k), or its opposite where k lies nearer to d, and

    A_c^2 = w_c^2 + (I_b g_db/I_c g_dc) w_b^2      A_b^2 = w_b^2 + (I_c g_dc/I_b g_db) w_c^2
    A_d^2 = w_d^2 + (I_b g_bc/I_d g_dc) w_b^2      p^2 = A_d^2 g_db g_dc/(I_b I_c)
    m = (I_c g_bc/I_d g_db) A_c^2/A_d^2            m1 = (I_d g_db w_d^2 - I_c g_bc w_c^2)/(I_d g_db A_d^2)

are differentiated with their signs, input by input, and only the derivatives with respect to one input are added in
size to those of the next: a bound of the first order that inputs of the worst signs reach, constant by constant. The
derivation is in docs/physics/error-statements.md.
"""

from __future__ import annotations

import math

from core.arrays import Floats
from core.compiled import kernel
from core.elliptic.integrals import one_less_e_over_k

(
    AMPLITUDE_C, AMPLITUDE_B, AMPLITUDE_D, PHASE, RATE, FREQUENCY, MODULUS, START_A, START_B, START_C, FORCE,
    FORCE_ALONG, FORCE_ACROSS, TURN, MOMENTS, GAPS, ALONG, CROSSWISE, TIP, POLE_C, POLE_B, POLE_D, PRECESSION, SINGULAR,
) = range(24)  # fmt: skip
COUNT = 24
"""What is summed, in this order: |dA_c|, |dA_b|, |dA_d|, the shift of u at the start, relative changes of p and of p/K,
|dm|/k1; the components of |dw| at the start, the largest change of Euler's coefficients, and of two equal moments that
along the axis of the third and the larger one across it; the turn of the axes; relative changes of the moments, and of
the gaps between them and that of the axis about which the body turns; of a steady spin along and across itself; of the
angular momentum's direction, the amplitudes of its path in the body, the rate of precession, and that part of it that
grows where the body leaves the middle axis."""


@kernel()
def third_axis(low: float, high: float) -> int:
    """Return the axis of the third moment where just two are equal, -1 otherwise; `low` and `high` are the gaps."""
    if low == 0.0 and high > 0.0:
        return 2
    return 0 if high == 0.0 and low > 0.0 else -1


@kernel()
def add_start(
    i: Floats, low: float, high: float, w: Floats, axis: int, dI: Floats, dw: Floats, turns: Floats, sums: Floats
) -> None:
    """Add what holds of every motion.

    Parameters
    ----------
    i, w : ndarray, shape (3,)
        Moments, ascending, and components at t = 0.
    low, high : float
        The gaps between the moments.
    axis : int
        Axis about which the body turns.
    dI, dw : ndarray, shape (n, 3)
        Changes of moments and components by each input.
    turns : ndarray, shape (n,)
        Angles by which the axes turn.
    """
    third = third_axis(low, high)
    spin = math.sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2])
    for k in range(dI.shape[0]):
        relative, apart, force, across, along = 0.0, 0.0, 0.0, 0.0, 0.0
        for a in range(3):
            b, c = (a + 1) % 3, (a + 2) % 3
            relative = max(relative, abs(dI[k, a]) / i[a])
            gap = (low if a + axis == 1 else high if a + axis == 3 else low + high) if a != axis else 0.0
            if gap > 0.0:
                apart = max(apart, abs(dI[k, a] - dI[k, axis]) / gap)
            coefficient = abs(dI[k, b] - dI[k, c] - (i[b] - i[c]) * dI[k, a] / i[a]) / i[a]
            force = max(force, coefficient)
            if a == third:
                sums[FORCE_ALONG] += coefficient
            else:
                across = max(across, coefficient)
            sums[START_A + a] += abs(dw[k, a])
            along += dw[k, a] * w[a]
        along = abs(along) / spin
        x = dw[k, 1] * w[2] - dw[k, 2] * w[1]
        y = dw[k, 2] * w[0] - dw[k, 0] * w[2]
        z = dw[k, 0] * w[1] - dw[k, 1] * w[0]
        sums[FORCE] += force
        sums[FORCE_ACROSS] += across
        sums[TURN] += turns[k]
        sums[MOMENTS] += relative
        sums[GAPS] += apart
        sums[ALONG] += along
        sums[CROSSWISE] += math.sqrt(x * x + y * y + z * z) / spin


@kernel()
def add_constants(
    i: Floats, low: float, high: float, w: Floats, circled: int, m: float, k1: float, K: float,
    dI: Floats, dw: Floats, sums: Floats, table: Floats,
) -> None:  # fmt: skip
    """Add what changes the constants of a motion that turns.

    `table`, shape (n, 6), is filled with what each input changes: A_c, A_b, A_d, u at the start, log p and m/k1.

    Parameters
    ----------
    i, w : ndarray, shape (3,)
        Moments, ascending, and components at t = 0, of order one.
    low, high : float
        The gaps between the moments, B - A and C - B.
    circled : int
        Axis d.
    m, k1, K : float
        Parameter, complementary modulus, quarter period; k1 = K = 0 on the separatrix.
    dI, dw : ndarray, shape (n, 3)
        By what a unit of the relative uncertainty of each input changes moments and components.
    """
    d, c, s = (2, 0, 1.0) if circled == 2 else (0, 2, -1.0)
    g_dc = low + high
    g_db, g_bc = (high, low) if circled == 2 else (low, high)
    Ic, Ib, Id, wc, wb, wd = i[c], i[1], i[d], w[c], w[1], abs(w[d])
    sign = 1.0 if w[d] >= 0.0 else -1.0
    r_c, r_b, r_d = Ib * g_db / (Ic * g_dc), Ic * g_dc / (Ib * g_db), Ib * g_bc / (Id * g_dc)
    # Norms whose squares may leave the range of doubles.
    A_c, A_b = math.hypot(wc, math.sqrt(r_c) * wb), math.hypot(wb, math.sqrt(r_b) * wc)
    A_d = math.hypot(wd, math.sqrt(r_d) * wb)
    sn, cn, dn = wb / A_b, wc / A_c, wd / A_d
    L = math.sqrt((Ic * wc) ** 2 + (Ib * wb) ** 2 + (Id * wd) ** 2)
    E2 = Ic * wc * wc + Ib * wb * wb + Id * wd * wd
    # Next to the separatrix m1 = k1^2 may be below every double: dm is kept as a multiple of k1.
    unit = k1 if k1 > 0.0 else 1.0
    D = Ic * g_dc * wc * wc + Ib * g_db * wb * wb
    dK = slope_of_quarter(m, k1, K)
    for k in range(dI.shape[0]):
        ic, ib, jd = dI[k, c], dI[k, 1], dI[k, d]
        c1, b1, d1 = dw[k, c], dw[k, 1], sign * dw[k, d]
        e_dc, e_db, e_bc = s * (jd - ic), s * (jd - ib), s * (ib - ic)
        e_c, e_b, e_d = ic / Ic, ib / Ib, jd / Id
        # Each ratio r of gaps carries its own relative change; a gap in a numerator may vanish, and is not divided by.
        dr_c = r_c * (e_b - e_c - e_dc / g_dc) + Ib / (Ic * g_dc) * e_db
        dr_d = r_d * (e_b - e_d - e_dc / g_dc) + Ib / (Id * g_dc) * e_bc
        from_b = r_b * (e_c - e_b + e_dc / g_dc - e_db / g_db)
        dA_c = cn * c1 + wb / A_c * (r_c * b1 + 0.5 * wb * dr_c)
        dA_b = sn * b1 + wc / A_b * (r_b * c1 + 0.5 * wc * from_b)
        dA_d = dn * d1 + wb / A_d * (r_d * b1 + 0.5 * wb * dr_d)
        dp = dA_d / A_d + 0.5 * (e_db / g_db + e_dc / g_dc - e_b - e_c)
        if m < 0.5:
            ratio = Ic / (Id * g_db) * (A_c / A_d) ** 2
            changed = ratio * e_bc + m * (e_c - e_d - e_db / g_db + 2.0 * dA_c / A_c - 2.0 * dA_d / A_d)
            changed /= unit
        else:
            share = wc / A_d
            dD = dn / unit * (dn * (e_d + e_db / g_db) + 2.0 * d1 / A_d)
            dD -= Ic / (Id * g_db) * share / unit * (share * (g_bc * e_c + e_bc) + 2.0 * g_bc * c1 / A_d)
            changed = -dD + k1 / unit * k1 * (e_d + e_db / g_db + 2.0 * dA_d / A_d)
        # tan phi = sn/cn at the start.
        phase = cn * (b1 - sn * dA_b) / A_b - sn * (c1 - cn * dA_c) / A_c
        sums[AMPLITUDE_C] += abs(dA_c)
        sums[AMPLITUDE_B] += abs(dA_b)
        sums[AMPLITUDE_D] += abs(dA_d)
        sums[PHASE] += abs(phase) / dn
        sums[RATE] += abs(dp)
        sums[FREQUENCY] += abs(dp - dK / K * changed) if K > 0.0 else abs(dp)
        sums[MODULUS] += abs(changed)
        table[k, 0], table[k, 1], table[k, 2] = dA_c, dA_b, dA_d
        table[k, 3], table[k, 4], table[k, 5] = phase / dn, dp, changed
        # The angular momentum: its size, its direction, the amplitudes of its unit vector, and the rate about it.
        xc, xb, xd = ic * wc + Ic * c1, ib * wb + Ib * b1, jd * wd + Id * d1
        dL = (xc * Ic * wc + xb * Ib * wb + xd * Id * wd) / L
        dE = ic * wc * wc + ib * wb * wb + jd * wd * wd + 2.0 * (Ic * wc * c1 + Ib * wb * b1 + Id * wd * d1)
        sums[TIP] += math.sqrt(max(0.0, xc * xc + xb * xb + xd * xd - dL * dL)) / L
        sums[POLE_C] += abs(ic * A_c + Ic * (dA_c - A_c * dL / L)) / L
        sums[POLE_B] += abs(ib * A_b + Ib * (dA_b - A_b * dL / L)) / L
        sums[POLE_D] += abs(jd * A_d + Id * (dA_d - A_d * dL / L)) / L
        largest = 0.0
        for at in (1.0, 0.5 + 0.5 * k1, k1):
            f = A_d * at
            h, over = (E2 + L * f) / (L + Id * f), L + Id * f
            largest = max(largest, abs(dE + dL * f + L * dA_d * at - h * (dL + jd * f + Id * dA_d * at)) / over)
        sums[PRECESSION] += largest
        under = L + Id * A_d * k1
        sums[SINGULAR] += D / (under * under) * A_d * abs(changed) * 0.5


@kernel()
def slope_of_quarter(m: float, k1: float, K: float) -> float:
    """Return k1 dK/dm = (E - m1 K)/(2 m k1), to a few digits; 0 on the separatrix, which has no quarter period."""
    if K == 0.0:
        return 0.0
    if m < 1e-4:
        return 0.125 * math.pi * (1.0 + 1.125 * m) * k1
    if k1 < 1e-6:
        return 0.5 / k1
    return 0.5 * (K * (1.0 - one_less_e_over_k(m, k1)) - k1 * k1 * K) / (m * k1)
