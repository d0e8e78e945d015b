"""The scenes page: every scene of the catalogue moves; sliders and the text change it, faults stand at their place."""

import json
import re
from pathlib import Path
from urllib.request import urlopen

import pytest

from tests.browser.waiting import settle

REFUSED = ("422",)
STANDING = {"sleeping-top", "painleve-chalk", "four-legged-table"}
"""A body that spins about the axis by which it is described, one for which no motion exists, and one at rest."""


FRAME = 16
"""Pixels at the edge of a picture: its rounded corners are not always composed alike."""


def canvas(page):
    picture = page.locator(".view:visible canvas")
    picture.scroll_into_view_if_needed()
    box = picture.bounding_box()
    inside = {"x": box["x"] + FRAME, "y": box["y"] + FRAME}
    return page.screenshot(clip=inside | {side: box[side] - 2 * FRAME for side in ("width", "height")})


def scrub(page, thousandths):
    page.locator("#player input").fill(str(thousandths))
    page.wait_for_timeout(120)


def test_every_scene_of_the_catalogue_moves(opened, base):
    names = [scene["name"] for scene in json.load(urlopen(f"{base}/v1/scenes"))["scenes"]]
    page = opened("/scenes")
    assert page.locator("#scene option").evaluate_all("options => options.map(o => o.value).sort()") == sorted(
        [*names, "own"]
    )
    page.locator("#forces").uncheck()
    standing = set()
    for name in names:
        page.locator("#scene").select_option(name)
        settle(page)
        if page.locator("#player").is_hidden():
            standing.add(name)
            continue
        scrub(page, 0)
        start = canvas(page)
        scrub(page, 330)
        if canvas(page) == start:
            standing.add(name)
        assert page.locator("#faults li").count() == 0, name
        assert page.locator("#curves option").count() >= 2, name
        assert page.locator("#summary").inner_text() in page.locator(".view:visible canvas").get_attribute("aria-label")
    assert standing == STANDING


def test_the_numbers_are_those_of_the_api(opened, ask):
    page = opened("/scenes#scene=atwood-machine")
    first, _, body = page.locator("#request pre").inner_text().partition("\n")
    answer = ask(first.removeprefix("POST "), json.loads(body))
    (name, force), *_ = answer["forces"].items()
    said = page.locator(f"#answer dt:text-is('{name}, at the start') + dd").inner_text()
    assert said == f"{force['value']:.8g} N"
    assert answer["model"]["name"] in page.locator("#answer").inner_text()


def test_a_slider_changes_its_number_alone(opened):
    page = opened("/scenes#scene=simple-pendulum")
    before = page.locator("#editor").input_value()
    page.locator("#numbers summary").click()
    slider = page.locator("label.number[data-pointer='/bodies/bob/mass'] input")
    picture = page.locator("#answer").inner_text()
    slider.fill("2.5")
    settle(page)
    after = page.locator("#editor").input_value()
    assert json.loads(after)["bodies"]["bob"]["mass"] == 2.5
    assert json.loads(after) | {"bodies": None} == json.loads(before) | {"bodies": None}
    assert page.locator("#answer").inner_text() != picture


def test_a_scene_of_the_reader_is_not_called_by_the_name_of_another(opened):
    page = opened("/scenes#scene=spool")
    summary = page.locator("#about").inner_text()
    own = {"gravity": [0, -9.81], "bodies": {"stone": {"mass": 1, "at": [0, 0]}}, "times": [0, 1]}
    page.locator("#editor").fill(json.dumps(own))
    settle(page)
    assert page.locator("#about").inner_text() == "Changed from “Spool pulled by a weight”."
    page.locator("#scene").select_option("yo-yo")
    settle(page)
    assert page.locator("#about").inner_text() not in (summary, "Changed from “Spool pulled by a weight”.")


def test_a_scene_that_ends_at_once_has_no_playhead(opened):
    page = opened("/scenes#scene=painleve-chalk")
    assert page.locator("#player").is_hidden()
    assert page.locator("#curves").is_hidden()
    assert "NaN" not in page.locator("body").inner_text()


def test_formulas_keep_their_text(opened):
    page = opened("/scenes#scene=cylinder-on-cylinder")
    page.locator("#numbers summary").click()
    page.locator("label.number[data-pointer='/bodies/upper/mass'] input").fill("2")
    settle(page)
    assert '"0.75*sin(0.2)"' in page.locator("#editor").input_value()


@pytest.mark.parametrize(
    ("old", "new", "pointer", "selected"),
    [
        ('"kind": "pin"', '"kind": "pinn"', "/connections/0/kind", '"pinn"'),
        ('"mass": 1', '"mass": -1', "/bodies/one/mass", "-1"),
        ('"gravity"', '"gravitie"', "/gravitie", None),
    ],
)
def test_faults_are_written_at_their_place(opened, old, new, pointer, selected):
    page = opened("/scenes", expected=REFUSED)
    editor = page.locator("#editor")
    editor.fill(editor.input_value().replace(old, new, 1))
    settle(page)
    fault = page.locator("#faults button").first
    assert fault.inner_text().startswith(f"{pointer}: ")
    assert editor.get_attribute("aria-invalid") == "true"
    fault.click()
    chosen = editor.evaluate("e => e.value.slice(e.selectionStart, e.selectionEnd)")
    assert chosen == selected or selected is None
    editor.fill(editor.input_value().replace(new, old, 1))
    settle(page)
    assert page.locator("#faults li").count() == 0


@pytest.mark.parametrize(
    ("scene", "pointer"),
    [
        ({"bodies": 5}, "/bodies"),
        ({"bodies": {"a": None}}, "/bodies/a"),
        ({"bodies": {"a": {"mass": 1, "at": [0, 0]}}, "connections": [None]}, "/connections/0"),
        ({"bodies": {"a": {"mass": 1, "at": [0, 0]}}, "connections": [{"kind": "string"}]}, "/connections/0"),
    ],
)
def test_what_cannot_be_drawn_is_left_to_the_service(opened, scene, pointer):
    page = opened("/scenes#scene=own&faces=[", expected=REFUSED)
    page.locator("#editor").fill(json.dumps({"gravity": [0, -9.81]} | scene))
    settle(page)
    assert page.locator("#faults button").first.inner_text().startswith(pointer)


def test_what_is_not_json_is_said_with_its_place(opened):
    page = opened("/scenes")
    editor = page.locator("#editor")
    text = editor.input_value()
    editor.fill(text.replace('"mass": 1,', '"mass": 1', 1))
    settle(page)
    fault = page.locator("#faults button")
    assert re.search("in line [0-9]+: a comma or } is missing", fault.inner_text())
    assert page.locator("#problem").inner_text() == ""
    fault.click()
    # The place is where the comma should be: the name that follows.
    assert editor.evaluate("e => e.value.slice(e.selectionStart, e.selectionStart + 9)") == '"inertia"'


def test_an_edited_scene_is_in_the_address(opened):
    page = opened("/scenes#scene=spool")
    page.locator("#numbers summary").click()
    page.locator("label.number[data-pointer='/bodies/weight/mass'] input").fill("2.5")
    settle(page)
    again = opened(page.url[page.url.index("/scenes") :])
    assert json.loads(again.locator("#editor").input_value())["bodies"]["weight"]["mass"] == 2.5
    assert again.locator("#summary").inner_text() == page.locator("#summary").inner_text()


def test_an_event_is_marked_and_said(opened):
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"bob": {"mass": 1, "at": [0, -1], "velocity": [6, 0]}},
        "connections": [{"kind": "string", "name": "cord", "through": ["bob", [0, 0]]}],
        "times": {"start": 0, "stop": 3, "count": 7},
    }
    page = opened("/scenes")
    page.locator("#editor").fill(json.dumps(scene))
    settle(page)
    assert page.locator(".marks span").count() == page.locator("#events li").count() > 0
    assert "cord goes slack" in page.locator("#events").inner_text()


def test_the_gallery_finds_scenes_by_their_words(opened):
    page = opened("/scenes")
    page.locator("#browse").click()
    page.locator("#gallery-search").fill("tips edge")
    assert page.locator("#gallery .card:visible strong").all_inner_texts() == ["Block tips over"]
    page.locator("#gallery .card:visible").click()
    settle(page)
    assert page.locator("#scene").input_value() == "block-tips-over"
    assert "tips about its right edge" in page.locator("#summary").inner_text()


def test_graphs_of_one_quantity_against_another_and_as_a_table(opened):
    # What Euler's method loses leaves the range of doubles, and is shown until then.
    page = opened("/scenes#scene=simple-pendulum", expected=REFUSED)
    page.locator("#curves").select_option("bob x")
    page.locator("#against").select_option("bob y")
    assert page.locator("#plane-chart canvas").is_visible()
    assert page.locator("#chart").is_hidden()
    page.locator("#table-shown").check()
    assert page.locator("#table thead th").all_inner_texts() == ["time (s)", "bob x (m)"]
    page.locator("#against").select_option("")
    page.locator("#beside").select_option("explicit-euler")
    page.locator("#chart[aria-label*=Euler]").wait_for()


def test_what_is_taken_away_is_what_is_shown(opened):
    page = opened("/scenes#scene=simple-pendulum")
    contents = {}
    for name in ("json", "svg", "csv", "png"):
        with page.expect_download() as waiting:
            page.locator(f"#take-{name}").click()
        contents[name] = Path(waiting.value.path()).read_bytes()
    assert json.loads(contents["json"]) == json.loads(page.locator("#editor").input_value())
    assert contents["svg"].startswith(b"<svg")
    assert b"NaN" not in contents["svg"]
    assert contents["png"].startswith(b"\x89PNG")
    head, first, *rest = contents["csv"].decode().split("\r\n")
    assert head.startswith("time (s),bob.position.x (m),bob.position.y (m)")
    assert len(rest) == 800
    assert len(first.split(",")) == len(head.split(","))


def test_an_embedded_page_is_the_picture_alone(opened):
    page = opened("/scenes?embed=1#scene=simple-pendulum")
    assert page.locator("#plane-canvas").is_visible()
    assert page.locator("#player").is_visible()
    for name in ("nav", "#palette", "#editor", "#inspector"):
        assert page.locator(name).is_hidden()
