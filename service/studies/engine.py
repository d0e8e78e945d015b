"""Works on the studies of a folder: hands stretches of members to the cluster and stores what comes back.

Which members make a stretch, which process has it and when it ends has no influence on any result. Studies have their
turns in rotation.

A stretch whose process has ended is suspect: it may have been the reason, or merely have waited in that process. It is
tried again with nothing beside it. If the process ends again it is divided, until a single member is left, whose result
is then that it has none.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from queue import Empty, SimpleQueue
from typing import Any

from service.execution.worker import Terms
from service.observability.logs import LOG
from service.problem_types import OVERDUE
from service.problems import Refusal
from service.studies.chunk_files import Chunk, ChunkFiles, CorruptedChunk
from service.studies.cluster import TRIED_AGAIN, Cluster
from service.studies.one_answer import compute_answer
from service.studies.store import Store, reason_of
from service.studies.study import FAILED
from service.studies.summary import summary
from service.studies.task import Computed, compute, end_process, trial, without_answer
from service.studies.unfinished_study import CHUNK_SECONDS, TRIAL, Stretch, UnfinishedStudy, gaps, stretch_seconds

AHEAD = 2
"""Stretches that each process of the cluster is given at a time, so that none waits for work."""

FASTEST = 1e-6
"""Processor time of a member at least (s)."""

MOST_ENDED = 100
"""Processes that a study may end, with waiting stretches counted as well; beyond, it has failed."""

TURN = 0.1
"""Seconds between two looks at the database."""

GATHERING = 60.0
"""Seconds in which a result must have travelled."""

ENDING = 10.0
"""Seconds in which a process that is ended must have gone."""

PAUSE = 2.0
"""Seconds after which something is tried again that failed for reasons outside of the study."""


class Engine:
    """Works on the studies in a store.

    `longest` is the time that a stretch of members may take beyond what is predicted, `longest_answer` that of a whole
    answer (s).
    """

    def __init__(
        self, store: Store, files: ChunkFiles, cluster: Cluster, terms: Terms, longest: float, longest_answer: float
    ) -> None:
        self._store, self._files, self._cluster, self._terms = store, files, cluster, terms
        self._longest, self._longest_answer = longest, longest_answer
        self._unfinished: dict[str, UnfinishedStudy] = {}
        self._done: SimpleQueue[Any] = SimpleQueue()
        self._processes, self._counted = 0, 0.0
        self._alone = False
        self._statistics_thread = ThreadPoolExecutor(1, "statistics")

    def turn(self) -> bool:
        """Do what there is to do now, waiting a moment for results; return whether studies are unfinished."""
        try:
            self._follow()
            if not self._unfinished:
                time.sleep(TURN)
                return False
            self._hand_over()
            self._collect()
            self._end_overdue()
        except OSError as fault:
            # A connection may break at any call.
            self._say(TRIED_AGAIN, fault)
            self._cluster.close()
            time.sleep(PAUSE)
            return True
        for unfinished in [*self._unfinished.values()]:
            if unfinished.done:
                self._finish(unfinished)
        return True

    def stop(self) -> None:
        """Leave everything as it is stored."""
        self._unfinished.clear()
        self._statistics_thread.shutdown(wait=False, cancel_futures=True)
        self._cluster.close()

    def _follow(self) -> None:
        """Take up new studies, and let go of those that were dismissed."""
        unfinished = {study.id: study for study in self._store.unfinished()}
        for identity in [*self._unfinished]:
            if identity not in unfinished:
                self._let_go(self._unfinished.pop(identity))
                try:
                    self._files.remove(identity)
                except OSError as fault:
                    # They go when the study is removed.
                    LOG.error("results cannot be removed", extra={"study": identity, "reason": str(fault)})
        for identity, study in unfinished.items():
            if identity not in self._unfinished:
                stored = self._store.chunks(identity)
                each = max(study.plan["seconds"] / study.count, FASTEST)
                missing = deque(gaps(stored, study.count))
                request = self._store.request(identity)
                # Of one answer, the trial would be all of the work.
                tried = bool(stored) or study.whole
                self._unfinished[identity] = UnfinishedStudy(study, missing, each, request, tried=tried)
                LOG.info("a study is worked on", extra={"study": identity, "members": study.count, "done": study.done})

    def _let_go(self, unfinished: UnfinishedStudy) -> None:
        futures = [*unfinished.in_flight]
        if futures and self._cluster.connected:
            client = self._cluster.client
            # A thread cannot be ended: processes that would be busy for long with these members are.
            long = unfinished.study.whole or unfinished.each > CHUNK_SECONDS
            busy = _processes_with({future.key for future in futures}, client) if long else []
            client.cancel(futures, force=True)
            self._end_processes(busy)
        unfinished.in_flight.clear()

    def _end_processes(self, addresses: list[str]) -> None:
        """End processes and wait until they are gone: what they would be given meanwhile would go with them."""
        if not addresses:
            return
        client = self._cluster.client
        client.run(end_process, workers=addresses, wait=False, on_error="ignore")
        until = time.monotonic() + ENDING
        while set(addresses) & set(client.nthreads()) and time.monotonic() < until:
            time.sleep(0.02)

    def _hand_over(self) -> None:
        client = self._cluster.open()
        for identity, unfinished in self._unfinished.items():
            if not unfinished.begun:
                unfinished.begun = True
                self._store.begin(identity)
        if time.monotonic() - self._counted > 1.0:
            self._processes = max(1, sum(client.nthreads().values()))
            self._counted = time.monotonic()
        busy = sum(len(unfinished.in_flight) for unfinished in self._unfinished.values())
        suspected = next((unfinished for unfinished in self._unfinished.values() if unfinished.suspects), None)
        if suspected is not None:
            # What is in flight comes back first.
            if not busy:
                self._alone = True
                self._submit(suspected, suspected.suspects.popleft())
            return
        if self._alone and busy:
            return
        self._alone = False
        for unfinished in self._unfinished.values():
            if not unfinished.tried:
                unfinished.tried = True
                self._hand(unfinished, TRIAL, trial, self._longest)
        for _ in range(AHEAD * self._processes - busy):
            # A whole answer holds its process to its end: members of studies keep half of the processes.
            answers = sum(len(one.in_flight) for one in self._unfinished.values() if one.study.whole)
            full = answers >= max(1, self._processes // 2)
            waiting = [one for one in self._unfinished.values() if one.missing and not (full and one.study.whole)]
            if not waiting:
                return
            unfinished = min(waiting, key=lambda one: len(one.in_flight))
            self._submit(unfinished, unfinished.next_stretch(self._processes))

    def _submit(self, unfinished: UnfinishedStudy, stretch: Stretch) -> None:
        # A process that others hold up comes back in time nevertheless.
        longest = 2.0 * stretch_seconds(self._processes)
        if unfinished.study.whole:
            self._hand(unfinished, stretch, compute_answer, unfinished.study.plan["path"])
        else:
            self._hand(unfinished, stretch, compute, *stretch, longest)

    def _hand(
        self, unfinished: UnfinishedStudy, stretch: Stretch, work: Callable[..., object], *arguments: object
    ) -> None:
        future = self._cluster.client.submit(work, self._terms, unfinished.request, *arguments, pure=False)
        unfinished.in_flight[future] = stretch, time.monotonic()
        future.add_done_callback(self._done.put)

    def _collect(self) -> None:
        """Store what has come back, after waiting for the first of it."""
        patience = TURN
        while True:
            try:
                future = self._done.get(timeout=patience) if patience else self._done.get_nowait()
            except Empty:
                return
            patience = 0.0
            unfinished = next((one for one in self._unfinished.values() if future in one.in_flight), None)
            if unfinished is not None:
                stretch, _ = unfinished.in_flight.pop(future)
                self._settle(unfinished, stretch, future)

    def _settle(self, unfinished: UnfinishedStudy, stretch: Stretch, future: Any) -> None:
        from distributed.scheduler import KilledWorker

        if future.status != "error":
            try:
                found = future.result(timeout=GATHERING)
            except Exception:
                # The scheduler has gone, or the process that had the result.
                if stretch == TRIAL:
                    unfinished.tried = False
                else:
                    unfinished.missing.appendleft(stretch)
                return
            if stretch != TRIAL:
                self._keep(unfinished, stretch, found)
            elif found:
                self._fail(unfinished, f"nearly all members are refused: {found}")
            return
        fault = future.exception()
        if isinstance(fault, KilledWorker):
            self._after_death(unfinished, stretch, "worker-lost")
            return
        LOG.error("a stretch has failed", extra={"study": unfinished.study.id, "fault": repr(fault)})
        self._fail(unfinished, f"the cluster could not compute its members: {type(fault).__name__}")

    def _after_death(self, unfinished: UnfinishedStudy, stretch: Stretch, code: str) -> None:
        start, stop = stretch
        if stretch == TRIAL:
            # Which of its members it was, and whether others have answers, the stretches show.
            return
        unfinished.ended += 1
        if unfinished.ended > MOST_ENDED:
            self._fail(unfinished, f"its members ended {unfinished.ended} processes")
        elif unfinished.study.whole and (self._alone or code == OVERDUE):
            self._fail(unfinished, f"{code}: the process that computed the answer was ended")
        elif not self._alone:
            unfinished.suspects.append(stretch)
        elif stop - start > 1:
            middle = (start + stop) // 2
            unfinished.suspects.extendleft(((middle, stop), (start, middle)))
        elif (deaths := unfinished.deaths.get(stretch, 0) + 1) < 2:
            unfinished.deaths[stretch] = deaths
            unfinished.suspects.append(stretch)
        else:
            self._keep(unfinished, stretch, without_answer(self._terms, unfinished.request, start, code))

    def _fail(self, unfinished: UnfinishedStudy, message: str) -> None:
        LOG.error("a study has failed", extra={"study": unfinished.study.id, "reason": message})
        self._let_go(self._unfinished.pop(unfinished.study.id))
        self._store.end(unfinished.study.id, FAILED, message)

    def _keep(self, unfinished: UnfinishedStudy, stretch: Stretch, found: Computed) -> None:
        start, stop = stretch[0], stretch[0] + found.members
        if found.reason:
            self._fail(unfinished, found.reason)
            return
        try:
            self._files.write(unfinished.study.id, start, stop, found.data)
            self._store.add_chunk(unfinished.study.id, start, stop, found.failed, found.seconds)
            if unfinished.study.whole:
                self._store.note_bytes(unfinished.study.id, len(found.data))
        except Exception as fault:
            # A full disk, most often: the members are computed again when there is room.
            unfinished.missing.appendleft(stretch)
            self._say("results cannot be stored, which is tried again", fault)
            time.sleep(PAUSE)
            return
        if stop < stretch[1]:
            # Its time was up.
            unfinished.missing.appendleft((stop, stretch[1]))
        unfinished.each = max(FASTEST, 0.5 * (unfinished.each + found.seconds / found.members))

    def _end_overdue(self) -> None:
        """End processes that have had a stretch for much longer than predicted."""
        now = time.monotonic()
        for unfinished in [*self._unfinished.values()]:
            for future, (stretch, since) in [*unfinished.in_flight.items()]:
                expected = unfinished.each * (stretch[1] - stretch[0])
                patience = AHEAD * (self._longest + 20.0 * expected)
                if now - since <= (self._longest_answer if unfinished.study.whole else patience):
                    continue
                client = self._cluster.client
                busy = _processes_with({future.key}, client)
                if not busy:
                    # It still waits for a process.
                    unfinished.in_flight[future] = stretch, now
                    continue
                del unfinished.in_flight[future]
                client.cancel([future], force=True)
                self._end_processes(busy)
                self._after_death(unfinished, stretch, OVERDUE)

    def _finish(self, unfinished: UnfinishedStudy) -> None:
        """Have the statistics formed, beside what other studies compute; damaged stretches are computed again."""
        study = unfinished.study
        if unfinished.finishing is None:
            unfinished.finishing = self._statistics_thread.submit(self._statistics, unfinished)
            unfinished.finishing.add_done_callback(lambda _: self._done.put(None))
            return
        if not unfinished.finishing.done():
            return
        finished, unfinished.finishing = unfinished.finishing, None
        try:
            damaged, statistics = finished.result()
        except (OSError, Refusal) as fault:
            self._say("results cannot be read, which is tried again", fault)
            time.sleep(PAUSE)
            return
        except Exception as fault:
            self._fail(unfinished, f"its statistics could not be formed: {type(fault).__name__}")
            return
        for stretch in damaged:
            self._store.drop_chunk(study.id, stretch[0])
            unfinished.missing.append(stretch)
        if not damaged:
            self._store.finish(study.id, statistics)
            del self._unfinished[study.id]

    def _statistics(self, unfinished: UnfinishedStudy) -> tuple[list[Stretch], Any]:
        """Return the stretches whose files are damaged, and the statistics if there are none."""
        stored, damaged = self._store.chunks(unfinished.study.id), []

        def chunks() -> Iterator[Chunk]:
            for stretch in stored:
                try:
                    yield self._files.read(unfinished.study.id, *stretch)
                except CorruptedChunk as fault:
                    extra = {"study": unfinished.study.id, "fault": str(fault)}
                    LOG.error("results are damaged and computed again", extra=extra)
                    damaged.append(stretch)

        found = summary(unfinished.study, unfinished.request, chunks)
        return [*dict.fromkeys(damaged)], found

    def _say(self, message: str, fault: Exception) -> None:
        LOG.error(message, extra={"reason": str(fault)})
        for unfinished in self._unfinished.values():
            # On a full disk there may be no room for it.
            with suppress(Refusal):
                self._store.note(unfinished.study.id, f"{message}: {reason_of(fault)}")


def _processes_with(keys: set[str], client: Any) -> list[str]:
    """Return the addresses of the processes that have been given any of some tasks."""
    return [address for address, tasks in client.processing().items() if keys & set(map(str, tasks))]
