"""What an answer takes while its client does not read it is bounded in size and in time."""

from __future__ import annotations

import json
import socket
import time
import urllib.error
import urllib.request
from typing import Any

from tests.service.conftest import PATIENCE, Server

PATH = "/v1/rotation/trajectory"
LARGE = json.dumps(
    {
        "body": {"kind": "principal-moments", "moments": [1, 2, 3]},
        "angular_velocity": [0.1, 1, 0.1],
        "times": {"start": 0, "stop": 20, "count": 400_000},
    }
).encode()


def asked(server: Server) -> tuple[int, dict[str, Any]]:
    request = urllib.request.Request(server.url + PATH, LARGE, {"content-type": "application/json"})
    try:
        with urllib.request.urlopen(request, timeout=PATIENCE) as response:
            return response.status, json.load(response)
    except urllib.error.HTTPError as refusal:
        with refusal:
            return refusal.code, json.load(refusal)


def test_unread_answers_are_counted_and_let_go() -> None:
    server = Server(POLHODE_STALLED_SECONDS="2", POLHODE_MAX_HELD_BYTES="1000000")
    try:
        server.wait_until_ready()
        with socket.socket() as idle:
            # A small window, so that what the kernel takes off the server's hands is little.
            idle.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            idle.settimeout(PATIENCE)
            idle.connect(("127.0.0.1", server.port))
            head = f"POST {PATH} HTTP/1.1\r\nhost: x\r\ncontent-type: application/json\r\n"
            idle.sendall(f"{head}content-length: {len(LARGE)}\r\n\r\n".encode() + LARGE)
            received = len(idle.recv(100))
            assert received
            status, problem = asked(server)
            assert (status, problem["code"]) == (429, "too-busy")
            assert "max_held_bytes" in problem["detail"]
            until = time.monotonic() + PATIENCE
            while status == 429 and time.monotonic() < until:
                time.sleep(0.2)
                status, answer = asked(server)
            assert status == 200
            ended = b""
            while more := idle.recv(65536):
                received, ended = received + len(more), more
        # Cut short, and without the end that would make it seem whole.
        assert received < 10_000_000
        assert not ended.endswith(b"0\r\n\r\n")
        assert len(answer["angular_velocity"]) == 400_000
    finally:
        server.stop()
