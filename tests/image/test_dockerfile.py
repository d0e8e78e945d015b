"""The Dockerfile says what an image of this service needs; `make image` runs it."""

from __future__ import annotations

from tests.image.clean_root import ROOT
from tests.image.dockerfile import assignments, stages


def test_continued_lines_comments_and_variables_are_read() -> None:
    text = (
        '# head\nFROM a:1 AS one\nENV X=1 \\\n    Y=\'2 3\'\nRUN cp a \\\n  b\n\nFROM b:2\nENTRYPOINT ["run", "$@"]\n'
    )
    first, second = stages(text)
    assert (first.image, first.name, second.image, second.name) == ("a:1", "one", "b:2", "1")
    assert first.steps == [("ENV", "X=1  Y='2 3'"), ("RUN", "cp a  b")]
    assert assignments(first.last("ENV"), {}) == {"X": "1", "Y": "2 3"}
    assert assignments("PATH=/x:$PATH", {"PATH": "/bin"}) == {"PATH": "/x:/bin"}
    assert second.entrypoint() == ["run", "$@"]


def test_the_image_runs_without_rights_and_is_watched() -> None:
    build, final = stages((ROOT / "Dockerfile").read_text(encoding="utf-8"))
    assert build.image == final.image
    assert int(final.last("USER")) > 0
    assert final.last("STOPSIGNAL") == "SIGTERM"
    assert "readyz" in final.health_check()[-1]
    assert all(instruction != "RUN" or "pip" not in argument for instruction, argument in final.steps)
