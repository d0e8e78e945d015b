"""PyBullet: impulses at the velocity level, one after another in every step, with a parameter for restitution."""

from __future__ import annotations

from collections.abc import Callable

from benchmarks.contact_peers.cases import ContactCase
from benchmarks.contact_peers.observed import State, Step

Run = Callable[[list[Step] | None], State]


def prepared(case: ContactCase, step: float, *, reach: float) -> Run:
    """Return a run of a case: a free body in space, which nothing moves out of the plane.

    Contacts act from a distance `reach` (m) on, 0.02 by default. What comes near then loses speed before it touches,
    and most of a bounce with it.
    """
    import pybullet as bullet

    world = bullet.connect(bullet.DIRECT)
    bullet.setGravity(0, -9.81, 0, physicsClientId=world)
    bullet.setPhysicsEngineParameter(
        fixedTimeStep=step,
        numSolverIterations=200,
        solverResidualThreshold=0.0,
        restitutionVelocityThreshold=0.0,
        contactBreakingThreshold=reach,
        physicsClientId=world,
    )
    # Bullet multiplies the two coefficients of a pair.
    for x, y, n, m in case.planes:
        shape = bullet.createCollisionShape(bullet.GEOM_PLANE, planeNormal=[n, m, 0], physicsClientId=world)
        plane = bullet.createMultiBody(0, shape, basePosition=[x, y, 0], physicsClientId=world)
        bullet.changeDynamics(plane, -1, lateralFriction=1.0, restitution=1.0, physicsClientId=world)
    shape = bullet.createCollisionShapeArray(
        shapeTypes=[bullet.GEOM_SPHERE] * len(case.balls),
        radii=[r for _, _, r in case.balls],
        collisionFramePositions=[[x, y, 0] for x, y, _ in case.balls],
        physicsClientId=world,
    )
    body = bullet.createMultiBody(case.mass, shape, physicsClientId=world)
    bullet.changeDynamics(
        body,
        -1,
        localInertiaDiagonal=[case.inertia] * 3,
        lateralFriction=case.friction,
        restitution=case.restitution,
        rollingFriction=0.0,
        spinningFriction=0.0,
        linearDamping=0.0,
        angularDamping=0.0,
        activationState=bullet.ACTIVATION_STATE_DISABLE_SLEEPING,
        physicsClientId=world,
    )
    count, (x, y, angle), (u, v, w) = round(case.stop / step), case.start, case.rates
    turned = bullet.getQuaternionFromEuler([0, 0, angle])

    def state() -> State:
        place, attitude = bullet.getBasePositionAndOrientation(body, physicsClientId=world)
        along, spin = bullet.getBaseVelocity(body, physicsClientId=world)
        return place[0], place[1], bullet.getEulerFromQuaternion(attitude)[2], along[0], along[1], spin[2]

    def forces() -> tuple[float, float, float]:
        wall = floor = friction = 0.0
        for point in bullet.getContactPoints(body, physicsClientId=world):
            if abs(point[7][0]) > 0.5:
                wall += point[9]
            else:
                floor, friction = floor + point[9], friction + (point[10] ** 2 + point[12] ** 2) ** 0.5
        return wall, floor, friction

    def run(steps: list[Step] | None) -> State:
        bullet.resetBasePositionAndOrientation(body, [x, y, 0], turned, physicsClientId=world)
        bullet.resetBaseVelocity(body, [u, v, 0], [0, 0, w], physicsClientId=world)
        if steps is not None:
            steps.append(Step(0.0, state()))
        for i in range(count):
            bullet.stepSimulation(physicsClientId=world)
            if steps is not None:
                steps.append(Step((i + 1) * step, state(), *forces()))
        return state()

    return run
