"""Descriptions of fields, taken from docstrings and units."""

from __future__ import annotations

import dataclasses
from typing import Any

import pytest

from core.bodies import Body
from core.quantities import members_of
from service.openapi.descriptions import attributes_of, describe, inherited_of

DOCSTRING = """A body.

    It has no section of its own for this: sizes : none.

    Attributes
    ----------
    mass : float
        Not 0 (kg).
    radius, height : float
        Of the base, and
        along the axis (m).
    kind : str
    place : tuple of float, shape (3,)
        Where: at : the centre.

    Raises
    ------
    error : never
        Not a field.
    """


class Base:
    """A base.

    Attributes
    ----------
    mass : float
        Of the base.
    edge : float
        Of the base too.
    """


class Derived(Base):
    """A derived one.

    Parameters
    ----------
    mass : float
        Its own.
    """


class Silent(Derived):
    pass


def test_attributes_are_read_as_numpydoc_lists_them() -> None:
    assert attributes_of(DOCSTRING) == {
        "mass": "Not 0 (kg).",
        "radius": "Of the base, and along the axis (m).",
        "height": "Of the base, and along the axis (m).",
        "place": "Where: at : the centre.",
    }


@pytest.mark.parametrize("text", ["", "A body.", "A body.\n\nRaises\n------\nerror : never\n    Not a field.\n"])
def test_without_a_list_there_is_nothing(text: str) -> None:
    assert attributes_of(text) == {}


@pytest.mark.parametrize("heading", ["Attributes", "Parameters"])
@pytest.mark.parametrize("more", ["", "\n\nReturns\n-------\nfloat\n    x : y", "\n\nSee Also\n--------\nother : a"])
def test_either_list_is_read_to_its_end(heading: str, more: str) -> None:
    text = f"A body.\n\n{heading}\n{'-' * len(heading)}\nmass : float\n    In all (kg).{more}"
    assert attributes_of(text) == {"mass": "In all (kg)."}


def test_what_is_derived_says_more_than_its_base() -> None:
    assert inherited_of(Derived) == inherited_of(Silent) == {"mass": "Its own.", "edge": "Of the base too."}
    assert inherited_of(int) == {}


@pytest.mark.parametrize("body", members_of(Body), ids=lambda body: body.__name__)
def test_docstrings_of_bodies_describe_fields_that_there_are(body: type) -> None:
    known = {
        entry.name for base in body.__mro__ if dataclasses.is_dataclass(base) for entry in dataclasses.fields(base)
    }
    assert set(inherited_of(body)) <= known | set(dir(body))


class TestDescribe:
    def described(self, schema: dict[str, Any], name: str = "Derived") -> dict[str, Any]:
        schemas = {name: schema}
        describe(schemas, [Derived])
        return schemas[name]

    def test_fields_get_the_words_of_their_docstring_then_of_their_class(self) -> None:
        found = self.described(
            {
                "description": "A form.\n\nAttributes\n----------\nmass : float\n    As asked.\n",
                "properties": {
                    "mass": {"type": "number", "x-unit": "kg"},
                    "edge": {"type": "number", "x-unit": "m"},
                    "rate": {"type": "number", "x-unit": "rad s^-1"},
                    "ratio": {"type": "number", "x-unit": "1"},
                    "kind": {"const": "x"},
                },
            }
        )
        assert {name: field.get("description") for name, field in found["properties"].items()} == {
            "mass": "As asked.",
            "edge": "Of the base too.",
            "rate": None,
            "ratio": None,
            "kind": None,
        }
        assert found["description"] == "A form."

    def test_a_description_that_is_there_stays(self) -> None:
        found = self.described({"properties": {"mass": {"description": "As it is.", "x-unit": "kg"}}})
        assert found["properties"]["mass"]["description"] == "As it is."
        assert "description" not in found

    def test_what_is_described_twice_is_described_as_once(self) -> None:
        schemas: dict[str, Any] = {"Derived": {"description": DOCSTRING, "properties": {"mass": {}, "radius": {}}}}
        describe(schemas, [Derived])
        once = repr(schemas)
        describe(schemas, [Derived])
        assert repr(schemas) == once

    def test_schemas_without_fields_are_left_alone(self) -> None:
        assert self.described({"enum": ["a"]}) == {"enum": ["a"]}
