"""A double pendulum of two rods released at rest, for 10 s: by this project and by its peers.

Integrators get the equations in the rods' angles, derived by hand or by sympy. MuJoCo and Drake get links and hinges.
Every number is a double, so that all solve the same problem. Each is swept through its setting; the error is the larger
difference of the two angles after 10 s (rad) from the motion at 30 digits. What a new scene costs is measured apart
from what a motion costs, but for the whole question to this project.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import mpmath
import numpy as np

from benchmarks.described_scenes.drake import prepared
from core.arrays import Floats
from core.balls import precision
from core.multibody.algebra.polynomials import BITS
from core.multibody.language.reading import scene_from
from core.multibody.motion.modelling import modelled
from core.multibody.motion.numerical import Numerical
from core.multibody.solve import solve_scene
from core.systems.methods.dormand_prince_853 import DormandPrince853

G, INERTIA, HALF, END = 9.8125, 0.08203125, 0.5, 10.0
START = (0.0, 1.5, 0.0, 0.0)
SCENE: dict[str, Any] = {
    "gravity": [0, -G],
    "bodies": {
        "one": {"mass": 1, "inertia": INERTIA, "at": [0.5, 0], "places": {"top": [-0.5, 0], "end": [0.5, 0]}},
        "two": {
            "mass": 1,
            "inertia": INERTIA,
            "at": ["1 + cos(1.5)/2", "sin(1.5)/2"],
            "angle": 1.5,
            "places": {"top": [-0.5, 0]},
        },
    },
    "connections": [{"kind": "pin", "a": "one.top", "b": [0, 0]}, {"kind": "pin", "a": "two.top", "b": "one.end"}],
}

Angles = tuple[mpmath.mpf | float, mpmath.mpf | float]
Run = Callable[[], Any]
TOLERANCES = tuple(10.0**-k for k in (4, 6, 8, 10, 12, 14))
FINEST_OF_DOUBLES = 1e-14
STEPS = (1e-2, 3e-3, 1e-3, 3e-4, 1e-4)


@dataclass(frozen=True)
class Entrant:
    """One way to compute the motion.

    Attributes
    ----------
    package : str
        The distribution that has to be installed.
    prepare : callable
        From a setting to a run.
    settings : tuple of float
    angles : callable
        From what a run returns to the two angles after 10 s.
    """

    name: str
    package: str
    prepare: Callable[[float], Run]
    settings: tuple[float, ...]
    angles: Callable[[Any], Angles] = lambda found: found


with mpmath.workdps(30):
    EXACT = (mpmath.mpf("0.31882713913599546864"), mpmath.mpf("-40.878526862214604295"))
"""The angles after 10 s, by heyoka's Taylor series of the equations in the angles, in 113 bits (real128)."""


def _ours(accuracy: float) -> Run:
    """The whole question: reading, set-up, motion, error statement."""

    def run() -> tuple[float, float]:
        answer = solve_scene(scene_from(SCENE), [END], ("trajectory",), accuracy)
        assert answer.trajectory is not None
        columns = answer.trajectory.columns
        return float(columns["one.angle"].values[-1]), float(columns["two.angle"].values[-1])

    return run


def _motion(accuracy: float) -> Run:
    """The motion and its error, of a scene that is set up: in doubles judged by pairs, or in pairs judged by pairs."""
    with precision(BITS):
        ((_, motion),) = modelled(scene_from(SCENE)).whole.parts
    assert isinstance(motion, Numerical)
    assert motion.table.names == ["one.cos", "one.sin", "two.cos", "two.sin"]

    def run() -> Floats:
        return replace(motion, _runs={}).states(np.array([END]), finer=accuracy < FINEST_OF_DOUBLES).q[0]

    return run


def _angles(found: Floats) -> Angles:
    """Return angles from direction cosines in pairs, with the turns of the known motion."""
    with mpmath.workdps(30):
        cosine, sine, *other = (mpmath.mpf(x) + mpmath.mpf(tail) for x, tail in found)
        turns = 2 * mpmath.pi * mpmath.nint((EXACT[1] - mpmath.atan2(other[1], other[0])) / (2 * mpmath.pi))
        return mpmath.atan2(sine, cosine), mpmath.atan2(other[1], other[0]) + turns


def _same_table(tolerance: float) -> Run:
    """Dormand and Prince's method of order 8 on the same table in compiled code, put back onto the connections."""
    method = DormandPrince853(tolerance=tolerance)

    def run() -> tuple[float, float]:
        answer = solve_scene(scene_from(SCENE), [END], ("trajectory",), method=method)
        assert answer.trajectory is not None
        columns = answer.trajectory.columns
        return float(columns["one.angle"].values[-1]), float(columns["two.angle"].values[-1])

    return run


def _rates(_: float, state: Any) -> tuple[float, ...]:
    p, q, u, v = state
    c, s = HALF * np.cos(p - q), HALF * np.sin(p - q)
    a, b = INERTIA + 1.25, INERTIA + 0.25
    x, y = -s * v * v - 1.5 * G * np.cos(p), s * u * u - HALF * G * np.cos(q)
    det = a * b - c * c
    return u, v, (b * x - c * y) / det, (a * y - c * x) / det


def _scipy(tolerance: float) -> Run:
    from scipy.integrate import solve_ivp

    def run() -> tuple[float, float]:
        found = solve_ivp(_rates, (0, END), START, "DOP853", rtol=max(tolerance, 3e-14), atol=tolerance).y
        return float(found[0, -1]), float(found[1, -1])

    return run


def _sympy(tolerance: float) -> Run:
    """Lagrange's equations derived and made a function by sympy, then solve_ivp."""
    import sympy
    from scipy.integrate import solve_ivp

    t = sympy.symbols("t")
    p, q = (sympy.Function(name)(t) for name in "pq")
    u, v = p.diff(t), q.diff(t)
    joint = (sympy.cos(p), sympy.sin(p))
    one = [x / 2 for x in joint]
    two = [joint[0] + sympy.cos(q) / 2, joint[1] + sympy.sin(q) / 2]
    speeds = sum(x.diff(t) ** 2 for x in (*one, *two))
    lagrangian = (speeds + INERTIA * (u**2 + v**2)) / 2 - G * (one[1] + two[1])
    equations = [lagrangian.diff(rate).diff(t) - lagrangian.diff(angle) for angle, rate in ((p, u), (q, v))]
    gains = sympy.solve(equations, [u.diff(t), v.diff(t)], simplify=False)
    state = sympy.symbols("p q u v")
    replaced = [gains[x.diff(t)].subs({u: state[2], v: state[3]}).subs({p: state[0], q: state[1]}) for x in (u, v)]
    function = sympy.lambdify(state, replaced, cse=True)

    def run() -> tuple[float, float]:
        found = solve_ivp(
            lambda _, y: (y[2], y[3], *function(*y)),
            (0, END),
            START,
            "DOP853",
            rtol=max(tolerance, 3e-14),
            atol=tolerance,
        ).y
        return float(found[0, -1]), float(found[1, -1])

    return run


def _heyoka(tolerance: float) -> Run:
    import heyoka as hy

    p, q, u, v = hy.make_vars("p", "q", "u", "v")
    c, s = HALF * hy.cos(p - q), HALF * hy.sin(p - q)
    a, b = INERTIA + 1.25, INERTIA + 0.25
    x, y = -s * v * v - 1.5 * G * hy.cos(p), s * u * u - HALF * G * hy.cos(q)
    det = a * b - c * c
    equations = [(p, u), (q, v), (u, (b * x - c * y) / det), (v, (a * y - c * x) / det)]
    integrator = hy.taylor_adaptive(equations, START, tol=tolerance)

    def run() -> tuple[float, float]:
        integrator.time = 0.0
        integrator.state[:] = START
        integrator.propagate_until(END)
        return float(integrator.state[0]), float(integrator.state[1])

    return run


ROD = f'<inertial pos=".5 0 0" mass="1" diaginertia="{INERTIA} {INERTIA} {INERTIA}"/>'


def _mujoco(step: float) -> Run:
    """Runge and Kutta's method of order 4; hinges are joints of the tree, exact by construction."""
    import mujoco

    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><compiler angle="radian"/><option gravity="0 0 -{G}" integrator="RK4" timestep="{step}">'
        '<flag contact="disable" constraint="disable"/></option><worldbody>'
        f'<body><joint name="p" axis="0 -1 0"/>{ROD}'
        f'<body pos="1 0 0"><joint name="q" axis="0 -1 0"/>{ROD}</body></body>'
        "</worldbody></mujoco>"
    )
    data, count = mujoco.MjData(model), round(END / step)

    def run() -> tuple[float, float]:
        mujoco.mj_resetData(model, data)
        data.qpos[:] = [START[0], START[1] - START[0]]
        mujoco.mj_step(model, data, nstep=count)
        return float(data.qpos[0]), float(data.qpos[0] + data.qpos[1])

    return run


def _drake(accuracy: float) -> Run:
    return prepared(accuracy, G, INERTIA, HALF, START, END)


ENTRANTS = (
    Entrant("Polhode, whole question with error statement", "numpy", _ours, (1e-6, 1e-9, 1e-12, 1e-15)),
    Entrant("Polhode, the motion with its error", "numpy", _motion, (1e-9, 1e-15), _angles),
    Entrant("Polhode, whole question by DOP853 on the same table", "numpy", _same_table, TOLERANCES[1:5]),
    Entrant("heyoka, equations by hand", "heyoka", _heyoka, TOLERANCES),
    Entrant("SciPy solve_ivp DOP853, equations by hand", "scipy", _scipy, TOLERANCES),
    Entrant("SciPy solve_ivp DOP853, equations by sympy", "sympy", _sympy, TOLERANCES[2:]),
    Entrant("MuJoCo, RK4", "mujoco", _mujoco, STEPS),
    Entrant("Drake, RungeKutta3 with error control", "drake", _drake, TOLERANCES[:4]),
)
