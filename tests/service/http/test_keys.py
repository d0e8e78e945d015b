"""Keys: who may ask, how much, and how keys are exchanged while the service runs."""

from __future__ import annotations

import asyncio
import hashlib
import os
import sys
import threading
from functools import partial
from math import inf
from pathlib import Path
from typing import Any

import httpx
import pytest
import uvicorn

from service.__main__ import main, server_options
from service.http import keys as module
from service.http.keys import Allowance, Key, Keys, new_key
from service.problems import Refusal
from service.settings import Settings
from tests.service.conftest import PATIENCE, client_of, inline_toys
from tests.service.toy_routes import GOOD

pytestmark = pytest.mark.anyio


class Clock:
    """A clock that stands until it is moved."""

    def __init__(self) -> None:
        self.now = 1000.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr(module, "monotonic", clock)
    return clock


def bearer(key: str) -> dict[str, str]:
    return {"authorization": f"Bearer {key}"}


async def test_only_known_keys_may_ask(tmp_path: Path) -> None:
    (first, one), (second, two) = new_key("alpha"), new_key("beta")
    file = tmp_path / "keys"
    file.write_text(f"# who may ask\n\n{one}\n{two}\n")
    async with client_of(inline_toys(keys_file=file)) as client:
        for key in (first, second):
            assert (await client.post("/v1/toy", json=GOOD, headers=bearer(key))).status_code == 200
        unknown = [
            {},
            bearer(""),
            bearer(first[:-1]),
            bearer(first + "a"),
            bearer(one.split()[1]),
            {"authorization": first},
            {"authorization": f"Basic {first}"},
            {"authorization": "Bearer " + "x" * 30_000},
        ]
        for headers in unknown:
            response = await client.post("/v1/toy", json=GOOD, headers=headers)
            assert (response.status_code, response.json()["code"]) == (401, "unauthorized")
            assert response.headers["www-authenticate"] == "Bearer"
            assert first not in response.text
        # What tells no result is open to all.
        for path in ("/healthz", "/metrics", "/docs", "/v1/errors"):
            assert (await client.get(path)).status_code == 200


def test_keys_are_stored_as_digests() -> None:
    key, line = new_key("alpha")
    assert key not in line
    assert len(key) > 40
    assert new_key("alpha")[0] != key
    with pytest.raises(ValueError, match="letters"):
        new_key("a b")


def test_the_command_line_makes_keys(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    main(["--new-key", "course-7"])
    shown, line = capsys.readouterr().out.splitlines()
    file = tmp_path / "keys"
    file.write_text(line.split(": ", 1)[1].strip() + "\n")
    assert Keys(file).admit({b"authorization": b"Bearer " + shown.split(": ")[1].encode()}).name == "course-7"


async def test_the_rate_of_each_key_is_its_own(tmp_path: Path, clock: Clock) -> None:
    (first, one), (second, two) = new_key("alpha"), new_key("beta")
    file = tmp_path / "keys"
    file.write_text(f"{one.replace('- -', '0.5 -')}\n{two}\n")
    async with client_of(inline_toys(keys_file=file)) as client:

        async def ask(key: str) -> Any:
            return await client.post("/v1/toy", json=GOOD, headers=bearer(key))

        assert [(await ask(first)).status_code for _ in range(6)] == [200] * 5 + [429]
        refused = await ask(first)
        assert (refused.json()["code"], refused.headers["retry-after"]) == ("quota-exceeded", "2")
        assert {(await ask(second)).status_code for _ in range(20)} == {200}
        clock.now += 2.0
        assert [(await ask(first)).status_code for _ in range(2)] == [200, 429]


def test_work_is_charged_with_what_it_came_to(clock: Clock) -> None:
    """6.5 s a minute, of which a whole minute's may be saved up."""
    key = Key("alpha", inf, 6.5, 1)
    for _ in range(3):
        key.work(2.0)
    # Each took a second less than predicted.
    key.charge(-3.0)
    key.work(3.4)
    with pytest.raises(Refusal):
        key.work(2.0)
    # One took far longer: nothing is admitted before the debt is paid.
    key.charge(5.0)
    for seconds, admitted in ((0.0, False), (40.0, False), (8.0, True)):
        clock.now += seconds
        if admitted:
            key.work(0.0)
        else:
            with pytest.raises(Refusal):
                key.work(0.0)


def test_an_allowance_never_grows_beyond_its_most(clock: Clock) -> None:
    allowance = Allowance(1.0, 3.0)
    clock.now += 1e6
    assert [allowance.take(1.0) for _ in range(4)] == [0.0, 0.0, 0.0, 1.0]
    # More than can ever be saved up is given once all is there, and has to be paid back.
    clock.now += 3.0
    assert allowance.take(10.0) == 0.0
    assert allowance.take(1.0) == pytest.approx(8.0)


def test_a_key_with_a_rate_of_zero_may_ask_nothing(clock: Clock) -> None:
    for rate, work, use in ((0.0, inf, Key.request), (inf, 0.0, partial(Key.work, seconds=1e-3))):
        key = Key("suspended", rate, work, 1)
        for _ in range(2):
            with pytest.raises(Refusal) as refused:
                use(key)
            assert refused.value.problem.retry_after == 3600.0
            clock.now += 1e6


def known(keys: Keys, key: str) -> bool:
    try:
        keys.admit({b"authorization": b"Bearer " + key.encode()})
    except Refusal as refusal:
        if refusal.problem.type.status == 429:
            raise
        return False
    return True


def test_keys_are_exchanged_while_the_service_runs(tmp_path: Path, clock: Clock) -> None:
    (first, one), (second, two) = new_key("alpha"), new_key("beta")
    file = tmp_path / "keys"
    file.write_text(one.replace("- -", "0.1 -") + "\n")
    keys = Keys(file)
    assert (known(keys, first), known(keys, second)) == (True, False)
    file.write_text(f"{one.replace('- -', '0.1 -')}\n{two}\n")
    keys.refresh()
    assert known(keys, second)
    # What a key has used stays used.
    with pytest.raises(Refusal):
        known(keys, first)
    file.write_text(two + "\n# the other has gone\n")
    keys.refresh()
    assert (known(keys, first), known(keys, second)) == (False, True)


def test_a_file_that_cannot_be_used_is_reported_and_the_keys_before_it_stay(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    (first, one), (second, two) = new_key("alpha"), new_key("beta")
    file = tmp_path / "keys"
    whole = f"{one}\n{two}\n"
    file.write_text(whole)
    keys = Keys(file)

    def stay() -> bool:
        caplog.clear()
        keys.refresh()
        return known(keys, first) and known(keys, second) and "the keys before it stay" in caplog.text

    # Truncated in place: anywhere but at the end of a line, which is no different from a key that was removed.
    for length in (0, 1, len(one) - 1, len(one), len(whole) - 1):
        file.write_text(whole[:length])
        assert stay(), length
    # It is reported once.
    caplog.clear()
    keys.refresh()
    assert not caplog.records
    file.write_text(two + "\nnonsense\n")
    assert stay()
    os.remove(file)
    assert stay()
    # Nobody writes to the pipe: whoever read it would wait for ever.
    os.mkfifo(file)
    assert stay()
    os.remove(file)
    file.write_text(two + "\n")
    keys.refresh()
    assert not known(keys, first)


async def test_the_file_is_followed_while_the_service_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "keys"
    file.write_text(new_key("alpha")[1] + "\n")
    keys, threads, loop = Keys(file), [], asyncio.get_running_loop()
    read = asyncio.Event()

    def noted() -> None:
        threads.append(threading.current_thread())
        loop.call_soon_threadsafe(read.set)

    monkeypatch.setattr(module, "LOOK_EVERY", 0.0)
    monkeypatch.setattr(keys, "refresh", noted)
    following = asyncio.create_task(keys.follow())
    await asyncio.wait_for(read.wait(), PATIENCE)
    following.cancel()
    assert threads[0] is not threading.main_thread()


def test_a_key_among_many_is_found_in_one_step(tmp_path: Path) -> None:
    lines = [f"key-{i} {hashlib.sha256(b'%d' % i).hexdigest()} - -" for i in range(20_000)]
    file = tmp_path / "keys"
    file.write_text("\n".join(lines) + "\n")
    keys = Keys(file)
    assert len(keys) == 20_000
    # The last of them, within so few steps of the interpreter that it cannot have been searched for.
    steps = 0

    def counted(frame: Any, event: str, argument: Any) -> Any:
        nonlocal steps
        steps += 1
        return counted

    sys.settrace(counted)
    try:
        assert keys.admit({b"authorization": b"Bearer 19999"}).name == "key-19999"
    finally:
        sys.settrace(None)
    assert 0 < steps < 100


def test_unknown_keys_are_limited_by_address(tmp_path: Path, clock: Clock) -> None:
    key, line = new_key("alpha")
    file = tmp_path / "keys"
    file.write_text(line + "\n")
    keys = Keys(file)

    def status(headers: dict[bytes, bytes], address: str) -> int:
        try:
            keys.admit(headers, address)
        except Refusal as refusal:
            return refusal.problem.type.status
        return 200

    wrong, right = {b"authorization": b"Bearer wrong"}, {b"authorization": b"Bearer " + key.encode()}
    assert [status(wrong, "10.0.0.1") for _ in range(11)] == [401] * 10 + [429]
    # Neither another address nor a known key from the same one is affected.
    assert (status({}, "10.0.0.2"), status(right, "10.0.0.1")) == (401, 200)
    clock.now += 1.0
    assert [status(wrong, "10.0.0.1") for _ in range(2)] == [401, 429]
    for i in range(3 * module.ADDRESSES):
        status(wrong, str(i))
    assert len(keys._wrong) == module.ADDRESSES


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        *(
            (line + "\n", "line 1")
            for line in ("alpha", "alpha 00 - -", f"alpha {'g' * 64} - -", f"alpha {'0' * 64} -1 -")
        ),
        (f"alpha {'0' * 64} - -", "line feed"),
        ("# none\n", "no keys"),
        ("", "line feed"),
    ],
)
def test_a_file_that_cannot_be_used_stops_the_start(tmp_path: Path, text: str, reason: str) -> None:
    file = tmp_path / "keys"
    file.write_text(text)
    with pytest.raises(ValueError, match=reason):
        Keys(file)
    with pytest.raises(FileNotFoundError):
        Keys(tmp_path / "absent")


@pytest.mark.parametrize(("trusted", "others"), [("127.0.0.1", 401), ("192.0.2.0/24", 429), ("", 429)])
async def test_a_trusted_proxy_names_its_clients_and_nobody_else_does(
    tmp_path: Path, trusted: str, others: int
) -> None:
    """Wrong keys are limited by address: ten at once, then one in a second."""
    (tmp_path / "keys").write_text(new_key("somebody")[1] + "\n")
    settings = Settings(keys_file=tmp_path / "keys", forwarded_allow_ips=trusted)
    served = uvicorn.Config(inline_toys(keys_file=tmp_path / "keys"), **server_options(settings))
    served.load()
    transport = httpx.ASGITransport(served.loaded_app, client=("127.0.0.1", 5))
    async with httpx.AsyncClient(transport=transport, base_url="http://test") as client:

        async def status_for(address: str) -> int:
            response = await client.post("/v1/toy", json=GOOD, headers={"X-Forwarded-For": address})
            return response.status_code

        statuses = [await status_for("198.51.100.1") for _ in range(20)]
        assert statuses[:10] == [401] * 10
        assert 429 in statuses
        assert await status_for("198.51.100.2") == others
        # What a client put in front of its address is not believed.
        assert await status_for("198.51.100.9, 198.51.100.1") == 429
