"""Independent computations of what the scenes compute: other formulations, other methods, 50 digits and more."""

from __future__ import annotations

from collections.abc import Sequence

import mpmath as mp
import numpy as np
from scipy.integrate import solve_ivp


def digits_for(*numbers: float) -> int:
    """Return a number of digits in which sums of products of `numbers` lose nothing that matters."""
    logs = [abs(float(mp.log10(abs(mp.mpf(x))))) for x in numbers if x]
    return 60 + int(6 * max(logs, default=0))


def lagrange_shafts(
    masses: Sequence[float], radii: Sequence[float], factors: Sequence[float], slopes: Sequence[float], gravity: float
) -> dict[str, list[mp.mpf]]:
    """Solve the five Lagrange equations of two shafts on a taut string as a linear system.

    Unknowns x1'', x2'', theta1'', theta2'', T; source: the Lagrangian with multiplier of the homework, signs corrected.
    """
    with mp.workdps(digits_for(*masses, *radii, *factors, gravity)):
        (M1, M2), (R1, R2), (c1, c2) = ([mp.mpf(v) for v in pair] for pair in (masses, radii, factors))
        a, b = (mp.mpf(gravity) * mp.sin(mp.mpf(s)) for s in slopes)
        # Rows are scaled so that the elimination meets no accidental zero.
        matrix = mp.matrix(
            [
                [M1, 0, 0, 0, 1],
                [0, M2, 0, 0, 1],
                [0, 0, c1 * M1 * R1, 0, -1],
                [0, 0, 0, c2 * M2 * R2, -1],
                [1, 1, -R1, -R2, 0],
            ]
        )
        solution = mp.lu_solve(matrix, mp.matrix([M1 * a, M2 * b, 0, 0, 0]))
        return {
            "tension": [solution[4]],
            "accelerations": [solution[0], solution[1]],
            "angular_accelerations": [solution[2], solution[3]],
        }


def bounce_by_bounce(
    masses: Sequence[float],
    radii: Sequence[float],
    factors: Sequence[float],
    pulls: Sequence[mp.mpf],
    positions: Sequence[float],
    velocities: Sequence[float],
    spins: Sequence[float],
    restitution: float,
    time: float,
    most: int = 400,
) -> tuple[list[mp.mpf], list[mp.mpf], list[mp.mpf]]:
    """Return positions, velocities and spins at `time` by stepping from jerk to jerk on smooth slopes, e > 0.

    The impulse comes from momentum and the law of restitution solved as a linear system, not from a reduced mass.
    """
    M, R, c = ([mp.mpf(v) for v in pair] for pair in (masses, radii, factors))
    x, v, w = ([mp.mpf(u) for u in pair] for pair in (positions, velocities, spins))
    now, end, e = mp.mpf(0), mp.mpf(time), mp.mpf(restitution)
    for _ in range(most):
        opening = R[0] * w[0] + R[1] * w[1] - v[0] - v[1]
        if opening < 0:
            # Unknowns: v1, v2, w1, w2 after the jerk, and the impulse J.
            rows = [
                [M[0], 0, 0, 0, 1],
                [0, M[1], 0, 0, 1],
                [0, 0, c[0] * M[0] * R[0], 0, -1],
                [0, 0, 0, c[1] * M[1] * R[1], -1],
                [-1, -1, R[0], R[1], 0],
            ]
            known = [M[0] * v[0], M[1] * v[1], c[0] * M[0] * R[0] * w[0], c[1] * M[1] * R[1] * w[1], -e * opening]
            after = mp.lu_solve(mp.matrix(rows), mp.matrix(known))
            v, w, opening = [after[0], after[1]], [after[2], after[3]], -e * opening
        arc = 2 * opening / (pulls[0] + pulls[1])
        step = min(arc, end - now)
        x = [x[i] + v[i] * step + pulls[i] * step**2 / 2 for i in (0, 1)]
        v = [v[i] + pulls[i] * step for i in (0, 1)]
        now += step
        if now >= end:
            return x, v, w
    raise AssertionError("the time lies behind the last jerk that was stepped")


def time_stepped_shafts(
    masses: Sequence[float],
    radii: Sequence[float],
    factors: Sequence[float],
    slopes: Sequence[float],
    gravity: float,
    velocities: Sequence[float],
    spins: Sequence[float],
    kinetic: Sequence[float],
    static: Sequence[float],
    times: np.ndarray,
    step: float,
    slack: float = 0.0,
) -> tuple[np.ndarray, np.ndarray]:
    """Return velocities x_i' and R_i theta_i' at `times` by Moreau's time stepping with plastic jerks.

    Each step solves the complementarity conditions of friction and string by projected Gauss-Seidel.
    Reference: J. J. Moreau, "Unilateral contact and dry friction in finite freedom dynamics" (1988).
    """
    M, R, c = np.array(masses), np.array(radii), np.array(factors)
    pull, load = gravity * np.sin(slopes), M * gravity * np.cos(slopes)
    mu = M * c / (1 + c)
    v, r = np.array(velocities, float), R * np.array(spins, float)
    gap, now = slack, 0.0
    found_v, found_r = [], []
    for goal in times:
        while now < goal - 0.5 * step:
            free_v, free_r = v + step * pull, r.copy()
            tension, friction = 0.0, np.zeros(2)
            for _ in range(200):
                u = free_v - free_r - (tension + friction) / mu
                # The string: no opening rate below -gap/step with an impulse that pulls.
                excess = u.sum() - max(gap, 0.0) / step
                before = (tension, *friction)
                tension = max(0.0, tension + excess / (1 / mu).sum())
                u = free_v - free_r - (tension + friction) / mu
                for i in (0, 1):
                    wanted = friction[i] + mu[i] * u[i]
                    hold, drag = static[i] * load[i] * step, kinetic[i] * load[i] * step
                    friction[i] = wanted if abs(wanted) <= hold else np.sign(wanted) * drag
                if np.allclose(before, (tension, *friction), rtol=1e-9, atol=1e-12):
                    break
            v, r = free_v - (tension + friction) / M, free_r + (tension + friction) / (c * M)
            gap += step * (r - v).sum()
            now += step
        found_v.append(v.copy())
        found_r.append(r.copy())
    return np.array(found_v), np.array(found_r)


def rod_with_multipliers(
    radius: float,
    length: float,
    mass: float,
    gravity: float,
    factor: float,
    angle: float,
    rate: float,
    times: np.ndarray,
) -> dict[str, np.ndarray]:
    """Integrate a rod free in its plane (x, y, angle), held by two multipliers: the wall's forces on its ends.

    x to the right, y up, origin on the axis; end A at -l/2 along the rod, end B at +l/2.
    """
    half, depth = length / 2, np.sqrt(radius**2 - length**2 / 4)
    moment = factor * mass * length**2

    def ends(x: float, y: float, phi: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        along, across = np.array([np.cos(phi), np.sin(phi)]), np.array([-np.sin(phi), np.cos(phi)])
        centre = np.array([x, y])
        return centre - half * along, centre + half * along, along, across

    def accelerations(state: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        x, y, phi, vx, vy, w = state
        a_end, b_end, along, across = ends(x, y, phi)
        velocity = np.array([vx, vy])
        matrix, known = np.zeros((5, 5)), np.zeros(5)
        matrix[0, 0] = matrix[1, 1] = mass
        matrix[2, 2] = moment
        known[1] = -mass * gravity
        for j, (end, arm) in enumerate(((a_end, -half), (b_end, half))):
            inward = -end / radius
            matrix[0:2, 3 + j] = -inward
            matrix[2, 3 + j] = -arm * (along[0] * inward[1] - along[1] * inward[0])
            # |end|^2 is constant: end . end'' = -|end'|^2, end'' = centre'' + arm (phi'' across - w^2 along).
            speed = velocity + arm * w * across
            matrix[3 + j, 0:2] = end
            matrix[3 + j, 2] = arm * end @ across
            known[3 + j] = -speed @ speed + arm * w**2 * end @ along
        solution = np.linalg.solve(matrix, known)
        return solution[:3], solution[3:]

    start = np.array(
        [
            depth * np.sin(angle),
            -depth * np.cos(angle),
            angle,
            depth * np.cos(angle) * rate,
            depth * np.sin(angle) * rate,
            rate,
        ]
    )
    solved = solve_ivp(
        lambda _, s: np.concatenate((s[3:], accelerations(s)[0])),
        (0.0, float(times[-1])),
        start,
        method="DOP853",
        t_eval=times,
        rtol=1e-12,
        atol=1e-13,
    )
    states = solved.y.T
    return {
        "angle": states[:, 2],
        "angular_velocity": states[:, 5],
        "forces": np.array([accelerations(s)[1] for s in states]),
    }


def pendulum_angle(frequency: mp.mpf, angle: mp.mpf, rate: mp.mpf, time: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
    """Return angle and rate of psi'' = -w0^2 sin psi by Taylor series of arbitrary order, at the working precision.

    The series of s = sin psi, c = cos psi and the rate follow from products; steps of at most 1/(4 w0 + |rate|).
    """
    remaining, way = abs(mp.mpf(time)), mp.sign(time) or 1
    psi, w = mp.mpf(angle), mp.mpf(rate) * way
    order = int(1.2 * mp.mp.dps) + 20
    while remaining > 0:
        step = min(remaining, 1 / (4 * frequency + abs(w)))
        p, r, s, c = [psi], [w], [mp.sin(psi)], [mp.cos(psi)]
        for n in range(order):
            r.append(-(frequency**2) * s[n] / (n + 1))
            p.append(r[n] / (n + 1))
            s.append(mp.fsum(r[j] * c[n - j] for j in range(n + 1)) / (n + 1))
            c.append(-mp.fsum(r[j] * s[n - j] for j in range(n + 1)) / (n + 1))
        powers = [step**n for n in range(order + 1)]
        psi, w = mp.fdot(p, powers), mp.fdot(r, powers)
        remaining -= step
    return psi, w * way


def chain_state(
    masses: Sequence[float],
    slopes: Sequence[float],
    gravity: float,
    length: float,
    density: float,
    position: float,
    velocity: float,
    time: float,
) -> tuple[mp.mpf, mp.mpf, mp.mpf]:
    """Return position, velocity and apex tension of the chain by the textbook's hyperbola, or parabola."""
    with mp.workdps(digits_for(*masses, gravity, length, density, position, velocity, time) + 200):
        M1, M2, g, L, rho, x0, v0, t = (
            mp.mpf(u) for u in (*masses, gravity, length, density, position, velocity, time)
        )
        a, b = mp.sin(mp.mpf(slopes[0])), mp.sin(mp.mpf(slopes[1]))
        total = M1 + M2 + rho * L
        k2 = rho * g * (a + b) / total
        if k2 == 0:
            a0 = g * (M1 * a - M2 * b + rho * (x0 * a - (L - x0) * b)) / total
            x, v = x0 + v0 * t + a0 * t**2 / 2, v0 + a0 * t
        else:
            k = mp.sqrt(k2)
            eq = ((M2 + rho * L) * b - M1 * a) / (rho * (a + b))
            x = eq + (x0 - eq) * mp.cosh(k * t) + v0 / k * mp.sinh(k * t)
            v = k * (x0 - eq) * mp.sinh(k * t) + v0 * mp.cosh(k * t)
        return x, v, g * (a + b) * (M1 + rho * x) * (M2 + rho * (L - x)) / total


def relative(found: float, true: mp.mpf) -> float:
    """Return the relative error of `found`."""
    if true == 0:
        return float(abs(found))
    return float(abs(mp.mpf(found) - true) / abs(true))
