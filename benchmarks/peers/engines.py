"""Physics engines: a free body in empty space, no gravity, no contact, steps that end at every sample."""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.peers.cases import SAMPLES, Case
from benchmarks.peers.peer import ENGINE, TOLERANCES, Peer, Run
from core.arrays import Floats

STEPS_PER_SAMPLE = tuple(float(2**k) for k in range(6))
MASS = 300.0
LONGEST = 1000.0
"""Engines are not asked for longer motions (s): at steps that leave anything right they would take minutes."""


def _in_body_axes(quaternions: Floats, vectors: Floats) -> Floats:
    """Return vectors of space, shape (n, 3), in body axes, for quaternions [w, x, y, z], body to space."""
    q = quaternions / np.linalg.norm(quaternions, axis=1)[:, None]
    turned = 2.0 * np.cross(-q[:, 1:], vectors)
    found: Floats = vectors + q[:, :1] * turned + np.cross(-q[:, 1:], turned)
    return found


def _mujoco(integrator: str, case: Case, steps: float) -> Run:
    """Every step in one call of `mujoco.rollout`, which runs in C."""
    import mujoco
    from mujoco import rollout

    every = int(steps)
    moments = " ".join(map(repr, case.moments))
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><option gravity="0 0 0" integrator="{integrator}"><flag contact="disable" constraint="disable"/>'
        f'</option><worldbody><body><freejoint/><inertial pos="0 0 0" mass="{MASS}" diaginertia="{moments}"/></body>'
        "</worldbody></mujoco>"
    )
    model.opt.timestep = case.stop / (SAMPLES - 1) / every
    data = mujoco.MjData(model)
    data.qvel[3:] = case.start
    full = mujoco.mjtState.mjSTATE_FULLPHYSICS
    start = np.empty(mujoco.mj_stateSize(model, full))
    mujoco.mj_getState(model, data, start, full)
    # The full state is time, position (3), quaternion (4), velocity (3), angular velocity in body axes (3).
    part = slice(4, 8) if case.attitude else slice(11, 14)

    def run() -> Floats:
        states, _ = rollout.rollout(model, data, start[None], nstep=every * (SAMPLES - 1))
        return np.vstack((start[part], states[0, every - 1 :: every, part]))

    return run


def _drake(integrator: str, fixed: bool, case: Case, setting: float) -> Run:
    """The states are logged at the samples in C++; angular velocities are turned into body axes at once."""
    from pydrake.multibody.plant import MultibodyPlant
    from pydrake.multibody.tree import RotationalInertia, SpatialInertia
    from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
    from pydrake.systems.framework import DiagramBuilder
    from pydrake.systems.primitives import LogVectorOutput

    spacing = case.stop / (SAMPLES - 1)
    builder = DiagramBuilder()
    plant = builder.AddSystem(MultibodyPlant(0.0))
    plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, 0.0])
    inertia = SpatialInertia.MakeFromCentralInertia(MASS, [0.0, 0.0, 0.0], RotationalInertia(*case.moments))
    plant.AddRigidBody("body", inertia)
    plant.Finalize()
    logger = LogVectorOutput(plant.get_state_output_port(), builder, publish_period=spacing)
    simulator = Simulator(builder.Build())
    context = simulator.get_mutable_context()
    ResetIntegratorFromFlags(simulator, integrator, spacing)
    method = simulator.get_mutable_integrator()
    if fixed:
        method.set_fixed_step_mode(True)
        method.set_maximum_step_size(spacing / setting)
    else:
        method.set_maximum_step_size(case.stop)
        method.set_target_accuracy(setting)
    own = plant.GetMyMutableContextFromRoot(context)
    start = np.array([1.0, 0, 0, 0, 0, 0, 0, *case.start, 0, 0, 0])

    def run() -> Floats:
        logger.FindMutableLog(context).Clear()
        context.SetTime(0.0)
        plant.SetPositionsAndVelocities(own, start)
        simulator.Initialize()
        simulator.AdvanceTo(case.stop)
        states = logger.FindLog(context).data().T
        return states[:, :4].copy() if case.attitude else _in_body_axes(states[:, :4], states[:, 7:10])

    return run


def _bullet(case: Case, steps: float) -> Run:
    """Every step and every sample is a call from Python, for which there is no array form."""
    import pybullet

    every = int(steps)
    world = pybullet.connect(pybullet.DIRECT)
    pybullet.setGravity(0, 0, 0, physicsClientId=world)
    pybullet.setTimeStep(case.stop / (SAMPLES - 1) / every, physicsClientId=world)
    shape = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=1.0, physicsClientId=world)
    body = pybullet.createMultiBody(MASS, shape, physicsClientId=world)
    pybullet.changeDynamics(
        body,
        -1,
        localInertiaDiagonal=list(case.moments),
        linearDamping=0.0,
        angularDamping=0.0,
        activationState=pybullet.ACTIVATION_STATE_DISABLE_SLEEPING,
        physicsClientId=world,
    )

    def run() -> Floats:
        step, place, velocity = (
            pybullet.stepSimulation,
            pybullet.getBasePositionAndOrientation,
            pybullet.getBaseVelocity,
        )
        pybullet.resetBasePositionAndOrientation(body, [0, 0, 0], [0, 0, 0, 1], physicsClientId=world)
        pybullet.resetBaseVelocity(body, [0, 0, 0], list(case.start), physicsClientId=world)
        rows: list[Any] = [(0.0, 0.0, 0.0, 1.0, *case.start)]
        for _ in range(SAMPLES - 1):
            for _ in range(every):
                step(physicsClientId=world)
            rows.append((*place(body, physicsClientId=world)[1], *velocity(body, physicsClientId=world)[1]))
        found = np.array(rows)
        quaternions = found[:, [3, 0, 1, 2]]
        return quaternions if case.attitude else _in_body_axes(quaternions, found[:, 4:])

    return run


def _mujoco_peer(integrator: str, settings: tuple[float, ...]) -> Peer:
    return Peer(
        f"MuJoCo {integrator}",
        ENGINE,
        "mujoco",
        lambda case, steps: _mujoco(integrator, case, steps),
        "steps per sample",
        settings,
        longest=LONGEST,
    )


def _drake_peer(name: str, integrator: str, fixed: bool, setting: str, settings: tuple[float, ...]) -> Peer:
    return Peer(
        f"Drake {name}",
        ENGINE,
        "drake",
        lambda case, value: _drake(integrator, fixed, case, value),
        setting,
        settings,
        longest=LONGEST,
    )


PEERS = (
    _mujoco_peer("Euler", STEPS_PER_SAMPLE[::2]),
    _mujoco_peer("implicitfast", STEPS_PER_SAMPLE[::2]),
    _mujoco_peer("RK4", STEPS_PER_SAMPLE),
    _drake_peer("RK3", "runge_kutta3", False, "accuracy", TOLERANCES[:8:2]),
    _drake_peer("RK5, fixed step", "runge_kutta5", True, "steps per sample", STEPS_PER_SAMPLE),
    _drake_peer("Radau3", "radau3", False, "accuracy", TOLERANCES[:6:2]),
    Peer("PyBullet", ENGINE, "pybullet", _bullet, "steps per sample", STEPS_PER_SAMPLE[::2], longest=LONGEST),
)
