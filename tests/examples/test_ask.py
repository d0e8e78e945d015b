"""Sending an example from the command line."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, HTTPServer

import pytest

from examples.ask import SHOWN, main, request_of

ANSWER = {"time": list(range(100)), "model": {"regime": "steady"}}


class Echo(BaseHTTPRequestHandler):
    """A service that answers the same to everything, and keeps what it was sent."""

    seen: list[tuple[str, bytes]] = []  # noqa: RUF012

    def do_POST(self) -> None:
        self.seen.append((self.path, self.rfile.read(int(self.headers["content-length"]))))
        body = json.dumps(ANSWER).encode()
        self.send_response(200)
        self.send_header("content-length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *arguments: object) -> None:
        pass


@pytest.fixture
def port(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    Echo.seen.clear()
    with HTTPServer(("127.0.0.1", 0), Echo) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield server.server_port
        server.shutdown()


def test_the_service_of_the_same_environment_is_sent_the_example(
    port: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("POLHODE_PORT", str(port))
    main(["scenes/rod-in-hole/horizontal"])
    assert Echo.seen == [("/v1/scenes/rod-in-hole", request_of("scenes/rod-in-hole/horizontal"))]
    shown = json.loads(capsys.readouterr().out)
    assert shown["model"] == ANSWER["model"]
    assert shown["time"] == [*range(SHOWN), "... 100 in all"]


def test_without_a_name_the_first_example_is_sent_and_all_are_listed(
    port: int, capsys: pytest.CaptureFixture[str]
) -> None:
    main(["--service", f"http://127.0.0.1:{port}", "--whole"])
    assert Echo.seen == [("/v1/rotation/trajectory", request_of("t-handle"))]
    printed = capsys.readouterr()
    assert json.loads(printed.out) == ANSWER
    assert "scenes/rod-in-hole/horizontal" in printed.err


def test_a_service_that_does_not_run_is_one_clear_line(port: int) -> None:
    with pytest.raises(SystemExit, match="is the service running"):
        main(["--service", "http://127.0.0.1:9"])
