"""Every catalogue of feedback has every text, with the same values, and no text gives a number away."""

from __future__ import annotations

import ast
from pathlib import Path
from string import Formatter
from typing import get_args

import pytest

import core.assessment
from core.assessment.catalogue import MISTAKES
from core.assessment.compare import Verdict
from core.assessment.feedback.languages import CATALOGUES, LANGUAGES, Language, Sentence
from core.assessment.units import RULES

ENGLISH = CATALOGUES["en"]
FOLDER = Path(core.assessment.__file__).parent


def values(text: str) -> set[tuple[str, str]]:
    """Return the names of the values that complete a text, with their formats."""
    return {(name, form or "") for _, name, form, _ in Formatter().parse(text) if name is not None}


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_language_has_every_text(language: Language) -> None:
    own = CATALOGUES[language]
    assert own.keys() == ENGLISH.keys()
    for key, text in own.items():
        assert values(text) == values(ENGLISH[key]), key
        assert text.strip() == text
        assert text[-1] in ".?", key
    assert language == "en" or not [key for key in own if len(ENGLISH[key]) > 25 and own[key] == ENGLISH[key]]


def test_every_mistake_verdict_and_rule_of_units_has_a_text() -> None:
    # A wrong unit has the text of the rule that it breaks.
    keys = {mistake.tag for mistake in MISTAKES} | RULES.keys() | {*get_args(Verdict)} - {"wrong-unit"}
    assert keys <= ENGLISH.keys()


def test_every_text_is_used() -> None:
    used = {mistake.tag for mistake in MISTAKES} | RULES.keys() | {*get_args(Verdict)}
    for module in FOLDER.rglob("*.py"):
        if module.parent.name != "feedback" or module.stem == "entry_fault":
            nodes = ast.walk(ast.parse(module.read_text(encoding="utf-8")))
            used |= {node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)}
    assert ENGLISH.keys() - used == set()


@pytest.mark.parametrize("language", LANGUAGES)
def test_feedback_on_mistakes_gives_no_number(language: Language) -> None:
    for mistake in MISTAKES:
        assert not any(character in CATALOGUES[language][mistake.tag] for character in "456789"), mistake.tag


def test_numbers_have_the_decimal_mark_of_the_language() -> None:
    sentence = Sentence("samples-until", {"until": 3.14159})
    assert sentence.text("en") == "The samples are correct until t = 3.14 s."
    assert sentence.text("de") == "Die Werte sind bis t = 3,14 s richtig."
    assert sentence.text("fr") == "Les échantillons sont corrects jusqu'à t = 3,14 s."
    assert sentence.text("es") == "Las muestras son correctas hasta t = 3,14 s."
