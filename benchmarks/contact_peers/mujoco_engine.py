"""MuJoCo: contacts are soft constraints on accelerations; forces are the minimum of a convex function.

`defaults` changes the time step alone. `stiff` takes elliptic cones, contacts as stiff as the step allows (a
time constant of two steps), an impedance near one and a friction that hardly creeps. Restitution has no parameter of
its own: a damped spring is one whose contact ends with the wanted share of the speed.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from scipy.optimize import brentq

from benchmarks.contact_peers.cases import ContactCase
from benchmarks.contact_peers.observed import State, Step

STEPS_OF_A_BOUNCE = 20
"""Steps in which a contact pushes the ball back."""

Run = Callable[[list[Step] | None], State]


def restitution_of(ratio: float) -> float:
    """Return what a linear spring and damper, which never pull, leave of a speed (Schwager, Poeschel 2007)."""
    root = math.sqrt(1 - ratio * ratio)
    return math.exp(-ratio / root * math.atan2(2 * ratio * root, 2 * ratio * ratio - 1))


def prepared(case: ContactCase, step: float, *, stiff: bool) -> Run:
    """Return a run of a case."""
    import mujoco
    import numpy as np

    options, solref, solimp = "", "0.02 1", "0.9 0.95 0.001"
    if stiff:
        options = 'cone="elliptic" impratio="1000" tolerance="1e-14" iterations="200" integrator="implicitfast"'
        solref, solimp = f"{2 * step} 1", "0.9999 0.9999 0.001"
    if case.restitution:
        ratio = brentq(lambda x: restitution_of(x) - case.restitution, 1e-6, 0.7)
        solref = f"{max(2.0, STEPS_OF_A_BOUNCE / math.pi / ratio) * step} {ratio}"
    law = f'solref="{solref}" solimp="{solimp}" friction="{case.friction} 0 0" condim="3" '
    law += 'contype="{}" conaffinity="{}"'
    planes = "".join(
        f'<geom type="plane" pos="{x} {y} 0" zaxis="{n} {m} 0" size="0 0 1" {law.format(1, 2)}/>'
        for x, y, n, m in case.planes
    )
    balls = "".join(
        f'<geom type="sphere" pos="{x} {y} 0" size="{r}" mass="0" {law.format(2, 1)}/>' for x, y, r in case.balls
    )
    x, y, angle = case.start
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><compiler angle="radian"/><option gravity="0 -9.81 0" timestep="{step}" {options}/><worldbody>'
        f"{planes}<body>"
        '<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/><joint type="hinge" axis="0 0 1"/>'
        f'<inertial pos="0 0 0" mass="{case.mass}" diaginertia="{case.inertia} {case.inertia} {case.inertia}"/>'
        f"{balls}</body></worldbody></mujoco>"
    )
    data, count = mujoco.MjData(model), round(case.stop / step)
    wrench = np.zeros(6)

    def forces() -> tuple[float, float, float]:
        wall = floor = friction = 0.0
        for i in range(data.ncon):
            mujoco.mj_contactForce(model, data, i, wrench)
            if abs(data.contact[i].frame[0]) > 0.5:
                wall += wrench[0]
            else:
                floor, friction = floor + wrench[0], friction + float(np.hypot(wrench[1], wrench[2]))
        return wall, floor, friction

    def state() -> State:
        return tuple(map(float, (*data.qpos, *data.qvel)))  # type: ignore[return-value]

    def run(steps: list[Step] | None) -> State:
        mujoco.mj_resetData(model, data)
        data.qpos[:] = x, y, angle
        data.qvel[:] = case.rates
        if steps is None:
            mujoco.mj_step(model, data, nstep=count)
            return state()
        steps.append(Step(0.0, state()))
        for i in range(count):
            mujoco.mj_step(model, data)
            steps.append(Step((i + 1) * step, state(), *forces()))
        return state()

    return run
