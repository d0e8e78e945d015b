"""The double pendulum of examples/scenes, two rods released at rest, for 10 s: by this project and by its peers.

Integrators get the equations in the rods' angles, derived by hand or by sympy: they need not be told what is connected
to what. Engines get links and hinges. Each is swept through its setting; the error is the larger difference of the two
angles after 10 s (rad) from the motion at 30 digits. What a new scene costs is told apart from what a motion costs.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from mpmath import cos, matrix, mp, mpf, odefun, pi, sin
from mpmath import lu_solve as solved

from core.multibody.reading import scene_from
from core.multibody.solve import solve_scene

G, INERTIA, HALF, END = 9.81, 0.0833, 0.5, 10.0
START = (0.0, np.pi / 2, 0.0, 0.0)
SCENE: dict[str, Any] = {
    "gravity": [0, -G],
    "bodies": {
        "one": {"mass": 1, "inertia": INERTIA, "at": [0.5, 0], "places": {"top": [-0.5, 0], "end": [0.5, 0]}},
        "two": {"mass": 1, "inertia": INERTIA, "at": [1, 0.5], "angle": {"degrees": 90}, "places": {"top": [-0.5, 0]}},
    },
    "connections": [{"kind": "pin", "a": "one.top", "b": [0, 0]}, {"kind": "pin", "a": "two.top", "b": "one.end"}],
}

Run = Callable[[], tuple[float, float]]
TOLERANCES = tuple(10.0**-k for k in (4, 6, 8, 10, 12, 14))
STEPS = (1e-2, 3e-3, 1e-3, 3e-4, 1e-4)


@dataclass(frozen=True)
class Entrant:
    """One way to compute the motion.

    Attributes
    ----------
    package : str
        The distribution that has to be installed.
    prepare : callable
        From a setting to a run, which returns the two angles after 10 s.
    settings : tuple of float
    """

    name: str
    package: str
    prepare: Callable[[float], Run]
    settings: tuple[float, ...]


def reference(digits: int = 30) -> tuple[Any, Any]:
    """Return the angles after 10 s by mpmath's series of the equations in the angles; takes minutes."""
    with mp.workdps(digits):
        inertia, g, half = mpf("0.0833"), mpf("9.81"), mpf(1) / 2

        def rates(_: Any, state: Any) -> list[Any]:
            p, q, u, v = state
            c, s = half * cos(p - q), half * sin(p - q)
            loads = matrix([-s * v * v - 3 * half * g * cos(p), s * u * u - half * g * cos(q)])
            return [u, v, *solved(matrix([[inertia + mpf("1.25"), c], [c, inertia + mpf("0.25")]]), loads)]

        state = odefun(rates, 0, [mpf(0), pi / 2, mpf(0), mpf(0)])(mpf(10))
        return state[0], state[1]


def _ours(accuracy: float) -> Run:
    """The whole question: reading, set-up, motion, error statement."""

    def run() -> tuple[float, float]:
        answer = solve_scene(scene_from(SCENE), [END], ("trajectory",), accuracy)
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


def _compiled(tolerance: float) -> Run:
    """numbalsoda's DOP853 of the equations compiled by numba: no Python while it runs."""
    import numba
    import numbalsoda

    @numba.cfunc(numbalsoda.lsoda_sig)  # type: ignore[untyped-decorator]
    def right(_: float, state: Any, rate: Any, __: Any) -> None:
        p, q, u, v = state[0], state[1], state[2], state[3]
        c, s = HALF * np.cos(p - q), HALF * np.sin(p - q)
        a, b = INERTIA + 1.25, INERTIA + 0.25
        x, y = -s * v * v - 1.5 * G * np.cos(p), s * u * u - HALF * G * np.cos(q)
        det = a * b - c * c
        rate[0], rate[1] = u, v
        rate[2], rate[3] = (b * x - c * y) / det, (a * y - c * x) / det

    address, start, times = right.address, np.array(START), np.array([0.0, END])

    def run() -> tuple[float, float]:
        found, _ = numbalsoda.dop853(address, start, times, rtol=tolerance, atol=tolerance)
        return float(found[-1, 0]), float(found[-1, 1])

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


def _drake(tolerance: float) -> Run:
    from pydrake.math import RigidTransform
    from pydrake.multibody.plant import MultibodyPlant
    from pydrake.multibody.tree import RevoluteJoint, SpatialInertia, UnitInertia
    from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator

    plant = MultibodyPlant(0.0)
    plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, -G])
    unit = UnitInertia(INERTIA, INERTIA, INERTIA).ShiftFromCenterOfMass([-HALF, 0.0, 0.0])
    rod = SpatialInertia(1.0, [HALF, 0.0, 0.0], unit)
    one, two = plant.AddRigidBody("one", rod), plant.AddRigidBody("two", rod)
    axis = [0.0, -1.0, 0.0]
    plant.AddJoint(RevoluteJoint("p", plant.world_frame(), one.body_frame(), axis))
    end = RigidTransform([1.0, 0.0, 0.0])
    plant.AddJoint(RevoluteJoint("q", plant.AddFrame(_fixed(one, end)), two.body_frame(), axis))
    plant.Finalize()
    simulator = Simulator(plant)
    context = simulator.get_mutable_context()
    ResetIntegratorFromFlags(simulator, "runge_kutta5", 0.01)
    simulator.get_mutable_integrator().set_maximum_step_size(END)
    simulator.get_mutable_integrator().set_target_accuracy(tolerance)

    def run() -> tuple[float, float]:
        context.SetTime(0.0)
        plant.SetPositionsAndVelocities(context, np.array([START[0], START[1] - START[0], 0.0, 0.0]))
        simulator.Initialize()
        simulator.AdvanceTo(END)
        p, q = plant.GetPositions(context)
        return float(p), float(p + q)

    return run


def _fixed(body: Any, pose: Any) -> Any:
    from pydrake.multibody.tree import FixedOffsetFrame

    return FixedOffsetFrame("end", body.body_frame(), pose)


ENTRANTS = (
    Entrant("Polhode, whole question with error statement", "numpy", _ours, (1e-6, 1e-9, 1e-12, 1e-15)),
    Entrant("heyoka, equations by hand", "heyoka", _heyoka, TOLERANCES),
    Entrant("numbalsoda DOP853, equations by hand", "numbalsoda", _compiled, TOLERANCES),
    Entrant("SciPy solve_ivp DOP853, equations by hand", "scipy", _scipy, TOLERANCES),
    Entrant("SciPy solve_ivp DOP853, equations by sympy", "sympy", _sympy, TOLERANCES[2:]),
    Entrant("Drake, Runge-Kutta 5", "drake", _drake, TOLERANCES[:5]),
    Entrant("MuJoCo, RK4", "mujoco", _mujoco, STEPS),
)
