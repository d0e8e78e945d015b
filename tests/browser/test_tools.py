"""What the page does with a scene beside showing it: finds values, shows equations, asks, films and prints."""

import json
import math
import re
from pathlib import Path
from urllib.parse import quote

import pytest

from tests.browser.waiting import settle

REFUSED = ("422",)
LENGTH = 1.0
PENDULUM = {
    "gravity": [0, -9.81],
    "bodies": {"bob": {"mass": 1, "at": ["sin(0.1)", "-cos(0.1)"]}},
    "connections": [{"kind": "rod", "name": "rod", "a": "bob", "b": [0, 0]}],
    "times": {"start": 0, "stop": 3, "count": 11},
}


def period(gravity):
    """Return the period for an amplitude of 0.1 by the mean of Gauss: 2 pi sqrt(l/g) over agm(1, cos(0.05))."""
    one, other = 1.0, math.cos(0.05)
    while abs(one - other) > 1e-15:
        one, other = (one + other) / 2, math.sqrt(one * other)
    return 2 * math.pi * math.sqrt(LENGTH / gravity) / one


def address(scene, search=""):
    return f"/scenes{search}#scene=own&json={quote(json.dumps(scene))}"


def test_a_value_is_found_and_taken(opened):
    page = opened(address(PENDULUM))
    page.locator("#find-title").click()
    page.locator("#find-vary").select_option("/gravity/1")
    page.locator("#find-low").fill("-15")
    page.locator("#find-high").fill("-5")
    page.locator("#find-until").select_option("the period (s) is")
    page.locator("#find-value").fill(str(period(8.0)))
    page.locator("#find-go").click()
    found = page.locator("#find-found button")
    found.wait_for(timeout=60_000)
    assert found.count() == 1
    assert float(found.inner_text().split(" ± ")[0]) == pytest.approx(-8.0, rel=1e-9)
    assert page.locator("#find-said").inner_text().startswith("One value of ")
    found.click()
    settle(page)
    assert json.loads(page.locator("#editor").input_value())["gravity"][1] == pytest.approx(-8.0, rel=1e-9)
    page.locator("#find-low").fill("nothing")
    page.locator("#find-go").click()
    assert page.locator("#find-said").inner_text() == "The range is two numbers, the smaller one first."


def test_equations_of_motion_follow_the_scene(opened):
    page = opened(address(PENDULUM))
    page.locator("#equations summary").click()
    shown = page.locator("#equations-shown")
    shown.locator("math").first.wait_for()
    assert "Equations of motion" in shown.inner_text()
    assert shown.get_by_text("Conserved").count() == 1
    before = shown.inner_text()
    changed = json.loads(json.dumps(PENDULUM))
    changed["bodies"]["bob"]["mass"] = 3
    page.locator("#editor").fill(json.dumps(changed))
    settle(page)
    page.wait_for_function("text => document.querySelector('#equations-shown').innerText !== text", arg=before)
    assert shown.locator("math").count() > 0


def test_an_exercise_hides_its_results_until_one_has_answered(opened):
    page = opened(address(PENDULUM, "?exercise=%2Fperiod"))
    for hidden in ("#summary", "#answer", "#chart", "#editor", "#events"):
        assert page.locator(hidden).is_hidden(), hidden
    assert page.locator("#exercise-question").inner_text() == "What is the period (s)?"
    assert f"{period(9.81):.2f}" not in page.locator("body").inner_text()
    answer, said = page.locator("#exercise-value"), page.locator("#exercise-said")
    assert page.locator("#exercise-show").is_hidden()
    answer.fill("1.5")
    answer.press("Enter")
    said.get_by_text("Not right yet.").wait_for()
    assert page.locator("#summary").is_hidden()
    answer.fill(f"{period(9.81):.4f}")
    answer.press("Enter")
    said.get_by_text("Right.").wait_for()
    page.locator("#summary").wait_for()
    assert page.locator("#editor").is_visible()


def test_the_link_of_an_exercise_leads_to_it(opened):
    page = opened(address(PENDULUM))
    page.locator("#exercise-figure").select_option("/period")
    page.locator("#take-exercise").click()
    # Where a page may not write to the clipboard, the link is said.
    page.wait_for_function("() => /copied|http/.test(document.querySelector('#said').textContent)")


def test_the_motion_is_recorded_as_a_film(opened):
    page = opened(address(PENDULUM | {"times": {"start": 0, "stop": 0.5, "count": 11}}))
    page.locator("#window").fill("0.5")
    page.locator("#window").press("Tab")
    settle(page)
    with page.expect_download(timeout=60_000) as waiting:
        page.locator("#take-film").click()
    film = Path(waiting.value.path()).read_bytes()
    # The head of the container of WebM (EBML), and its name.
    assert film.startswith(b"\x1a\x45\xdf\xa3")
    assert b"webm" in film[:64]
    assert len(film) > 5_000


def test_a_notebook_has_the_scene(opened):
    page = opened(address(PENDULUM))
    with page.expect_download() as waiting:
        page.locator("#take-notebook").click()
    notebook = json.loads(Path(waiting.value.path()).read_text())
    text = "".join("".join(cell["source"]) for cell in notebook["cells"])
    assert notebook["nbformat"] == 4
    assert re.search("sin\\(0.1\\)", text)


def test_a_printed_sheet_has_problem_figure_and_graph(opened):
    page = opened(address(PENDULUM))
    page.emulate_media(media="print")
    for shown in ("#about", "#summary", "#plane-canvas", "#chart"):
        assert page.locator(shown).is_visible(), shown
    for hidden in ("#palette", "#inspector", "#player button", "nav"):
        assert page.locator(hidden).first.is_hidden(), hidden
