"""XML from strangers: what is never read, what is limited, and that every fault names its line."""

from __future__ import annotations

import pytest

from core.errors import InvalidParameter
from core.interchange.xml_reading import DEEPEST, MOST_CHARACTERS, MOST_ELEMENTS, read_xml

LAUGHS = """<?xml version="1.0"?>
<!DOCTYPE lolz [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">]>
<robot>&b;</robot>"""
FILE = '<!DOCTYPE r [<!ENTITY f SYSTEM "file:///etc/hostname">]><robot>&f;</robot>'


def test_elements_have_their_lines_attributes_and_texts() -> None:
    root = read_xml('<?xml version="1.0" encoding="latin-1"?>\n<a>\n <b x="1 2 3" y="&lt;"> ü </b>\n <b/></a>')
    first, second = root.all("b")
    assert (root.line, first.line, second.line) == (2, 3, 4)
    assert first.numbers("x", 3) == (1.0, 2.0, 3.0)
    assert (first.get("y"), first.text) == ("<", "ü")


@pytest.mark.parametrize("text", [LAUGHS, FILE])
def test_document_types_and_their_entities_are_refused_unread(text: str) -> None:
    with pytest.raises(InvalidParameter, match="no document type and no entities"):
        read_xml(text)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "no element found"),
        ("<a>\n<b></a>", "line 2, column 6: mismatched tag"),
        ("<a>&other;</a>", "undefined entity"),
        ("<a x='1' x='2'/>", "duplicate attribute"),
        ("<a>\x00</a>", "line 1"),
        ("<a>\ud800</a>", "lone surrogates"),
        ("x" * (MOST_CHARACTERS + 1), f"at most {MOST_CHARACTERS} characters"),
        ("<a>" * (DEEPEST + 1), f"at most {DEEPEST} levels"),
        ("<a>" + "<b/>" * MOST_ELEMENTS + "</a>", f"at most {MOST_ELEMENTS} elements"),
    ],
)
def test_what_is_no_document_or_too_large_is_refused_at_its_place(text: str, says: str) -> None:
    with pytest.raises(InvalidParameter) as fault:
        read_xml(text)
    assert fault.value.path == ("document",)
    assert says in fault.value.detail


@pytest.mark.parametrize(
    ("numbers", "says"),
    [
        ("1 2", "3 numbers in x, not 2"),
        ("1 2 k", "numbers in x"),
        ("1 2 nan", "finite"),
        ("1 2 1_0", "numbers in x"),
        ("1 2 ٣", "numbers in x"),
        ("1 2 1e101", "up to 1e+100"),
    ],
)
def test_numbers_that_are_none_are_refused_with_the_line(numbers: str, says: str) -> None:
    element = read_xml(f'<a>\n<b name="n" x="{numbers}"/></a>').children[0]
    with pytest.raises(InvalidParameter) as fault:
        element.numbers("x", 3)
    assert "line 2" in fault.value.detail
    assert says in fault.value.detail
