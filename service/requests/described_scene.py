"""The question about a scene that the client describes: bodies, places, connections.

Core reads the description, so that its rules stand once. The form of the question here checks what surrounds it, and
shows in the documentation what core's dataclasses say of it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, fields
from typing import Annotated, Any, Literal, Self, get_type_hints

from pydantic import Field, SkipValidation, create_model

from core.bodies import Body
from core.errors import InvalidParameter, Path
from core.multibody.language.body import SceneBody as DescribedBody
from core.multibody.language.connection import Connection
from core.multibody.language.contacts import ImpactLaw, Simultaneous
from core.multibody.language.kinds import KINDS
from core.multibody.language.reading import scene_from, unknown_field
from core.multibody.language.scene import MOST_BODIES, MOST_CONNECTIONS, Scene
from core.multibody.language.written import Number
from core.multibody.language.written_units import unit_at
from core.multibody.solve import DEFAULT_OUTPUTS, Output
from core.multibody.statics.thresholds import RestOf
from core.multibody.trajectory.occurrences import ExtremesOf, When
from core.near_names import did_you_mean
from core.quantities import Tolerance, Uncertainty
from core.systems.methods import Method
from service.requests.figures import SensitivitiesQuestion
from service.requests.written_values import WhenQuestion, read_by_core
from service.schemas import ROUND, Request, Rounding, Times

MOST_OUTPUTS = 30
"""Outputs of one question, among them searches along the motion."""

SEARCHES = ("when", "extremes", "thresholds")
"""The key of each search."""


def _body_form() -> type[Request]:
    hints = get_type_hints(DescribedBody)
    own: dict[str, Any] = {
        entry.name: (read_by_core(hints[entry.name]), ... if entry.default is MISSING and entry.name == "at" else None)
        for entry in fields(DescribedBody)
    }
    own["body"] = (Body | None, None)
    form: type[Request] = create_model("SceneBody", __base__=Request, __doc__=DescribedBody.__doc__, **own)
    return form


def _connection_form() -> type[Request]:
    """Return the form with the fields of all kinds; core checks those of each."""
    kinds: dict[str, dict[str, Any]] = {}
    for kind, cls in KINDS.items():
        written = get_type_hints(cls)
        for entry in fields(cls):
            # A word of Python's has a sign behind it as the name of a field.
            name, hint = entry.name.rstrip("_"), written[entry.name]
            kinds.setdefault(name, {})[kind] = hint
    own: dict[str, Any] = {
        name: (read_by_core(*hints.values()), Field(default=None, description=f"For {', '.join(hints)}."))
        for name, hints in kinds.items()
    }
    meaning = " ".join(f"{kind}: {' '.join((cls.__doc__ or '').split())}" for kind, cls in KINDS.items())
    own["kind"] = (Literal.__getitem__(tuple(KINDS)), Field(description=meaning))
    docs = Connection.__doc__
    form: type[Request] = create_model("SceneConnection", __base__=Request, __doc__=docs, **own)
    return form


SceneBody: Any = _body_form()
SceneConnection: Any = _connection_form()
Gravity: Any = read_by_core(get_type_hints(Scene)["gravity"])
WrittenNumber: Any = read_by_core(Number)
NamedNumbers: Any = read_by_core(get_type_hints(Scene)["let"])
ConnectionReadByCore: Any = read_by_core(SceneConnection)
Assemble: Any = read_by_core(get_type_hints(Scene)["assemble"])
SCENE_FIELDS = tuple(entry.name for entry in fields(Scene))


class ThresholdsQuestion(Request):
    """In which range of a number the scene stays at rest."""

    vary: str = Field(
        max_length=300, description="JSON pointer of the number in the scene: /connections/0/friction, /let/slope."
    )
    between: list[WrittenNumber] = Field(
        min_length=2,
        max_length=2,
        description="Bounds up to which is looked, with the written value between them; numbers as in the description.",
    )


class SearchOutput(Request):
    """A search between the start and the latest of the times, or of a number: one of its fields is given."""

    when: WhenQuestion | None = Field(default=None, description="At which times a quantity takes a value.")
    extremes: str | None = Field(
        default=None, max_length=100, description="Of which quantity the least and the largest value are wanted."
    )
    sensitivities: SensitivitiesQuestion | None = Field(
        default=None, description="Of which figures of the answer the derivatives by which numbers are wanted."
    )


RequestedOutput = Annotated[Output | SearchOutput, SkipValidation()]
"""What may be requested; core says what is wrong with it, with one place for each fault."""


class SceneDescription(Request):
    """Bodies, and what connects them."""

    gravity: Gravity = Field(
        default=None, description="Acceleration of free fall (m/s^2), of two or three components; none if left out."
    )
    bodies: dict[str, SceneBody] = Field(
        description=f"By name, at most {MOST_BODIES}. Names are letters, digits, - and _."
    )
    connections: list[ConnectionReadByCore] = Field(default=[], description=f"At most {MOST_CONNECTIONS}.")
    let: NamedNumbers = Field(
        default={},
        description="Named constants for formulas; each may use those before it. Also formulas of the motion, which "
        "mean what they say where a force uses them, and functions by points, {points, interpolation, outside}.",
    )
    numbers: Literal["decimals", "doubles"] = Field(
        default="decimals", description="Whether 0.1 is the decimal or the double nearest to it."
    )
    assemble: Assemble = Field(
        default=None,
        description="nearest: places and velocities are a sketch, in place of which the nearest are taken that satisfy "
        'the connections; the answer has them in `assembly`. {"nearest": [names]} moves these bodies alone.',
    )

    impacts: ImpactLaw = Field(
        default="newton",
        description="Law of the impacts of contacts that name none of their own. newton: restitution by the rates "
        "before and after. poisson, stronge: the slip is followed through the impulse, and restitution is by the "
        "impulse, or by the work along the gap.",
    )
    simultaneous: Simultaneous = Field(
        default="undecided",
        description="How contacts act that take impulses at one time. together: all at once. in order: one after "
        "another, by their order or as they are listed, the first of those that approach. undecided: the motion ends "
        "there with simultaneous-impacts, unless all orders have one outcome.",
    )

    attitudes: bool = Field(
        default=False,
        description="Whether the whole attitude of every rigid body in space is answered, and its angular velocity. "
        "Else a body with two equal moments that only its axis is seen of has the column `axis` in place of these, "
        "and a ball that only rolls has its angular velocity in space: their models are smaller.",
    )

    def with_digits(self, document: Any) -> Self:
        """Return the question with the numbers of its scene as they are written."""
        if self.numbers == "doubles":
            return self
        bodies = {
            name: form.model_copy(
                update={key: value for key, value in document["bodies"][name].items() if key != "body"}
            )
            for name, form in self.bodies.items()
        }
        written = ("gravity", "connections", "let", "outputs")
        read = {name: document[name] for name in written if document.get(name) is not None}
        return self.model_copy(update={**read, "bodies": bodies})

    def unit_of(self, path: Path) -> str | None:
        """Return the unit of a number as it is written; see `Request.unit_of`."""
        return super().unit_of(path) or (unit_at(self.scene(), path) if path[0] in SCENE_FIELDS else None)

    def description(self) -> dict[str, Any]:
        """Return the description of the scene, as it is written."""
        description = {name: getattr(self, name) for name in SCENE_FIELDS if name in self.model_fields_set}
        description["bodies"] = {
            name: {field: getattr(form, field) for field in form.model_fields_set} for name, form in self.bodies.items()
        }
        return description

    def scene(self) -> Scene:
        """Return the scene, or raise `InvalidParameter`."""
        return scene_from(self.description())


class DescribedSceneRequest(SceneDescription):
    """Bodies, what connects them, and what is requested of them."""

    times: Times | None = Field(
        default=None,
        description="Measured from the given state, of either sign, in any order; none: no motion. Doubles, also "
        "where numbers of the description are decimals: 1000.1 stands for the double nearest to it, in the answer too.",
    )
    accuracy: Tolerance = Field(
        default=1e-9,
        description="Largest tolerated error of any column, relative to the largest value in columns of its unit.",
    )
    method: Method | None = Field(
        default=None,
        description="Computes the motion in place of the smallest model, and is answered whatever its error. The whole "
        "scene is run as one system, and put back onto its connections after every step; by lsoda and radau, its "
        "samples alone. An evaluation counts as 4 + n^3/200 of the evaluations that are allowed, n being the number of "
        "coordinates and equations of constraint that remain.",
    )
    input_uncertainty: Uncertainty | None = Field(
        default=None,
        description="Relative uncertainty of every number of the description, 1.1e-16 for numbers known as doubles. "
        "If it is given, accuracy.inherited says what it does to the samples. Formulas are exact.",
    )
    round: Rounding | None = ROUND
    outputs: list[RequestedOutput] | None = Field(
        default=None,
        min_length=1,
        max_length=MOST_OUTPUTS,
        description=f"What to answer; default: {', '.join(DEFAULT_OUTPUTS)}. work-in-time: what gravity, springs, "
        "dampers, motors and forces have done; paths-in-time: lengths of paths; momenta-in-time: momenta and, about "
        "the origin, angular momenta; equations: the equations of motion in writing.",
    )

    def requested(self) -> tuple[Output | When | ExtremesOf | RestOf, ...] | None:
        """Return the outputs as core takes them, None for those that it chooses."""
        if self.outputs is None:
            return None
        return tuple(_searched(output, ("outputs", i)) for i, output in enumerate(self.outputs))


def _searched(output: Any, path: Path) -> Any:
    """Return an output as core takes it: a name, or a search along the motion."""
    if not isinstance(output, Mapping):
        return output
    if set(output) == {"extremes"}:
        return ExtremesOf(output["extremes"])
    if set(output) == {"thresholds"}:
        return RestOf(**_fields(output["thresholds"], ThresholdsQuestion, (*path, "thresholds")))
    if set(output) != {"when"}:
        raise InvalidParameter(
            path,
            'be a name, {"when": {"quantity", "equals", "nth"}}, {"extremes": quantity} or '
            '{"thresholds": {"vary", "between"}}',
            remedy=next((near for key in output if (near := did_you_mean(key, SEARCHES))), None),
        )
    return When(**_fields(output["when"], WhenQuestion, (*path, "when")))


def _fields(given: Any, form: type[Request], path: Path) -> dict[str, Any]:
    """Return the fields of a search, whose values core looks at."""
    if not isinstance(given, Mapping):
        raise InvalidParameter(path, "be an object")
    for key in given:
        if key not in form.model_fields:
            raise unknown_field(key, form.model_fields, path)
    for key, entry in form.model_fields.items():
        if key not in given and entry.is_required():
            raise InvalidParameter((*path, key), "be given")
    return dict(given)
