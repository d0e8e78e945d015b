"""Objects that are sent and answered.

Written by clients/python/generate.py from docs/openapi.json; do not edit.
"""

# ruff: noqa: E501, D1
from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, NotRequired, TypedDict

from polhode_client.arrays import Floats, Integers, Numbers


class MassPropertiesRequest(TypedDict):
    """A body."""

    body: (
        PrincipalMoments
        | InertiaTensor
        | PointMasses
        | Ball
        | Cuboid
        | Cylinder
        | Rod
        | Ellipsoid
        | Cone
        | SphericalShell
        | CylindricalShell
        | Disc
        | Torus
        | Capsule
        | Hemisphere
        | Composite
        | Mesh
    )


class PrincipalMoments(TypedDict):
    """A body known by its principal moments of inertia; its body axes are the principal axes, in the order given."""

    moments: Numbers
    kind: Literal["principal-moments"]


class InertiaTensor(TypedDict):
    """A body known by its tensor of inertia about its centre of mass, in body axes."""

    tensor: Numbers
    mass: NotRequired[float | None]
    center_of_mass: NotRequired[Numbers | None]
    kind: Literal["inertia-tensor"]


class PointMasses(TypedDict):
    """Point masses held rigidly together."""

    masses: float | Numbers
    positions: Numbers
    about: NotRequired[Literal["center-of-mass", "origin"]]
    kind: Literal["point-masses"]


class Ball(TypedDict):
    """A solid ball centred on the origin."""

    radius: float
    kind: Literal["ball"]
    mass: NotRequired[float | None]
    density: NotRequired[float | None]


class Cuboid(TypedDict):
    """A rectangular block centred on the origin, edges along x, y and z."""

    edges: Numbers
    kind: Literal["cuboid"]
    mass: NotRequired[float | None]
    density: NotRequired[float | None]


class Cylinder(TypedDict):
    """A solid circular cylinder centred on the origin, axis along z."""

    radius: float
    height: float
    kind: Literal["cylinder"]
    mass: NotRequired[float | None]
    density: NotRequired[float | None]


class Rod(TypedDict):
    """A straight rod centred on the origin, along z."""

    length: float
    radius: NotRequired[float]
    kind: Literal["rod"]
    mass: NotRequired[float | None]
    density: NotRequired[float | None]


class Ellipsoid(TypedDict):
    """A solid ellipsoid centred on the origin, semi-axes along x, y and z."""

    semi_axes: Numbers
    kind: Literal["ellipsoid"]
    mass: NotRequired[float | None]
    density: NotRequired[float | None]


class Cone(TypedDict):
    """A solid circular cone: base on the plane z = 0, apex at z = height; its centre of mass is at height/4."""

    radius: float
    height: float
    kind: Literal["cone"]
    mass: NotRequired[float | None]
    density: NotRequired[float | None]


class SphericalShell(TypedDict):
    """The solid between two concentric spheres about the origin; equal radii are an infinitely thin shell."""

    outer_radius: float
    inner_radius: float
    kind: Literal["spherical-shell"]
    mass: NotRequired[float | None]
    density: NotRequired[float | None]


class CylindricalShell(TypedDict):
    """A tube, open at both ends, centred on the origin, axis along z; equal radii are an infinitely thin wall."""

    outer_radius: float
    inner_radius: float
    height: float
    kind: Literal["cylindrical-shell"]
    mass: NotRequired[float | None]
    density: NotRequired[float | None]


class Disc(TypedDict):
    """A flat circular disc centred on the origin, axis along z."""

    radius: float
    thickness: NotRequired[float]
    kind: Literal["disc"]
    mass: NotRequired[float | None]
    density: NotRequired[float | None]


class Torus(TypedDict):
    """A solid ring centred on the origin, axis along z."""

    ring_radius: float
    tube_radius: float
    kind: Literal["torus"]
    mass: NotRequired[float | None]
    density: NotRequired[float | None]


class Capsule(TypedDict):
    """A cylinder with a half-ball on each end, centred on the origin, axis along z."""

    radius: float
    length: float
    kind: Literal["capsule"]
    mass: NotRequired[float | None]
    density: NotRequired[float | None]


class Hemisphere(TypedDict):
    """A solid half-ball: flat face on the plane z = 0, dome towards z; its centre of mass is at 3/8 radius."""

    radius: float
    kind: Literal["hemisphere"]
    mass: NotRequired[float | None]
    density: NotRequired[float | None]


class Composite(TypedDict):
    """Bodies that are rigidly connected."""

    parts: Sequence[Part]
    about: NotRequired[Literal["center-of-mass", "origin"]]
    kind: Literal["composite"]


class Part(TypedDict):
    """A body with its position and attitude in a composite.

    A point r of the body is at position + R r in the composite, with R the rotation of the attitude: the body is
    rotated about its own origin and then displaced."""

    body: (
        PrincipalMoments
        | InertiaTensor
        | PointMasses
        | Ball
        | Cuboid
        | Cylinder
        | Rod
        | Ellipsoid
        | Cone
        | SphericalShell
        | CylindricalShell
        | Disc
        | Torus
        | Capsule
        | Hemisphere
        | Composite
        | Mesh
    )
    position: NotRequired[Numbers]
    attitude: NotRequired[Numbers]
    hole: NotRequired[bool]


class Mesh(TypedDict):
    """A uniform solid given by its surface, a list of triangles.

    Every edge belongs to exactly two triangles, which traverse it in opposite directions. There may be several closed
    surfaces; those that face inwards bound cavities. Intersections of triangles are not checked: a region that is
    enclosed twice counts twice."""

    vertices: Numbers
    faces: Numbers
    kind: Literal["mesh"]
    mass: NotRequired[float | None]
    density: NotRequired[float | None]


class MassPropertiesAnswer(TypedDict):
    """Mass properties of a body."""

    signature: Signature
    warnings: list[Notice]
    mass: float | None
    center_of_mass: Floats | None
    inertia: InertiaTensors
    principal: PrincipalAxes
    principal_about_origin: PrincipalAxes | None
    symmetry: Literal["spherical", "oblate", "prolate", "triaxial", "linear", "point"]
    about: Literal["center-of-mass", "origin"]
    validity: Validity


class Signature(TypedDict):
    """Name and version of the service."""

    source: Literal["polhode"]
    version: str


class Notice(TypedDict):
    """Something the client should know about an answer that is given all the same."""

    code: str
    detail: str
    pointer: NotRequired[str | None]


class InertiaTensors(TypedDict):
    """Tensors of inertia in body axes; I_xy = -(integral of x y dm)."""

    about_center_of_mass: Floats
    about_origin: Floats | None


class PrincipalAxes(TypedDict):
    """Principal moments and axes."""

    moments: Floats
    axes: Floats


class Validity(TypedDict):
    """Whether matter can have these mass properties, condition by condition."""

    physical: bool
    report: list[Condition]


class Condition(TypedDict):
    """One condition of the report."""

    name: str
    holds: bool
    detail: str
    excess: NotRequired[float]
    tolerance: NotRequired[float]
    moments: NotRequired[Floats]


class TrajectoryRequest(TypedDict):
    """A body, how it turns at t = 0, and the times at which its motion is wanted."""

    body: (
        PrincipalMoments
        | InertiaTensor
        | PointMasses
        | Ball
        | Cuboid
        | Cylinder
        | Rod
        | Ellipsoid
        | Cone
        | SphericalShell
        | CylindricalShell
        | Disc
        | Torus
        | Capsule
        | Hemisphere
        | Composite
        | Mesh
    )
    angular_velocity: Numbers
    attitude: NotRequired[Numbers | None]
    times: Span | Numbers
    accuracy: NotRequired[float]
    method: NotRequired[
        ClosedFormEvaluation
        | ExplicitEuler
        | RungeKutta4
        | ImplicitMidpoint
        | SymmetricSplitting
        | DiscreteMoserVeselov
        | DormandPrince853
        | Lsoda
        | Radau
        | None
    ]
    input_uncertainty: NotRequired[float]
    round: NotRequired[Literal["meaningful"] | int | None]
    outputs: NotRequired[Sequence[Literal["time", "angular_velocity", "attitude"]] | None]


class Span(TypedDict):
    """Evenly spaced times, both ends included, exactly as numpy.linspace gives them."""

    start: float
    stop: float
    count: int


class ClosedFormEvaluation(TypedDict):
    """Evaluate the closed form of the motion at each time, at a cost that does not depend on the time."""

    kind: Literal["closed-form"]


class ExplicitEuler(TypedDict):
    """Forward Euler: w[i+1] = w[i] + h f(t[i], w[i])."""

    step: float
    kind: Literal["explicit-euler"]


class RungeKutta4(TypedDict):
    """The classical Runge-Kutta method."""

    step: float
    kind: Literal["runge-kutta-4"]


class ImplicitMidpoint(TypedDict):
    """The implicit midpoint rule: w[i+1] = w[i] + h f(t[i] + h/2, (w[i] + w[i+1])/2)."""

    step: float
    kind: Literal["implicit-midpoint"]


class SymmetricSplitting(TypedDict):
    """Strang's composition of the flows that the system offers; for a free body, of rotations about its axes."""

    step: float
    kind: Literal["symmetric-splitting"]


class DiscreteMoserVeselov(TypedDict):
    """The discrete mechanics that the system offers; for a free body, Moser and Veselov's."""

    step: float
    kind: Literal["discrete-moser-veselov"]


class DormandPrince853(TypedDict):
    """Dormand and Prince's method of order 8(5,3)."""

    tolerance: float
    kind: Literal["dormand-prince-853"]


class Lsoda(TypedDict):
    """LSODA: Adams' methods of orders 1 to 12, or backward differentiation of orders 1 to 5 where the motion is stiff."""

    tolerance: float
    kind: Literal["lsoda"]


class Radau(TypedDict):
    """Radau IIA with three stages; samples inside a step come from an interpolant of order three."""

    tolerance: float
    kind: Literal["radau"]


class TrajectoryAnswer(TypedDict):
    """Samples of a free rotation."""

    signature: Signature
    warnings: list[Notice]
    model: Model
    method: str
    period: float | None
    flip_interval: float | None
    middle_axis_tilt: Floats | None
    tumbles: bool
    energy: float | None
    angular_momentum: float | None
    work: Work
    ended: str
    time: NotRequired[Floats | None]
    angular_velocity: NotRequired[Floats | None]
    attitude: NotRequired[Floats | None]
    accuracy: Accuracy


class Model(TypedDict):
    """The smallest model that suffices for a question, and why it does."""

    name: str
    regime: str
    why: str
    degrees_of_freedom: int


class Work(TypedDict):
    """What an answer cost, counted and therefore the same on every machine."""

    samples: int
    evaluations: NotRequired[int]
    steps: NotRequired[int]
    rejected_steps: NotRequired[int]
    evaluations_for_error: NotRequired[int]
    step: NotRequired[float | None]


class Accuracy(TypedDict):
    """How right the answer is."""

    requested: float
    error: float
    final_error: float | None
    how: Literal["closed form", "measured against closed form", "estimate (finer run)"]
    inherited: float | None
    largest_norm: NotRequired[float | None]
    horizon: NotRequired[float | None]
    drifts: dict[str, float]
    attitude_error: NotRequired[float | None]
    attitude_inherited: NotRequired[float | None]
    attitude_horizon: NotRequired[float | None]


class EnsembleRequest(TypedDict):
    """A body, its starts, and the times at which every motion is wanted."""

    body: (
        PrincipalMoments
        | InertiaTensor
        | PointMasses
        | Ball
        | Cuboid
        | Cylinder
        | Rod
        | Ellipsoid
        | Cone
        | SphericalShell
        | CylindricalShell
        | Disc
        | Torus
        | Capsule
        | Hemisphere
        | Composite
        | Mesh
    )
    angular_velocities: NotRequired[Numbers | None]
    sample: NotRequired[Sample | None]
    times: Span | Numbers
    accuracy: NotRequired[float]
    method: NotRequired[
        ClosedFormEvaluation
        | ExplicitEuler
        | RungeKutta4
        | ImplicitMidpoint
        | SymmetricSplitting
        | DiscreteMoserVeselov
        | DormandPrince853
        | Lsoda
        | Radau
        | None
    ]
    round: NotRequired[Literal["meaningful"] | int | None]


class Sample(TypedDict):
    """Starts of one energy, drawn uniformly over the scaled sphere."""

    energy: float
    count: int
    seed: NotRequired[int]


class EnsembleAnswer(TypedDict):
    """Samples of every motion."""

    signature: Signature
    warnings: list[Notice]
    error: float
    seed: int | None
    members: list[Member]
    time: Floats
    angular_velocity: Floats


class Member(TypedDict):
    """One motion."""

    model: Model
    method: str
    period: float | None
    accuracy: Accuracy
    work: Work
    ended: str


class PrecessionRequest(TypedDict):
    """A body and how it turns at t = 0."""

    body: (
        PrincipalMoments
        | InertiaTensor
        | PointMasses
        | Ball
        | Cuboid
        | Cylinder
        | Rod
        | Ellipsoid
        | Cone
        | SphericalShell
        | CylindricalShell
        | Disc
        | Torus
        | Capsule
        | Hemisphere
        | Composite
        | Mesh
    )
    angular_velocity: Numbers
    measure: NotRequired[Measure | None]


class Measure(TypedDict):
    """How the period is to be measured."""

    method: (
        ClosedFormEvaluation
        | ExplicitEuler
        | RungeKutta4
        | ImplicitMidpoint
        | SymmetricSplitting
        | DiscreteMoserVeselov
        | DormandPrince853
        | Lsoda
        | Radau
    )
    duration: float
    samples: int
    tolerance: float


class PrecessionAnswer(TypedDict):
    """Rates and angles; null where the motion has no such thing."""

    signature: Signature
    warnings: list[Notice]
    symmetry: Literal["spherical", "oblate", "prolate", "triaxial", "linear", "point"]
    regime: Literal["rest", "steady", "periodic", "separatrix"]
    axis: Floats | None
    body_rate: float | None
    space_rate: float | None
    period: float | None
    flip_interval: float | None
    middle_axis_tilt: Floats | None
    tumbles: bool
    axis_to_angular_momentum: float | None
    axis_to_angular_velocity: float | None
    angular_momentum_to_angular_velocity: float | None
    order_of_directions: str | None
    precession_per_period: float | None
    mean_precession_rate: float | None
    absent: dict[str, str]
    errors: dict[str, float | Floats | None]
    measured: NotRequired[MeasuredPeriod | None]


class MeasuredPeriod(TypedDict):
    """What the experiment found, and why it differs from theory."""

    time: float | None
    grid_point: int | None
    theory: float | None
    relative_difference: float | None
    from_tolerance: float | None
    from_grid: float | None
    from_method: float | None
    crossing: Crossing | None
    error: float
    drifts: dict[str, float]
    explanation: str
    work: Work


class Crossing(TypedDict):
    """Where the method's samples cross, on the first return, the plane through the start across the initial motion."""

    time: float
    distance: float


class StabilityRequest(TypedDict):
    """A body, and how fast it turns about its principal axes."""

    body: (
        PrincipalMoments
        | InertiaTensor
        | PointMasses
        | Ball
        | Cuboid
        | Cylinder
        | Rod
        | Ellipsoid
        | Cone
        | SphericalShell
        | CylindricalShell
        | Disc
        | Torus
        | Capsule
        | Hemisphere
        | Composite
        | Mesh
    )
    rate: NotRequired[float]
    disturbance: NotRequired[Numbers | None]


class StabilityAnswer(TypedDict):
    """Every equilibrium of a free body at one rate."""

    signature: Signature
    warnings: list[Notice]
    symmetry: Literal["spherical", "oblate", "prolate", "triaxial", "linear", "point"]
    rate: float
    equilibria: list[EquilibriumInDoubles]
    flip: FlipInDoubles | None


class EquilibriumInDoubles(TypedDict):
    """A constant angular velocity, and what becomes of one near it."""

    axis: Floats | None
    moment: float | None
    eigenvalues: Floats | None
    kind: Literal["center", "saddle", "degenerate"]
    stable: bool
    growth_rate: float | None
    drift_rate: float | None
    linearly_stable: bool
    attitude: Literal["orbital", "unstable"]
    survives_dissipation: bool
    reason: str
    errors: EquilibriumErrors


class EquilibriumErrors(TypedDict):
    """Of rounding, and of derived moments."""

    axis: float | None
    moment: float | None
    eigenvalue: float | None
    drift_rate: float | None


class FlipInDoubles(TypedDict):
    """What becomes of a disturbed rotation about the middle axis."""

    disturbance: Floats
    interval: float | None
    reason: str
    error: float | None


class EllipsoidRequest(TypedDict):
    """A body and the energy of its rotation, or a state that has it."""

    body: (
        PrincipalMoments
        | InertiaTensor
        | PointMasses
        | Ball
        | Cuboid
        | Cylinder
        | Rod
        | Ellipsoid
        | Cone
        | SphericalShell
        | CylindricalShell
        | Disc
        | Torus
        | Capsule
        | Hemisphere
        | Composite
        | Mesh
    )
    energy: NotRequired[float | None]
    angular_velocity: NotRequired[Numbers | None]
    resolution: NotRequired[int]
    layout: NotRequired[Literal["triangles", "grid"]]
    polhodes: NotRequired[Drawn | None]
    separatrix: NotRequired[bool]
    points: NotRequired[int]


class Drawn(TypedDict):
    """How many random starts to draw, uniformly over the scaled sphere, and the seed of the draw."""

    count: int
    seed: NotRequired[int]


class EllipsoidAnswer(TypedDict):
    """The surface w.I.w = 2E in body axes."""

    signature: Signature
    warnings: list[Notice]
    energy: float
    semi_axes: Floats
    axes: Floats
    mesh: NotRequired[SurfaceMesh | None]
    grid: NotRequired[SurfaceGrid | None]
    polhodes: NotRequired[list[Polhode] | None]
    separatrix: NotRequired[list[Polhode] | None]


class SurfaceMesh(TypedDict):
    """Triangles, counter-clockwise seen from outside."""

    vertices: Floats
    faces: Integers
    quality: MeshQuality


class MeshQuality(TypedDict):
    """How well the triangles stand for the ellipsoid."""

    watertight: bool
    euler_characteristic: int
    volume_ratio: float
    smallest_angle: float
    longest_edge: float


class SurfaceGrid(TypedDict):
    """Coordinates over longitude (down) and colatitude (along), both ends included."""

    x: Floats
    y: Floats
    z: Floats


class Polhode(TypedDict):
    """One curve; the last point is the first if it is closed."""

    regime: str
    closed: bool
    angular_momentum: float | None
    points: Floats


class StatesRequest(TypedDict):
    """A body, an energy, and how many starts to draw."""

    body: (
        PrincipalMoments
        | InertiaTensor
        | PointMasses
        | Ball
        | Cuboid
        | Cylinder
        | Rod
        | Ellipsoid
        | Cone
        | SphericalShell
        | CylindricalShell
        | Disc
        | Torus
        | Capsule
        | Hemisphere
        | Composite
        | Mesh
    )
    energy: float
    count: int
    seed: NotRequired[int]


class StatesAnswer(TypedDict):
    """Angular velocities of one energy, in body axes."""

    signature: Signature
    warnings: list[Notice]
    angular_velocities: Floats
    energy: float
    seed: int


class WobbleRequest(TypedDict):
    """A period, or the shape of the body."""

    period: NotRequired[float | None]
    day: NotRequired[Literal["sidereal", "solar"]]
    ellipticity: NotRequired[float | None]


class WobbleAnswer(TypedDict):
    """A wobble and the body that has it."""

    signature: Signature
    warnings: list[Notice]
    period: float
    day: Literal["sidereal", "solar"]
    rotations: float
    asymmetry: float
    ellipticity: float
    flattening: float
    earth: EarthFigures


class EarthFigures(TypedDict):
    """The Earth's measured figures, and why they differ from a rigid body's."""

    axis_ratio: NotRequired[float]
    asymmetry: NotRequired[float]
    asymmetry_of_shape: NotRequired[float]
    rigid_period_sidereal: NotRequired[float]
    rigid_period_solar: NotRequired[float]
    observed_period_solar: NotRequired[float]
    sources: NotRequired[list[str]]
    why: NotRequired[str]


class WorkPrecisionRequest(TypedDict):
    """A free rotation, a described scene or a named one, and the methods to be compared on it."""

    body: NotRequired[
        PrincipalMoments
        | InertiaTensor
        | PointMasses
        | Ball
        | Cuboid
        | Cylinder
        | Rod
        | Ellipsoid
        | Cone
        | SphericalShell
        | CylindricalShell
        | Disc
        | Torus
        | Capsule
        | Hemisphere
        | Composite
        | Mesh
        | None
    ]
    angular_velocity: NotRequired[Numbers | None]
    scene: NotRequired[SceneDescription | None]
    named_scene: NotRequired[UnwindingShafts | RodInHole | ChainOnWedge | None]
    times: Span | Numbers
    methods: NotRequired[
        Sequence[
            ClosedFormEvaluation
            | ExplicitEuler
            | RungeKutta4
            | ImplicitMidpoint
            | SymmetricSplitting
            | DiscreteMoserVeselov
            | DormandPrince853
            | Lsoda
            | Radau
        ]
        | None
    ]
    accuracy: NotRequired[float]
    repeats: NotRequired[int]


class SceneDescription(TypedDict):
    """Bodies, and what connects them."""

    gravity: NotRequired[Sequence[float | str | AngleInDegrees] | PolarVector]
    bodies: Mapping[str, SceneBody]
    connections: NotRequired[Sequence[SceneConnection]]
    let: NotRequired[Mapping[str, float | str | AngleInDegrees]]
    numbers: NotRequired[Literal["decimals", "doubles"]]
    assemble: NotRequired[Mapping[str, Sequence[str]] | Literal["nearest"]]


class AngleInDegrees(TypedDict):
    """An angle in degrees."""

    degrees: float | str


class PolarVector(TypedDict):
    """A vector of the plane by its length and its direction."""

    polar: Sequence[float | str | AngleInDegrees]


class SceneBody(TypedDict):
    """What has mass: a particle, a rigid body of the plane or of space, a symmetric top."""

    at: Sequence[float | str | AngleInDegrees] | PolarVector
    mass: NotRequired[float | str | AngleInDegrees]
    velocity: NotRequired[Sequence[float | str | AngleInDegrees] | PolarVector]
    inertia: NotRequired[float | str | AngleInDegrees]
    moments: NotRequired[Sequence[float | str | AngleInDegrees] | PolarVector]
    tensor: NotRequired[Sequence[Sequence[float | str | AngleInDegrees] | PolarVector]]
    body: NotRequired[
        PrincipalMoments
        | InertiaTensor
        | PointMasses
        | Ball
        | Cuboid
        | Cylinder
        | Rod
        | Ellipsoid
        | Cone
        | SphericalShell
        | CylindricalShell
        | Disc
        | Torus
        | Capsule
        | Hemisphere
        | Composite
        | Mesh
        | None
    ]
    radius: NotRequired[float | str | AngleInDegrees]
    angle: NotRequired[float | str | AngleInDegrees]
    axes: NotRequired[Sequence[Sequence[float | str | AngleInDegrees] | PolarVector]]
    angular_velocity: NotRequired[float | str | Sequence[float | str | AngleInDegrees] | AngleInDegrees]
    places: NotRequired[Mapping[str, Sequence[float | str | AngleInDegrees] | PolarVector]]


_SceneConnection = TypedDict("_SceneConnection", {"in": NotRequired[Literal["body"]]})


class SceneConnection(_SceneConnection):
    """What ties bodies to one another and to the ground; `name` is by default its kind and number."""

    a: NotRequired[str | Sequence[float | str | AngleInDegrees] | PolarVector]
    b: NotRequired[str | Sequence[float | str | AngleInDegrees] | PolarVector]
    axis: NotRequired[Sequence[float | str | AngleInDegrees] | PolarVector]
    name: NotRequired[str]
    slope: NotRequired[float | str | AngleInDegrees]
    direction: NotRequired[Sequence[float | str | AngleInDegrees] | PolarVector]
    length: NotRequired[float | str | AngleInDegrees]
    place: NotRequired[str | Sequence[float | str | AngleInDegrees] | PolarVector]
    on: NotRequired[Sequence[str] | Mapping[str, Any]]
    inside: NotRequired[bool]
    measure: NotRequired[Literal["gap", "turn", "length"]]
    at_least: NotRequired[float | str | AngleInDegrees]
    at_most: NotRequired[float | str | AngleInDegrees]
    friction: NotRequired[float | str | Sequence[float | str | AngleInDegrees] | AngleInDegrees]
    restitution: NotRequired[float | str | AngleInDegrees]
    order: NotRequired[float | str | AngleInDegrees]
    through: NotRequired[Sequence[str | Sequence[float | str | AngleInDegrees] | PolarVector]]
    sides: NotRequired[Mapping[str, Any]]
    slips: NotRequired[Sequence[str]]
    density: NotRequired[float | str | AngleInDegrees]
    stiffness: NotRequired[float | str | AngleInDegrees]
    rest_length: NotRequired[float | str | AngleInDegrees]
    law: NotRequired[str]
    rest_angle: NotRequired[float | str | AngleInDegrees]
    constant: NotRequired[float | str | AngleInDegrees]
    strength: NotRequired[float | str | AngleInDegrees]
    coefficient: NotRequired[float | str | AngleInDegrees]
    rate: NotRequired[float | str | AngleInDegrees]
    at: NotRequired[Sequence[float | str | AngleInDegrees] | PolarVector]
    about: NotRequired[Literal["vertical", "normal"]]
    force: NotRequired[Sequence[float | str | AngleInDegrees] | PolarVector]
    body: NotRequired[str]
    torque: NotRequired[float | str | Sequence[float | str | AngleInDegrees] | AngleInDegrees]
    acceleration: NotRequired[Sequence[float | str | AngleInDegrees] | PolarVector]
    kind: Literal[
        "pin",
        "ball-joint",
        "weld",
        "slider",
        "rod",
        "rolling",
        "track",
        "contact",
        "string",
        "chain",
        "spring",
        "torsion-spring",
        "gravitation",
        "inverse-square",
        "damper",
        "motor",
        "spinning-frame",
        "force",
        "torque",
        "field",
    ]


class UnwindingShafts(TypedDict):
    """Two shafts on a fixed wedge, on whose ends a massless, inextensible string over the smooth apex is wound."""

    masses: Numbers
    radii: Numbers
    slopes: Numbers
    gravity: float
    inertia_factors: NotRequired[Numbers]
    positions: NotRequired[Numbers | None]
    velocities: NotRequired[Numbers]
    spins: NotRequired[Numbers]
    wound: NotRequired[Numbers | None]
    slope_lengths: NotRequired[Numbers | None]
    restitution: NotRequired[float]
    friction: NotRequired[Friction | None]
    kind: Literal["unwinding-shafts"]


class Friction(TypedDict):
    """Coulomb friction of two shafts on their slopes."""

    static: Numbers
    kinetic: Numbers


class RodInHole(TypedDict):
    """A rod in the plane across the axis of a smooth cylindrical hole, its ends A and B on the wall.

    Angles are those of the line from the axis to the rod's centre, from the downward vertical; positive has end B
    higher."""

    hole_radius: float
    length: float
    mass: float
    gravity: float
    angle: NotRequired[float | None]
    angular_velocity: NotRequired[float]
    inertia_factor: NotRequired[float]
    hole: NotRequired[Literal["half-cylinder", "cylinder"]]
    kind: Literal["rod-in-hole"]


class ChainOnWedge(TypedDict):
    """An inextensible heavy chain over the smooth apex of a fixed wedge, with a mass at each end."""

    masses: Numbers
    slopes: Numbers
    gravity: float
    length: float
    linear_density: float
    position: float
    velocity: NotRequired[float]
    kind: Literal["chain-on-wedge"]


class WorkPrecisionAnswer(TypedDict):
    """Error against cost."""

    signature: Signature
    warnings: list[Notice]
    reference: str
    reference_error: float
    curves: list[MethodCurve]
    pareto_front: list[MethodMeasurement]
    recommendation: Recommendation


class MethodCurve(TypedDict):
    """All settings of one method, cheapest first."""

    kind: str
    declared_order: int | None
    fitted_order: float | None
    floor: float | None
    measurements: list[MethodMeasurement]


class MethodMeasurement(TypedDict):
    """One method with one setting; errors are relative to the largest norm of the state in the whole motion.

    The state of a described scene holds the coordinates that remain of it, and then their rates, in units in which they
    are of the order of one: SI units times powers of two. That of a named scene holds its coordinates, and then their
    rates, in SI units."""

    method: (
        ClosedFormEvaluation
        | ExplicitEuler
        | RungeKutta4
        | ImplicitMidpoint
        | SymmetricSplitting
        | DiscreteMoserVeselov
        | DormandPrince853
        | Lsoda
        | Radau
    )
    error: float | None
    final_error: float | None
    component_errors: Floats
    drifts: dict[str, float] | None
    evaluations: int
    steps: int
    seconds: float | None
    failure: str | None


class Recommendation(TypedDict):
    """The cheapest setting that was measured to reach the accuracy."""

    method: (
        ClosedFormEvaluation
        | ExplicitEuler
        | RungeKutta4
        | ImplicitMidpoint
        | SymmetricSplitting
        | DiscreteMoserVeselov
        | DormandPrince853
        | Lsoda
        | Radau
        | None
    )
    reason: str


class UnwindingShaftsRequest(TypedDict):
    """Two shafts on a fixed wedge, on whose ends a massless, inextensible string over the smooth apex is wound."""

    outputs: NotRequired[
        Sequence[
            Literal[
                "tension",
                "tension_range",
                "accelerations",
                "angular_accelerations",
                "string_acceleration",
                "reduced_masses",
                "normal_forces",
                "friction_forces",
                "energy",
                "phases",
                "events",
                "ended",
                "trajectory",
            ]
        ]
        | None
    ]
    masses: Numbers
    radii: Numbers
    slopes: Numbers
    gravity: float
    inertia_factors: NotRequired[Numbers]
    positions: NotRequired[Numbers | None]
    velocities: NotRequired[Numbers]
    spins: NotRequired[Numbers]
    wound: NotRequired[Numbers | None]
    slope_lengths: NotRequired[Numbers | None]
    restitution: NotRequired[float]
    friction: NotRequired[Friction | None]
    kind: NotRequired[Literal["unwinding-shafts"]]
    times: NotRequired[Span | Numbers | None]
    round: NotRequired[Literal["meaningful"] | int | None]
    accuracy: NotRequired[float]
    method: NotRequired[
        ClosedFormEvaluation
        | ExplicitEuler
        | RungeKutta4
        | ImplicitMidpoint
        | SymmetricSplitting
        | DiscreteMoserVeselov
        | DormandPrince853
        | Lsoda
        | Radau
        | None
    ]


class UnwindingShaftsAnswer(TypedDict):
    """Figures: what two unwinding shafts answer; forces and accelerations are those right after t = 0."""

    signature: Signature
    warnings: list[Notice]
    model: Model
    method: NotRequired[str | None]
    work: Work
    requested_samples: int
    ended: str | None
    events: NotRequired[list[SceneEvent] | None]
    accuracy: Accuracy
    errors: dict[str, float | list[float | None] | None]
    tension: NotRequired[float | None]
    tension_range: NotRequired[list[float | None] | None]
    accelerations: NotRequired[list[float | None] | None]
    angular_accelerations: NotRequired[list[float | None] | None]
    string_acceleration: NotRequired[float | None]
    reduced_masses: NotRequired[list[float | None] | None]
    normal_forces: NotRequired[list[float | None] | None]
    friction_forces: NotRequired[list[float | None] | None]
    energy: NotRequired[MechanicalEnergy | None]
    phases: NotRequired[list[ShaftPhase] | None]
    trajectory: NotRequired[ShaftSamples | None]


class SceneEvent(TypedDict):
    """Something that happens at an instant."""

    kind: str
    time: float | None
    error: NotRequired[float | None]


class MechanicalEnergy(TypedDict):
    """Energy of the given state."""

    kinetic: float | None
    potential: float | None
    total: float | None
    errors: NotRequired[dict[str, float | list[float | None] | None] | None]


class ShaftPhase(TypedDict):
    """A time in which the accelerations are constant but for jerks."""

    kind: Literal["taut", "slack", "stick"]
    start: float | None
    end: float | None
    impulse: float | None
    jerks: int | None
    dissipated: float | None
    errors: NotRequired[dict[str, float | list[float | None] | None] | None]


class ShaftSamples(TypedDict):
    """Samples of the shafts' motion: one entry for each time."""

    time: Floats
    positions: Floats
    velocities: Floats
    spins: Floats
    unwound: Floats
    tension: NotRequired[Floats | None]


class RodInHoleRequest(TypedDict):
    """A rod in the plane across the axis of a smooth cylindrical hole, its ends A and B on the wall.

    Angles are those of the line from the axis to the rod's centre, from the downward vertical; positive has end B
    higher."""

    outputs: NotRequired[
        Sequence[
            Literal[
                "angular_velocity_at_horizontal",
                "equivalent_length",
                "period",
                "release_angle",
                "forces_at_release",
                "energy",
                "contact",
                "events",
                "ended",
                "trajectory",
            ]
        ]
        | None
    ]
    hole_radius: float
    length: float
    mass: float
    gravity: float
    angle: NotRequired[float | None]
    angular_velocity: NotRequired[float]
    inertia_factor: NotRequired[float]
    hole: NotRequired[Literal["half-cylinder", "cylinder"]]
    kind: NotRequired[Literal["rod-in-hole"]]
    times: NotRequired[Span | Numbers | None]
    round: NotRequired[Literal["meaningful"] | int | None]
    accuracy: NotRequired[float]
    method: NotRequired[
        ClosedFormEvaluation
        | ExplicitEuler
        | RungeKutta4
        | ImplicitMidpoint
        | SymmetricSplitting
        | DiscreteMoserVeselov
        | DormandPrince853
        | Lsoda
        | Radau
        | None
    ]


class RodInHoleAnswer(TypedDict):
    """Figures: what a rod in a hole answers."""

    signature: Signature
    warnings: list[Notice]
    model: Model
    method: NotRequired[str | None]
    work: Work
    requested_samples: int
    ended: str | None
    events: NotRequired[list[SceneEvent] | None]
    accuracy: Accuracy
    errors: dict[str, float | list[float | None] | None]
    angular_velocity_at_horizontal: NotRequired[float | None]
    equivalent_length: NotRequired[float | None]
    period: NotRequired[float | None]
    release_angle: NotRequired[float | None]
    forces_at_release: NotRequired[list[float | None] | None]
    energy: NotRequired[MechanicalEnergy | None]
    contact: NotRequired[Contact | None]
    trajectory: NotRequired[RodSamples | None]


class Contact(TypedDict):
    """Contact of the rod's ends with the wall."""

    kept: bool
    limit_angle: float | None
    full_turn_rate: float | None
    errors: NotRequired[dict[str, float | list[float | None] | None] | None]


class RodSamples(TypedDict):
    """Samples of a rod's motion: one entry for each time."""

    time: Floats
    angle: Floats
    angular_velocity: Floats
    forces: NotRequired[Floats | None]


class ChainOnWedgeRequest(TypedDict):
    """An inextensible heavy chain over the smooth apex of a fixed wedge, with a mass at each end."""

    outputs: NotRequired[
        Sequence[
            Literal[
                "acceleration",
                "apex_tension",
                "growth_rate",
                "equilibrium",
                "energy",
                "lift_off",
                "events",
                "ended",
                "trajectory",
            ]
        ]
        | None
    ]
    masses: Numbers
    slopes: Numbers
    gravity: float
    length: float
    linear_density: float
    position: float
    velocity: NotRequired[float]
    kind: NotRequired[Literal["chain-on-wedge"]]
    times: NotRequired[Span | Numbers | None]
    round: NotRequired[Literal["meaningful"] | int | None]
    accuracy: NotRequired[float]
    method: NotRequired[
        ClosedFormEvaluation
        | ExplicitEuler
        | RungeKutta4
        | ImplicitMidpoint
        | SymmetricSplitting
        | DiscreteMoserVeselov
        | DormandPrince853
        | Lsoda
        | Radau
        | None
    ]


class ChainOnWedgeAnswer(TypedDict):
    """Figures: what a chain on a wedge answers."""

    signature: Signature
    warnings: list[Notice]
    model: Model
    method: NotRequired[str | None]
    work: Work
    requested_samples: int
    ended: str | None
    events: NotRequired[list[SceneEvent] | None]
    accuracy: Accuracy
    errors: dict[str, float | list[float | None] | None]
    acceleration: NotRequired[float | None]
    apex_tension: NotRequired[float | None]
    growth_rate: NotRequired[float | None]
    equilibrium: NotRequired[float | None]
    energy: NotRequired[MechanicalEnergy | None]
    lift_off: NotRequired[LiftOff | None]
    trajectory: NotRequired[ChainSamples | None]


class LiftOff(TypedDict):
    """Whether the chain leaves the apex."""

    occurs: bool
    time: float | None
    error: NotRequired[float | None]


class ChainSamples(TypedDict):
    """Samples of a chain's motion: one entry for each time."""

    time: Floats
    position: Floats
    velocity: Floats
    apex_tension: NotRequired[Floats | None]


class DescribedSceneRequest(TypedDict):
    """Bodies, what connects them, and what is requested of them."""

    gravity: NotRequired[Sequence[float | str | AngleInDegrees] | PolarVector]
    bodies: Mapping[str, SceneBody]
    connections: NotRequired[Sequence[SceneConnection]]
    let: NotRequired[Mapping[str, float | str | AngleInDegrees]]
    numbers: NotRequired[Literal["decimals", "doubles"]]
    assemble: NotRequired[Mapping[str, Sequence[str]] | Literal["nearest"]]
    times: NotRequired[Span | Numbers | None]
    accuracy: NotRequired[float]
    method: NotRequired[
        ClosedFormEvaluation
        | ExplicitEuler
        | RungeKutta4
        | ImplicitMidpoint
        | SymmetricSplitting
        | DiscreteMoserVeselov
        | DormandPrince853
        | Lsoda
        | Radau
        | None
    ]
    input_uncertainty: NotRequired[float | None]
    round: NotRequired[Literal["meaningful"] | int | None]
    outputs: NotRequired[
        Sequence[
            Literal[
                "accelerations",
                "forces",
                "energy",
                "trajectory",
                "forces-in-time",
                "energy-in-time",
                "momenta-in-time",
                "work-in-time",
                "paths-in-time",
                "equilibria",
            ]
            | SearchOutput
        ]
        | None
    ]


class SearchOutput(TypedDict):
    """A search between the start and the latest of the times, or of a number: one of its fields is given."""

    when: NotRequired[WhenQuestion | None]
    extremes: NotRequired[str | None]


class WhenQuestion(TypedDict):
    """A quantity, and the value that it is to take."""

    quantity: str
    equals: float | str | AngleInDegrees
    nth: NotRequired[int | None]


class DescribedSceneAnswer(TypedDict):
    """The requested answer about a scene."""

    signature: Signature
    warnings: list[Notice]
    model: DescribedModel
    accelerations: NotRequired[dict[str, BodyAccelerations] | None]
    forces: NotRequired[dict[str, ConnectionForce] | None]
    energy: NotRequired[StartEnergy | None]
    method: NotRequired[str | None]
    work: NotRequired[Work | None]
    period: float | None
    errors: dict[str, float | None]
    ended: str | None
    events: list[EndEvent]
    phases: NotRequired[list[MotionPhase] | None]
    problem: NotRequired[SceneProblem | None]
    trajectory: NotRequired[DescribedTrajectory | None]
    occurrences: NotRequired[list[SceneOccurrence] | None]
    extremes: NotRequired[list[SceneExtremes] | None]
    equilibria: NotRequired[list[SceneEquilibrium] | None]
    thresholds: NotRequired[list[RestRange] | None]
    assembly: NotRequired[Assembly | None]
    accuracy: NotRequired[DescribedAccuracy | None]


class DescribedModel(TypedDict):
    """The smallest model of a scene, and what was noticed on the way."""

    name: str
    why: str
    degrees_of_freedom: int
    mobility: int
    coordinates: int
    rows: int
    described: Integers
    apart: list[ScenePart]
    noticed: list[str]
    redundant: dict[str, list[str]]


class ScenePart(TypedDict):
    """A part of a scene that has no force or connection in common with the others, and its smallest model."""

    name: str
    why: str
    degrees_of_freedom: int
    coordinates: list[str]
    period: float | None
    precession: float | None
    modes: list[SmallMotion]
    errors: NotRequired[dict[str, float | None] | None]


class SmallMotion(TypedDict):
    """One mode: q = exp(growth_rate t) cos(frequency t)."""

    frequency: float
    growth_rate: float
    errors: NotRequired[dict[str, float | None] | None]


class BodyAccelerations(TypedDict):
    """Accelerations of a body at the start; null beyond the range of doubles."""

    linear: list[float | None]
    angular: float | list[float | None] | None
    errors: NotRequired[dict[str, float | None] | None]


class ConnectionForce(TypedDict):
    """A force of a connection at the start."""

    value: float | None
    unit: str
    determined: bool
    shared_with: list[str]
    error: NotRequired[float | None]


class StartEnergy(TypedDict):
    """Energies at the start; the potential of gravity is zero at the origin."""

    kinetic: float | None
    potential: float | None
    total: float | None
    conserved: bool
    errors: NotRequired[dict[str, float | None] | None]


class EndEvent(TypedDict):
    """Something that ends a phase of a motion, or the motion."""

    kind: str
    name: str
    time: float
    error: float
    impulses: dict[str, float]
    energy_loss: float
    errors: ImpactErrors


class ImpactErrors(TypedDict):
    """Of impulses and energy loss; that of the time is in error."""

    impulses: dict[str, float | None]
    energy_loss: float | None


class MotionPhase(TypedDict):
    """A time in which no contact, stop or string changes its state."""

    start: float
    end: float | None
    model: str
    why: str
    degrees_of_freedom: int
    coordinates: int
    states: dict[str, str]
    errors: dict[str, float | None]


class SceneProblem(TypedDict):
    """Something that mechanics does not decide, or that is not followed any further: the motion ends there."""

    code: Literal[
        "no-motion",
        "several-motions",
        "undetermined-friction",
        "simultaneous-impacts",
        "several-impacts",
        "no-impact",
        "energy-gain",
        "grazing-contact",
        "several-onsets",
        "turning-onset",
        "no-progress",
        "event-limit",
        "lost-event",
    ]
    type: str
    explanation: str
    time: float
    connections: list[str]
    candidates: list[dict[str, str]]
    decided_by: str
    error: float


class DescribedTrajectory(TypedDict):
    """Columns by name, such as wheel.angle or s.1.tension, at the times that the motion reaches."""

    time: Floats
    rows: Integers
    columns: dict[str, SceneColumn]


class SceneColumn(TypedDict):
    """One quantity at every time."""

    values: list[float | Floats]
    unit: str
    error: float
    how: Literal["closed form", "measured against pairs", "measured against closed form"]
    inherited: float | None


class SceneOccurrence(TypedDict):
    """A time at which a quantity takes the requested value."""

    quantity: str
    equals: float
    unit: str
    nth: int
    time: float
    error: float
    how: Literal["closed form", "measured against pairs", "measured against closed form"]


class SceneExtremes(TypedDict):
    """Least and largest value of a quantity."""

    quantity: str
    unit: str
    least: float
    least_time: float
    largest: float
    largest_time: float
    error: float
    until: float
    periodic: bool
    errors: dict[str, float]
    least_places: NotRequired[dict[str, Floats]]
    largest_places: NotRequired[dict[str, Floats]]
    place_errors: NotRequired[dict[str, float]]


class SceneEquilibrium(TypedDict):
    """A place where the scene can rest."""

    positions: dict[str, Floats]
    angles: dict[str, float]
    stable: bool | None
    modes: list[SmallMotion]
    residual: float
    errors: dict[str, dict[str, float]]


class RestRange(TypedDict):
    """In which range of a number a scene stays at rest."""

    vary: str
    written: float
    lower: RestEnd | None
    upper: RestEnd | None
    reason: str | None
    error: float


class RestEnd(TypedDict):
    """One end of the range of a number in which a scene stays at rest."""

    value: float
    error: float
    beyond: dict[str, str] | None
    problem: str | None


class Assembly(TypedDict):
    """The start that satisfies the connections, nearest to the places that were given."""

    distance: float
    bodies: dict[str, AssembledBody]
    others: Floats
    velocities_changed: bool
    four_bar: FourBarLinkage | None
    errors: dict[str, float | None]


class AssembledBody(TypedDict):
    """A body at the place that was found for it."""

    at: Floats
    angle: float | None
    axes: Floats | None
    moved: float
    turned: float
    errors: dict[str, float | None]


class FourBarLinkage(TypedDict):
    """A planar four-bar linkage."""

    links: list[str]
    lengths: Floats
    kind: Literal["crank-rocker", "double-crank", "double-rocker", "triple-rocker", "change-point"]
    margin: float
    branch: Literal["open", "crossed"]
    errors: dict[str, float | None]


class DescribedAccuracy(TypedDict):
    """How right the samples are."""

    requested: float
    error: float
    how: Literal["closed form", "measured against pairs", "measured against closed form"]
    inherited: float | None
    horizon: float | None
    why: str | None


class SceneCatalogue(TypedDict):
    """The catalogue of scenes."""

    signature: Signature
    scenes: list[SceneEntry]


class SceneEntry(TypedDict):
    """One scene of the catalogue."""

    name: str
    path: str
    summary: str
    outputs: list[str]
    example: dict[str, Any]


class CertifiedTrajectoryRequest(TypedDict):
    """A body, how it turns at t = 0, and the times at which its motion is wanted."""

    body: DecimalBody
    angular_velocity: Sequence[float | str]
    attitude: NotRequired[Sequence[float | str] | None]
    times: DecimalSpan | Sequence[float | str]
    digits: int
    outputs: NotRequired[Sequence[Literal["time", "angular_velocity", "attitude"]] | None]


class DecimalBody(TypedDict):
    """A body whose numbers may be decimal strings, with the fields of the ordinary body of its kind."""

    kind: Literal[
        "principal-moments",
        "inertia-tensor",
        "point-masses",
        "ball",
        "cuboid",
        "cylinder",
        "rod",
        "ellipsoid",
        "cone",
        "spherical-shell",
        "cylindrical-shell",
        "disc",
        "torus",
        "capsule",
        "hemisphere",
        "composite",
    ]
    moments: NotRequired[Sequence[float | str]]
    tensor: NotRequired[Sequence[Sequence[float | str]]]
    mass: NotRequired[float | str | None]
    center_of_mass: NotRequired[Sequence[float | str] | None]
    masses: NotRequired[float | str | Sequence[float | str]]
    positions: NotRequired[Sequence[Sequence[float | str]]]
    about: NotRequired[Literal["center-of-mass", "origin"]]
    density: NotRequired[float | str | None]
    radius: NotRequired[float | str]
    edges: NotRequired[Sequence[float | str]]
    height: NotRequired[float | str]
    length: NotRequired[float | str]
    semi_axes: NotRequired[Sequence[float | str]]
    outer_radius: NotRequired[float | str]
    inner_radius: NotRequired[float | str]
    thickness: NotRequired[float | str]
    ring_radius: NotRequired[float | str]
    tube_radius: NotRequired[float | str]
    parts: NotRequired[Sequence[DecimalPart]]


class DecimalPart(TypedDict):
    """A body with its position and attitude in a composite.

    A point r of the body is at position + R r in the composite, with R the rotation of the attitude: the body is
    rotated about its own origin and then displaced."""

    body: DecimalBody
    position: NotRequired[Sequence[float | str]]
    attitude: NotRequired[Sequence[float | str]]
    hole: NotRequired[bool]


class DecimalSpan(TypedDict):
    """Times at exactly equal distances, both ends included."""

    start: float | str
    stop: float | str
    count: int


class CertifiedTrajectoryAnswer(TypedDict):
    """Samples of a free rotation, numbers as decimal strings."""

    signature: Signature
    warnings: list[Notice]
    model: Model
    method: Literal["closed-form"]
    period: str | None
    flip_interval: str | None
    middle_axis_tilt: list[str] | None
    tumbles: bool
    energy: str | None
    angular_momentum: str | None
    work: Work
    ended: Literal["horizon"]
    time: NotRequired[list[str] | None]
    angular_velocity: NotRequired[list[list[str]] | None]
    attitude: NotRequired[list[list[str]] | None]
    accuracy: CertifiedAccuracy


class CertifiedAccuracy(TypedDict):
    """How right every number of the answer is."""

    requested: int
    error: str
    how: Literal["ball arithmetic"]


class CertifiedPrecessionRequest(TypedDict):
    """A body and how it turns at t = 0."""

    body: DecimalBody
    angular_velocity: Sequence[float | str]
    digits: int


class CertifiedPrecessionAnswer(TypedDict):
    """Rates and angles as decimal strings; null where the motion has no such thing."""

    signature: Signature
    warnings: list[Notice]
    symmetry: Literal["spherical", "oblate", "prolate", "triaxial", "linear", "point"]
    regime: Literal["rest", "steady", "periodic", "separatrix"]
    axis: list[str] | None
    body_rate: str | None
    space_rate: str | None
    period: str | None
    flip_interval: str | None
    middle_axis_tilt: list[str] | None
    tumbles: bool
    axis_to_angular_momentum: str | None
    axis_to_angular_velocity: str | None
    angular_momentum_to_angular_velocity: str | None
    order_of_directions: str | None
    precession_per_period: str | None
    mean_precession_rate: str | None
    absent: dict[str, str]
    accuracy: CertifiedAccuracy


class CertifiedStabilityRequest(TypedDict):
    """A body, and how fast it turns about its principal axes."""

    body: DecimalBody
    rate: NotRequired[float | str]
    disturbance: NotRequired[Sequence[float | str] | None]
    digits: int


class CertifiedStabilityAnswer(TypedDict):
    """Every equilibrium of a free body at one rate, numbers as decimal strings."""

    signature: Signature
    warnings: list[Notice]
    symmetry: Literal["spherical", "oblate", "prolate", "triaxial", "linear", "point"]
    rate: str
    equilibria: list[CertifiedEquilibrium]
    flip: CertifiedFlip | None
    accuracy: CertifiedAccuracy


class CertifiedEquilibrium(TypedDict):
    """A constant angular velocity, and what becomes of one near it."""

    axis: list[str] | None
    moment: str | None
    eigenvalues: list[list[str]] | None
    kind: Literal["center", "saddle", "degenerate"]
    stable: bool
    growth_rate: str | None
    drift_rate: str | None
    linearly_stable: bool
    attitude: Literal["orbital", "unstable"]
    survives_dissipation: bool
    reason: str


class CertifiedFlip(TypedDict):
    """What becomes of a disturbed rotation about the middle axis."""

    disturbance: list[str]
    interval: str | None
    reason: str


class CertifiedEllipsoidRequest(TypedDict):
    """A body and the energy of its rotation, or a state that has it."""

    body: DecimalBody
    energy: NotRequired[float | str | None]
    angular_velocity: NotRequired[Sequence[float | str] | None]
    resolution: NotRequired[int | None]
    layout: NotRequired[Literal["triangles", "grid"] | None]
    polhodes: NotRequired[Drawn | None]
    separatrix: NotRequired[bool]
    points: NotRequired[int]
    digits: int


class CertifiedEllipsoidAnswer(TypedDict):
    """The surface w.I.w = 2E in body axes, numbers as decimal strings."""

    signature: Signature
    warnings: list[Notice]
    energy: str
    semi_axes: list[str]
    axes: list[list[str]]
    mesh: NotRequired[CertifiedSurfaceMesh | None]
    grid: NotRequired[CertifiedSurfaceGrid | None]
    polhodes: NotRequired[list[CertifiedPolhode] | None]
    separatrix: NotRequired[list[CertifiedPolhode] | None]
    accuracy: CertifiedAccuracy


class CertifiedSurfaceMesh(TypedDict):
    """Triangles, counter-clockwise seen from outside."""

    vertices: list[list[str]]
    faces: Integers
    quality: CertifiedMeshQuality


class CertifiedMeshQuality(TypedDict):
    """How well the triangles stand for the ellipsoid."""

    watertight: bool
    euler_characteristic: int
    volume_ratio: str
    smallest_angle: str
    longest_edge: str


class CertifiedSurfaceGrid(TypedDict):
    """Coordinates over longitude (down) and colatitude (along), both ends included."""

    x: list[list[str]]
    y: list[list[str]]
    z: list[list[str]]


class CertifiedPolhode(TypedDict):
    """One curve; the last point is the first if it is closed."""

    regime: str
    closed: bool
    angular_momentum: str | None
    points: list[list[str]]


class CertifiedUnwindingShaftsRequest(TypedDict):
    """Two shafts on a fixed wedge, on whose ends a massless, inextensible string over the smooth apex is wound."""

    outputs: NotRequired[
        Sequence[
            Literal[
                "tension",
                "tension_range",
                "accelerations",
                "angular_accelerations",
                "string_acceleration",
                "reduced_masses",
                "normal_forces",
                "friction_forces",
                "energy",
                "phases",
                "events",
                "ended",
                "trajectory",
            ]
        ]
        | None
    ]
    masses: Sequence[float | str]
    radii: Sequence[float | str]
    slopes: Sequence[float | str]
    gravity: float | str
    inertia_factors: NotRequired[Sequence[float | str]]
    positions: NotRequired[Sequence[float | str] | None]
    velocities: NotRequired[Sequence[float | str]]
    spins: NotRequired[Sequence[float | str]]
    wound: NotRequired[Sequence[float | str] | None]
    slope_lengths: NotRequired[Sequence[float | str] | None]
    restitution: NotRequired[float | str]
    friction: NotRequired[DecimalFriction | None]
    kind: NotRequired[Literal["unwinding-shafts"]]
    times: NotRequired[DecimalSpan | Sequence[float | str] | None]
    digits: int


class DecimalFriction(TypedDict):
    """Coulomb friction of two shafts on their slopes."""

    static: Sequence[float | str]
    kinetic: Sequence[float | str]


class CertifiedUnwindingShaftsAnswer(TypedDict):
    """Figures: what two unwinding shafts answer; forces and accelerations are those right after t = 0."""

    signature: Signature
    warnings: list[Notice]
    model: Model
    method: NotRequired[str | None]
    work: Work
    requested_samples: int
    ended: str | None
    events: NotRequired[list[CertifiedSceneEvent] | None]
    accuracy: CertifiedAccuracy
    tension: NotRequired[str | None]
    tension_range: NotRequired[list[str | None] | None]
    accelerations: NotRequired[list[str | None] | None]
    angular_accelerations: NotRequired[list[str | None] | None]
    string_acceleration: NotRequired[str | None]
    reduced_masses: NotRequired[list[str | None] | None]
    normal_forces: NotRequired[list[str | None] | None]
    friction_forces: NotRequired[list[str | None] | None]
    energy: NotRequired[CertifiedMechanicalEnergy | None]
    phases: NotRequired[list[CertifiedShaftPhase] | None]
    trajectory: NotRequired[CertifiedShaftSamples | None]


class CertifiedSceneEvent(TypedDict):
    """Something that happens at an instant."""

    kind: str
    time: str | None
    error: NotRequired[float | None]


class CertifiedMechanicalEnergy(TypedDict):
    """Energy of the given state."""

    kinetic: str | None
    potential: str | None
    total: str | None
    errors: NotRequired[dict[str, float | list[float | None] | None] | None]


class CertifiedShaftPhase(TypedDict):
    """A time in which the accelerations are constant but for jerks."""

    kind: Literal["taut", "slack", "stick"]
    start: str | None
    end: str | None
    impulse: str | None
    jerks: int | None
    dissipated: str | None
    errors: NotRequired[dict[str, float | list[float | None] | None] | None]


class CertifiedShaftSamples(TypedDict):
    """Samples of the shafts' motion: one entry for each time."""

    time: list[str]
    positions: list[list[str]]
    velocities: list[list[str]]
    spins: list[list[str]]
    unwound: list[list[str]]
    tension: NotRequired[list[str] | None]


class CertifiedRodInHoleRequest(TypedDict):
    """A rod in the plane across the axis of a smooth cylindrical hole, its ends A and B on the wall.

    Angles are those of the line from the axis to the rod's centre, from the downward vertical; positive has end B
    higher."""

    outputs: NotRequired[
        Sequence[
            Literal[
                "angular_velocity_at_horizontal",
                "equivalent_length",
                "period",
                "release_angle",
                "forces_at_release",
                "energy",
                "contact",
                "events",
                "ended",
                "trajectory",
            ]
        ]
        | None
    ]
    hole_radius: float | str
    length: float | str
    mass: float | str
    gravity: float | str
    angle: NotRequired[float | str | None]
    angular_velocity: NotRequired[float | str]
    inertia_factor: NotRequired[float | str]
    hole: NotRequired[Literal["half-cylinder", "cylinder"]]
    kind: NotRequired[Literal["rod-in-hole"]]
    times: NotRequired[DecimalSpan | Sequence[float | str] | None]
    digits: int


class CertifiedRodInHoleAnswer(TypedDict):
    """Figures: what a rod in a hole answers."""

    signature: Signature
    warnings: list[Notice]
    model: Model
    method: NotRequired[str | None]
    work: Work
    requested_samples: int
    ended: str | None
    events: NotRequired[list[CertifiedSceneEvent] | None]
    accuracy: CertifiedAccuracy
    angular_velocity_at_horizontal: NotRequired[str | None]
    equivalent_length: NotRequired[str | None]
    period: NotRequired[str | None]
    release_angle: NotRequired[str | None]
    forces_at_release: NotRequired[list[str | None] | None]
    energy: NotRequired[CertifiedMechanicalEnergy | None]
    contact: NotRequired[CertifiedContact | None]
    trajectory: NotRequired[CertifiedRodSamples | None]


class CertifiedContact(TypedDict):
    """Contact of the rod's ends with the wall."""

    kept: bool
    limit_angle: str | None
    full_turn_rate: str | None
    errors: NotRequired[dict[str, float | list[float | None] | None] | None]


class CertifiedRodSamples(TypedDict):
    """Samples of a rod's motion: one entry for each time."""

    time: list[str]
    angle: list[str]
    angular_velocity: list[str]
    forces: NotRequired[list[list[str]] | None]


class CertifiedChainOnWedgeRequest(TypedDict):
    """An inextensible heavy chain over the smooth apex of a fixed wedge, with a mass at each end."""

    outputs: NotRequired[
        Sequence[
            Literal[
                "acceleration",
                "apex_tension",
                "growth_rate",
                "equilibrium",
                "energy",
                "lift_off",
                "events",
                "ended",
                "trajectory",
            ]
        ]
        | None
    ]
    masses: Sequence[float | str]
    slopes: Sequence[float | str]
    gravity: float | str
    length: float | str
    linear_density: float | str
    position: float | str
    velocity: NotRequired[float | str]
    kind: NotRequired[Literal["chain-on-wedge"]]
    times: NotRequired[DecimalSpan | Sequence[float | str] | None]
    digits: int


class CertifiedChainOnWedgeAnswer(TypedDict):
    """Figures: what a chain on a wedge answers."""

    signature: Signature
    warnings: list[Notice]
    model: Model
    method: NotRequired[str | None]
    work: Work
    requested_samples: int
    ended: str | None
    events: NotRequired[list[CertifiedSceneEvent] | None]
    accuracy: CertifiedAccuracy
    acceleration: NotRequired[str | None]
    apex_tension: NotRequired[str | None]
    growth_rate: NotRequired[str | None]
    equilibrium: NotRequired[str | None]
    energy: NotRequired[CertifiedMechanicalEnergy | None]
    lift_off: NotRequired[CertifiedLiftOff | None]
    trajectory: NotRequired[CertifiedChainSamples | None]


class CertifiedLiftOff(TypedDict):
    """Whether the chain leaves the apex."""

    occurs: bool
    time: str | None
    error: NotRequired[float | None]


class CertifiedChainSamples(TypedDict):
    """Samples of a chain's motion: one entry for each time."""

    time: list[str]
    position: list[str]
    velocity: list[str]
    apex_tension: NotRequired[list[str] | None]


class CertifiedSceneRequest(TypedDict):
    """Bodies, their connections, and the number of proven digits."""

    gravity: NotRequired[Sequence[float | str | AngleInDegrees] | PolarVector]
    bodies: Mapping[str, SceneBody]
    connections: NotRequired[Sequence[SceneConnection]]
    let: NotRequired[Mapping[str, float | str | AngleInDegrees]]
    numbers: NotRequired[Literal["decimals", "doubles"]]
    assemble: NotRequired[Mapping[str, Sequence[str]] | Literal["nearest"]]
    times: NotRequired[DecimalSpan | Sequence[float | str] | None]
    outputs: NotRequired[Sequence[Literal["accelerations", "forces", "energy", "trajectory"]] | None]
    digits: int


class CertifiedDescribedAnswer(TypedDict):
    """The requested answer about a scene, numbers as decimal strings."""

    signature: Signature
    warnings: list[Notice]
    model: CertifiedDescribedModel
    accelerations: NotRequired[dict[str, CertifiedBodyAccelerations] | None]
    forces: NotRequired[dict[str, CertifiedConnectionForce] | None]
    energy: NotRequired[CertifiedStartEnergy | None]
    accuracy: CertifiedAccuracy
    ended: str | None
    trajectory: NotRequired[CertifiedMotion | None]


class CertifiedDescribedModel(TypedDict):
    """The smallest model of a scene, and what was noticed on the way."""

    name: str
    why: str
    degrees_of_freedom: int
    mobility: int
    coordinates: int
    rows: int
    described: Integers
    apart: list[CertifiedScenePart]
    noticed: list[str]
    redundant: dict[str, list[str]]


class CertifiedScenePart(TypedDict):
    """A part of a scene that has no force or connection in common with the others, and its smallest model."""

    name: str
    why: str
    degrees_of_freedom: int
    coordinates: list[str]
    period: str | None
    precession: str | None
    modes: list[CertifiedSmallMotion]
    errors: NotRequired[dict[str, float | None] | None]


class CertifiedSmallMotion(TypedDict):
    """One mode: q = exp(growth_rate t) cos(frequency t)."""

    frequency: str
    growth_rate: str
    errors: NotRequired[dict[str, float | None] | None]


class CertifiedBodyAccelerations(TypedDict):
    """Accelerations of a body at the start; null beyond the range of doubles."""

    linear: list[str | None]
    angular: str | list[str | None] | None
    errors: NotRequired[dict[str, float | None] | None]


class CertifiedConnectionForce(TypedDict):
    """A force of a connection at the start."""

    value: str | None
    unit: str
    determined: bool
    shared_with: list[str]
    error: NotRequired[float | None]


class CertifiedStartEnergy(TypedDict):
    """Energies at the start; the potential of gravity is zero at the origin."""

    kinetic: str | None
    potential: str | None
    total: str | None
    conserved: bool
    errors: NotRequired[dict[str, float | None] | None]


class CertifiedMotion(TypedDict):
    """Columns by name, such as rod.angle, at the times that the motion reaches."""

    time: list[str]
    rows: Integers
    columns: dict[str, CertifiedColumn]


class CertifiedColumn(TypedDict):
    """One quantity at every time."""

    values: list[str | list[str]]
    unit: str


class PlanRequest(TypedDict):
    """A request that is not sent: where to, and what."""

    path: str
    request: Any


class PlanAnswer(TypedDict):
    """A plan."""

    signature: Signature
    warnings: list[Notice]
    path: str
    answerable: bool | None
    duration: Literal["immediate", "seconds", "minutes", "beyond the limit"] | None
    why: str | None
    model: PlannedModel | None
    method: (
        ClosedFormEvaluation
        | ExplicitEuler
        | RungeKutta4
        | ImplicitMidpoint
        | SymmetricSplitting
        | DiscreteMoserVeselov
        | DormandPrince853
        | Lsoda
        | Radau
        | None
    )
    cost: PlannedCost | None
    accuracy: PlannedError | None
    errors: list[PlannedFault]


class PlannedModel(TypedDict):
    """The model that would be used; the other fields are those of the answer, where it has them."""

    name: str
    why: str
    degrees_of_freedom: int
    regime: NotRequired[str | None]
    mobility: NotRequired[int | None]
    coordinates: NotRequired[int | None]
    rows: NotRequired[int | None]
    described: NotRequired[Integers | None]
    apart: NotRequired[list[ScenePart] | None]
    noticed: NotRequired[list[str] | None]


class PlannedCost(TypedDict):
    """What an answer costs, where that is counted exactly: it holds on every machine."""

    evaluations: int | None
    samples: int | None
    members: NotRequired[int | None]
    bytes: int | None


class PlannedError(TypedDict):
    """How wrong the answer would be, relative to the largest norm of the whole motion."""

    error: float | str
    how: str
    inherited: float | None


class PlannedFault(TypedDict):
    """What the request would be refused for."""

    pointer: str
    detail: str
    remedy: NotRequired[str | None]
    code: str


class AssessmentRequest(TypedDict):
    """A question, and what was submitted as its answer."""

    question: EndpointRequest
    submissions: Sequence[Mapping[str, ClaimDocument]]
    comparison: NotRequired[RelAbs | SigFig | DecDig | Interval | Data | None]
    comparisons: NotRequired[Mapping[str, RelAbs | SigFig | DecDig | Interval | Data] | None]
    input_uncertainty: NotRequired[float | None]
    input_uncertainties: NotRequired[Mapping[str, float] | None]
    names: NotRequired[Mapping[str, str] | None]
    credits: NotRequired[Mapping[str, float] | None]
    locale: NotRequired[Literal["de", "en", "es", "fr"] | None]
    language: NotRequired[Literal["de", "en", "es", "fr"]]
    steps: NotRequired[Mapping[str, CarriedStep] | None]
    reveal: NotRequired[bool]


class EndpointRequest(TypedDict):
    """A request to another endpoint, whose answer is the reference."""

    path: str
    request: Mapping[str, Any]


class ClaimDocument(TypedDict):
    """A claim about one figure of the answer."""

    value: NotRequired[Any]
    unit: NotRequired[str | None]
    formula: NotRequired[str | None]
    text: NotRequired[str | None]
    times: NotRequired[Numbers | None]


class RelAbs(TypedDict):
    """An error of at most `rtol` times the largest magnitude of the reference, plus `atol`."""

    rtol: NotRequired[float]
    atol: NotRequired[float | None]
    kind: Literal["relabs"]


class SigFig(TypedDict):
    """Agreement in so many significant figures of the reference, of an array those of its largest entry."""

    digits: NotRequired[int]
    kind: Literal["sigfig"]


class DecDig(TypedDict):
    """Agreement in so many decimal places, in the unit of the reference."""

    digits: NotRequired[int]
    kind: Literal["decdig"]


class Interval(TypedDict):
    """A number between two limits, whatever the reference is."""

    lower: float
    upper: float
    kind: Literal["interval"]


class Data(TypedDict):
    """An error of at most what the uncertainty of the question's own data may cause."""

    factor: NotRequired[float]
    kind: Literal["data"]


class CarriedStep(TypedDict):
    """How a figure follows from earlier figures."""

    formula: str
    earlier: Mapping[str, str]
    credit: NotRequired[float]


class AssessmentAnswer(TypedDict):
    """Verdicts, in the order of the submissions."""

    signature: Signature
    warnings: list[Notice]
    results: list[SubmissionResult]
    reference: NotRequired[list[ReferenceFigure] | None]


class SubmissionResult(TypedDict):
    """What becomes of one submission."""

    score: float | None
    correct: bool | None
    gradable: bool
    format_errors: list[Fault]
    tests: list[ClaimResult]
    matches: list[str]
    feedback: str


class Fault(TypedDict):
    """A place in the document that was sent and what must hold there."""

    pointer: str
    detail: str
    remedy: NotRequired[str | None]


class ClaimResult(TypedDict):
    """What becomes of one claim."""

    pointer: str
    verdict: Literal["correct", "incorrect", "carried", "missing-unit", "wrong-unit", "not-gradable", "unreadable"]
    correct: bool | None
    score: float | None
    matches: list[RecognisedMistake]
    feedback: str
    error: NotRequired[ClaimError | None]
    samples: NotRequired[SamplesError | None]


class RecognisedMistake(TypedDict):
    """A mistake by which the submitted value comes out."""

    tag: str
    credit: float
    feedback: str


class ClaimError(TypedDict):
    """How far a claim is from the reference."""

    absolute: float | None
    relative: float | None
    in_tolerances: float | None
    tolerance: float | None
    sensitive: float | None
    unit: str


class SamplesError(TypedDict):
    """How wrong samples of the angular velocity are."""

    largest: float
    final: float
    within_until: float | None
    energy_drift: float | None
    angular_momentum_drift: float | None
    phase_lag: float | None
    separatrix_crossed: float | None
    consistent_with: ConsistentMethod | None


class ConsistentMethod(TypedDict):
    """A method by which the samples come out, confirmed by running it."""

    method: str
    step: float | None
    tolerance: float | None
    unexplained: float


class ReferenceFigure(TypedDict):
    """What is right, and how well it is known."""

    pointer: str
    value: Any
    unit: str
    form: Literal[
        "number",
        "vector",
        "matrix",
        "angle",
        "attitude",
        "direction",
        "axes",
        "set",
        "choice",
        "samples",
        "curve",
        "none",
    ]
    error: float
    how: str
    inherited: float | None
    body_axis: Literal[1, 2, 3] | None
    sensitive: str | None


class VariantsRequest(TypedDict):
    """A question, and what varies in it."""

    question: EndpointRequest
    vary: Mapping[str, VariedInput]
    seed: int
    count: NotRequired[int]
    quantities: NotRequired[Sequence[str] | None]
    constraints: NotRequired[Mapping[str, Constraint] | None]
    max_condition: NotRequired[float | None]
    input_uncertainty: NotRequired[float | None]
    draws: NotRequired[int]


class VariedInput(TypedDict):
    """A range from `min` to `max`, or a choice from `values`."""

    min: NotRequired[float | None]
    max: NotRequired[float | None]
    distribution: NotRequired[Literal["uniform", "log-uniform"]]
    step: NotRequired[float | None]
    digits: NotRequired[int | None]
    values: NotRequired[Sequence[float | str | bool] | None]
    also: NotRequired[Sequence[str]]


class Constraint(TypedDict):
    """What is required of a figure of the answer; of an array, of each of its entries."""

    min: NotRequired[float | None]
    max: NotRequired[float | None]
    digits: NotRequired[int | None]
    within: NotRequired[float]
    apart: NotRequired[float | None]


class VariantsAnswer(TypedDict):
    """Variants of a question."""

    signature: Signature
    warnings: list[Notice]
    path: str
    seed: int
    variants: list[Variant]
    rejected: dict[str, int]


class Variant(TypedDict):
    """A question with other numbers, and its figures."""

    request: dict[str, Any]
    figures: list[VariantFigure]
    draws: int


class VariantFigure(TypedDict):
    """A figure of a variant, how well it is known and how sensitive it is."""

    pointer: str
    value: Any
    unit: str
    form: Literal[
        "number",
        "vector",
        "matrix",
        "angle",
        "attitude",
        "direction",
        "axes",
        "set",
        "choice",
        "samples",
        "curve",
        "none",
    ]
    error: float
    how: str
    inherited: float | None
    body_axis: Literal[1, 2, 3] | None
    sensitive: str | None
    condition: float | None


class StudyRequest(TypedDict):
    """One question with varied inputs, and the figures of its answers that are wanted."""

    question: EndpointRequest
    vary: Sequence[StudyInput]
    design: NotRequired[Literal["product", "zip", "sobol", "random"]]
    count: NotRequired[int | None]
    seed: NotRequired[int | None]
    quantities: Sequence[str]
    statistics: NotRequired[Sequence[Literal["mean", "std", "quantiles", "extremes", "histogram", "failures"]]]
    probabilities: NotRequired[Numbers]
    bins: NotRequired[int]


class StudyInput(TypedDict):
    """An input that varies: a range from `min` to `max`, `values`, or a normal distribution."""

    min: NotRequired[float | None]
    max: NotRequired[float | None]
    distribution: NotRequired[Literal["uniform", "log-uniform", "normal"]]
    step: NotRequired[float | None]
    digits: NotRequired[int | None]
    values: NotRequired[Sequence[float | str | bool | Mapping[str, Any] | Numbers] | None]
    also: NotRequired[Sequence[str]]
    pointer: NotRequired[str]
    mean: NotRequired[float | None]
    deviation: NotRequired[float | None]
    count: NotRequired[int | None]


class StudyState(TypedDict):
    """The state of one study."""

    signature: Signature
    jobID: str
    type: Literal["process"]
    processID: Literal["study"]
    status: Literal["accepted", "running", "successful", "failed", "dismissed"]
    message: str
    created: str
    started: str | None
    finished: str | None
    updated: str
    progress: int
    path: str
    count: int
    shape: Integers
    inputs: list[StudyAxis]
    figures: list[StudyFigure]
    together: bool
    done: int
    failed: int
    seconds: float
    predicted_seconds: float
    bytes: int
    predicted_end: str | None
    links: list[Link]


class StudyAxis(TypedDict):
    """A varied input."""

    pointer: str
    unit: str | None
    levels: int | None


class StudyFigure(TypedDict):
    """A figure of the members."""

    pointer: str
    unit: str | None


class Link(TypedDict):
    """A document that belongs to a study."""

    href: str
    rel: str
    type: str


class StudyList(TypedDict):
    """The studies of a client, the latest first."""

    signature: Signature
    studies: list[StudyStatus]


class StudyStatus(TypedDict):
    """The state of a study, in the shape of OGC API Processes' statusInfo."""

    jobID: str
    type: Literal["process"]
    processID: Literal["study"]
    status: Literal["accepted", "running", "successful", "failed", "dismissed"]
    message: str
    created: str
    started: str | None
    finished: str | None
    updated: str
    progress: int
    path: str
    count: int
    shape: Integers
    inputs: list[StudyAxis]
    figures: list[StudyFigure]
    together: bool
    done: int
    failed: int
    seconds: float
    predicted_seconds: float
    bytes: int
    predicted_end: str | None
    links: list[Link]


class StudyResults(TypedDict):
    """Results of members that follow each other, column by column."""

    signature: Signature
    warnings: list[Notice]
    jobID: str
    count: int
    shape: Integers
    statistics: StudySummary
    start: int
    inputs: dict[str, list[Any]]
    figures: dict[str, list[float | None]]
    failures: list[FailedMember]
    next: str | None


class StudySummary(TypedDict):
    """Statistics of all members."""

    figures: dict[str, StudyStatistics]
    failures: NotRequired[dict[str, int] | None]
    warnings: NotRequired[dict[str, int] | None]


class StudyStatistics(TypedDict):
    """Statistics of one quantity; null where they were not requested or do not exist."""

    unit: str | None
    present: int
    mean: float | None
    standard_error: float | None
    std: float | None
    quantiles: list[StudyQuantile] | None
    min: StudyExtreme | None
    max: StudyExtreme | None
    histogram: StudyHistogram | None


class StudyQuantile(TypedDict):
    """The value below which a share of the samples lies."""

    probability: float
    value: float


class StudyExtreme(TypedDict):
    """A smallest or largest figure."""

    value: float
    member: int


class StudyHistogram(TypedDict):
    """Members by figure."""

    edges: Floats
    counts: Integers


class FailedMember(TypedDict):
    """A member without result."""

    member: int
    code: str


class ProblemRegistry(TypedDict):
    """The registry of problems."""

    signature: Signature
    errors: list[ProblemEntry]


class ProblemEntry(TypedDict):
    """One entry of the registry of problems."""

    code: str
    type: str
    status: int
    title: str
    meaning: str


class MethodCatalogue(TypedDict):
    """The catalogue of methods."""

    signature: Signature
    methods: list[MethodEntry]


class MethodEntry(TypedDict):
    """One member of the catalogue of methods."""

    kind: str
    setting: str | None
    order: int | None
    family: Literal["closed form", "explicit", "implicit", "structure-preserving"]
    preserves: list[
        Literal["every first integral", "quadratic invariants", "invariants of every part", "time symmetry"]
    ]
    between_steps: str
    on_constraints: str
    when_to_use: str
    record: list[MethodRecord]


class MethodRecord(TypedDict):
    """What a method with one setting was measured to do on problems with known solutions."""

    tolerance: float
    error: float
    evaluations: int


class MistakeCatalogue(TypedDict):
    """The catalogue of recognised mistakes."""

    signature: Signature
    mistakes: list[MistakeEntry]


class MistakeEntry(TypedDict):
    """One mistake that is recognised in submitted answers."""

    tag: str
    summary: str
    feedback: dict[str, str]
    credit: float


class UndecidedRegistry(TypedDict):
    """What can be left undecided about a scene with contacts."""

    signature: Signature
    undecided: list[UndecidedEntry]


class UndecidedEntry(TypedDict):
    """One kind of thing that is left undecided about a scene with contacts."""

    code: Literal[
        "no-motion",
        "several-motions",
        "undetermined-friction",
        "simultaneous-impacts",
        "several-impacts",
        "no-impact",
        "energy-gain",
        "grazing-contact",
        "several-onsets",
        "turning-onset",
        "no-progress",
        "event-limit",
        "lost-event",
    ]
    type: str
    title: str
    meaning: str
    of_mechanics: bool
    documentation: str


class Status(TypedDict):
    """State of the service."""

    status: str
    audit: NotRequired[str | None]


class ProblemDocument(TypedDict):
    """RFC 9457 problem document."""

    type: str
    title: str
    status: int
    detail: str
    code: str
    instance: NotRequired[str | None]
    request_id: NotRequired[str | None]
    errors: NotRequired[list[Fault] | None]
    what: NotRequired[str | None]
    needed: NotRequired[int | None]
    limit: NotRequired[int | None]
    requested: NotRequired[float | None]
    achievable: NotRequired[float | None]
    retry_after_seconds: NotRequired[float | None]
    id: NotRequired[str | None]
