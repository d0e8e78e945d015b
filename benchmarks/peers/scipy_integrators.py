"""SciPy's integrators: they step in Python, except odeint, and all of them call the equation through Python."""

from __future__ import annotations

import warnings

from benchmarks.peers.cases import Case
from benchmarks.peers.equations import answer, array_function, initial_state
from benchmarks.peers.peer import INTERPRETED, TOLERANCES, Peer, Run
from core.arrays import Floats


def _solve_ivp(method: str, case: Case, tolerance: float) -> Run:
    from scipy.integrate import solve_ivp

    slope, start, times = array_function(case), initial_state(case), case.times
    slope(0.0, start)

    def run() -> Floats:
        with warnings.catch_warnings(action="ignore"):
            found = solve_ivp(slope, (0.0, case.stop), start, method, times, rtol=tolerance, atol=tolerance)
        if not found.success:
            raise ArithmeticError(found.message)
        return answer(case, found.y.T)

    return run


def _odeint(case: Case, tolerance: float) -> Run:
    from scipy.integrate import ODEintWarning, odeint

    slope, start, times = array_function(case), initial_state(case), case.times

    def run() -> Floats:
        with warnings.catch_warnings(action="error", category=ODEintWarning):
            states = odeint(slope, start, times, rtol=tolerance, atol=tolerance, mxstep=10**6, tfirst=True)
        return answer(case, states)

    return run


def _peer(method: str, tolerances: tuple[float, ...]) -> Peer:
    return Peer(
        f"SciPy solve_ivp {method}",
        INTERPRETED,
        "scipy",
        lambda case, tolerance: _solve_ivp(method, case, tolerance),
        "rtol = atol",
        tolerances,
    )


PEERS = (
    _peer("DOP853", TOLERANCES),
    _peer("RK45", TOLERANCES[::2]),
    _peer("LSODA", TOLERANCES[::2]),
    _peer("Radau", TOLERANCES[:6:2]),
    Peer("SciPy odeint", INTERPRETED, "scipy", _odeint, "rtol = atol", TOLERANCES),
)
