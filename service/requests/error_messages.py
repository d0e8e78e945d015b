"""What the validator finds wrong, in words for who sent it: where, which rule, what would mend it.

The validator's locations name members of unions as if they were steps; left out, they are JSON pointers into what the
client sent. Which names and kinds there would have been is read off its schema (`service.requests.layout`).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from typing import Any

from core.errors import InvalidParameter, pointer_of
from core.near_names import plain
from core.quantities import RADIANS
from service.problems import KNOWN, MOST_FAULTS, Fault, code_of
from service.requests.document_limits import LONGEST_KEY_SHOWN
from service.requests.layout import ARRAY, OBJECT, Layout, Step
from service.requests.suggestions import FORCES, STEPS, count_in_place_of_step, nearest

LOOKED_AT = 3 * MOST_FAULTS
"""Findings among which the most useful ones are looked for."""

_RULES: Mapping[str, str] = {
    "missing": "is required",
    "extra_forbidden": "is not known here",
    "unexpected_keyword_argument": "is not known here",
    "finite_number": "must be finite",
    "float_type": "must be a number",
    "int_type": "must be an integer",
    "int_parsing_size": "must be an integer of moderate size",
    "int_from_float": "must be an integer",
    "bool_type": "must be true or false",
    "string_type": "must be a string",
    "model_type": "must be an object",
    "dataclass_type": "must be an object",
    "dict_type": "must be an object",
    "list_type": "must be an array",
    "tuple_type": "must be an array",
    "greater_than": "must be greater than {gt:g}",
    "greater_than_equal": "must be at least {ge:g}",
    "less_than": "must be less than {lt:g}",
    "less_than_equal": "must be at most {le:g}",
    "literal_error": "must be {expected}",
    "neither": "must be an object or an array",
    "union_tag_invalid": "must be one of {expected_tags}",
    "union_tag_not_found": "must have the key {discriminator}",
    "string_too_long": "must have at most {max_length} characters",
}
_REMEDIES: Mapping[str, str] = {
    "float_type": "write a JSON number: no quotes, no true, false or null; /v1/certified takes decimal strings",
    "int_type": 'write a JSON integer: 10, not 10.0, 1e1 or "10"',
    "int_from_float": 'write a JSON integer: 10, not 10.0, 1e1 or "10"',
    "finite_number": "NaN, infinities and numbers beyond 1.8e308 are not read",
}
_SPANNED = "give numbers in an array, or start, stop and count in an object"
_KEYS: Mapping[str, str] = {
    "bodies": 'write {"name": {...}}: its keys are the names of the bodies',
    "places": 'write {"name": [...]}: its keys are the names of the places',
    "let": 'write {"name": ...}: its keys are the names of the numbers',
}
"""Remedies of objects whose keys the client chooses."""
_TYPES = ("model_type", "dataclass_type", "list_type", "tuple_type")
_OBJECTS = ("model_type", "dataclass_type", "dict_type")
_UNKNOWN = ("extra_forbidden", "unexpected_keyword_argument")
_BOUNDS = ("greater_than", "greater_than_equal", "less_than", "less_than_equal")
_MISSING, _NOT_KNOWN = "is required", "is not known here"
_MEANT = "did you mean "
_SPAN = frozenset({"start", "stop", "count"})
_NOT_FREE = f"{_NOT_KNOWN}: only torque-free motion is answered"
_FREE_ONLY = "leave it out; motion under forces is a scene: POST /v1/scenes"


class Wording:
    """Words what is wrong with documents.

    Parameters
    ----------
    layout : Layout
        What the validator's schema says of the documents that it admits.
    elsewhere : mapping of str to str
        Keys of the document that only another route's question has, each with what would mend it.
    """

    def __init__(self, layout: Layout, elsewhere: Mapping[str, str]) -> None:
        self._layout, self._elsewhere = layout, elsewhere

    def faults(self, found: Sequence[Any], document: Callable[[], Any]) -> tuple[list[Fault], set[str]]:
        """Return the validator's findings as faults, no more than a problem lists, and the codes that they have.

        The most useful come first: those that say what was meant, then values that are wrong, then what is missing.

        Parameters
        ----------
        found : sequence
            The validator's.
        document : callable
            Returns what the client sent, for the faults whose remedy depends on a value.
        """
        faults: list[tuple[Fault, str]] = []
        for entry in islice(_of_the_member_meant(_lengths_once(found)), LOOKED_AT):
            steps, owner = self._layout.steps(entry["loc"])
            cause = entry.get("ctx", {}).get("error")
            if isinstance(cause, InvalidParameter):
                rule = f"must {cause.rule}"
                remedy = cause.remedy or (_REMEDIES["float_type"] if rule == _RULES["float_type"] else None)
                faults.append((Fault(pointer_of((*steps, *cause.path)), rule, remedy), code_of(cause)))
            else:
                faults.append((self._fault(entry, steps, owner, document), "invalid-parameter"))
        faults = sorted(faults, key=lambda one: _rank(one[0]))[:MOST_FAULTS]
        return _lists_once([fault for fault, _ in faults]), {code for _, code in faults}

    def _fault(self, entry: Any, steps: tuple[Step, ...], owner: str, document: Callable[[], Any]) -> Fault:
        kind, context = entry["type"], entry.get("ctx", {})
        if kind in _UNKNOWN:
            return self._unknown(steps, owner, document)
        if kind == "short":
            return Fault(pointer_of(steps), f"must have {context['needs']} entries, not {context['has']}")
        if kind == "too_long":
            fixed = context.get("field_type") == "Tuple"
            most = context["max_length"]
            has = f", not {context['actual_length']}" if context.get("actual_length") else ""
            return Fault(pointer_of(steps), f"must have {most if fixed else f'at most {most}'} entries{has}")
        if kind == "too_short":
            least = context["min_length"]
            return Fault(pointer_of(steps), f"must have at least {least} entries" if least > 1 else "must not be empty")
        rule = _RULES.get(kind)
        # A rule of our own is worded where it is stated; other messages of the validator quote no input.
        detail = rule.format_map(context) if rule else str(entry["msg"]).removeprefix("Value error, ")
        named = steps[-1] if steps and isinstance(steps[-1], str) else ""
        if kind in _BOUNDS:
            unit = self._layout.unit_of(next((step for step in reversed(steps) if isinstance(step, str)), ""))
            detail = detail if unit == "1" else f"{detail} {unit}"
            return Fault(pointer_of(steps), detail, RADIANS if unit == "rad" else None)
        if kind == "literal_error":
            value = _value_at(document(), steps)
            near = nearest(value, re.findall("'([^']*)'", str(context["expected"]))) if isinstance(value, str) else None
            return Fault(pointer_of(steps), detail, near and f"{_MEANT}'{near}'?")
        if kind == "union_tag_invalid":
            tag, discriminator = str(context["tag"]), str(context["discriminator"]).strip("'")
            near = nearest(tag, self._layout.tags.get(named, ()))
            return Fault(pointer_of((*steps, discriminator)), detail, near and f"{_MEANT}'{near}'?")
        if kind == "union_tag_not_found":
            return Fault(pointer_of(steps), detail, f"its values here: {', '.join(self._layout.tags.get(named, ()))}")
        if kind == "neither":
            names = self._layout.names.get(named, ())
            keys = f"give an object, or an array of objects, with the keys {', '.join(names)}" if names else None
            return Fault(pointer_of(steps), detail, _SPANNED if _SPAN.issubset(names) or named == "times" else keys)
        if kind == "dict_type" and named in _KEYS:
            return Fault(pointer_of(steps), detail, _KEYS[named])
        if kind in _OBJECTS and named in self._layout.tags:
            # A client that gives a name alone meant the kind.
            return Fault(
                pointer_of(steps), detail, f'write {{"kind": ...}}, one of {", ".join(self._layout.tags[named])}'
            )
        if kind in _OBJECTS and (named or not steps) and named in self._layout.names:
            return Fault(pointer_of(steps), detail, f"its keys: {', '.join(self._layout.names[named])}")
        if kind == "tuple_type" and named in self._layout.lengths:
            detail = f"{detail} of {self._layout.lengths[named]} entries"
        return Fault(pointer_of(steps), detail, _REMEDIES.get(kind))

    def _unknown(self, steps: tuple[Step, ...], owner: str, document: Callable[[], Any]) -> Fault:
        key, names = str(steps[-1]), self._layout.names.get(owner, ())
        if len(key) > LONGEST_KEY_SHOWN:
            return Fault(pointer_of(steps[:-1]), "has a key that is not known here", _known(names))
        if len(steps) == 1 and key in self._elsewhere:
            return Fault(pointer_of(steps), _NOT_KNOWN, self._elsewhere[key])
        if len(steps) == 1 and self._layout.of_free_rotation and plain(key) in FORCES:
            return Fault(pointer_of(steps), _NOT_FREE, _FREE_ONLY)
        if _SPAN.issuperset(names) and plain(key) in STEPS:
            span = _value_at(document(), steps[:-1])
            remedy = count_in_place_of_step(span, _value_at(span, steps[-1:]))
            return Fault(pointer_of(steps), _NOT_KNOWN, remedy)
        near = nearest(key, names)
        return Fault(pointer_of(steps), _NOT_KNOWN, f"{_MEANT}{near}?" if near else _known(names))


def _known(names: Iterable[str]) -> str | None:
    return f"{KNOWN}{', '.join(names)}" if names else None


def _lists_once(faults: Sequence[Fault]) -> list[Fault]:
    """Return the faults with every list of names once: repeated for many unknown keys, it would fill the document."""
    given: set[str | None] = set()
    found = []
    for fault in faults:
        repeated = fault.remedy in given and str(fault.remedy).startswith(KNOWN)
        given.add(fault.remedy)
        found.append(replace(fault, remedy=None) if repeated else fault)
    return found


def _rank(fault: Fault) -> int:
    """Return where a fault stands among others: the lower, the sooner it helps."""
    if fault.detail.startswith(_NOT_KNOWN):
        return 3 if (fault.remedy or KNOWN).startswith(KNOWN) else 0
    if fault.detail == _MISSING:
        return 2
    return 0 if (fault.remedy or "").startswith(_MEANT) else 1


def _value_at(document: Any, steps: Sequence[Step]) -> Any:
    """Return what stands at a place of a document, None if nothing does."""
    for step in steps:
        if isinstance(document, dict):
            document = document.get(step)
        elif isinstance(document, list) and isinstance(step, int) and step < len(document):
            document = document[step]
        else:
            return None
    return document


def _lengths_once(found: Sequence[Any]) -> Iterator[Any]:
    """Yield the faults, those of the missing entries of one array as a single one that gives its length."""
    length: dict[tuple[Step, ...], tuple[int, int]] = {}
    for entry in found:
        if _missing_entry(entry):
            parent, at = entry["loc"][:-1], entry["loc"][-1]
            least, most = length.get(parent, (at, at))
            length[parent] = min(least, at), max(most, at)
    for entry in found:
        if not _missing_entry(entry):
            yield entry
        elif entry["loc"][:-1] in length:
            has, last = length.pop(entry["loc"][:-1])
            yield {"type": "short", "loc": entry["loc"][:-1], "ctx": {"has": has, "needs": last + 1}}


def _missing_entry(entry: Any) -> bool:
    return entry["type"] == "missing" and bool(entry["loc"]) and isinstance(entry["loc"][-1], int)


def _of_the_member_meant(found: Iterator[Any]) -> Iterator[Any]:
    """Yield the faults without those of the member of an object-or-array union that the client did not mean.

    That member has a single fault, its type, and stands first or second; if both members have it, neither was meant.
    """
    entries = list(found)
    other = {OBJECT: ARRAY, ARRAY: OBJECT}
    wrong = {
        entry["loc"] for entry in entries if entry["type"] in _TYPES and entry["loc"] and entry["loc"][-1] in other
    }
    for entry in entries:
        location = entry["loc"]
        if location not in wrong:
            yield entry
        elif (*location[:-1], other[location[-1]]) in wrong and location[-1] == OBJECT:
            yield {"type": "neither", "loc": location[:-1]}
