"""The question that is assessed: its answer, computed once, and the references that are read off it."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import cache, cached_property
from itertools import count
from typing import Any

import numpy as np

from core.arrays import Floats
from core.assessment.compare import Form, Reference, distance
from core.assessment.curves import dense
from core.assessment.figures import (
    DESCRIBED,
    equal_moments,
    figures_within,
    form_of,
    inside,
    is_null,
    names_of,
    value_at,
)
from core.assessment.formula_variations import VARIATIONS, Parameters, Variation, Varied, drawn, tied_numbers
from core.assessment.judged_formulas import ENOUGH
from core.assessment.propagation import Propagation, numbers_of, relative_uncertainties
from core.assessment.question_source import Source
from core.assessment.stated_bounds import body_axis_of, bound_beside, distance_of
from core.assessment.stated_units import unit_of
from core.errors import InvalidParameter, MechanicsError, Path
from core.rotation.torque_free import TorqueFree
from core.work import spend

ANSWERING = 60
"""Work (`core.work`) of asking a question again, beside what the question counts itself."""

SENSITIVE: Mapping[str, tuple[str, float]] = {"ellipticity": ("a/c - 1", 1.0)}
"""Figures near a number that says nothing: by their names, the figure in which errors show, and that number."""

TRAJECTORY = "rotation/trajectory"
"""The question of which all figures but the columns are the same whatever times it has."""

MEASURED = "measured"
"""What a precession is answered with beside its figures if a measurement is requested."""

COLUMNS = ("angular_velocity", "attitude")

IN_TIME = "-in-time"
"""What outputs end with that are further columns of a trajectory."""

ULP = 2.0**-52

CONDITIONING, ROUNDING = 8.0, 2e-15
"""Numerical error of figures whose answer states none: so many times the effect of half a unit in the last place of
every input, and this share of the figure (docs/accuracy.md)."""

MOST_CERTIFIED = 20
"""Times of a request that is answered in proven digits, too."""

CERTIFIED = "ball arithmetic"
STATED = "bound that the answer states"
BETWEEN_POINTS = "measured (curve through its points)"
ESTIMATE = "estimate (conditioning)"
UNKNOWN = "unknown"
"""Unit of a number that none is declared for: nothing is said of the dimensions of formulas with it."""

OF_METHOD = "estimate (rounding of the method that the question names)"


class GradedQuestion:
    """A question, answered as often as references, uncertainties and mistakes need.

    Parameters
    ----------
    source : Source
    request : Any
        As it was sent.
    uncertainty : float, mapping of path to float, or None
        Relative, of the numbers of the request.
    """

    def __init__(self, source: Source, request: Any, uncertainty: float | Mapping[Path, float] | None) -> None:
        if isinstance(uncertainty, float) and source.takes("input_uncertainty"):
            request = {"input_uncertainty": uncertainty, **request}
        self._source, self.request, self._uncertainty = source, request, uncertainty
        self._answers: dict[str, Mapping[str, Any] | None] = {}
        self._references: dict[Path, Reference | None] = {}
        self._variations: dict[Any, tuple[list[Varied], Iterator[Varied]]] = {}

    @property
    def subject(self) -> str:
        """Last steps of the endpoint's path."""
        return self._source.subject

    @cached_property
    def answer(self) -> Mapping[str, Any]:
        """The answer; raises what the question is refused with."""
        return self._answered(self.request)

    def evaluate(self, request: Any) -> Callable[[Path], Any]:
        """Ask a changed question; the result finds the value at a path of its answer, None where there is none."""

        # A request may have thousands of numbers, and an answer hundreds of figures.
        @cache
        def answered(output: str | int) -> Mapping[str, Any] | None:
            return self._ask(request, output)

        def find(path: Path) -> Any:
            answer = answered(path[0])
            return None if answer is None else value_at(answer, path)

        return find

    def reference(self, path: Path) -> Reference | None:
        """Return the reference at a path of the answer, None if nothing that can be compared stands there."""
        if path not in self._references:
            self._references[path] = self._made(path)
        return self._references[path]

    def unit(self, path: Path) -> str:
        """Return the unit of the figure at a path of the answer, "1" where none is stated."""
        return self._unit(path, self.answer)

    def figures_in(self, path: Path) -> list[str]:
        """Return the fields of the object at a path of the answer that are figures, null ones last."""
        return figures_within(self.answer, path)

    def samples(self, path: Path, times: Floats) -> Reference | None:
        """Return a column of samples at other times, None if the path leads to no column.

        Raises
        ------
        MechanicsError
            If the question is refused with these times.
        """
        request = self.request | {"times": times.tolist()}
        own = [output for output in request.get("outputs", ()) if isinstance(output, str)]
        in_time = sorted(output for output in self._source.outputs if output.endswith(IN_TIME))
        # Columns beside those of the question's own are only answered where they are requested.
        for outputs in ([path[0], *own], [path[0], *in_time])[: 2 if in_time else 1]:
            if path[0] in self._source.outputs:
                request["outputs"] = [*dict.fromkeys(outputs)]
            sampled = GradedQuestion(self._source, request, self._uncertainty)
            value = value_at(sampled.answer, path)
            if isinstance(value, np.ndarray) and len(value) == len(times):
                return sampled._stated(path, value, "samples", sampled.answer)
        return None

    def parameters(self, names: Mapping[str, Path] | None) -> dict[str, tuple[Path, float, str]]:
        """Return path, value and unit of the numbers of the request that formulas may name.

        Parameters
        ----------
        names : mapping of str to path, or None
            By default those of `core.assessment.figures.names_of`.
        """
        numbers = dict(numbers_of(self.request, zeros=True))
        chosen = names if names is not None else names_of(numbers)
        unit_of = self._source.units_of_request(self.request)
        return {name: (path, numbers[path], unit_of(path) or UNKNOWN) for name, path in chosen.items()}

    def variations(self, path: Path, parameters: Parameters) -> list[Variation]:
        """Return the question's parameters and the figure at a path, and those of seeded variations of it."""
        found = self._varied(path, parameters, ())
        if len(found) > ENOUGH:
            return found
        tied = tied_numbers(self.request, path, self.evaluate)
        return [*found, *self._varied(path, parameters, tied)[1:]][: 1 + VARIATIONS] if tied else found

    def _varied(self, path: Path, parameters: Parameters, tied: tuple[Path, ...]) -> list[Variation]:
        """Return variations that have a figure at a path; they are drawn once for all figures."""
        key = tuple(parameters.items()), tied
        if key not in self._variations:
            self._variations[key] = [], drawn(self.request, parameters, tied, self.evaluate)
        known, further = self._variations[key]
        found = list[Variation]()
        for k in count():
            if k == len(known):
                one = next(further, None)
                if one is None:
                    break
                known.append(one)
            values, find = known[k]
            figure = find(path)
            if type(figure) is float:
                found.append(Variation(values, figure))
            if len(found) > VARIATIONS:
                break
        return found

    def rotation(self) -> TorqueFree | None:
        """Return the free rotation that the question is about, None for questions about anything else."""
        return self._source.rotation(self.request) if self.subject == TRAJECTORY else None

    def _answered(self, request: Any) -> Mapping[str, Any]:
        spend(ANSWERING)
        return self._source.answer(json.dumps(request))

    def _ask(self, request: Any, output: str | int) -> Mapping[str, Any] | None:
        changes: dict[str, Any] = {}
        if output in self._source.outputs and "outputs" not in request:
            changes["outputs"] = [output]
        if self.subject == TRAJECTORY and output not in (*COLUMNS, "time"):
            changes["times"] = [0.0]
        if request.get("measure") is not None and output != MEASURED:
            # No other figure depends on the measurement, which runs an integrator.
            changes["measure"] = None
        document = json.dumps(request | changes)
        if document not in self._answers:
            spend(ANSWERING)
            try:
                self._answers[document] = self._source.answer(document)
            except MechanicsError:
                self._answers[document] = None
        return self._answers[document]

    @cached_property
    def _propagation(self) -> Propagation:
        return self._propagated(self._uncertainty)

    @cached_property
    def _in_half_ulps(self) -> Propagation:
        return self._propagated(None)

    def _propagated(self, given: float | Mapping[Path, float] | None) -> Propagation:
        uncertainties = relative_uncertainties(self.request, given)
        return Propagation(self.request, uncertainties, self.evaluate, connected=self.subject == DESCRIBED)

    @cached_property
    def _scales(self) -> Mapping[str, float]:
        return self._source.scales(self.answer, self.request)

    def _made(self, path: Path) -> Reference | None:
        value = value_at(self.answer, path)
        if value is None:
            return Reference(None, self._unit(path, self.answer), "none") if is_null(self.answer, path) else None
        return self._stated(path, value, form_of(path, value, self._unit(path, self.answer)), self.answer)

    def _unit(self, path: Path, answer: Mapping[str, Any]) -> str:
        return unit_of(answer, path, self._source.unit_of_answer)

    def _stated(self, path: Path, value: Any, form: Form, answer: Mapping[str, Any]) -> Reference:
        if form == "choice":
            return Reference(value, form=form)
        unit = self._unit(path, answer)
        size = float(np.abs(value).max(initial=0.0))
        # Of a figure that is 0 the scale is that of others in its unit.
        scale = 1.0 if form in ("direction", "axes", "attitude") else size or self._scales.get(unit) or 1.0
        sensitive, offset = SENSITIVE.get(str(path[-1]), (None, 0.0))
        groups = equal_moments(value_at(answer, (*path[:-1], "moments"))) if form == "axes" else ()
        bare = Reference(value, unit, form, scale, groups=groups, sensitive=sensitive, offset=offset)
        if path[0] in ("time", "times"):
            return bare
        accuracy: Any = answer.get("accuracy")
        if self.subject == TRAJECTORY and path[0] in COLUMNS:
            return self._sampled(bare, path[0], size, accuracy)
        axis = body_axis_of(answer, path)
        inherited, bare = self._propagation.of(path, bare), replace(bare, body_axis=axis)
        beside = bound_beside(answer, path)
        stated = None if beside is None else replace(bare, error=distance_of(bare, beside), inherited=inherited)
        if accuracy is not None and self.subject != TRAJECTORY:
            how = inside(accuracy, "how")
            if stated is not None:
                return replace(stated, how=how if form == "samples" else STATED)
            return replace(bare, error=inside(accuracy, "error") * size, how=how, inherited=inherited)
        if form == "curve":
            return replace(bare, error=dense(value)[1], how=BETWEEN_POINTS, inherited=inherited)
        if self._errors is not None:
            errors, how = self._errors
            bound = value_at(errors, path)
            if bound is not None:
                return replace(bare, error=distance_of(bare, bound), how=how, inherited=inherited)
        proven = self._proven(path, bare)
        if proven is not None:
            return replace(bare, error=proven, how=CERTIFIED, inherited=inherited)
        if stated is not None:
            return replace(stated, how=STATED)
        half = inherited if self._uncertainty is None else self._in_half_ulps.of(path, bare)
        return replace(bare, error=CONDITIONING * (half or 0.0) + ROUNDING * size, how=ESTIMATE, inherited=inherited)

    @cached_property
    def _errors(self) -> tuple[Mapping[str, Any], str] | None:
        return self._source.errors(self.request)

    @cached_property
    def _certified(self) -> Mapping[str, Any] | None:
        request = self.request | ({"times": [0.0]} if self.subject == TRAJECTORY else {})
        times = request.get("times", ())
        if (times["count"] if isinstance(times, dict) else len(times)) > MOST_CERTIFIED:
            return None
        return self._source.certified(request)

    def _proven(self, path: Path, bare: Reference) -> float | None:
        """Return how far the figure is from its proven digits, with what comparing them rounds; None without any."""
        found = None if self._certified is None else value_at(self._certified, path)
        if found is None:
            return None
        number = bare.form in ("number", "angle")
        size = 1.0 if bare.form in ("direction", "axes", "attitude") else bare.magnitude
        try:
            return distance(bare, float(found) if number else found) + (ULP if number else ROUNDING) * size
        except (InvalidParameter, ValueError):
            return None

    def _sampled(self, bare: Reference, column: str | int, size: float, accuracy: Any) -> Reference:
        """Return a column of a trajectory, or a part of one, with the error that the answer states."""
        turned = column == "attitude"
        norm = 1.0 if turned else accuracy["largest_norm"] or size
        names = ("attitude_error", "attitude_inherited") if turned else ("error", "inherited")
        error, inherited = (accuracy[name] for name in names)
        inherited = None if inherited is None else inherited * norm
        method = self.request.get("method")
        if isinstance(method, dict) and method.get("kind") != "closed-form":
            # What is right is then what the method gives, whatever its error.
            return replace(bare, error=ROUNDING * norm, how=OF_METHOD, inherited=inherited)
        scale = max(norm, bare.scale) if bare.form == "samples" else bare.scale
        return replace(bare, scale=scale, error=error * norm, how=accuracy["how"], inherited=inherited)
