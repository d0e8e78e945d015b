"""The double pendulum by Drake: a MultibodyPlant with two revolute joints, an error-controlled Runge-Kutta method.

It runs in a process of its own, which is ended if it does not answer in time.
"""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable
from multiprocessing.connection import Connection

PATIENCE = 60.0
"""Seconds within which a motion has to be there."""


class Late(Exception):
    """The other process did not answer in time, or ended."""


def prepared(
    accuracy: float, gravity: float, inertia: float, half: float, start: tuple[float, ...], end: float
) -> Callable[[], tuple[float, float]]:
    """Return a run that returns the two angles at the end, at an accuracy of Drake's integrator.

    Raises
    ------
    Late
        If the model is not there in time; the run raises it as well.
    """
    spawn = multiprocessing.get_context("spawn")
    near, far = spawn.Pipe()
    process = spawn.Process(target=_serve, args=(far, accuracy, gravity, inertia, half, start, end), daemon=True)
    process.start()
    far.close()

    def answer() -> tuple[float, float]:
        try:
            if near.poll(PATIENCE):
                first, second = near.recv()
                return float(first), float(second)
        except EOFError:
            pass
        process.kill()
        raise Late

    def run() -> tuple[float, float]:
        near.send(None)
        return answer()

    answer()
    return run


def _serve(
    pipe: Connection,
    accuracy: float,
    gravity: float,
    inertia: float,
    half: float,
    start: tuple[float, ...],
    end: float,
) -> None:
    from pydrake.math import RigidTransform
    from pydrake.multibody.plant import MultibodyPlant
    from pydrake.multibody.tree import RevoluteJoint, SpatialInertia, UnitInertia
    from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator

    plant = MultibodyPlant(time_step=0.0)
    # About the centre, with the same moment about every axis; the joints are at the rods' ends.
    rod = SpatialInertia(1.0, [half, 0.0, 0.0], UnitInertia(inertia, inertia + half**2, inertia + half**2))
    one, two = (plant.AddRigidBody(name, rod) for name in ("one", "two"))
    at_end = RigidTransform([2.0 * half, 0.0, 0.0])
    first = plant.AddJoint(RevoluteJoint("p", plant.world_frame(), one.body_frame(), [0.0, -1.0, 0.0]))
    offset = plant.AddFrame(_fixed("end", one.body_frame(), at_end))
    second = plant.AddJoint(RevoluteJoint("q", offset, two.body_frame(), [0.0, -1.0, 0.0]))
    plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, -gravity])
    plant.Finalize()
    simulator = Simulator(plant)
    ResetIntegratorFromFlags(simulator, "runge_kutta3", 0.1)
    integrator = simulator.get_mutable_integrator()
    integrator.set_fixed_step_mode(False)
    integrator.set_target_accuracy(accuracy)
    context = simulator.get_mutable_context()
    pipe.send((0.0, 0.0))
    while True:
        try:
            pipe.recv()
        except EOFError:
            return
        context.SetTime(0.0)
        first.set_angle(context, start[0])
        second.set_angle(context, start[1] - start[0])
        first.set_angular_rate(context, start[2])
        second.set_angular_rate(context, start[3] - start[2])
        simulator.Initialize()
        simulator.AdvanceTo(end)
        angle = first.get_angle(context)
        pipe.send((angle, angle + second.get_angle(context)))


def _fixed(name: str, frame: object, pose: object) -> object:
    from pydrake.multibody.tree import FixedOffsetFrame

    return FixedOffsetFrame(name, frame, pose)
