"""Integrators that run compiled from end to end: the equation too, by their own means or as a function from Numba."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numba import njit

from benchmarks.peers.cases import Case
from benchmarks.peers.equations import answer, c_function, c_function_output_first, initial_state, vector_field
from benchmarks.peers.peer import COMPILED, TOLERANCES, Peer, Run
from core.arrays import Floats
from core.systems.budget import Budget
from core.systems.methods import DormandPrince853
from tests.core.systems.systems import Given

UNLIMITED = Budget(evaluations=10**12)


def _own(case: Case, tolerance: float) -> Run:
    """This project's Dormand-Prince, compiled by Numba with the equation as a C pointer."""
    system = Given(vector_field(case.attitude), initial_state(case), np.array(case.coefficients))
    times, method = case.times, DormandPrince853(tolerance)
    return lambda: answer(case, method.integrate(system, times, UNLIMITED).states)


def _heyoka(case: Case, tolerance: float) -> Run:
    import heyoka as hy

    x, y, z, a, b, c, d = hy.make_vars("x", "y", "z", "a", "b", "c", "d")
    p, q, r = case.coefficients
    equations = [(x, p * y * z), (y, q * z * x), (z, r * x * y)]
    if case.attitude:
        equations += [
            (a, -0.5 * (b * x + c * y + d * z)),
            (b, 0.5 * (a * x + c * z - d * y)),
            (c, 0.5 * (a * y + d * x - b * z)),
            (d, 0.5 * (a * z + b * y - c * x)),
        ]
    start, times = initial_state(case), case.times
    integrator = hy.taylor_adaptive(equations, start, tol=tolerance)

    def run() -> Floats:
        integrator.time = 0.0
        integrator.state[:] = start
        return answer(case, np.asarray(integrator.propagate_grid(times)[-1]))

    return run


def _numbalsoda(method: str, case: Case, tolerance: float) -> Run:
    import numbalsoda

    solver = getattr(numbalsoda, method)
    address, start, times = c_function(case.attitude).address, initial_state(case), case.times
    coefficients = np.array(case.coefficients)

    def run() -> Floats:
        states, success = solver(address, start, times, data=coefficients, rtol=tolerance, atol=tolerance, mxstep=10**8)
        if not success:
            raise ArithmeticError("the integrator reports failure")
        return answer(case, states)

    return run


@cache
def _cyrk_solver() -> Any:
    """Return CyRK's solver with the samples copied out of it, compiled as one function."""
    from CyRK import nbsolve2_ivp

    @njit
    def solved(address: int, span: Any, start: Floats, times: Floats, coefficients: Floats, tolerance: float) -> Any:
        found = nbsolve2_ivp(
            address, span, start, method="DOP853", t_eval=times, args=coefficients, rtol=tolerance, atol=tolerance
        )
        success, states = found.success, found.y.T.copy()
        found.free()
        return success, states

    return solved


def _cyrk(case: Case, tolerance: float) -> Run:
    solver, address = _cyrk_solver(), c_function_output_first(case.attitude).address
    span, start, times, coefficients = (0.0, case.stop), initial_state(case), case.times, np.array(case.coefficients)

    def run() -> Floats:
        success, states = solver(address, span, start, times, coefficients, tolerance)
        if not success:
            raise ArithmeticError("the integrator reports failure")
        return answer(case, states)

    return run


@cache
def _diffrax_solver(attitude: bool) -> Any:
    """Return diffrax's solver as one compiled function of start, times, coefficients and tolerance."""
    import diffrax
    import jax
    import jax.numpy as jnp

    jax.config.update("jax_enable_x64", True)

    def field(t: object, s: jax.Array, coefficients: jax.Array) -> jax.Array:
        p, q, r = coefficients
        x, y, z = s[0], s[1], s[2]
        slope = [p * y * z, q * z * x, r * x * y]
        if attitude:
            a, b, c, d = s[3], s[4], s[5], s[6]
            slope += [-(b * x + c * y + d * z) / 2, (a * x + c * z - d * y) / 2]
            slope += [(a * y + d * x - b * z) / 2, (a * z + b * y - c * x) / 2]
        return jnp.stack(slope)

    @jax.jit
    def solved(start: jax.Array, times: jax.Array, coefficients: jax.Array, tolerance: jax.Array) -> jax.Array:
        return diffrax.diffeqsolve(
            diffrax.ODETerm(field),
            diffrax.Dopri5(),
            0.0,
            times[-1],
            None,
            start,
            coefficients,
            saveat=diffrax.SaveAt(ts=times),
            stepsize_controller=diffrax.PIDController(rtol=tolerance, atol=tolerance),
            adjoint=diffrax.ForwardMode(),
            max_steps=10**7,
        ).ys

    return solved


def _diffrax(case: Case, tolerance: float) -> Run:
    """Dopri5: Dopri8 took longer at every tolerance, since it evaluates its larger interpolant for every sample."""
    solver, coefficients = _diffrax_solver(case.attitude), np.array(case.coefficients)
    start, times = initial_state(case), case.times
    return lambda: answer(case, np.asarray(solver(start, times, coefficients, tolerance)))


PEERS = (
    Peer("Dormand-Prince 853, Numba", COMPILED, "numba", _own, "tolerance", TOLERANCES),
    Peer("heyoka Taylor", COMPILED, "heyoka", _heyoka, "tolerance", (*TOLERANCES, 2.0**-52)),
    Peer(
        "numbalsoda DOP853",
        COMPILED,
        "numbalsoda",
        lambda case, tolerance: _numbalsoda("dop853", case, tolerance),
        "tolerance",
        TOLERANCES,
    ),
    Peer(
        "numbalsoda LSODA",
        COMPILED,
        "numbalsoda",
        lambda case, tolerance: _numbalsoda("lsoda", case, tolerance),
        "tolerance",
        TOLERANCES,
    ),
    Peer(
        "CyRK DOP853",
        COMPILED,
        "CyRK",
        _cyrk,
        "tolerance",
        TOLERANCES,
    ),
    Peer("diffrax Dopri5", COMPILED, "diffrax", _diffrax, "tolerance", TOLERANCES[::2]),
)
