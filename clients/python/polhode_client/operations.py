"""Every operation of the service as a method.

Written by clients/python/generate.py from docs/openapi.json; do not edit.
"""

# ruff: noqa: E501, D1
from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, NamedTuple, Unpack

from polhode_client import documents


class Operation(NamedTuple):
    """Method, path and summary."""

    method: str
    path: str
    summary: str

    def at(self, **places: str) -> Operation:
        """Return the operation with the braces of its path filled."""
        return self._replace(path=self.path.format(**places)) if places else self


OPERATIONS: Mapping[str, Operation] = {
    "mass_properties": Operation(
        "POST",
        "/v1/bodies/mass-properties",
        "Mass, centre of mass, inertia, principal axes, symmetry and validity of a body",
    ),
    "rotation_trajectory": Operation(
        "POST",
        "/v1/rotation/trajectory",
        "The free rotation of a body: angular velocity and, if requested, attitude at given times",
    ),
    "rotation_ensemble": Operation(
        "POST", "/v1/rotation/ensemble", "Many free rotations of one body, from given starts or a sample of one energy"
    ),
    "precession": Operation(
        "POST", "/v1/rotation/precession", "Rates, period, flip interval and cones of a free rotation"
    ),
    "stability": Operation(
        "POST",
        "/v1/rotation/stability",
        "Every equilibrium of a free body: eigenvalues, kind, stability and the reason",
    ),
    "energy_ellipsoid": Operation(
        "POST",
        "/v1/rotation/energy-ellipsoid",
        "The energy ellipsoid as a mesh or a grid, with polhodes and separatrix",
    ),
    "initial_states": Operation(
        "POST", "/v1/rotation/initial-states", "Starts of one energy, drawn uniformly over the scaled sphere"
    ),
    "wobble": Operation(
        "POST", "/v1/rotation/wobble", "The free wobble of a planet: asymmetry, ellipticity and period"
    ),
    "work_precision": Operation(
        "POST", "/v1/work-precision", "What error each method buys for which work, on a motion of your own"
    ),
    "scene_unwinding_shafts": Operation(
        "POST",
        "/v1/scenes/unwinding-shafts",
        "Two shafts on a fixed wedge, on whose ends a massless, inextensible string over the smooth apex is wound",
    ),
    "scene_rod_in_hole": Operation(
        "POST",
        "/v1/scenes/rod-in-hole",
        "A rod in the plane across the axis of a smooth cylindrical hole, its ends A and B on the wall",
    ),
    "scene_chain_on_wedge": Operation(
        "POST",
        "/v1/scenes/chain-on-wedge",
        "An inextensible heavy chain over the smooth apex of a fixed wedge, with a mass at each end",
    ),
    "described_scene": Operation(
        "POST",
        "/v1/scenes",
        "A scene of your own: bodies and what connects them, answered by the smallest model that suffices",
    ),
    "list_scenes": Operation(
        "GET", "/v1/scenes", "Every named scene and what it answers, and examples of described ones"
    ),
    "certified_rotation_trajectory": Operation(
        "POST",
        "/v1/certified/rotation/trajectory",
        "The free rotation of a body: angular velocity and, if requested, attitude at given times; every digit proven",
    ),
    "certified_precession": Operation(
        "POST",
        "/v1/certified/rotation/precession",
        "Rates, period, flip interval and cones of a free rotation; every digit proven",
    ),
    "certified_stability": Operation(
        "POST",
        "/v1/certified/rotation/stability",
        "Every equilibrium of a free body: eigenvalues, kind, stability and the reason; every digit proven",
    ),
    "certified_energy_ellipsoid": Operation(
        "POST",
        "/v1/certified/rotation/energy-ellipsoid",
        "The energy ellipsoid as a mesh or a grid, with polhodes and separatrix; every digit proven",
    ),
    "certified_scene_unwinding_shafts": Operation(
        "POST",
        "/v1/certified/scenes/unwinding-shafts",
        "Two shafts on a fixed wedge, on whose ends a massless, inextensible string over the smooth apex is wound; every digit proven",
    ),
    "certified_scene_rod_in_hole": Operation(
        "POST",
        "/v1/certified/scenes/rod-in-hole",
        "A rod in the plane across the axis of a smooth cylindrical hole, its ends A and B on the wall; every digit proven",
    ),
    "certified_scene_chain_on_wedge": Operation(
        "POST",
        "/v1/certified/scenes/chain-on-wedge",
        "An inextensible heavy chain over the smooth apex of a fixed wedge, with a mass at each end; every digit proven",
    ),
    "certified_described_scene": Operation(
        "POST",
        "/v1/certified/scenes",
        "A scene of your own: bodies and what connects them, answered by the smallest model that suffices; every digit proven",
    ),
    "plan": Operation(
        "POST", "/v1/plan", "What is known beforehand of any request: model, method, cost, error and faults"
    ),
    "assess": Operation(
        "POST",
        "/v1/assessments",
        "Student answers to any problem that the service can solve, graded: verdict, error, recognised mistakes",
    ),
    "vary": Operation(
        "POST",
        "/v1/variants",
        "Well-conditioned variants of any problem from a seed, with their values, errors and condition numbers",
    ),
    "create_study": Operation(
        "POST", "/v1/studies", "A study: any problem with varied inputs, computed in the background"
    ),
    "list_studies": Operation("GET", "/v1/studies", "The client's own studies"),
    "get_study": Operation("GET", "/v1/studies/{study}", "The state of a study"),
    "dismiss_study": Operation(
        "DELETE", "/v1/studies/{study}", "Stop a study, or remove one that has ended with its results"
    ),
    "get_study_results": Operation(
        "GET", "/v1/studies/{study}/results", "Statistics and results of a study, page by page or as a whole"
    ),
    "watch_study": Operation(
        "GET", "/v1/studies/{study}/events", "The state of a study as server-sent events, until it ends"
    ),
    "list_errors": Operation("GET", "/v1/errors", "Every problem that can be answered"),
    "list_methods": Operation("GET", "/v1/methods", "Every method that can be chosen, and when to use it"),
    "list_mistakes": Operation("GET", "/v1/mistakes", "Every mistake that is recognised in submitted answers"),
    "list_undecided": Operation(
        "GET", "/v1/undecided", "Everything that can be left undecided about a scene with contacts"
    ),
    "get_health": Operation("GET", "/healthz", "Whether the process answers"),
    "get_readiness": Operation("GET", "/readyz", "Whether every kernel is compiled and the compute processes are up"),
    "get_metrics": Operation("GET", "/metrics", "Counters in Prometheus' text format"),
    "get_openapi": Operation("GET", "/openapi.json", "The OpenAPI document"),
    "get_start_page": Operation("GET", "/", "Page: a rotating body beside its energy ellipsoid"),
    "get_scenes_page": Operation("GET", "/scenes", "Every scene of the catalogue in motion, and your own"),
    "get_studies_page": Operation("GET", "/studies", "Studies with their progress, maps, histograms and results"),
    "get_documentation": Operation("GET", "/docs", "The reference of the API, to read and to try"),
}


class Operations(ABC):
    """Methods of the blocking client."""

    @abstractmethod
    def _ask(self, name: str, question: Mapping[str, Any] | None, media: str | None, **places: str) -> Any:
        """Return what an operation answers, in a media type or as its document.

        `places` fill the braces of its path."""

    def mass_properties(self, **question: Unpack[documents.MassPropertiesRequest]) -> documents.MassPropertiesAnswer:
        """Mass, centre of mass, inertia, principal axes, symmetry and validity of a body."""
        found: documents.MassPropertiesAnswer = self._ask("mass_properties", question, None)
        return found

    def rotation_trajectory(self, **question: Unpack[documents.TrajectoryRequest]) -> documents.TrajectoryAnswer:
        """The free rotation of a body: angular velocity and, if requested, attitude at given times."""
        found: documents.TrajectoryAnswer = self._ask("rotation_trajectory", question, None)
        return found

    def rotation_trajectory_svg(self, **question: Unpack[documents.TrajectoryRequest]) -> str:
        """The free rotation of a body: angular velocity and, if requested, attitude at given times, as a drawing."""
        found: str = self._ask("rotation_trajectory", question, "image/svg+xml")
        return found

    def rotation_ensemble(self, **question: Unpack[documents.EnsembleRequest]) -> documents.EnsembleAnswer:
        """Many free rotations of one body, from given starts or a sample of one energy."""
        found: documents.EnsembleAnswer = self._ask("rotation_ensemble", question, None)
        return found

    def rotation_ensemble_svg(self, **question: Unpack[documents.EnsembleRequest]) -> str:
        """Many free rotations of one body, from given starts or a sample of one energy, as a drawing."""
        found: str = self._ask("rotation_ensemble", question, "image/svg+xml")
        return found

    def precession(self, **question: Unpack[documents.PrecessionRequest]) -> documents.PrecessionAnswer:
        """Rates, period, flip interval and cones of a free rotation."""
        found: documents.PrecessionAnswer = self._ask("precession", question, None)
        return found

    def stability(self, **question: Unpack[documents.StabilityRequest]) -> documents.StabilityAnswer:
        """Every equilibrium of a free body: eigenvalues, kind, stability and the reason."""
        found: documents.StabilityAnswer = self._ask("stability", question, None)
        return found

    def energy_ellipsoid(self, **question: Unpack[documents.EllipsoidRequest]) -> documents.EllipsoidAnswer:
        """The energy ellipsoid as a mesh or a grid, with polhodes and separatrix."""
        found: documents.EllipsoidAnswer = self._ask("energy_ellipsoid", question, None)
        return found

    def energy_ellipsoid_svg(self, **question: Unpack[documents.EllipsoidRequest]) -> str:
        """The energy ellipsoid as a mesh or a grid, with polhodes and separatrix, as a drawing."""
        found: str = self._ask("energy_ellipsoid", question, "image/svg+xml")
        return found

    def initial_states(self, **question: Unpack[documents.StatesRequest]) -> documents.StatesAnswer:
        """Starts of one energy, drawn uniformly over the scaled sphere."""
        found: documents.StatesAnswer = self._ask("initial_states", question, None)
        return found

    def wobble(self, **question: Unpack[documents.WobbleRequest]) -> documents.WobbleAnswer:
        """The free wobble of a planet: asymmetry, ellipticity and period."""
        found: documents.WobbleAnswer = self._ask("wobble", question, None)
        return found

    def work_precision(self, **question: Unpack[documents.WorkPrecisionRequest]) -> documents.WorkPrecisionAnswer:
        """What error each method buys for which work, on a motion of your own."""
        found: documents.WorkPrecisionAnswer = self._ask("work_precision", question, None)
        return found

    def work_precision_svg(self, **question: Unpack[documents.WorkPrecisionRequest]) -> str:
        """What error each method buys for which work, on a motion of your own, as a drawing."""
        found: str = self._ask("work_precision", question, "image/svg+xml")
        return found

    def scene_unwinding_shafts(
        self, **question: Unpack[documents.UnwindingShaftsRequest]
    ) -> documents.UnwindingShaftsAnswer:
        """Two shafts on a fixed wedge, on whose ends a massless, inextensible string over the smooth apex is wound."""
        found: documents.UnwindingShaftsAnswer = self._ask("scene_unwinding_shafts", question, None)
        return found

    def scene_unwinding_shafts_svg(self, **question: Unpack[documents.UnwindingShaftsRequest]) -> str:
        """Two shafts on a fixed wedge, on whose ends a massless, inextensible string over the smooth apex is wound, as a drawing."""
        found: str = self._ask("scene_unwinding_shafts", question, "image/svg+xml")
        return found

    def scene_rod_in_hole(self, **question: Unpack[documents.RodInHoleRequest]) -> documents.RodInHoleAnswer:
        """A rod in the plane across the axis of a smooth cylindrical hole, its ends A and B on the wall."""
        found: documents.RodInHoleAnswer = self._ask("scene_rod_in_hole", question, None)
        return found

    def scene_rod_in_hole_svg(self, **question: Unpack[documents.RodInHoleRequest]) -> str:
        """A rod in the plane across the axis of a smooth cylindrical hole, its ends A and B on the wall, as a drawing."""
        found: str = self._ask("scene_rod_in_hole", question, "image/svg+xml")
        return found

    def scene_chain_on_wedge(self, **question: Unpack[documents.ChainOnWedgeRequest]) -> documents.ChainOnWedgeAnswer:
        """An inextensible heavy chain over the smooth apex of a fixed wedge, with a mass at each end."""
        found: documents.ChainOnWedgeAnswer = self._ask("scene_chain_on_wedge", question, None)
        return found

    def scene_chain_on_wedge_svg(self, **question: Unpack[documents.ChainOnWedgeRequest]) -> str:
        """An inextensible heavy chain over the smooth apex of a fixed wedge, with a mass at each end, as a drawing."""
        found: str = self._ask("scene_chain_on_wedge", question, "image/svg+xml")
        return found

    def described_scene(self, **question: Unpack[documents.DescribedSceneRequest]) -> documents.DescribedSceneAnswer:
        """A scene of your own: bodies and what connects them, answered by the smallest model that suffices."""
        found: documents.DescribedSceneAnswer = self._ask("described_scene", question, None)
        return found

    def described_scene_svg(self, **question: Unpack[documents.DescribedSceneRequest]) -> str:
        """A scene of your own: bodies and what connects them, answered by the smallest model that suffices, as a drawing."""
        found: str = self._ask("described_scene", question, "image/svg+xml")
        return found

    def list_scenes(self) -> documents.SceneCatalogue:
        """Every named scene and what it answers, and examples of described ones."""
        found: documents.SceneCatalogue = self._ask("list_scenes", None, None)
        return found

    def certified_rotation_trajectory(
        self, **question: Unpack[documents.CertifiedTrajectoryRequest]
    ) -> documents.CertifiedTrajectoryAnswer:
        """The free rotation of a body: angular velocity and, if requested, attitude at given times; every digit proven."""
        found: documents.CertifiedTrajectoryAnswer = self._ask("certified_rotation_trajectory", question, None)
        return found

    def certified_rotation_trajectory_svg(self, **question: Unpack[documents.CertifiedTrajectoryRequest]) -> str:
        """The free rotation of a body: angular velocity and, if requested, attitude at given times; every digit proven, as a drawing."""
        found: str = self._ask("certified_rotation_trajectory", question, "image/svg+xml")
        return found

    def certified_precession(
        self, **question: Unpack[documents.CertifiedPrecessionRequest]
    ) -> documents.CertifiedPrecessionAnswer:
        """Rates, period, flip interval and cones of a free rotation; every digit proven."""
        found: documents.CertifiedPrecessionAnswer = self._ask("certified_precession", question, None)
        return found

    def certified_stability(
        self, **question: Unpack[documents.CertifiedStabilityRequest]
    ) -> documents.CertifiedStabilityAnswer:
        """Every equilibrium of a free body: eigenvalues, kind, stability and the reason; every digit proven."""
        found: documents.CertifiedStabilityAnswer = self._ask("certified_stability", question, None)
        return found

    def certified_energy_ellipsoid(
        self, **question: Unpack[documents.CertifiedEllipsoidRequest]
    ) -> documents.CertifiedEllipsoidAnswer:
        """The energy ellipsoid as a mesh or a grid, with polhodes and separatrix; every digit proven."""
        found: documents.CertifiedEllipsoidAnswer = self._ask("certified_energy_ellipsoid", question, None)
        return found

    def certified_energy_ellipsoid_svg(self, **question: Unpack[documents.CertifiedEllipsoidRequest]) -> str:
        """The energy ellipsoid as a mesh or a grid, with polhodes and separatrix; every digit proven, as a drawing."""
        found: str = self._ask("certified_energy_ellipsoid", question, "image/svg+xml")
        return found

    def certified_scene_unwinding_shafts(
        self, **question: Unpack[documents.CertifiedUnwindingShaftsRequest]
    ) -> documents.CertifiedUnwindingShaftsAnswer:
        """Two shafts on a fixed wedge, on whose ends a massless, inextensible string over the smooth apex is wound; every digit proven."""
        found: documents.CertifiedUnwindingShaftsAnswer = self._ask("certified_scene_unwinding_shafts", question, None)
        return found

    def certified_scene_unwinding_shafts_svg(
        self, **question: Unpack[documents.CertifiedUnwindingShaftsRequest]
    ) -> str:
        """Two shafts on a fixed wedge, on whose ends a massless, inextensible string over the smooth apex is wound; every digit proven, as a drawing."""
        found: str = self._ask("certified_scene_unwinding_shafts", question, "image/svg+xml")
        return found

    def certified_scene_rod_in_hole(
        self, **question: Unpack[documents.CertifiedRodInHoleRequest]
    ) -> documents.CertifiedRodInHoleAnswer:
        """A rod in the plane across the axis of a smooth cylindrical hole, its ends A and B on the wall; every digit proven."""
        found: documents.CertifiedRodInHoleAnswer = self._ask("certified_scene_rod_in_hole", question, None)
        return found

    def certified_scene_rod_in_hole_svg(self, **question: Unpack[documents.CertifiedRodInHoleRequest]) -> str:
        """A rod in the plane across the axis of a smooth cylindrical hole, its ends A and B on the wall; every digit proven, as a drawing."""
        found: str = self._ask("certified_scene_rod_in_hole", question, "image/svg+xml")
        return found

    def certified_scene_chain_on_wedge(
        self, **question: Unpack[documents.CertifiedChainOnWedgeRequest]
    ) -> documents.CertifiedChainOnWedgeAnswer:
        """An inextensible heavy chain over the smooth apex of a fixed wedge, with a mass at each end; every digit proven."""
        found: documents.CertifiedChainOnWedgeAnswer = self._ask("certified_scene_chain_on_wedge", question, None)
        return found

    def certified_scene_chain_on_wedge_svg(self, **question: Unpack[documents.CertifiedChainOnWedgeRequest]) -> str:
        """An inextensible heavy chain over the smooth apex of a fixed wedge, with a mass at each end; every digit proven, as a drawing."""
        found: str = self._ask("certified_scene_chain_on_wedge", question, "image/svg+xml")
        return found

    def certified_described_scene(
        self, **question: Unpack[documents.CertifiedSceneRequest]
    ) -> documents.CertifiedDescribedAnswer:
        """A scene of your own: bodies and what connects them, answered by the smallest model that suffices; every digit proven."""
        found: documents.CertifiedDescribedAnswer = self._ask("certified_described_scene", question, None)
        return found

    def certified_described_scene_svg(self, **question: Unpack[documents.CertifiedSceneRequest]) -> str:
        """A scene of your own: bodies and what connects them, answered by the smallest model that suffices; every digit proven, as a drawing."""
        found: str = self._ask("certified_described_scene", question, "image/svg+xml")
        return found

    def plan(self, **question: Unpack[documents.PlanRequest]) -> documents.PlanAnswer:
        """What is known beforehand of any request: model, method, cost, error and faults."""
        found: documents.PlanAnswer = self._ask("plan", question, None)
        return found

    def assess(self, **question: Unpack[documents.AssessmentRequest]) -> documents.AssessmentAnswer:
        """Student answers to any problem that the service can solve, graded: verdict, error, recognised mistakes."""
        found: documents.AssessmentAnswer = self._ask("assess", question, None)
        return found

    def vary(self, **question: Unpack[documents.VariantsRequest]) -> documents.VariantsAnswer:
        """Well-conditioned variants of any problem from a seed, with their values, errors and condition numbers."""
        found: documents.VariantsAnswer = self._ask("vary", question, None)
        return found

    def create_study(self, **question: Unpack[documents.StudyRequest]) -> documents.StudyState:
        """A study: any problem with varied inputs, computed in the background."""
        found: documents.StudyState = self._ask("create_study", question, None)
        return found

    def list_studies(self) -> documents.StudyList:
        """The client's own studies."""
        found: documents.StudyList = self._ask("list_studies", None, None)
        return found

    def get_study(self, study: str) -> documents.StudyState:
        """The state of a study."""
        found: documents.StudyState = self._ask("get_study", None, None, study=study)
        return found

    def dismiss_study(self, study: str) -> documents.StudyState:
        """Stop a study, or remove one that has ended with its results."""
        found: documents.StudyState = self._ask("dismiss_study", None, None, study=study)
        return found

    def get_study_results(self, study: str) -> documents.StudyResults:
        """Statistics and results of a study, page by page or as a whole."""
        found: documents.StudyResults = self._ask("get_study_results", None, None, study=study)
        return found

    def get_study_results_svg(self, study: str) -> str:
        """Statistics and results of a study, page by page or as a whole, as a drawing."""
        found: str = self._ask("get_study_results", None, "image/svg+xml", study=study)
        return found

    def watch_study(self, study: str) -> str:
        """The state of a study as server-sent events, until it ends."""
        found: str = self._ask("watch_study", None, "text/event-stream", study=study)
        return found

    def list_errors(self) -> documents.ProblemRegistry:
        """Every problem that can be answered."""
        found: documents.ProblemRegistry = self._ask("list_errors", None, None)
        return found

    def list_methods(self) -> documents.MethodCatalogue:
        """Every method that can be chosen, and when to use it."""
        found: documents.MethodCatalogue = self._ask("list_methods", None, None)
        return found

    def list_mistakes(self) -> documents.MistakeCatalogue:
        """Every mistake that is recognised in submitted answers."""
        found: documents.MistakeCatalogue = self._ask("list_mistakes", None, None)
        return found

    def list_undecided(self) -> documents.UndecidedRegistry:
        """Everything that can be left undecided about a scene with contacts."""
        found: documents.UndecidedRegistry = self._ask("list_undecided", None, None)
        return found

    def get_health(self) -> documents.Status:
        """Whether the process answers."""
        found: documents.Status = self._ask("get_health", None, None)
        return found

    def get_readiness(self) -> documents.Status:
        """Whether every kernel is compiled and the compute processes are up."""
        found: documents.Status = self._ask("get_readiness", None, None)
        return found

    def get_metrics(self) -> str:
        """Counters in Prometheus' text format."""
        found: str = self._ask("get_metrics", None, "text/plain")
        return found

    def get_openapi(self) -> dict[str, Any]:
        """The OpenAPI document."""
        found: dict[str, Any] = self._ask("get_openapi", None, None)
        return found

    def get_start_page(self) -> str:
        """Page: a rotating body beside its energy ellipsoid."""
        found: str = self._ask("get_start_page", None, "text/html")
        return found

    def get_scenes_page(self) -> str:
        """Every scene of the catalogue in motion, and your own."""
        found: str = self._ask("get_scenes_page", None, "text/html")
        return found

    def get_studies_page(self) -> str:
        """Studies with their progress, maps, histograms and results."""
        found: str = self._ask("get_studies_page", None, "text/html")
        return found

    def get_documentation(self) -> str:
        """The reference of the API, to read and to try."""
        found: str = self._ask("get_documentation", None, "text/html")
        return found


class AsyncOperations(ABC):
    """Methods of the asynchronous client."""

    @abstractmethod
    async def _ask(self, name: str, question: Mapping[str, Any] | None, media: str | None, **places: str) -> Any:
        """Return what an operation answers, in a media type or as its document.

        `places` fill the braces of its path."""

    async def mass_properties(
        self, **question: Unpack[documents.MassPropertiesRequest]
    ) -> documents.MassPropertiesAnswer:
        """Mass, centre of mass, inertia, principal axes, symmetry and validity of a body."""
        found: documents.MassPropertiesAnswer = await self._ask("mass_properties", question, None)
        return found

    async def rotation_trajectory(self, **question: Unpack[documents.TrajectoryRequest]) -> documents.TrajectoryAnswer:
        """The free rotation of a body: angular velocity and, if requested, attitude at given times."""
        found: documents.TrajectoryAnswer = await self._ask("rotation_trajectory", question, None)
        return found

    async def rotation_trajectory_svg(self, **question: Unpack[documents.TrajectoryRequest]) -> str:
        """The free rotation of a body: angular velocity and, if requested, attitude at given times, as a drawing."""
        found: str = await self._ask("rotation_trajectory", question, "image/svg+xml")
        return found

    async def rotation_ensemble(self, **question: Unpack[documents.EnsembleRequest]) -> documents.EnsembleAnswer:
        """Many free rotations of one body, from given starts or a sample of one energy."""
        found: documents.EnsembleAnswer = await self._ask("rotation_ensemble", question, None)
        return found

    async def rotation_ensemble_svg(self, **question: Unpack[documents.EnsembleRequest]) -> str:
        """Many free rotations of one body, from given starts or a sample of one energy, as a drawing."""
        found: str = await self._ask("rotation_ensemble", question, "image/svg+xml")
        return found

    async def precession(self, **question: Unpack[documents.PrecessionRequest]) -> documents.PrecessionAnswer:
        """Rates, period, flip interval and cones of a free rotation."""
        found: documents.PrecessionAnswer = await self._ask("precession", question, None)
        return found

    async def stability(self, **question: Unpack[documents.StabilityRequest]) -> documents.StabilityAnswer:
        """Every equilibrium of a free body: eigenvalues, kind, stability and the reason."""
        found: documents.StabilityAnswer = await self._ask("stability", question, None)
        return found

    async def energy_ellipsoid(self, **question: Unpack[documents.EllipsoidRequest]) -> documents.EllipsoidAnswer:
        """The energy ellipsoid as a mesh or a grid, with polhodes and separatrix."""
        found: documents.EllipsoidAnswer = await self._ask("energy_ellipsoid", question, None)
        return found

    async def energy_ellipsoid_svg(self, **question: Unpack[documents.EllipsoidRequest]) -> str:
        """The energy ellipsoid as a mesh or a grid, with polhodes and separatrix, as a drawing."""
        found: str = await self._ask("energy_ellipsoid", question, "image/svg+xml")
        return found

    async def initial_states(self, **question: Unpack[documents.StatesRequest]) -> documents.StatesAnswer:
        """Starts of one energy, drawn uniformly over the scaled sphere."""
        found: documents.StatesAnswer = await self._ask("initial_states", question, None)
        return found

    async def wobble(self, **question: Unpack[documents.WobbleRequest]) -> documents.WobbleAnswer:
        """The free wobble of a planet: asymmetry, ellipticity and period."""
        found: documents.WobbleAnswer = await self._ask("wobble", question, None)
        return found

    async def work_precision(self, **question: Unpack[documents.WorkPrecisionRequest]) -> documents.WorkPrecisionAnswer:
        """What error each method buys for which work, on a motion of your own."""
        found: documents.WorkPrecisionAnswer = await self._ask("work_precision", question, None)
        return found

    async def work_precision_svg(self, **question: Unpack[documents.WorkPrecisionRequest]) -> str:
        """What error each method buys for which work, on a motion of your own, as a drawing."""
        found: str = await self._ask("work_precision", question, "image/svg+xml")
        return found

    async def scene_unwinding_shafts(
        self, **question: Unpack[documents.UnwindingShaftsRequest]
    ) -> documents.UnwindingShaftsAnswer:
        """Two shafts on a fixed wedge, on whose ends a massless, inextensible string over the smooth apex is wound."""
        found: documents.UnwindingShaftsAnswer = await self._ask("scene_unwinding_shafts", question, None)
        return found

    async def scene_unwinding_shafts_svg(self, **question: Unpack[documents.UnwindingShaftsRequest]) -> str:
        """Two shafts on a fixed wedge, on whose ends a massless, inextensible string over the smooth apex is wound, as a drawing."""
        found: str = await self._ask("scene_unwinding_shafts", question, "image/svg+xml")
        return found

    async def scene_rod_in_hole(self, **question: Unpack[documents.RodInHoleRequest]) -> documents.RodInHoleAnswer:
        """A rod in the plane across the axis of a smooth cylindrical hole, its ends A and B on the wall."""
        found: documents.RodInHoleAnswer = await self._ask("scene_rod_in_hole", question, None)
        return found

    async def scene_rod_in_hole_svg(self, **question: Unpack[documents.RodInHoleRequest]) -> str:
        """A rod in the plane across the axis of a smooth cylindrical hole, its ends A and B on the wall, as a drawing."""
        found: str = await self._ask("scene_rod_in_hole", question, "image/svg+xml")
        return found

    async def scene_chain_on_wedge(
        self, **question: Unpack[documents.ChainOnWedgeRequest]
    ) -> documents.ChainOnWedgeAnswer:
        """An inextensible heavy chain over the smooth apex of a fixed wedge, with a mass at each end."""
        found: documents.ChainOnWedgeAnswer = await self._ask("scene_chain_on_wedge", question, None)
        return found

    async def scene_chain_on_wedge_svg(self, **question: Unpack[documents.ChainOnWedgeRequest]) -> str:
        """An inextensible heavy chain over the smooth apex of a fixed wedge, with a mass at each end, as a drawing."""
        found: str = await self._ask("scene_chain_on_wedge", question, "image/svg+xml")
        return found

    async def described_scene(
        self, **question: Unpack[documents.DescribedSceneRequest]
    ) -> documents.DescribedSceneAnswer:
        """A scene of your own: bodies and what connects them, answered by the smallest model that suffices."""
        found: documents.DescribedSceneAnswer = await self._ask("described_scene", question, None)
        return found

    async def described_scene_svg(self, **question: Unpack[documents.DescribedSceneRequest]) -> str:
        """A scene of your own: bodies and what connects them, answered by the smallest model that suffices, as a drawing."""
        found: str = await self._ask("described_scene", question, "image/svg+xml")
        return found

    async def list_scenes(self) -> documents.SceneCatalogue:
        """Every named scene and what it answers, and examples of described ones."""
        found: documents.SceneCatalogue = await self._ask("list_scenes", None, None)
        return found

    async def certified_rotation_trajectory(
        self, **question: Unpack[documents.CertifiedTrajectoryRequest]
    ) -> documents.CertifiedTrajectoryAnswer:
        """The free rotation of a body: angular velocity and, if requested, attitude at given times; every digit proven."""
        found: documents.CertifiedTrajectoryAnswer = await self._ask("certified_rotation_trajectory", question, None)
        return found

    async def certified_rotation_trajectory_svg(self, **question: Unpack[documents.CertifiedTrajectoryRequest]) -> str:
        """The free rotation of a body: angular velocity and, if requested, attitude at given times; every digit proven, as a drawing."""
        found: str = await self._ask("certified_rotation_trajectory", question, "image/svg+xml")
        return found

    async def certified_precession(
        self, **question: Unpack[documents.CertifiedPrecessionRequest]
    ) -> documents.CertifiedPrecessionAnswer:
        """Rates, period, flip interval and cones of a free rotation; every digit proven."""
        found: documents.CertifiedPrecessionAnswer = await self._ask("certified_precession", question, None)
        return found

    async def certified_stability(
        self, **question: Unpack[documents.CertifiedStabilityRequest]
    ) -> documents.CertifiedStabilityAnswer:
        """Every equilibrium of a free body: eigenvalues, kind, stability and the reason; every digit proven."""
        found: documents.CertifiedStabilityAnswer = await self._ask("certified_stability", question, None)
        return found

    async def certified_energy_ellipsoid(
        self, **question: Unpack[documents.CertifiedEllipsoidRequest]
    ) -> documents.CertifiedEllipsoidAnswer:
        """The energy ellipsoid as a mesh or a grid, with polhodes and separatrix; every digit proven."""
        found: documents.CertifiedEllipsoidAnswer = await self._ask("certified_energy_ellipsoid", question, None)
        return found

    async def certified_energy_ellipsoid_svg(self, **question: Unpack[documents.CertifiedEllipsoidRequest]) -> str:
        """The energy ellipsoid as a mesh or a grid, with polhodes and separatrix; every digit proven, as a drawing."""
        found: str = await self._ask("certified_energy_ellipsoid", question, "image/svg+xml")
        return found

    async def certified_scene_unwinding_shafts(
        self, **question: Unpack[documents.CertifiedUnwindingShaftsRequest]
    ) -> documents.CertifiedUnwindingShaftsAnswer:
        """Two shafts on a fixed wedge, on whose ends a massless, inextensible string over the smooth apex is wound; every digit proven."""
        found: documents.CertifiedUnwindingShaftsAnswer = await self._ask(
            "certified_scene_unwinding_shafts", question, None
        )
        return found

    async def certified_scene_unwinding_shafts_svg(
        self, **question: Unpack[documents.CertifiedUnwindingShaftsRequest]
    ) -> str:
        """Two shafts on a fixed wedge, on whose ends a massless, inextensible string over the smooth apex is wound; every digit proven, as a drawing."""
        found: str = await self._ask("certified_scene_unwinding_shafts", question, "image/svg+xml")
        return found

    async def certified_scene_rod_in_hole(
        self, **question: Unpack[documents.CertifiedRodInHoleRequest]
    ) -> documents.CertifiedRodInHoleAnswer:
        """A rod in the plane across the axis of a smooth cylindrical hole, its ends A and B on the wall; every digit proven."""
        found: documents.CertifiedRodInHoleAnswer = await self._ask("certified_scene_rod_in_hole", question, None)
        return found

    async def certified_scene_rod_in_hole_svg(self, **question: Unpack[documents.CertifiedRodInHoleRequest]) -> str:
        """A rod in the plane across the axis of a smooth cylindrical hole, its ends A and B on the wall; every digit proven, as a drawing."""
        found: str = await self._ask("certified_scene_rod_in_hole", question, "image/svg+xml")
        return found

    async def certified_scene_chain_on_wedge(
        self, **question: Unpack[documents.CertifiedChainOnWedgeRequest]
    ) -> documents.CertifiedChainOnWedgeAnswer:
        """An inextensible heavy chain over the smooth apex of a fixed wedge, with a mass at each end; every digit proven."""
        found: documents.CertifiedChainOnWedgeAnswer = await self._ask("certified_scene_chain_on_wedge", question, None)
        return found

    async def certified_scene_chain_on_wedge_svg(
        self, **question: Unpack[documents.CertifiedChainOnWedgeRequest]
    ) -> str:
        """An inextensible heavy chain over the smooth apex of a fixed wedge, with a mass at each end; every digit proven, as a drawing."""
        found: str = await self._ask("certified_scene_chain_on_wedge", question, "image/svg+xml")
        return found

    async def certified_described_scene(
        self, **question: Unpack[documents.CertifiedSceneRequest]
    ) -> documents.CertifiedDescribedAnswer:
        """A scene of your own: bodies and what connects them, answered by the smallest model that suffices; every digit proven."""
        found: documents.CertifiedDescribedAnswer = await self._ask("certified_described_scene", question, None)
        return found

    async def certified_described_scene_svg(self, **question: Unpack[documents.CertifiedSceneRequest]) -> str:
        """A scene of your own: bodies and what connects them, answered by the smallest model that suffices; every digit proven, as a drawing."""
        found: str = await self._ask("certified_described_scene", question, "image/svg+xml")
        return found

    async def plan(self, **question: Unpack[documents.PlanRequest]) -> documents.PlanAnswer:
        """What is known beforehand of any request: model, method, cost, error and faults."""
        found: documents.PlanAnswer = await self._ask("plan", question, None)
        return found

    async def assess(self, **question: Unpack[documents.AssessmentRequest]) -> documents.AssessmentAnswer:
        """Student answers to any problem that the service can solve, graded: verdict, error, recognised mistakes."""
        found: documents.AssessmentAnswer = await self._ask("assess", question, None)
        return found

    async def vary(self, **question: Unpack[documents.VariantsRequest]) -> documents.VariantsAnswer:
        """Well-conditioned variants of any problem from a seed, with their values, errors and condition numbers."""
        found: documents.VariantsAnswer = await self._ask("vary", question, None)
        return found

    async def create_study(self, **question: Unpack[documents.StudyRequest]) -> documents.StudyState:
        """A study: any problem with varied inputs, computed in the background."""
        found: documents.StudyState = await self._ask("create_study", question, None)
        return found

    async def list_studies(self) -> documents.StudyList:
        """The client's own studies."""
        found: documents.StudyList = await self._ask("list_studies", None, None)
        return found

    async def get_study(self, study: str) -> documents.StudyState:
        """The state of a study."""
        found: documents.StudyState = await self._ask("get_study", None, None, study=study)
        return found

    async def dismiss_study(self, study: str) -> documents.StudyState:
        """Stop a study, or remove one that has ended with its results."""
        found: documents.StudyState = await self._ask("dismiss_study", None, None, study=study)
        return found

    async def get_study_results(self, study: str) -> documents.StudyResults:
        """Statistics and results of a study, page by page or as a whole."""
        found: documents.StudyResults = await self._ask("get_study_results", None, None, study=study)
        return found

    async def get_study_results_svg(self, study: str) -> str:
        """Statistics and results of a study, page by page or as a whole, as a drawing."""
        found: str = await self._ask("get_study_results", None, "image/svg+xml", study=study)
        return found

    async def watch_study(self, study: str) -> str:
        """The state of a study as server-sent events, until it ends."""
        found: str = await self._ask("watch_study", None, "text/event-stream", study=study)
        return found

    async def list_errors(self) -> documents.ProblemRegistry:
        """Every problem that can be answered."""
        found: documents.ProblemRegistry = await self._ask("list_errors", None, None)
        return found

    async def list_methods(self) -> documents.MethodCatalogue:
        """Every method that can be chosen, and when to use it."""
        found: documents.MethodCatalogue = await self._ask("list_methods", None, None)
        return found

    async def list_mistakes(self) -> documents.MistakeCatalogue:
        """Every mistake that is recognised in submitted answers."""
        found: documents.MistakeCatalogue = await self._ask("list_mistakes", None, None)
        return found

    async def list_undecided(self) -> documents.UndecidedRegistry:
        """Everything that can be left undecided about a scene with contacts."""
        found: documents.UndecidedRegistry = await self._ask("list_undecided", None, None)
        return found

    async def get_health(self) -> documents.Status:
        """Whether the process answers."""
        found: documents.Status = await self._ask("get_health", None, None)
        return found

    async def get_readiness(self) -> documents.Status:
        """Whether every kernel is compiled and the compute processes are up."""
        found: documents.Status = await self._ask("get_readiness", None, None)
        return found

    async def get_metrics(self) -> str:
        """Counters in Prometheus' text format."""
        found: str = await self._ask("get_metrics", None, "text/plain")
        return found

    async def get_openapi(self) -> dict[str, Any]:
        """The OpenAPI document."""
        found: dict[str, Any] = await self._ask("get_openapi", None, None)
        return found

    async def get_start_page(self) -> str:
        """Page: a rotating body beside its energy ellipsoid."""
        found: str = await self._ask("get_start_page", None, "text/html")
        return found

    async def get_scenes_page(self) -> str:
        """Every scene of the catalogue in motion, and your own."""
        found: str = await self._ask("get_scenes_page", None, "text/html")
        return found

    async def get_studies_page(self) -> str:
        """Studies with their progress, maps, histograms and results."""
        found: str = await self._ask("get_studies_page", None, "text/html")
        return found

    async def get_documentation(self) -> str:
        """The reference of the API, to read and to try."""
        found: str = await self._ask("get_documentation", None, "text/html")
        return found
