"""Processes by themselves: every request has one end, and a process that is lost takes only its own with it."""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import os
import signal
import socket
import time
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager
from math import inf
from multiprocessing import forkserver
from multiprocessing.context import ForkServerProcess
from pathlib import Path
from random import Random
from threading import Event
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from service.execution.fair_shares import MOST_OF_A_CLIENT
from service.execution.job import DeadlineExceeded, Job, NoProcess, SliceUsed, Stopped, WorkerDied
from service.execution.process_starter import ProcessStarter
from service.execution.worker_pool import Processes
from service.execution.worker_process import Process
from service.http.held_bytes import HeldBytes
from tests.service.conftest import PATIENCE
from tests.service.toy_processes import framed, main

pytestmark = pytest.mark.anyio


@pytest.fixture(scope="module", autouse=True)
def _fork_server() -> Iterator[None]:
    """Leave no fork server behind that has other modules imported than the next one wants."""
    yield
    for pid in fork_servers():
        kill_unnoticed(pid)


@pytest.fixture
def place(tmp_path: Path) -> Path:
    return tmp_path


PLENTY = 100_000_000
"""Bytes that may be held where that is not what is tested."""


def made(place: Path, size: int, lost: list[int], most_held: int = PLENTY) -> Processes:
    held = HeldBytes(most_held)
    return Processes(
        size, main, (str(place),), "tests.service.toy_processes", lost.append, held=held, slice_seconds=inf, reserve=0
    )


@asynccontextmanager
async def warm(place: Path, size: int = 1, most_held: int = PLENTY) -> AsyncIterator[tuple[Processes, list[int]]]:
    lost: list[int] = []
    processes = made(place, size, lost, most_held)
    try:
        async with asyncio.timeout(PATIENCE):
            await processes.start()
        yield processes, lost
    finally:
        await processes.stop()


@asynccontextmanager
async def classes(place: Path) -> AsyncIterator[tuple[Processes, list[bool]]]:
    """Yield the processes of one processor, and a list that is as long as requests have been moved."""
    moved: list[bool] = []
    processes = Processes(
        1,
        main,
        (str(place),),
        "tests.service.toy_processes",
        lambda code: None,
        lambda: moved.append(True),
        held=HeldBytes(PLENTY),
        slice_seconds=0.01,
    )
    try:
        async with asyncio.timeout(PATIENCE):
            await processes.start()
        yield processes, moved
    finally:
        await processes.stop()


def stopped(processes: Processes, job: Job) -> bool:
    """Return whether the process of a request is stopped."""
    process = processes.process_of(job)
    return process is not None and process.stopped


async def until(holds: Callable[[], Any]) -> None:
    async with asyncio.timeout(PATIENCE):
        while not holds():
            await asyncio.sleep(0.002)


def ask(
    processes: Processes,
    request: bytes,
    longest: float = PATIENCE,
    client: str = "client",
) -> Job:
    return processes.submit([framed(request)], client, longest=longest)


def parent_of(pid: int) -> int:
    return int(Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[1])


def fork_servers() -> list[int]:
    """Return the fork servers that this process has started."""
    found = []
    for place in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            if (
                parent_of(int(place.name)) == os.getpid()
                and b"multiprocessing.forkserver" in (place / "cmdline").read_bytes()
            ):
                found.append(int(place.name))
    return found


def begun(place: Path) -> list[str]:
    return (place / "begun").read_text().split() if (place / "begun").exists() else []


def running(pid: int) -> bool:
    """Return whether a process goes on; nobody may be there to take leave of one that has ended."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] not in "ZX"
    except (FileNotFoundError, ProcessLookupError):
        return False


def kill_unnoticed(pid: int) -> None:
    """Kill a process and return when it is dead, without letting the event loop hear of it."""
    os.kill(pid, signal.SIGKILL)
    while running(pid):
        time.sleep(0.001)


def receive(process: Process, data: bytes) -> None:
    """Have a process's messages received, as the event loop does."""
    while data:
        buffer = process.get_buffer(len(data))
        count = min(len(buffer), len(data))
        buffer[:count], data = data[:count], data[count:]
        process.buffer_updated(count)


def holds_together(processes: Processes) -> bool:
    """Return whether all processes are there and have nothing to do."""
    return processes.ready and not any(processes.pids.values())


class TestUnreadAnswers:
    """Each answer has 400 bytes; one client may hold 500."""

    async def test_those_beyond_the_share_of_a_client_stay_in_their_processes(self, place: Path) -> None:
        async with warm(place, 3, 1000) as (processes, _):
            jobs = [ask(processes, b"echo " + bytes(400)) for _ in range(3)]
            await until(lambda: processes.unread == 2)
            received = next(job for job in jobs if job.reply.done())
            assert await received.reply == bytes(400)
            # A question of another client has its answer; nothing more of the first one is begun.
            later = ask(processes, b"echo later")
            assert await ask(processes, b"echo " + b"b" * 400, client="other").reply == b"b" * 400
            assert not later.begun
            for left in (1, 0):
                processes.drop(received)
                await until(
                    lambda left=left: processes.unread == left and sum(job.reply.done() for job in jobs) == 3 - left
                )  # type: ignore[misc]
                jobs.remove(received)
                received = next(job for job in jobs if job.reply.done())
                jobs.append(later)
            processes.drop(received)
            assert await later.reply == b"later"
            await until(lambda: holds_together(processes))

    async def test_one_whose_client_leaves_is_dropped_with_its_process(self, place: Path) -> None:
        async with warm(place, 2, 1000) as (processes, lost):
            jobs = [ask(processes, b"echo " + bytes(400)) for _ in range(2)]
            await until(lambda: processes.unread == 1)
            for job in sorted(jobs, key=lambda job: job.reply.done()):
                processes.drop(job)
            assert processes.unread == 0
            await until(lambda: holds_together(processes))
            assert await ask(processes, b"echo a").reply == b"a"
            assert not lost

    async def test_one_whose_process_dies_is_lost(self, place: Path) -> None:
        async with warm(place, 2, 1000) as (processes, _):
            jobs = [ask(processes, b"last " + bytes(4_000_000)) for _ in range(2)]
            await until(lambda: processes.unread == 1)
            waiting, received = sorted(jobs, key=lambda job: job.reply.done())
            process = processes.process_of(waiting)
            assert process is not None
            kill_unnoticed(process.handle.pid or 0)
            processes.drop(received)
            with pytest.raises(WorkerDied):
                await waiting.reply
            await until(lambda: holds_together(processes))


class TestReady:
    async def test_started_means_that_all_are_ready(self, place: Path) -> None:
        processes = made(place, 3, [])
        assert (processes.ready, processes.any_ready, processes.pids) == (False, False, {})
        await processes.start()
        assert (processes.ready, processes.any_ready) == (True, True)
        assert len(processes.pids) == 3
        assert not any(processes.pids.values())
        assert os.getpid() not in processes.pids
        await processes.stop()
        assert (processes.ready, processes.any_ready, processes.pids) == (False, False, {})

    async def test_what_works_is_reported(self, place: Path) -> None:
        async with warm(place, 2) as (processes, _):
            job = ask(processes, b"wait a")
            await until(lambda: job.begun)
            assert sorted(processes.pids.values()) == [False, True]
            (place / "gate").touch()
            assert await job.reply == b"a"
            assert job.seconds > 0.0
            assert sorted(processes.pids.values()) == [False, False]

    async def test_one_that_dies_before_it_is_ready_is_replaced(
        self, place: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr("service.execution.process_starter.PAUSE", 0.01)
        (place / "stillborn").touch()
        async with warm(place, 2) as (processes, lost):
            assert processes.ready
            assert await ask(processes, b"echo a").reply == b"a"
            await until(lambda: lost)
            assert lost == [3]

    async def test_those_that_die_at_once_are_not_replaced_without_a_pause(
        self, place: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """A fault at the start would otherwise take the machine for itself."""
        monkeypatch.setattr("service.execution.process_starter.PAUSE", 1e6)
        (place / "stillborn").touch()
        lost: list[int] = []
        processes = made(place, 1, lost)
        starting = asyncio.create_task(processes.start())
        await until(lambda: lost)
        assert processes.pids == {}
        assert not starting.done()
        starting.cancel()
        await processes.stop()

    async def test_whatever_was_lacking_starting_is_tried_again(
        self, place: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
    ) -> None:
        """A pair of sockets or a thread."""
        async with warm(place, 2) as (processes, _):
            failures = iter([OSError(24, "Too many open files"), RuntimeError("can't start new thread")])
            pair = socket.socketpair

            def lacking() -> tuple[socket.socket, socket.socket]:
                for failure in failures:
                    raise failure
                return pair()

            monkeypatch.setattr("service.execution.process_starter.socket.socketpair", lacking)
            monkeypatch.setattr("service.execution.process_starter.PAUSE", 0.01)
            before = set(processes.pids)
            for pid in before:
                os.kill(pid, signal.SIGKILL)
            await until(lambda: not before & set(processes.pids) and processes.ready)
            assert next(failures, None) is None
            assert [record.message for record in caplog.records] == ["a compute process could not be started"] * 2
            assert await ask(processes, b"echo a").reply == b"a"

    async def test_attempts_become_rare_while_nothing_can_be_started(
        self, place: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """Each of them is logged with its traceback: two a second would fill a disk."""
        async with warm(place) as (processes, _):
            pauses: list[float] = []
            pair, sleep = socket.socketpair, asyncio.sleep

            def lacking() -> tuple[socket.socket, socket.socket]:
                if len(pauses) < 6:
                    raise OSError(28, "No space left on device")
                return pair()

            async def noted(seconds: float) -> None:
                # Other waits are those of this test.
                if seconds in (0.0, 0.0011, 0.0022, 0.0044, 0.005):
                    pauses.append(seconds)
                await sleep(seconds)

            monkeypatch.setattr("service.execution.process_starter.socket.socketpair", lacking)
            monkeypatch.setattr("service.execution.process_starter.PAUSE", 0.0011)
            monkeypatch.setattr("service.execution.process_starter.LONGEST_PAUSE", 0.005)
            monkeypatch.setattr("service.execution.process_starter.asyncio.sleep", noted)
            (before,) = processes.pids
            os.kill(before, signal.SIGKILL)
            await until(lambda: processes.ready and before not in processes.pids)
            assert pauses[:6] == [0.0, 0.0011, 0.0022, 0.0044, 0.005, 0.005]


class TestMessages:
    @given(st.lists(st.binary(max_size=300), max_size=6), st.lists(st.integers(0, 2000), max_size=12))
    @settings(deadline=None, derandomize=True)
    def test_messages_are_heard_however_they_are_cut(self, messages: list[bytes], cuts: list[int]) -> None:
        heard: list[bytes] = []
        announced: list[int] = []

        class Pool:
            def announced(self, process: Process, length: int) -> None:
                announced.append(length)

            def heard(self, process: Process, message: memoryview | None) -> None:
                heard.append(bytes(message or b""))

        process = Process(Pool(), None)  # type: ignore[arg-type]
        stream = b"".join(map(framed, messages))
        edges = [0, *sorted(min(cut, len(stream)) for cut in cuts), len(stream)]
        for start, end in itertools.pairwise(edges):
            receive(process, stream[start:end])
            # Nothing is held back that is whole.
            whole, count = 0, 0
            for message in messages:
                whole += len(framed(message))
                count += whole <= end
            assert len(heard) == count
        assert heard == messages
        assert announced == [len(message) for message in messages if message]

    async def test_requests_and_replies_of_any_size_come_through_whole(self, place: Path) -> None:
        async with warm(place) as (processes, _):
            for size in (1, 7, 8, 9, 65_535, 65_536, 3_000_001):
                text = Random(size).randbytes(size)
                assert await ask(processes, b"echo " + text).reply == text


class TestQueue:
    async def test_requests_are_begun_in_the_order_in_which_they_came(self, place: Path) -> None:
        async with warm(place) as (processes, _):
            jobs = [ask(processes, b"wait 0"), *(ask(processes, b"echo %d" % i) for i in range(1, 6))]
            await until(lambda: jobs[0].begun)
            assert not any(job.begun for job in jobs[1:])
            (place / "gate").touch()
            assert [await job.reply for job in jobs] == [b"%d" % i for i in range(6)]
            assert begun(place) == [*"012345"]

    async def test_as_many_are_worked_on_as_there_are_processes(self, place: Path) -> None:
        async with warm(place, 3) as (processes, _):
            jobs = [ask(processes, b"wait %d" % i) for i in range(5)]
            await until(lambda: len(begun(place)) == 3)
            assert all(processes.pids.values())
            (place / "gate").touch()
            assert [await job.reply for job in jobs] == [b"0", b"1", b"2", b"3", b"4"]

    async def test_nobody_is_refused_for_what_others_have_taken(self, place: Path) -> None:
        """It waits for longer than it may work."""
        async with warm(place) as (processes, _):
            ahead, behind = ask(processes, b"wait a"), ask(processes, b"echo b", longest=0.02, client="other")
            await asyncio.sleep(0.1)
            assert (ahead.begun, behind.begun, behind.reply.done()) == (True, False, False)
            (place / "gate").touch()
            assert [await ahead.reply, await behind.reply] == [b"a", b"b"]

    async def test_clients_have_their_turns_in_rotation(self, place: Path) -> None:
        async with warm(place) as (processes, _):
            jobs = [ask(processes, b"wait 0", client="many")]
            await until(lambda: jobs[0].begun)
            jobs += [ask(processes, b"echo %d" % i, client="many") for i in range(1, 5)]
            jobs += [ask(processes, b"echo %d" % i, client="few") for i in (5, 6)]
            (place / "gate").touch()
            for job in jobs:
                await job.reply
            assert begun(place) == [*"0152634"]

    async def test_one_that_is_dropped_while_it_waits_is_never_begun(self, place: Path) -> None:
        async with warm(place) as (processes, lost):
            before = set(processes.pids)
            jobs = [ask(processes, b"wait 0"), *(ask(processes, b"echo %d" % i) for i in range(1, 5))]
            processes.drop(jobs[2])
            assert jobs[2].reply.cancelled()
            (place / "gate").touch()
            assert [await jobs[i].reply for i in (0, 1, 3, 4)] == [b"0", b"1", b"3", b"4"]
            assert begun(place) == [*"0134"]
            assert set(processes.pids) == before
            assert lost == []


class TestLoss:
    @pytest.mark.parametrize(
        ("request_", "code"), [(b"die a", -signal.SIGKILL), (b"exit 0", 0), (b"exit 7", 7), (b"tear a", 6)]
    )
    async def test_a_process_that_dies_fails_its_own_request_only(
        self, place: Path, request_: bytes, code: int
    ) -> None:
        async with warm(place, 2) as (processes, lost):
            bystander = ask(processes, b"wait b")
            await until(lambda: bystander.begun)
            dying, waiting = ask(processes, request_), ask(processes, b"echo c")
            with pytest.raises(WorkerDied):
                await dying.reply
            assert await waiting.reply == b"c"
            assert not bystander.reply.done()
            (place / "gate").touch()
            assert await bystander.reply == b"b"
            await until(lambda: lost and holds_together(processes))
            assert lost == [code]

    async def test_every_exit_code_is_reported_as_it_was(self, place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        """Starting a process reads the codes of others, which those who bury them read too."""
        read = forkserver.read_signed  # type: ignore[attr-defined]

        def slow(end: int) -> int:
            time.sleep(0.005)
            return int(read(end))

        monkeypatch.setattr(forkserver, "read_signed", slow)
        async with warm(place, 4) as (processes, lost):
            jobs = [ask(processes, b"exit 7") for _ in range(24)]
            outcomes = await asyncio.gather(*(job.reply for job in jobs), return_exceptions=True)
            assert {type(outcome) for outcome in outcomes} == {WorkerDied}
            await until(lambda: len(lost) == 24)
            assert set(lost) == {7}

    async def test_a_reply_that_was_sent_counts_though_its_process_dies(self, place: Path) -> None:
        async with warm(place) as (processes, lost):
            assert await ask(processes, b"last a").reply == b"a"
            assert await ask(processes, b"echo b").reply == b"b"
            await until(lambda: lost)
            assert lost == [5]

    async def test_requests_that_were_not_begun_go_back_to_the_head_of_the_queue(self, place: Path) -> None:
        """From a process that lay dead when it was given work, and from one that died before it began."""
        async with warm(place) as (processes, lost):
            (before,) = processes.pids
            kill_unnoticed(before)
            (place / "vanish").touch()
            jobs = [ask(processes, b"vanish %d" % i) for i in range(5)]
            assert [await job.reply for job in jobs] == [b"%d" % i for i in range(5)]
            assert begun(place) == [*"01234"]
            await until(lambda: len(lost) == 2)
            assert sorted(lost) == [-signal.SIGKILL, 4]
            assert before not in processes.pids

    async def test_a_process_that_is_stopped_loses_its_request_to_another(
        self, place: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
    ) -> None:
        monkeypatch.setattr("service.execution.worker_pool.BEGIN_SECONDS", 0.2)
        async with warm(place, 2) as (processes, _):
            before = set(processes.pids)
            for pid in before:
                os.kill(pid, signal.SIGSTOP)
            jobs = [ask(processes, b"echo %d" % i) for i in range(3)]
            assert [await job.reply for job in jobs] == [b"0", b"1", b"2"]
            assert sorted(begun(place)) == [*"012"]
            await until(lambda: holds_together(processes))
            assert not before & set(processes.pids)
            assert not any(map(running, before))
            messages = [record.message for record in caplog.records]
            assert messages.count("a compute process did not begin a request") >= 2

    async def test_stopping_waits_until_no_handle_is_being_closed(
        self, place: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """At its exit Python ends all children, and fails on one whose handle a thread closes meanwhile."""
        closed, bury = [], ProcessStarter._bury

        def slowly(starter: ProcessStarter, *handle: Any) -> None:
            time.sleep(0.3)
            bury(starter, *handle)
            closed.append(handle)

        monkeypatch.setattr(ProcessStarter, "_bury", slowly)
        async with warm(place, 2):
            pass
        assert len(closed) >= 2

    async def test_what_was_not_begun_is_not_left_without_an_end(
        self, place: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """Where no process can be started any more."""
        async with warm(place) as (processes, _):

            def lacking() -> None:
                raise OSError(24, "Too many open files")

            monkeypatch.setattr("service.execution.process_starter.socket.socketpair", lacking)
            (pid,) = processes.pids
            kill_unnoticed(pid)
            job, behind = ask(processes, b"echo a", longest=0.05), ask(processes, b"echo b", longest=0.05)
            for one in (job, behind):
                with pytest.raises(NoProcess):
                    await one.reply
            assert begun(place) == []
            assert not processes.any_ready

    async def test_all_goes_on_though_the_fork_server_is_dead(self, place: Path) -> None:
        async with warm(place, 2) as (processes, _):
            before = set(processes.pids)
            (server,) = {parent_of(pid) for pid in before}
            os.kill(server, signal.SIGKILL)
            for job in [ask(processes, b"spin %d" % i, longest=0.05) for i in range(2)]:
                with pytest.raises(DeadlineExceeded):
                    await job.reply
            await until(lambda: not any(map(running, before)))
            assert await ask(processes, b"echo a").reply == b"a"
            await until(lambda: holds_together(processes))
            assert not before & set(processes.pids)

    async def test_every_request_has_one_end_whatever_happens(self, place: Path) -> None:
        """Replies, deaths, kills from outside, drops and deadlines in any order; the seed is fixed."""
        chance = Random(20261121)
        (place / "gate").touch()
        async with warm(place, 3) as (processes, _):
            jobs: list[tuple[bytes, Job]] = []
            for i in range(150):
                word = chance.choice([b"echo", b"echo", b"wait", b"die", b"last", b"vanish", b"tear"])
                if word == b"vanish":
                    (place / "vanish").touch()
                jobs.append((word, ask(processes, b"%b %d" % (word, i))))
                if chance.random() < 0.1:
                    processes.drop(chance.choice(jobs)[1])
                if chance.random() < 0.05 and processes.pids:
                    # It may be dead already.
                    with contextlib.suppress(ProcessLookupError):
                        os.kill(chance.choice([*processes.pids]), signal.SIGKILL)
                if chance.random() < 0.3:
                    await asyncio.sleep(0.005)
            async with asyncio.timeout(PATIENCE):
                outcomes = await asyncio.gather(*(job.reply for _, job in jobs), return_exceptions=True)
            for i, ((word, _), outcome) in enumerate(zip(jobs, outcomes, strict=True)):
                if isinstance(outcome, BaseException):
                    assert isinstance(outcome, (WorkerDied, asyncio.CancelledError))
                else:
                    assert outcome == b"%d" % i
                    assert word not in (b"die", b"tear")
            assert {type(outcome) for outcome in outcomes} == {memoryview, WorkerDied, asyncio.CancelledError}
            found = begun(place)
            assert len(set(found)) == len(found)
            await until(lambda: holds_together(processes))
            assert len(processes.pids) == 3


class TestKilled:
    async def test_one_that_works_for_too_long_is_stopped(self, place: Path) -> None:
        async with warm(place, 2) as (processes, lost):
            late = ask(processes, b"spin a", longest=0.05)
            (pid,) = (pid for pid, works in processes.pids.items() if works)
            with pytest.raises(DeadlineExceeded):
                await late.reply
            await until(lambda: not running(pid) and holds_together(processes))
            assert pid not in processes.pids
            assert late.used >= 0.05
            # One that only waits has its end, too.
            with pytest.raises(DeadlineExceeded):
                await ask(processes, b"wait a", longest=0.005).reply
            assert await ask(processes, b"echo b").reply == b"b"
            # It is not reported as a loss: nobody need look for its reason. One that comes later is.
            assert lost == []
            with pytest.raises(WorkerDied):
                await ask(processes, b"exit 7").reply
            await until(lambda: lost)
            assert lost == [7]

    async def test_one_that_is_dropped_is_stopped_and_the_next_is_answered(self, place: Path) -> None:
        async with warm(place) as (processes, lost):
            dropped, following = ask(processes, b"wait a"), ask(processes, b"echo b")
            await until(lambda: dropped.begun)
            (pid,) = processes.pids
            processes.drop(dropped)
            assert dropped.reply.cancelled()
            # It is as good as gone at once: nothing is given to it, and nothing counts on it.
            assert (processes.ready, processes.any_ready) == (False, False)
            assert await following.reply == b"b"
            assert not running(pid)
            assert pid not in processes.pids
            with pytest.raises(WorkerDied):
                await ask(processes, b"exit 7").reply
            await until(lambda: lost)
            assert lost == [7]

    async def test_dropping_what_is_answered_harms_nothing(self, place: Path) -> None:
        async with warm(place) as (processes, _):
            before = set(processes.pids)
            job = ask(processes, b"echo a")
            assert await job.reply == b"a"
            following = ask(processes, b"wait b")
            for _ in range(2):
                processes.drop(job)
            (place / "gate").touch()
            assert await following.reply == b"b"
            assert await job.reply == b"a"
            assert set(processes.pids) == before

    async def test_dropping_twice_kills_one_process_only(self, place: Path) -> None:
        async with warm(place, 2) as (processes, _):
            dropped, bystander = ask(processes, b"wait a"), ask(processes, b"wait b")
            await until(lambda: dropped.begun and bystander.begun)
            for _ in range(2):
                processes.drop(dropped)
            (place / "gate").touch()
            assert await bystander.reply == b"b"

    async def test_a_request_that_nobody_waits_for_any_more_holds_up_nothing(self, place: Path) -> None:
        """Its reply was given up by who waited, but it was not dropped yet."""
        async with warm(place) as (processes, lost):
            given_up = ask(processes, b"wait a")
            given_up.reply.cancel()
            (place / "gate").touch()
            assert await ask(processes, b"echo b").reply == b"b"
            for request in (b"die c", b"vanish d"):
                (place / "vanish").touch()
                ask(processes, request).reply.cancel()
                assert await ask(processes, b"echo e").reply == b"e"
            await until(lambda: len(lost) == 2)
            # Nor is it begun again.
            assert begun(place) == [*"abcee"]

    async def test_what_a_killed_process_still_says_is_not_heard(self, place: Path) -> None:
        async with warm(place) as (processes, _):
            late = ask(processes, b"wait a")
            await until(lambda: late.begun)
            process = processes.process_of(late)
            assert process is not None
            processes.drop(late)
            job = ask(processes, b"echo b")
            receive(process, framed(b"a") + framed(b""))
            assert not job.begun
            assert await job.reply == b"b"


class TestClasses:
    """What uses more than its slice goes on in the long class, and nothing starts over."""

    async def test_a_long_request_leaves_its_place_to_short_ones(self, place: Path) -> None:
        async with classes(place) as (processes, moved):
            long = ask(processes, b"spin a")
            await until(lambda: moved)
            assert (processes.long, long.begun, long.reply.done()) == (1, True, False)
            for i in range(5):
                assert await ask(processes, b"echo %d" % i).reply == b"%d" % i
            assert not long.reply.done()
            (place / "gate").touch()
            assert await long.reply == b"a"
            assert begun(place) == [*"a01234"]
            assert (processes.long, processes.waiting, len(moved)) == (0, 0, 1)

    async def test_one_that_is_not_to_become_long_is_ended_with_its_slice(self, place: Path) -> None:
        async with classes(place) as (processes, moved):
            for i in range(3):
                with pytest.raises(SliceUsed):
                    await processes.submit(
                        [framed(b"spin %d" % i)], "client", longest=PATIENCE, may_be_long=False
                    ).reply
            assert await ask(processes, b"echo a").reply == b"a"
            assert (processes.long, len(moved)) == (0, 0)
            await until(lambda: holds_together(processes))

    async def test_what_waits_without_using_its_slice_is_moved_too(self, place: Path) -> None:
        async with classes(place) as (processes, moved):
            idling = ask(processes, b"wait a")
            await until(lambda: moved)
            assert await ask(processes, b"echo b").reply == b"b"
            (place / "gate").touch()
            assert await idling.reply == b"a"

    async def test_long_requests_have_their_turns_and_only_one_runs_at_a_time(self, place: Path) -> None:
        async with classes(place) as (processes, _):
            jobs = [ask(processes, b"spin %d" % i, client="ab"[i % 2]) for i in range(4)]
            await until(lambda: processes.long == 4)
            for job in jobs:
                since = job.seconds
                await until(lambda job=job, since=since: job.seconds > since)
            for _ in range(20):
                assert sum(stopped(processes, job) for job in jobs) == 3
                await asyncio.sleep(0.01)
            (place / "gate").touch()
            assert [await job.reply for job in jobs] == [b"0", b"1", b"2", b"3"]
            assert begun(place) == [*"0123"]

    async def test_a_client_with_many_long_requests_has_the_next_one_wait(self, place: Path) -> None:
        async with classes(place) as (processes, moved):
            jobs = [ask(processes, b"wait %d" % i, client="many") for i in range(MOST_OF_A_CLIENT + 2)]
            await until(lambda: len(moved) == MOST_OF_A_CLIENT)
            assert await ask(processes, b"echo a", client="other").reply == b"a"
            assert processes.waiting == 2
            assert [job.begun for job in jobs[-2:]] == [False, False]
            assert [*processes.waiting_of("many")] == jobs[-2:]
            (place / "gate").touch()
            for job in jobs:
                await job.reply

    async def test_where_there_is_no_room_for_another_long_one_it_waits_for_it(
        self, place: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr("service.execution.fair_shares.MOST", 2)
        async with classes(place) as (processes, moved):
            first = [ask(processes, b"wait %d" % i, client=str(i)) for i in range(2)]
            await until(lambda: len(moved) == 2)
            third = ask(processes, b"wait b", client="b")
            await until(lambda: third.is_long)
            assert (processes.long, processes.waiting, third.reply.done()) == (2, 1, False)
            assert await ask(processes, b"echo c", client="c").reply == b"c"
            processes.drop(first[0])
            await until(lambda: len(moved) == 3)
            (place / "gate").touch()
            assert [await job.reply for job in (first[1], third)] == [b"1", b"b"]

    async def test_the_deadline_counts_the_processor_time_that_it_uses(self, place: Path) -> None:
        async with classes(place) as (processes, moved):
            jobs = [ask(processes, b"spin %d" % i, longest=0.25) for i in range(2)]
            await until(lambda: len(moved) == 2)
            for job in jobs:
                with pytest.raises(DeadlineExceeded):
                    await job.reply
            assert all(job.used >= 0.25 for job in jobs)
            # Both together had half a second of the one processor.
            assert max(job.waited for job in jobs) >= 0.45
            await until(lambda: holds_together(processes))

    async def test_what_is_stopped_can_be_dropped(self, place: Path) -> None:
        async with classes(place) as (processes, moved):
            jobs = [ask(processes, b"wait %d" % i) for i in range(2)]
            await until(lambda: len(moved) == 2 and any(stopped(processes, job) for job in jobs))
            (dropped,) = (job for job in jobs if stopped(processes, job))
            process = processes.process_of(dropped)
            assert process is not None
            pid = process.handle.pid or 0
            processes.drop(dropped)
            await until(lambda: not running(pid))
            (place / "gate").touch()
            await next(job for job in jobs if job is not dropped).reply
            await until(lambda: holds_together(processes))

    async def test_processes_left_over_from_long_requests_are_ended(self, place: Path) -> None:
        async with classes(place) as (processes, moved):
            jobs = [ask(processes, b"wait %d" % i, client=str(i)) for i in range(8)]
            await until(lambda: len(moved) == 8)
            assert len(processes.pids) >= 9
            (place / "gate").touch()
            for job in jobs:
                await job.reply
            await until(lambda: len(processes.pids) <= 5 and holds_together(processes))


class TestStop:
    async def test_what_works_and_what_waits_is_reported_and_nothing_goes_on(self, place: Path) -> None:
        lost: list[int] = []
        processes = made(place, 2, lost)
        await processes.start()
        jobs = [ask(processes, b"wait %d" % i) for i in range(4)]
        answered = ask(processes, b"echo a")
        processes.drop(answered)
        await until(lambda: sum(job.begun for job in jobs) == 2)
        pids = set(processes.pids)
        await processes.stop()
        for job in jobs:
            with pytest.raises(Stopped):
                await job.reply
        await until(lambda: not any(map(running, pids)))
        assert processes.pids == {}
        # Nothing is handed out, started or reported after it.
        with pytest.raises(Stopped):
            await ask(processes, b"echo a").reply
        assert begun(place) == ["0", "1"] or begun(place) == ["1", "0"]
        assert lost == []

    async def test_processes_that_are_being_started_do_not_outlive_it(
        self, place: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        processes = made(place, 2, [])
        asked, stopped, spawned = Event(), Event(), []
        start = ForkServerProcess.start

        def slow(handle: ForkServerProcess) -> None:
            asked.set()
            stopped.wait(PATIENCE)
            start(handle)
            spawned.append(handle)

        monkeypatch.setattr(ForkServerProcess, "start", slow)
        starting = asyncio.create_task(processes.start())
        await until(asked.is_set)
        starting.cancel()
        await processes.stop()
        stopped.set()
        await until(lambda: spawned)
        for handle in spawned:
            await asyncio.to_thread(handle.join, PATIENCE)
            assert handle.exitcode is not None
        assert processes.pids == {}

    async def test_it_may_come_before_the_start_and_twice(self, place: Path) -> None:
        processes = made(place, 1, [])
        await processes.stop()
        await processes.stop()
        with pytest.raises(Stopped):
            await ask(processes, b"echo a").reply
