"""The command polhode, run in this process; studies are sent to a server that plays the service."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
import tomllib
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from typing import Any, ClassVar

import pytest

from service.broken_pipe import UNREAD
from service.command import main

ROOT = Path(__file__).parents[2]


class PlayedService(BaseHTTPRequestHandler):
    """Accepts a study, has it run for two looks at its state, and has results."""

    states: ClassVar[list[str]] = []

    def do_POST(self) -> None:
        study = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        if study == {"count": 6} and self.headers["Authorization"] != "Bearer secret":
            self._write(401, {"title": "No key"})
            return
        if study == {"count": 4}:
            self.send_error(502)
            return
        if study == {"count": 5}:
            self.send_response(202)
            self.send_header("Content-Length", "100")
            self.end_headers()
            return
        if study not in ({"count": 2}, {"count": 6}):
            self._write(422, {"title": "Invalid parameter", "detail": "count must be 2"})
            return
        type(self).states = ["running", "successful"]
        self._write(202, {"jobID": "one", "status": "accepted", "progress": 0})

    def do_GET(self) -> None:
        if "/results" in self.path:
            self._write(200, {"path": self.path, "key": self.headers["Authorization"]})
        else:
            self._write(200, {"jobID": "one", "status": self.states.pop(0), "progress": 50})

    def _write(self, status: int, document: Any) -> None:
        body = json.dumps(document).encode()
        self.send_response(status)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, form: str, *values: object) -> None:
        """Write no lines."""


@pytest.fixture
def played(monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    monkeypatch.setattr("service.command.POLLING", 0.0)
    server = HTTPServer(("127.0.0.1", 0), PlayedService)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    yield f"http://127.0.0.1:{server.server_port}"
    server.shutdown()
    thread.join()
    server.server_close()


def test_grades_files_without_a_server(capsysbinary: pytest.CaptureFixture[bytes]) -> None:
    main(["grade", str(ROOT / "examples/assessments/1f.json")])
    answer = json.loads(capsysbinary.readouterr().out)
    assert [result["score"] for result in answer["results"]] == [1.0, 0.5]


def test_says_what_is_wrong_with_a_file(tmp_path: Path) -> None:
    file = tmp_path / "request.json"
    with pytest.raises(SystemExit, match="No such file"):
        main(["grade", str(file)])
    file.write_text('{"question": {"path": "/v1/nothing", "request": {}}, "submissions": [{}]}')
    with pytest.raises(SystemExit, match="/question/path"):
        main(["grade", str(file)])


def test_runs_a_study(played: str, tmp_path: Path) -> None:
    file, output = tmp_path / "study.json", tmp_path / "results.parquet"
    file.write_text('{"count": 2}')
    main(["study", str(file), "--url", f"{played}/", "--output", str(output)])
    assert json.loads(output.read_text()) == {"path": "/v1/studies/one/results.parquet", "key": None}


def test_a_study_is_sent_with_a_key(played: str, tmp_path: Path) -> None:
    file, key, output = tmp_path / "study.json", tmp_path / "key", tmp_path / "results.json"
    file.write_text('{"count": 6}')
    key.write_text("secret\n")
    command = ["study", str(file), "--url", played, "--output", str(output)]
    with pytest.raises(SystemExit, match="No key"):
        main(command)
    main([*command, "--key-file", str(key)])
    assert json.loads(output.read_text())["key"] == "Bearer secret"


def test_shows_the_problem_of_a_study(played: str, tmp_path: Path) -> None:
    file = tmp_path / "study.json"
    file.write_text('{"count": 3}')
    with pytest.raises(SystemExit, match="count must be 2"):
        main(["study", str(file), "--url", played, "--output", str(tmp_path / "results.json")])
    with pytest.raises(SystemExit, match="must end in one of"):
        main(["study", str(file), "--url", played, "--output", str(tmp_path / "results.txt")])
    with pytest.raises(SystemExit, match="no service at"):
        main(["study", str(file), "--url", "http://127.0.0.1:1", "--output", str(tmp_path / "results.json")])


@pytest.mark.parametrize(("count", "said"), [(4, "/v1/studies: 502 Bad Gateway"), (5, "the response broke off")])
def test_says_what_comes_from_other_servers_on_the_way(played: str, tmp_path: Path, count: int, said: str) -> None:
    file = tmp_path / "study.json"
    file.write_text(json.dumps({"count": count}))
    with pytest.raises(SystemExit, match=said):
        main(["study", str(file), "--url", played, "--output", str(tmp_path / "results.json")])


def test_an_output_that_cannot_be_written_is_told_before_the_study_if_it_is_known(played: str, tmp_path: Path) -> None:
    file, folder = tmp_path / "study.json", tmp_path / "folder.json"
    file.write_text('{"count": 2}')
    PlayedService.states = ["none was sent"]
    with pytest.raises(SystemExit, match="there is no folder"):
        main(["study", str(file), "--url", played, "--output", str(tmp_path / "none" / "results.json")])
    assert PlayedService.states == ["none was sent"]
    folder.mkdir()
    with pytest.raises(SystemExit, match=f"Is a directory; the results stay at {played}/v1/studies/one/results"):
        main(["study", str(file), "--url", played, "--output", str(folder)])


def test_an_address_has_a_scheme(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["study", str(tmp_path / "a.json"), "--url", "localhost:8000", "--output", str(tmp_path / "b.json")])
    assert "localhost:8000 does not begin with http:// or https://" in capsys.readouterr().err


def test_makes_a_key_and_passes_options_on(capsys: pytest.CaptureFixture[str]) -> None:
    main(["new-key", "laboratory"])
    assert "line for keys_file:  laboratory " in capsys.readouterr().out
    with pytest.raises(SystemExit):
        main(["serve", "--help"])
    assert "POLHODE_PORT" in capsys.readouterr().out
    with pytest.raises(SystemExit):
        main(["openapi", "--port", "1"])


@pytest.mark.parametrize(
    "command",
    [
        ["service.command", "--help"],
        ["service.command", "grade", "examples/assessments/1f.json"],
        ["service.command", "openapi"],
        ["service", "--new-key", "laboratory"],
    ],
    ids=" ".join,
)
def test_a_command_whose_reader_has_gone_ends_without_a_word(command: list[str]) -> None:
    read, written = os.pipe()
    os.close(read)
    try:
        ended = subprocess.run(
            [sys.executable, "-m", *command],
            cwd=ROOT,
            # With a buffer, as outside of tests: what is left in it is written when the interpreter ends.
            env=os.environ | {"PYTHONUNBUFFERED": ""},
            stdout=written,
            stderr=subprocess.PIPE,
            check=False,
        )
    finally:
        os.close(written)
    assert (ended.returncode, ended.stderr) == (UNREAD, b"")


def test_a_wheel_has_the_command_and_no_package_of_examples() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert project["project"]["scripts"] == {"polhode": "service.command:main"}
    wheel = project["tool"]["hatch"]["build"]["targets"]["wheel"]
    assert wheel["packages"] == ["core", "service"]
    assert wheel["force-include"] == {"examples/scenes": "service/routes/scene_examples"}
