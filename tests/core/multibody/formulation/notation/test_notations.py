"""Formulas in four notations, and text that is read back."""

from __future__ import annotations

from xml.etree import ElementTree

import pytest

from core.errors import NotApplicable
from core.formulas import ARGUMENTS, FUNCTIONS, Formula, Node
from core.multibody.formulation.notation.latex import latex
from core.multibody.formulation.notation.mathml import mathml
from core.multibody.formulation.notation.modelica import modelica
from core.multibody.formulation.notation.plain import plain

NAMES = ("a", "b", "c", "bob.x", "rod-2.angle")


@pytest.mark.parametrize(
    "text",
    [
        *("a - (b - c)", "a - b - c", "a/(b*c)", "a/b/c", "(a + b)*c", "-a^2", "(-a)^2", "a^(b + c)", "(a^b)^c"),
        *("a - -b", "-(a + b)", "2*sin(a - b)*bob.x", "sqrt(a^2 + rod-2.angle^2)", "1.5e-10*a", "a*(b/c)"),
    ],
)
def test_text_is_read_back_as_the_same_formula(text: str) -> None:
    root = Formula.read(text, NAMES, FUNCTIONS).root
    assert Formula.read(plain(root), NAMES, FUNCTIONS).root == root


NAME = Node("name", "bob.theta''")
ANGLE = Node("sin", inner=(Node("name", "bob.theta"),))


def test_names_have_letters_dots_and_owners() -> None:
    assert latex(NAME) == r"\ddot{\theta}_{\text{bob}}"
    assert latex(Node("name", "rod_a.angle'")) == r"\dot{\varphi}_{\text{rod\_a}}"
    assert latex(Node("name", "lambda_1")) == r"\lambda_{\text{1}}"
    assert latex(Node("name", "bob.dx")) == r"\Delta x_{\text{bob}}"
    assert latex(Node("name", "drag.force_2")) == r"F_{\text{2, drag}}"
    assert latex(Node("name", "top.omega_1")) == r"\omega_{\text{1, top}}"


def test_latex_of_operations() -> None:
    assert latex(Formula.read("a/(b + 2)", NAMES).root) == r"\frac{a}{b + 2}"
    assert latex(Formula.read("-((a + b)*c)", NAMES).root) == r"-\left( a + b \right) \, c"
    assert latex(Formula.read("sqrt(a)^2", NAMES).root) == r"\sqrt{a}^{2}"
    assert latex(Node("^", inner=(ANGLE, Node("number", "2")))) == r"\sin^{2} \theta_{\text{bob}}"
    assert latex(Node("number", "2.5e-07")) == r"2.5 \cdot 10^{-7}"


@pytest.mark.parametrize("text", ["a/(b + 2)", "-a^2*sin(a - b)", "sqrt(a)/bob.x", "abs(a) - 1e-9*rod-2.angle"])
def test_mathml_is_well_formed_and_has_every_name_and_number(text: str) -> None:
    root = Formula.read(text, NAMES, FUNCTIONS).root
    element = ElementTree.fromstring(mathml(root, Node("number", "0")))
    assert element.tag == "math"
    assert [one.text for one in element.iter("mn")][-1] == "0"
    owners = [one.text for one in element.iter("mtext")]
    assert owners == [name.split(".")[0] for name in NAMES if "." in name and name in text]


def test_a_name_cannot_bring_elements_of_its_own() -> None:
    assert "<script" not in mathml(Node("name", "a<script>.x"))


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("a - -b", "a - (-b)"),
        ("-a + b", "-a + b"),
        ("a*-b", "a*(-b)"),
        ("a^b^c", "a^(b^c)"),
        ("(-a)^2", "(-a)^2"),
        ("-a^2", "-a^2"),
        ("a - (b + c)", "a - (b + c)"),
        ("a/b/c", "a/b/c"),
        ("atan2(a, -b)*pi", "atan2(a, -b)*pi"),
        ("2*if(a, b, c)", "2*(if a > 0 then b else c)"),
        ("bob.x + rod-2.angle", "bob_x + rod_2_angle"),
    ],
)
def test_modelica_has_signs_before_the_first_term_alone_and_powers_of_two(text: str, written: str) -> None:
    """Specification 3.6, appendix A.2.7: arithmetic_expression has one sign in front, factor one power."""
    root = Formula.read(text, NAMES, (*FUNCTIONS, *ARGUMENTS)).root
    assert modelica(root, lambda name: name.replace(".", "_").replace("-", "_")) == written


def test_functions_that_modelica_does_not_have_are_refused() -> None:
    with pytest.raises(NotApplicable, match="Modelica has no sn"):
        modelica(Node("sn", inner=(Node("name", "t"), Node("number", "1"))), str)
