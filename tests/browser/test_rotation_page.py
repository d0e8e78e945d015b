"""The start page: its numbers are the API's, the spin can be dragged, everything has words."""

import json
import re
from math import dist, isclose
from urllib.parse import parse_qs, urlsplit

import pytest

from tests.browser.serving import ROOT
from tests.browser.waiting import settle

REFUSED = ("422",)
"""Chromium writes every refused request to the console."""


def state_of(page):
    return {name: values[0] for name, values in parse_qs(urlsplit(page.url).fragment).items()}


def spin_of(page):
    return [float(x) for x in state_of(page)["spin"].split(",")]


def shown(page, name):
    """Return the text beside a name in the list of results."""
    return page.locator(f"#answer dt:text-is('{name}') + dd").inner_text()


def number_in(text):
    plain = text.replace("−", "-").replace("·10", "e").translate(str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-"))
    return float(re.search(r"-?[\d.]+(?:e-?\d+)?", plain).group())


def request_of(page):
    first, _, body = page.locator("#request pre").inner_text().partition("\n")
    return first.removeprefix("POST "), json.loads(body)


def picture(page, name):
    return page.locator(f"#{name}").screenshot()


def test_the_numbers_are_those_of_the_api(opened, ask):
    page = opened("/")
    path, question = request_of(page)
    answer = ask(path, question)
    assert isclose(number_in(shown(page, "Period of ω in the body")), answer["period"], rel_tol=1e-7)
    assert isclose(number_in(shown(page, "Flip interval")), answer["flip_interval"], rel_tol=1e-7)
    assert isclose(number_in(shown(page, "Energy")), answer["energy"], rel_tol=1e-5)
    assert shown(page, "Regime") == answer["model"]["regime"]
    assert isclose(number_in(shown(page, "Accuracy")), answer["accuracy"]["error"], rel_tol=0.06)
    assert f"turns over every {answer['flip_interval']:.6g} s" in page.locator("#summary").inner_text()


def test_the_t_handle_is_that_of_the_examples(opened):
    _, question = request_of(opened("/"))
    example = json.loads((ROOT / "examples/t-handle.json").read_text())
    assert question["angular_velocity"] == example["angular_velocity"]
    pairs = list(zip(question["body"]["positions"], example["body"]["positions"], strict=True))
    assert len(pairs) == 300
    assert max(dist(ours, theirs) for ours, theirs in pairs) < 1e-14


def drag(page, dx, dy):
    box = page.locator(".handle").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    for k in range(1, 9):
        page.mouse.move(x + dx * k / 8, y + dy * k / 8)
    page.mouse.up()
    settle(page)


def test_a_drag_changes_the_polhode_and_not_the_energy(opened, ask):
    page = opened("/#body=moments&moments=1,2,3&spin=0.1,2,0.1")
    before, curve = spin_of(page), picture(page, "ellipsoid-canvas")
    regime = shown(page, "Regime")
    drag(page, 40, -90)
    after = spin_of(page)
    assert dist(before, after) > 0.2
    moments = (1, 2, 3)
    energies = [sum(i * w * w for i, w in zip(moments, spin, strict=True)) / 2 for spin in (before, after)]
    assert isclose(*energies, rel_tol=1e-4)
    assert picture(page, "ellipsoid-canvas") != curve
    answer = ask(*request_of(page))
    assert shown(page, "Regime") == answer["model"]["regime"] != regime
    assert isclose(number_in(shown(page, "Period of ω in the body")), answer["period"], rel_tol=1e-7)


def test_the_spin_moves_by_keys(opened):
    page = opened("/#body=moments&moments=1,2,3&spin=0.1,2,0.1")
    before = spin_of(page)
    page.locator(".handle").focus()
    for _ in range(4):
        page.keyboard.press("ArrowRight")
        settle(page)
    assert 0.05 < dist(before, spin_of(page)) < 1.5


def test_the_pictures_turn_by_pointer_buttons_and_keys(opened):
    page = opened("/")
    spin = spin_of(page)
    for view in ("ellipsoid", "body"):
        frames = [picture(page, f"{view}-canvas")]
        box = page.locator(f"#{view}-canvas").bounding_box()
        page.mouse.move(box["x"] + 25, box["y"] + 25)
        page.mouse.down()
        page.mouse.move(box["x"] + 90, box["y"] + 60, steps=4)
        page.mouse.up()
        page.wait_for_timeout(100)
        frames.append(picture(page, f"{view}-canvas"))
        # A press on the picture gives it the keys.
        page.keyboard.press("ArrowRight")
        page.wait_for_timeout(100)
        frames.append(picture(page, f"{view}-canvas"))
        left = page.locator(f"#{view}-view .turn button").first
        left.click()
        page.wait_for_timeout(100)
        frames.append(picture(page, f"{view}-canvas"))
        page.keyboard.press("ArrowUp")
        page.wait_for_timeout(100)
        frames.append(picture(page, f"{view}-canvas"))
        assert len(set(frames)) == 5
    assert spin_of(page) == spin


def test_the_camera_looks_at_the_start_from_the_front(opened):
    for path in ("/", "/#body=racket", "/#body=moments&moments=1,2,3&spin=-2,-0.1,0.3"):
        assert not opened(path).locator(".handle.behind").count()


@pytest.mark.parametrize(
    ("state", "words"),
    [
        ("body=moments&moments=1,2,3&spin=0,2,0", "about an unstable axis"),
        ("body=moments&moments=1,2,3&spin=2,0.01,0.01", "does not flip"),
        ("body=moments&moments=1,2,3&spin=0,0,2", "the axis is stable"),
        ("body=moments&moments=1,2,3&spin=0.1,2,0.1", "turns over every"),
        ("body=coin", "does not flip"),
    ],
)
def test_stability_is_said_in_words(opened, state, words):
    page = opened(f"/#{state}")
    assert words in page.locator("#summary").inner_text()
    assert words in page.locator("#ellipsoid-canvas").get_attribute("aria-label")
    assert page.locator("#answer dt:text-is('Flip interval')").count() == (words == "turns over every")


def test_every_body_is_answered(opened):
    page = opened("/")
    for value in page.locator("#body option").evaluate_all("options => options.map(o => o.value)"):
        page.locator("#body").select_option(value)
        settle(page)
        assert page.locator("#problem").inner_text() == ""
        assert state_of(page)["body"] == value


def test_an_integrator_leaves_the_ellipsoid_and_pays_for_accuracy(opened, ask):
    page = opened("/#body=moments&moments=1,2,3&spin=0.1,2,0.1")
    exact = picture(page, "ellipsoid-canvas")
    page.locator("#method").select_option("explicit-euler")
    settle(page)
    assert picture(page, "ellipsoid-canvas") != exact
    errors, work = [], []
    for position in (20, 50, 80):
        page.locator("#setting").fill(str(position))
        page.wait_for_timeout(200)
        settle(page)
        page.locator("#request select").first.select_option("the integrator")
        answer = ask(*request_of(page))
        said = page.locator("#trade").inner_text()
        assert f"{answer['work']['evaluations']:,} evaluations" in said
        assert isclose(number_in(said), answer["accuracy"]["error"], rel_tol=0.06)
        errors.append(answer["accuracy"]["error"])
        work.append(answer["work"]["evaluations"])
    assert errors[0] > 2 * errors[1] > 4 * errors[2]
    assert work[0] < work[1] < work[2]


def test_the_address_is_the_state(opened):
    page = opened("/#body=moments&moments=1,2,3&spin=0.1,2,0.1&window=12&method=runge-kutta-4&setting=0.05")
    assert page.locator("#method").input_value() == "runge-kutta-4"
    assert "12 s" in page.locator("#player output").inner_text()
    page.locator("#spin input").first.fill("0.4")
    page.locator("#spin input").first.blur()
    settle(page)
    again = opened(page.url[page.url.index("/#") :])
    assert again.locator("#summary").inner_text() == page.locator("#summary").inner_text()
    assert again.locator("#trade").inner_text().split(",")[0] == page.locator("#trade").inner_text().split(",")[0]


def test_errors_stand_at_their_fields_in_words(opened):
    page = opened("/#body=moments", expected=REFUSED)
    page.locator("#moments input").first.fill("-1")
    page.locator("#moments input").first.blur()
    settle(page)
    assert "Moments" in page.locator("#problem").inner_text()
    assert page.locator("#moments input[aria-invalid=true]").count() == 3
    page.locator("#moments input").first.fill("one")
    page.locator("#moments input").first.blur()
    assert "three numbers" in page.locator("#problem").inner_text()
    page.locator("#window").fill("-3")
    page.locator("#window").blur()
    assert "above 0" in page.locator("#window-error").inner_text()
    page.locator("#body").select_option("points")
    settle(page)
    page.locator("#points").fill("1 0 0 0\n1 2")
    page.locator("#points").blur()
    settle(page)
    assert "line 2" in page.locator("#points-error").inner_text()


def test_pictures_beside_an_error_are_those_of_the_last_answer_and_pale(opened):
    page = opened("/#body=t-handle&spin=0,0,10", expected=REFUSED)
    before = picture(page, "ellipsoid-canvas")
    page.locator("#spin input").nth(2).fill("0")
    page.locator("#spin input").nth(2).blur()
    settle(page)
    assert "must not be zero" in page.locator("#problem").inner_text()
    assert "stale" in page.locator(".stage").get_attribute("class")
    assert picture(page, "ellipsoid-canvas") != before
    page.locator("#spin input").nth(2).fill("10")
    page.locator("#spin input").nth(2).blur()
    settle(page)
    assert "stale" not in page.locator(".stage").get_attribute("class")
    assert picture(page, "ellipsoid-canvas") == before


def test_the_playhead(opened):
    page = opened("/")
    assert page.locator("button.play").inner_text() == "Play"
    before = picture(page, "body-canvas")
    page.locator("#player input").fill("300")
    page.wait_for_timeout(100)
    scrubbed = picture(page, "body-canvas")
    assert scrubbed != before
    page.locator("button.play").click()
    page.wait_for_timeout(400)
    page.locator("button.play").click()
    assert picture(page, "body-canvas") != scrubbed
    assert opened("/", reduced_motion="no-preference").locator("button.play").inner_text() == "Pause"


def test_long_work_shows_progress_and_can_be_cancelled(opened):
    page = opened("/", expected=("ERR_FAILED",))
    page.route("**/v1/rotation/trajectory", lambda route: page.wait_for_timeout(1) and None)
    page.locator("#body").select_option("phone")
    progress = page.locator("#progress")
    progress.wait_for(state="visible", timeout=10_000)
    assert "computing" in progress.inner_text()
    progress.locator("button").click()
    progress.wait_for(state="hidden")
    assert "Cancelled" in page.locator("#problem").inner_text()
    page.unroute("**/v1/rotation/trajectory")
    page.locator("#body").select_option("cards")
    settle(page)
    assert "turns over" in page.locator("#summary").inner_text()


def test_python_and_curl_ask_the_same(opened):
    page = opened("/#body=moments")
    _, question = request_of(page)
    forms = page.locator("#request select").nth(1)
    forms.select_option("curl")
    text = page.locator("#request pre").inner_text()
    assert json.loads(re.search(r"-d '(.*)'", text).group(1)) == question
    forms.select_option("Python")
    text = page.locator("#request pre").inner_text()
    compile(text, "request", "exec")
    assert json.loads(re.search(r"r'''(.*)'''", text).group(1)) == question
