"""The nginx configuration of docs/nginx, started and exercised where nginx is installed."""

from __future__ import annotations

import http.client
import json
import re
import shutil
import socket
import ssl
import subprocess
import time
from collections.abc import Iterator
from contextlib import ExitStack
from email.message import Message
from pathlib import Path

import pytest

from service.problem_types import REGISTRY
from tests.service import hostile
from tests.service.conftest import PATIENCE, ROOT, Server

CONFIGURATION = ROOT / "docs" / "nginx" / "polhode.conf"
NGINX, OPENSSL = shutil.which("nginx"), shutil.which("openssl")
PATH = "/v1/rotation/trajectory"

needs_nginx = pytest.mark.skipif(not (NGINX and OPENSSL), reason="nginx and openssl are not installed")


def test_limits_are_those_of_the_service() -> None:
    from service.settings import Settings

    text = CONFIGURATION.read_text(encoding="utf-8")
    assert f"client_max_body_size {Settings().max_body_bytes};" in text
    assert "server 127.0.0.1:8000;" in text
    # Replaced, not added to: what a client sends under this name must not be taken for its address.
    assert "proxy_set_header X-Forwarded-For $remote_addr;" in text
    read = float(text.split("proxy_read_timeout ")[1].split("s;")[0])
    assert read > Settings().deadline_seconds
    # The proxy closes idle connections first: one that the service closed while a request is on its way is a 502.
    upstream = text.split("upstream polhode {")[1].split("}")[0]
    assert float(upstream.split("keepalive_timeout ")[1].split("s;")[0]) < Settings().keep_alive_seconds


def test_its_problems_are_those_of_the_service() -> None:
    for written in re.findall(r"'(\{.*\})'", CONFIGURATION.read_text(encoding="utf-8")):
        problem = json.loads(written)
        known = REGISTRY[problem["code"]]
        assert (problem["type"], problem["title"], problem["status"]) == (known.uri, known.title, known.status)


@pytest.fixture(scope="module")
def proxy(server: Server, tmp_path_factory: pytest.TempPathFactory) -> Iterator[int]:
    folder: Path = tmp_path_factory.mktemp("nginx")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port: int = free.getsockname()[1]
    text = CONFIGURATION.read_text(encoding="utf-8")
    text = text.replace("127.0.0.1:8000", f"127.0.0.1:{server.port}").replace("listen 8443", f"listen 127.0.0.1:{port}")
    text = text.replace("client_header_timeout 5s", "client_header_timeout 1s")
    (folder / "polhode.conf").write_text("daemon off;\n" + text)
    assert OPENSSL
    assert NGINX
    making = f"{OPENSSL} req -x509 -newkey rsa:2048 -nodes -days 1 -subj /CN=localhost"
    files = ["-keyout", str(folder / "key.pem"), "-out", str(folder / "certificate.pem")]
    subprocess.run([*making.split(), *files], check=True, capture_output=True)
    process = subprocess.Popen(
        [NGINX, "-p", str(folder), "-c", str(folder / "polhode.conf")], stderr=subprocess.PIPE, text=True
    )
    try:
        deadline = time.monotonic() + PATIENCE
        while True:
            try:
                socket.create_connection(("127.0.0.1", port), timeout=1).close()
                break
            except OSError:
                assert process.poll() is None, process.stderr and process.stderr.read()
                assert time.monotonic() < deadline
                time.sleep(0.05)
        yield port
    finally:
        process.terminate()
        process.communicate(timeout=PATIENCE)


def tls() -> ssl.SSLContext:
    context = ssl.create_default_context()
    context.check_hostname = False
    context.verify_mode = ssl.CERT_NONE
    return context


def post(port: int, body: bytes, **headers: str) -> tuple[int, Message, bytes]:
    connection = http.client.HTTPSConnection("127.0.0.1", port, timeout=PATIENCE, context=tls())
    try:
        connection.request("POST", PATH, body, {"content-type": "application/json", **headers})
        response = connection.getresponse()
        return response.status, response.headers, response.read()
    finally:
        connection.close()


@needs_nginx
def test_questions_are_answered_over_tls(proxy: int) -> None:
    status, headers, content = post(proxy, hostile.text())
    assert status == 200
    assert json.loads(content)["signature"]["source"] == "polhode"
    assert headers["strict-transport-security"]
    assert "/" not in headers["server"]
    longer = hostile.text(times={"start": 0, "stop": 1, "count": 1000})
    for coding in ("gzip", "zstd"):
        status, headers, content = post(proxy, longer, **{"accept-encoding": coding})
        assert (status, headers["content-encoding"]) == (200, coding)
        # What is revalidated through the proxy is what it passed on.
        assert headers["etag"].endswith(f'-{coding}"')
        known = {"accept-encoding": coding, "if-none-match": headers["etag"]}
        assert (post(proxy, longer, **known)[0], post(proxy, longer, **known)[2]) == (304, b"")
    plain = post(proxy, longer)
    assert plain[1]["content-encoding"] is None
    assert json.loads(plain[2])["signature"]["source"] == "polhode"


@needs_nginx
def test_large_bodies_are_refused_unread(proxy: int) -> None:
    with socket.create_connection(("127.0.0.1", proxy), timeout=PATIENCE) as plain, tls().wrap_socket(plain) as secure:
        head = f"POST {PATH} HTTP/1.1\r\nhost: x\r\ncontent-type: application/json\r\n"
        secure.sendall(f"{head}content-length: 9000000\r\n\r\n".encode())
        received = b""
        while not received.endswith(b"}") and (more := secure.recv(4096)):
            received += more
    assert received.startswith(b"HTTP/1.1 413")
    assert b"content-type: application/problem+json" in received.lower()
    assert json.loads(received.split(b"\r\n\r\n", 1)[1])["code"] == "body-too-large"


@needs_nginx
def test_too_many_connections_of_an_address_are_a_problem(proxy: int) -> None:
    with ExitStack() as stack:
        # As many as the configuration allows, each with a request that is under way.
        for _ in range(50):
            plain = stack.enter_context(socket.create_connection(("127.0.0.1", proxy), timeout=PATIENCE))
            secure = stack.enter_context(tls().wrap_socket(plain))
            secure.sendall(f"POST {PATH} HTTP/1.1\r\nhost: x\r\ncontent-length: 9\r\n\r\n".encode())
        status, headers, content = post(proxy, hostile.text())
    assert (status, headers["content-type"], headers["retry-after"]) == (429, "application/problem+json", "1")
    assert json.loads(content)["code"] == "too-busy"


@needs_nginx
def test_large_headers_are_refused(proxy: int) -> None:
    assert post(proxy, hostile.text(), **{"x-large": "x" * 40_000})[0] == 400
    many = {f"x-{i}": "y" * 1000 for i in range(60)}
    assert post(proxy, hostile.text(), **many)[0] == 400


@needs_nginx
def test_slow_headers_are_let_go(proxy: int, server: Server) -> None:
    since = time.monotonic()
    with socket.create_connection(("127.0.0.1", proxy), timeout=PATIENCE) as plain, tls().wrap_socket(plain) as secure:
        secure.sendall(b"POST / HTTP/1.1\r\nhost: x\r\n")
        closed = False
        while not closed and time.monotonic() - since < PATIENCE:
            time.sleep(0.3)
            try:
                secure.sendall(b"x: y\r\n")
                secure.settimeout(0.05)
                secure.recv(100)
                closed = True
            except TimeoutError:
                continue
            except OSError:
                closed = True
    assert closed
    assert post(proxy, hostile.text())[0] == 200
