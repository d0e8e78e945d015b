"""Drake: point contacts (hydroelastic contact is off), in discrete steps or as a differential equation.

Contacts are compliant. The discrete models take a stiffness beyond what a step resolves as rigid; the continuous one
integrates springs with Hunt and Crossley's damping and a friction that is smooth below a slip speed. Its accuracy a
comes with a stiffness of 1/a N/m and a slip speed of a m/s. Restitution follows from the damping and the speed of an
impact; it is set for the first one.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from scipy.optimize import brentq

from benchmarks.contact_peers.cases import ContactCase
from benchmarks.contact_peers.mujoco_engine import restitution_of
from benchmarks.contact_peers.observed import State, Step

Run = Callable[[list[Step] | None], State]

LONG_BOUNCE = 100
"""Steps in which a contact of a discrete model pushes the ball back; with fewer, they damp by themselves."""
RIGID = 1e9
"""Stiffness (N/m) that a discrete model takes as rigid."""


def dissipation_for(restitution: float, speed: float) -> float:
    """Return the d (s/m) that leaves a share e of a speed v: x (1 + e) = ln((1 + x)/(1 - e x)) with x = d v."""
    e = restitution
    root = brentq(lambda x: x * (1 + e) - math.log((1 + x) / (1 - e * x)), 1e-3, (1 - 1e-12) / e)
    return float(root / speed)


def prepared(case: ContactCase, setting: float, *, kind: str) -> Run:
    """Return a run of a case.

    Parameters
    ----------
    setting : float
        The time step (s) of discrete models; the accuracy of continuous ones.
    kind : str
        sap or lagged, or the name of an integrator.
    """
    from pydrake.geometry import AddContactMaterial, HalfSpace, ProximityProperties, Sphere
    from pydrake.math import RigidTransform
    from pydrake.multibody.plant import (
        AddMultibodyPlant,
        ContactModel,
        CoulombFriction,
        DiscreteContactApproximation,
        MultibodyPlantConfig,
    )
    from pydrake.multibody.tree import PlanarJoint, RotationalInertia, SpatialInertia
    from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
    from pydrake.systems.framework import DiagramBuilder

    discrete = kind in ("sap", "lagged")
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlant(MultibodyPlantConfig(time_step=setting if discrete else 0.0), builder)
    plant.mutable_gravity_field().set_gravity_vector([0.0, -9.81, 0.0])
    plant.set_contact_model(ContactModel.kPoint)
    if discrete:
        approximations = {"sap": DiscreteContactApproximation.kSap, "lagged": DiscreteContactApproximation.kLagged}
        plant.set_discrete_contact_approximation(approximations[kind])
        stiffness, slip_speed = RIGID, 1e-4
        if case.restitution:
            stiffness = case.mass * (math.pi / (LONG_BOUNCE * setting)) ** 2
    else:
        stiffness, slip_speed = 1.0 / setting, max(1e-7, setting)
    plant.set_stiction_tolerance(slip_speed)
    damping = 10.0
    if case.restitution:
        damping = dissipation_for(case.restitution, math.sqrt(2 * 9.81 * case.start[1]))
    properties = ProximityProperties()
    if kind == "sap" and case.restitution:
        # This one damps by a time of relaxation, 0.1 s by default, in place of Hunt and Crossley's law.
        ratio = brentq(lambda x: restitution_of(x) - case.restitution, 1e-6, 0.7)
        properties.AddProperty("material", "relaxation_time", 2 * ratio * LONG_BOUNCE * setting / math.pi / 2)
    # A pair has half of the stiffness of two equal ones, and their damping and friction.
    AddContactMaterial(damping, 2 * stiffness, CoulombFriction(case.friction, case.friction), properties)
    inertia = SpatialInertia.MakeFromCentralInertia(case.mass, [0.0, 0.0, 0.0], RotationalInertia(*[case.inertia] * 3))
    body = plant.AddRigidBody("body", inertia)
    joint = plant.AddJoint(PlanarJoint("plane", plant.world_frame(), body.body_frame(), [0.0, 0.0, 0.0]))
    for i, (x, y, n, m) in enumerate(case.planes):
        pose = HalfSpace.MakePose([n, m, 0.0], [x, y, 0.0])
        plant.RegisterCollisionGeometry(plant.world_body(), pose, HalfSpace(), f"plane{i}", properties)
    for i, (x, y, r) in enumerate(case.balls):
        plant.RegisterCollisionGeometry(body, RigidTransform([x, y, 0.0]), Sphere(r), f"ball{i}", properties)
    plant.Finalize()
    simulator = Simulator(builder.Build())
    context = simulator.get_mutable_context()
    if not discrete:
        ResetIntegratorFromFlags(simulator, kind, 1e-3)
        method = simulator.get_mutable_integrator()
        method.set_maximum_step_size(0.1)
        method.set_target_accuracy(setting)
    own = plant.GetMyMutableContextFromRoot(context)
    results = plant.get_contact_results_output_port()

    def state(here: Any) -> State:
        found = plant.GetPositionsAndVelocities(here)
        return tuple(map(float, found))  # type: ignore[return-value]

    def forces(here: Any) -> tuple[float, float, float]:
        wall = floor = friction = 0.0
        contacts = results.Eval(here)
        for i in range(contacts.num_point_pair_contacts()):
            info = contacts.point_pair_contact_info(i)
            force = info.contact_force()
            if abs(info.point_pair().nhat_BA_W[0]) > 0.5:
                wall += abs(force[0])
            else:
                floor, friction = floor + abs(force[1]), friction + abs(force[0])
        return wall, floor, friction

    def run(steps: list[Step] | None) -> State:
        context.SetTime(0.0)
        joint.set_translation(own, case.start[:2])
        joint.set_rotation(own, case.start[2])
        joint.set_translational_velocity(own, case.rates[:2])
        joint.set_angular_velocity(own, case.rates[2])
        simulator.Initialize()
        if steps is None:
            simulator.clear_monitor()
        else:

            def watch(root: Any) -> None:
                here = plant.GetMyContextFromRoot(root)
                steps.append(Step(root.get_time(), state(here), *forces(here)))

            simulator.set_monitor(watch)
        simulator.AdvanceTo(case.stop)
        return state(own)

    return run
