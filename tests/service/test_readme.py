"""The README's first question, run as it is printed, in curl and in Python, against a server that the test starts."""

import contextlib
import io
import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def block(language: str) -> str:
    found = re.search(rf"```{language}\n(.*?)```", README, re.DOTALL)
    assert found is not None
    return found[1]


def at(text: str, url: str) -> str:
    assert "http://127.0.0.1:8000" in text
    return text.replace("http://127.0.0.1:8000", url)


def test_python_prints_what_is_shown(server, monkeypatch):
    monkeypatch.chdir(ROOT)
    printed = io.StringIO()
    code = at(block("python"), server.url)
    assert len(code.strip().splitlines()) == 6
    with contextlib.redirect_stdout(printed):
        exec(compile(code, "README.md", "exec"), {})
    assert printed.getvalue() == block("text")


@pytest.mark.skipif(shutil.which("curl") is None, reason="curl is not installed")
def test_curl_line_gives_the_answer(server):
    line = at(block("sh"), server.url).replace("| head -c 700", "")
    answer = json.loads(subprocess.run(line, shell=True, cwd=ROOT, check=True, capture_output=True).stdout)
    assert answer["flip_interval"] == pytest.approx(2.453763074, abs=1e-9)
    assert len(answer["angular_velocity"]) == 10_000


def test_every_linked_file_exists():
    for target in re.findall(r"\]\(([^)#]+)\)", README):
        assert (ROOT / target).exists(), target
