"""Work in a thread of its own: its result, its failure, its being given up, the end of the loop."""

import asyncio
import threading

import pytest

from service.execution.daemon_thread import call_soon_if_open, run_in_daemon_thread

pytestmark = pytest.mark.anyio


async def test_the_result_and_the_loop_goes_on_meanwhile() -> None:
    allowed = threading.Event()
    task = asyncio.create_task(run_in_daemon_thread(lambda: (allowed.wait(20), threading.current_thread().daemon)))
    await asyncio.sleep(0)
    assert not task.done()
    allowed.set()
    assert await task == (True, True)


async def test_a_failure_is_reported_as_it_was() -> None:
    with pytest.raises(KeyError, match="lost"):
        await run_in_daemon_thread(lambda: {}["lost"])


async def test_what_is_given_up_disturbs_nobody() -> None:
    allowed, ended = threading.Event(), threading.Event()
    task = asyncio.create_task(run_in_daemon_thread(lambda: (allowed.wait(20), ended.set())))
    await asyncio.sleep(0)
    task.cancel()
    with pytest.raises(asyncio.CancelledError):
        await task
    failures: list[dict[str, object]] = []
    asyncio.get_running_loop().set_exception_handler(lambda _, context: failures.append(context))
    allowed.set()
    assert await asyncio.to_thread(ended.wait, 20)
    await asyncio.sleep(0.05)
    assert failures == []


def test_a_loop_that_is_closed_is_sent_nothing() -> None:
    loop = asyncio.new_event_loop()
    loop.close()
    told: list[int] = []
    call_soon_if_open(loop, told.append, 1)
    assert told == []
