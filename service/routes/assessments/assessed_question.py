"""The question that is assessed: its answer, computed once, and the references that are read off it."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import is_dataclass
from functools import cached_property
from random import Random
from typing import Any, NamedTuple

import numpy as np

from core.assessment.compare import Form, Reference
from core.assessment.propagation import Propagation, changed, numbers_of, relative_uncertainties
from core.errors import InvalidParameter, MechanicsError, Path
from core.rotation.torque_free import TorqueFree
from core.systems.budget import Budget
from core.systems.system import Floats
from core.work import spend
from service.problems import Refusal
from service.responses.json_rows import written
from service.routes.assessments.declared_units import has_field, numbers_within, outputs_of, unit_at
from service.routes.bodies import properties_of
from service.routing import Answer, PostRoute

ASKING = 60
"""Work (`core.work`) of asking a question again, beside what the question counts itself."""

SENSITIVE: Mapping[str, tuple[str, float]] = {"ellipticity": ("a/c - 1", 1.0)}
"""Figures near a number that says nothing: by their names, the figure in which errors show, and that number."""

TIMELESS = ("/v1/rotation/trajectory",)
"""Questions of which all figures but the columns are the same whatever times are asked for."""

MEASURED = "measured"
"""What a precession is answered with beside its figures if a measurement is requested."""

COLUMNS = ("angular_velocity", "attitude")

CONDITIONING, ROUNDING = 8.0, 2e-15
"""Numerical error of figures whose answer states none: so many times the effect of half a unit in the last place of
every input, and this share of the figure (docs/accuracy.md)."""


VARIATIONS = 20
"""Changed questions at which a formula has to agree, beside the question itself."""


class Variation(NamedTuple):
    """Parameters by name, and the figure that belongs to them."""

    parameters: Mapping[str, float]
    figure: float


class AssessedQuestion:
    """A question to a route, which is asked as often as references, uncertainties and mistakes need.

    Parameters
    ----------
    route : PostRoute
    read : callable
        From JSON bytes to the question; raises `Refusal`.
    request : Any
        As it was sent.
    budget : Budget
    uncertainty : float, mapping of path to float, or None
        Relative, of the numbers of the request.
    """

    def __init__(
        self,
        route: PostRoute,
        read: Callable[[bytes], Any],
        request: Any,
        budget: Budget,
        uncertainty: float | Mapping[Path, float] | None,
    ) -> None:
        self._route, self._read, self._budget = route, read, budget
        if isinstance(uncertainty, float) and has_field(route.question, "input_uncertainty"):
            request = {"input_uncertainty": uncertainty, **request}
        self.request, self._uncertainty = request, uncertainty
        self._answers: dict[str, Answer | None] = {}
        self._references: dict[Path, Reference | None] = {}

    @property
    def path(self) -> str:
        """Of the endpoint."""
        return self._route.path

    @cached_property
    def answer(self) -> Answer:
        """The answer; raises what the question is refused with."""
        spend(ASKING)
        return self._route.handle(self._read(json.dumps(self.request).encode()), self._budget)

    def evaluate(self, request: Any) -> Callable[[Path], Any]:
        """Ask a changed question; the result finds the value at a path of its answer, None where there is none."""

        def find(path: Path) -> Any:
            answer = self._ask(request, path[0])
            return None if answer is None else value_at(answer, path)

        return find

    def reference(self, path: Path) -> Reference | None:
        """Return the reference at a path of the answer, None if nothing that can be compared stands there."""
        if path not in self._references:
            self._references[path] = self._made(path)
        return self._references[path]

    def samples(self, path: Path, times: Floats) -> Reference | None:
        """Return a column of samples at other times, None if the path leads to no column.

        Raises
        ------
        MechanicsError, Refusal
            If the question is refused with these times.
        """
        request = self.request | {"times": times.tolist()}
        if path[0] in self._outputs:
            request["outputs"] = [path[0]]
        spend(ASKING)
        answer = self._route.handle(self._read(json.dumps(request).encode()), self._budget)
        value = value_at(answer, path)
        if not isinstance(value, np.ndarray) or len(value) != len(times):
            return None
        return self._stated(path, value, "samples", answer)

    def parameters(self, names: Mapping[str, Path] | None) -> dict[str, tuple[Path, float, str]]:
        """Return path, value and unit of the numbers of the request that formulas may name.

        Parameters
        ----------
        names : mapping of str to path, or None
            By default a number is named by its field, one of several with its number: gravity, masses_1.
        """
        numbers = dict(numbers_of(self.request, zeros=True))
        chosen = names if names is not None else {_name(path): path for path in numbers}
        return {
            name: (path, numbers[path], unit_at(self._route.question, path) or "1") for name, path in chosen.items()
        }

    def variations(self, path: Path, parameters: Mapping[str, tuple[Path, float, str]]) -> list[Variation]:
        """Return the question's parameters and the figure at a path, and those of seeded variations of it."""
        chance, found = Random(0), list[Variation]()
        for k in range(1 + 3 * VARIATIONS):
            # Numbers that have to be equal are, in the last third.
            shares: dict[tuple[Path, float], float] = {}
            values = {}
            for name, (place, value, _) in parameters.items():
                group = (place[:-1], value) if k > 2 * VARIATIONS else (place, value)
                share = shares.setdefault(group, chance.uniform(0.75, 1.25))
                values[name] = value if k == 0 else value * share
            request = changed(self.request, {parameters[name][0]: value for name, value in values.items()})
            figure = self.evaluate(request)(path)
            if type(figure) is float:
                found.append(Variation(values, figure))
            if len(found) > VARIATIONS:
                break
        return found

    def rotation(self) -> TorqueFree | None:
        """Return the free rotation that the question is about, None for questions about anything else."""
        if self.path not in TIMELESS:
            return None
        question = self._read(json.dumps(self.request).encode())
        return TorqueFree(properties_of(question.body), np.array(question.angular_velocity))

    def _ask(self, request: Any, output: str | int) -> Answer | None:
        changes: dict[str, Any] = {}
        if output in self._outputs and "outputs" not in request:
            changes["outputs"] = [output]
        if self.path in TIMELESS and output not in (*COLUMNS, "time"):
            changes["times"] = [0.0]
        if request.get("measure") is not None and output != MEASURED:
            # No other figure depends on the measurement, which runs an integrator.
            changes["measure"] = None
        document = json.dumps(request | changes)
        if document not in self._answers:
            spend(ASKING)
            try:
                self._answers[document] = self._route.handle(self._read(document.encode()), self._budget)
            except (MechanicsError, Refusal):
                self._answers[document] = None
        return self._answers[document]

    @cached_property
    def _outputs(self) -> frozenset[str]:
        return outputs_of(self._route.question)

    @cached_property
    def _propagation(self) -> Propagation:
        return Propagation(self.request, relative_uncertainties(self.request, self._uncertainty), self.evaluate)

    @cached_property
    def _scales(self) -> Mapping[str, float]:
        """Largest magnitude of the numbers in each unit, of the answer and, where they are all 0, of the request."""
        found: dict[str, float] = {}
        for model, document in (
            (self._route.answer, json.loads(written(self.answer))),
            (self._route.question, self.request),
        ):
            here: dict[str, float] = {}
            for unit, magnitude in numbers_within(model, document):
                here[unit] = max(here.get(unit, 0.0), magnitude)
            found = here | {unit: magnitude for unit, magnitude in found.items() if magnitude > 0.0}
        return found

    def _made(self, path: Path) -> Reference | None:
        value = value_at(self.answer, path)
        if value is None:
            return Reference(None, form="none") if _stands(self.answer, path) else None
        form = _form(path, value, self._unit(path))
        return None if form is None else self._stated(path, value, form, self.answer)

    def _unit(self, path: Path) -> str:
        beside = value_at(self.answer, (*path[:-1], "unit")) if len(path) > 1 else None
        return beside if isinstance(beside, str) else unit_at(self._route.answer, path) or "1"

    def _stated(self, path: Path, value: Any, form: Form, answer: Answer) -> Reference:
        if form == "choice":
            return Reference(value, form=form)
        unit = self._unit(path)
        size = float(np.abs(value).max(initial=0.0))
        # Of a figure that is 0 the scale is that of others in its unit.
        scale = 1.0 if form in ("direction", "axes", "attitude") else size or self._scales.get(unit) or 1.0
        sensitive, offset = SENSITIVE.get(str(path[-1]), (None, 0.0))
        groups = _groups(value_at(answer, (*path[:-1], "moments"))) if form == "axes" else ()
        bare = Reference(value, unit, form, scale, groups=groups, sensitive=sensitive, offset=offset)
        accuracy: Any = answer.get("accuracy")
        if path[0] in ("time", "times"):
            return bare
        if self.path in TIMELESS and path[0] in COLUMNS:
            turned = path[0] == "attitude"
            norm = 1.0 if turned else accuracy["largest_norm"] or size
            names = ("attitude_error", "attitude_inherited") if turned else ("error", "inherited")
            error, inherited = (accuracy[name] for name in names)
            inherited = None if inherited is None else inherited * norm
            if self._method_named:
                # What is right is then what the method gives, whatever its error.
                return _with(bare, scale, ROUNDING * norm, OF_METHOD, inherited)
            return _with(
                bare, max(norm, scale) if form == "samples" else scale, error * norm, accuracy["how"], inherited
            )
        inherited = self._propagation.of(path, bare)
        if accuracy is not None and self.path not in TIMELESS:
            return _with(bare, scale, _inside(accuracy, "error") * size, _inside(accuracy, "how"), inherited)
        half = inherited if self._uncertainty is None else self._in_half_ulps.of(path, bare)
        if half is None:
            return _with(bare, scale, ROUNDING * size, ESTIMATE, inherited)
        return _with(bare, scale, CONDITIONING * half + ROUNDING * size, ESTIMATE, inherited)

    @property
    def _method_named(self) -> bool:
        method = self.request.get("method")
        return isinstance(method, dict) and method.get("kind") != "closed-form"

    @cached_property
    def _in_half_ulps(self) -> Propagation:
        return Propagation(self.request, relative_uncertainties(self.request, None), self.evaluate)


ESTIMATE = "estimate (conditioning)"
OF_METHOD = "estimate (rounding of the method that the question names)"


def _with(bare: Reference, scale: float, error: float, how: str, inherited: float | None) -> Reference:
    return Reference(
        bare.value, bare.unit, bare.form, scale, error, how, inherited, bare.groups, bare.offset, bare.sensitive
    )


def value_at(answer: Any, path: Path) -> Any:
    """Return the figure at a path of an answer: a number, a string, true or false, an array of finite numbers, or None.

    Objects, and arrays that hold anything else, are no figures, and None too.
    """
    found = answer
    for step in path:
        found = _inside(found, step)
        if found is None:
            return None
    if isinstance(found, (np.generic, bool, int, float, str)):
        plain = found.item() if isinstance(found, np.generic) else found
        return float(plain) if type(plain) is int else plain
    if isinstance(found, (list, tuple, np.ndarray)):
        try:
            array = np.array(found, dtype=np.float64)
        except (TypeError, ValueError):
            return None
        return array if array.size and array.ndim <= 2 and np.isfinite(array).all() else None
    return None


def _inside(found: Any, step: str | int) -> Any:
    if isinstance(found, Mapping):
        return found.get(str(step))
    if isinstance(step, str):
        named = is_dataclass(found) or hasattr(found, "_fields")
        return getattr(found, step, None) if named and not step.startswith("_") else None
    if isinstance(found, (list, tuple, np.ndarray)) and not hasattr(found, "_fields"):
        return found[step] if step < len(found) else None
    return None


def _stands(answer: Any, path: Path) -> bool:
    """Return whether the field at a path exists and is null."""
    outer = answer
    for step in path[:-1]:
        outer = _inside(outer, step)
    last = path[-1]
    if isinstance(outer, Mapping):
        return last in outer and outer[last] is None
    if isinstance(outer, (list, tuple)):
        return isinstance(last, int) and last < len(outer) and outer[last] is None
    return isinstance(last, str) and not last.startswith("_") and getattr(outer, last, 0) is None


def _form(path: Path, value: Any, unit: str) -> Form | None:
    if isinstance(value, (bool, str)):
        return "choice"
    if isinstance(value, float):
        return "angle" if unit == "rad" else "number"
    name = next((step for step in reversed(path) if isinstance(step, str)), "")
    if name == "attitude" and value.shape == (4,):
        return "attitude"
    if name in ("axis", "axes") and value.shape == (3,) and name == "axis":
        return "direction"
    if name == "axes" and value.shape == (3, 3):
        return "axes"
    if name == "eigenvalues":
        return "set"
    if name in COLUMNS and value.ndim == 2:
        return "samples"
    return "vector" if value.ndim == 1 else "matrix"


def _name(path: Path) -> str:
    """Return the default name of a parameter: its field, and its place among several, counted from 1."""
    fields = [step for step in path if isinstance(step, str)]
    return "_".join([fields[-1], *(str(step + 1) for step in path if isinstance(step, int))])


def _groups(moments: Any) -> tuple[tuple[int, ...], ...]:
    """Return the principal axes in groups of equal moments (to 1e-9); neighbours, as moments ascend."""
    if moments is None:
        return ()
    groups: list[list[int]] = [[0]]
    for k in range(1, len(moments)):
        if abs(moments[k] - moments[k - 1]) <= 1e-9 * abs(moments[-1]):
            groups[-1].append(k)
        else:
            groups.append([k])
    return tuple(tuple(group) for group in groups)


def steps_of(pointer: str) -> Path:
    """Return the steps of an RFC 6901 JSON pointer into an answer.

    Raises
    ------
    InvalidParameter
        If it is none, or leads to the whole document.
    """
    if not pointer.startswith("/"):
        raise InvalidParameter((), "be a JSON pointer into the answer", remedy='such as "/flip_interval"')
    return tuple(_steps(pointer))


def _steps(pointer: str) -> Iterator[str | int]:
    for step in pointer[1:].split("/"):
        plain = step.replace("~1", "/").replace("~0", "~")
        yield int(plain) if plain.isascii() and plain.isdigit() and len(plain) < 10 else plain
