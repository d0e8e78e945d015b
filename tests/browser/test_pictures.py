"""What is drawn of every scene of the catalogue is what its description says, by the geometry of the drawing."""

import json
from urllib.request import urlopen

import pytest

DRAWN = """async (scenes) => {
  const { SceneModel } = await import("/page/scene_model.js");
  const { drawingOf } = await import("/page/plane_drawing.js");
  const models = scenes.map(({ name, example }) => ({ name, model: new SceneModel(example, null) }));
  return models.filter(({ model }) => !model.space).map(({ name, model }) => {
    const { low, high, size } = model.bounds();
    const items = drawingOf(model, { px: size / 400, view: { low, high } });
    return { name, items, places: Object.fromEntries(model.bodies.map((body) => [body.name, body.at])) };
  });
}"""
UNSEEN = {"force", "torque", "field", "contact", "gravitation", "inverse-square", "relation", "impulse"}
"""Kinds that are arrows, or seen by what touches."""


@pytest.fixture(scope="module")
def drawings(browser, base):
    page = browser.new_page()
    page.goto(f"{base}/scenes")
    scenes = [one for one in json.load(urlopen(f"{base}/v1/scenes"))["scenes"] if one["path"] == "/v1/scenes"]
    drawn = page.evaluate(DRAWN, scenes)
    page.close()
    examples = {one["name"]: one["example"] for one in scenes}
    return {one["name"]: one | {"example": examples[one["name"]]} for one in drawn}


def items(drawing, part):
    return [item for item in drawing["items"] if item["part"] == part]


def corners(drawing, body):
    (outline, *_) = [item for item in items(drawing, f"body:{body}") if item["shape"] == "outline"]
    return outline["points"]


def test_every_body_and_connection_is_seen(drawings):
    assert len(drawings) > 60
    for name, drawing in drawings.items():
        for body in drawing["example"]["bodies"]:
            assert items(drawing, f"body:{body}"), (name, body)
        for index, c in enumerate(drawing["example"].get("connections", [])):
            label = c.get("name", f"{c['kind']}-{index + 1}")
            on_body = isinstance(c.get("on"), dict) and isinstance(c["on"].get("at"), str)
            seen = c["kind"] not in UNSEEN and not on_body and c.get("measure") != "turn" and c.get("about") != "normal"
            assert items(drawing, f"connection:{label}") or not seen, (name, label)


def test_numbers_of_a_drawing_are_numbers(drawings):
    for name, drawing in drawings.items():
        text = json.dumps(drawing["items"])
        assert "NaN" not in text, name
        # JSON writes null for what is no number.
        for item in drawing["items"]:
            for point in item.get("points") or []:
                assert None not in point, (name, item)


def test_a_tipping_block_is_a_block(drawings):
    block = corners(drawings["block-tips-over"], "block")
    assert [x for corner in sorted(block) for x in corner] == pytest.approx(
        [-0.1, 0, -0.1, 0.6, 0.1, 0, 0.1, 0.6], abs=1e-12
    )


def test_the_upper_block_stands_on_the_lower(drawings):
    drawing = drawings["blocks-pulled"]
    low, high = corners(drawing, "lower"), corners(drawing, "upper")
    assert min(y for _, y in low) == 0
    assert min(y for _, y in high) == pytest.approx(max(y for _, y in low))


def test_a_tackle_has_both_parts_of_its_string(drawings):
    lines = [
        item["points"] for item in items(drawings["block-and-tackle"], "connection:string-1") if item["shape"] == "line"
    ]
    hanging = [line for line in lines if abs(line[0][0] - line[1][0]) < 1e-9 and min(line[0][1], line[1][1]) == -2]
    assert len(hanging) == 2
    assert hanging[0][0][0] != hanging[1][0][0]


def test_a_plank_has_the_length_of_its_moment_of_inertia(drawings):
    (bar, *_) = [item["points"] for item in items(drawings["rod-on-edge"], "body:rod") if item["shape"] == "line"]
    assert abs(bar[1][0] - bar[0][0]) == pytest.approx(1)


def test_a_spring_reaches_from_end_to_end(drawings):
    (coil, *_) = [
        item["points"]
        for item in items(drawings["damped-oscillator"], "connection:spring-1")
        if item["shape"] == "line"
    ]
    spring = next(c for c in drawings["damped-oscillator"]["example"]["connections"] if c["kind"] == "spring")
    ends = [
        drawings["damped-oscillator"]["places"].get(end, end) if isinstance(end, str) else end
        for end in (spring["a"], spring["b"])
    ]
    assert [coil[0], coil[-1]] == ends
    assert len(coil) > 10


def test_both_sides_of_a_chain_over_a_peg_are_seen(drawings):
    one, other = [
        item["points"] for item in items(drawings["chain-over-peg"], "connection:chain") if item["shape"] == "line"
    ]
    assert {x for x, _ in one} != {x for x, _ in other}


def test_a_rod_lies_on_the_edge_that_holds_it(drawings):
    (support,) = [
        item["points"] for item in items(drawings["rod-on-edge"], "connection:edge") if item["shape"] == "outline"
    ]
    assert support[0] == [0, 0]
    assert max(y for _, y in support) == 0


def test_a_drawer_has_the_size_that_rubs(drawings):
    (block, *_) = [
        item["points"]
        for item in items(drawings["drawer-pulled-aside"], "connection:runners")
        if item["shape"] == "outline"
    ]
    across, up = ([point[k] for point in block] for k in range(2))
    assert (min(across), max(across)) == pytest.approx((-0.2, 0.2))
    assert (min(up), max(up)) == pytest.approx((-0.25, 0.25))
