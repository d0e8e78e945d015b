"""XML read safely: elements with their lines, no document type, no entities of its own, within limits."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import NoReturn
from xml.parsers import expat

from core.errors import InvalidParameter

DOCUMENT = ("document",)
"""The field of a question that holds the text."""

MOST_CHARACTERS = 1_000_000
"""Characters of a document: a model of a hundred bodies has some 50,000."""

MOST_ELEMENTS = 20_000
"""Elements of a document: two hundred for each body that a scene may have."""

DEEPEST = 200
"""Levels of nesting: a chain of a hundred bodies in MJCF has one for each."""

LARGEST = 1e100
"""Size of a number: a moment of inertia of such lengths and masses is a double."""

LONGEST_WORD = 60
"""Characters of the document that a message repeats."""


@dataclass(frozen=True)
class Element:
    """An element of a document.

    Attributes
    ----------
    name : str
    attributes : mapping of str to str
    line : int
        In the document, from 1.
    children : list of Element
    words : list of str
        Its own text, in pieces.
    """

    name: str
    attributes: Mapping[str, str]
    line: int
    children: list[Element] = field(default_factory=list)
    words: list[str] = field(default_factory=list)

    @property
    def text(self) -> str:
        """Its own text without the space around it."""
        return "".join(self.words).strip()

    def all(self, *names: str) -> Iterator[Element]:
        """Return the children of some names."""
        return (child for child in self.children if child.name in names)

    def first(self, name: str) -> Element | None:
        """Return the first child of a name."""
        return next(self.all(name), None)

    def get(self, name: str, default: str = "") -> str:
        """Return an attribute."""
        return self.attributes.get(name, default)

    def required(self, name: str) -> str:
        """Return an attribute that must be there."""
        if name not in self.attributes:
            raise fault(self, f"must have the attribute {name}")
        return self.attributes[name]

    def numbers(self, name: str, count: int, default: tuple[float, ...] | None = None) -> tuple[float, ...]:
        """Return the numbers of an attribute, as many as stated."""
        if name not in self.attributes:
            if default is None:
                raise fault(self, f"must have the attribute {name}")
            return default
        return numbers_in(self, self.attributes[name], name, count)

    def number(self, name: str, default: float | None = None) -> float:
        """Return the number of an attribute."""
        return self.numbers(name, 1, None if default is None else (default,))[0]


def numbers_in(element: Element, text: str, what: str, count: int | None) -> tuple[float, ...]:
    """Return the finite numbers that a text of an element lists, `count` of them if that is given."""
    words = text.split()
    if count is not None and len(words) != count:
        raise fault(element, f"must have {count} numbers in {what}, not {len(words)}")
    try:
        # Python reads _ between digits and digits of other scripts, which files do not have.
        if "_" in text or not text.isascii():
            raise ValueError(text)
        found = tuple(float(word) for word in words)
    except ValueError:
        raise fault(element, f"must have numbers in {what}, not {shortened(text)}") from None
    if not all(abs(x) <= LARGEST for x in found):
        raise fault(element, f"must have finite numbers up to {LARGEST:g} in {what}")
    return found


def by_name(elements: Iterable[Element]) -> dict[str, Element]:
    """Return elements by their names, of which each must have one of its own."""
    found: dict[str, Element] = {}
    for element in elements:
        if element.required("name") in found:
            raise fault(
                element,
                f"must have a name of its own: <{element.name}> of line {found[element.get('name')].line} has it",
            )
        found[element.get("name")] = element
    return found


def shortened(text: str) -> str:
    """Return a word of the document in quotes, cut where it is long."""
    return f'"{text[:LONGEST_WORD]}{"..." if len(text) > LONGEST_WORD else ""}"'


def fault(element: Element, rule: str, remedy: str | None = None) -> InvalidParameter:
    """Return the fault of an element, which names its line."""
    name = element.get("name")
    called = f"<{element.name}>" + (f" {shortened(name)}" if name else "")
    return no_model(element.line, f"{called} {rule}", remedy)


def no_model(line: int, said: str, remedy: str | None = None) -> InvalidParameter:
    """Return the fault of a document that is no model, with the line that shows it."""
    return InvalidParameter(DOCUMENT, f"be a model that can be read; line {line}: {said}", remedy=remedy)


def read_xml(text: str) -> Element:
    """Return the root element of a document.

    Raises
    ------
    InvalidParameter
        For what is no XML, with line and column; for a document type or entities, which are never read; for more
        elements or levels than a model has.
    """
    if len(text) > MOST_CHARACTERS:
        raise InvalidParameter(DOCUMENT, f"have at most {MOST_CHARACTERS} characters, not {len(text)}")
    reader = _Reader()
    try:
        # The text is decoded already, whatever encoding its first line declares.
        reader.parser.Parse(text.encode("utf-8"), True)
    except UnicodeEncodeError:
        raise InvalidParameter(DOCUMENT, "be text without lone surrogates") from None
    except expat.ExpatError as error:
        said = f"line {error.lineno}, column {error.offset + 1}: {expat.ErrorString(error.code)}"
        raise InvalidParameter(DOCUMENT, f"be well-formed XML; {said}") from None
    return reader.root


class _Reader:
    """Builds the tree of elements as expat comes to them."""

    def __init__(self) -> None:
        self.parser = expat.ParserCreate(encoding="utf-8")
        self.parser.StartElementHandler = self._begin
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._text
        self.parser.StartDoctypeDeclHandler = self._doctype
        self.parser.EntityDeclHandler = self._doctype
        self.open: list[Element] = []
        self.count = 0

    def _doctype(self, *declared: object) -> NoReturn:
        line = self.parser.CurrentLineNumber
        raise InvalidParameter(
            DOCUMENT,
            f"have no document type and no entities of its own; line {line}",
            remedy="leave <!DOCTYPE ...> out",
        )

    def _begin(self, name: str, attributes: dict[str, str]) -> None:
        self.count += 1
        line = self.parser.CurrentLineNumber
        if self.count > MOST_ELEMENTS:
            raise InvalidParameter(DOCUMENT, f"have at most {MOST_ELEMENTS} elements; line {line} has one more")
        if len(self.open) >= DEEPEST:
            raise InvalidParameter(DOCUMENT, f"be nested at most {DEEPEST} levels deep; line {line} is deeper")
        element = Element(name, attributes, line)
        if self.open:
            self.open[-1].children.append(element)
        else:
            self.root = element
        self.open.append(element)

    def _end(self, name: str) -> None:
        self.open.pop()

    def _text(self, text: str) -> None:
        self.open[-1].words.append(text)
