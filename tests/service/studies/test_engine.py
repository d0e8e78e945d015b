"""The same bits on every cluster and after every accident; nothing that is stored is computed again."""

from __future__ import annotations

import errno
import json
import os
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from service.studies.cluster import TRIED_AGAIN
from service.studies.study import ACCEPTED, DISMISSED, FAILED, SUCCESSFUL
from service.studies.task import compute
from tests.service.studies.conftest import FOREVER, TERMS, UNIFORM, Desk, sleeping
from tests.service.toy_routes import GOOD

Desks = Callable[..., Desk]


def finished(desk: Desk, request: dict[str, Any], each: float = 1e-3) -> tuple[bytes, ...]:
    identity = desk.submit(request, each)
    desk.work()
    assert desk.study(identity).status == SUCCESSFUL
    return desk.bits(identity)


def test_equal_bits_in_one_thread_and_two_processes_however_members_are_divided(
    desk_on: Desks, in_process: str, processes: str, tmp_path: Path
) -> None:
    whole = finished(desk_on(in_process), UNIFORM, 1e-6)
    assert finished(desk_on(in_process, tmp_path / "b"), UNIFORM, 0.1) == whole
    assert finished(desk_on(processes, tmp_path / "c"), UNIFORM, 0.02) == whole


def test_a_member_has_the_figures_of_its_single_request(desk_on: Desks, in_process: str) -> None:
    desk = desk_on(in_process)
    inputs, figures, *_ = finished(desk, UNIFORM)
    rates = np.frombuffer(inputs).reshape(300, 2)[:, 0]
    found = np.frombuffer(figures).reshape(300, 2)
    assert found[:, 0].tolist() == rates.tolist()
    assert (found[:, 1] == 0.5 * GOOD["angular_velocity"][1]).all()


def test_refused_members_are_results(desk_on: Desks, in_process: str) -> None:
    request = UNIFORM | {"vary": [{"pointer": "/body/moments/2", "values": [3.0, 7.0, -1.0, 4.0]}], "design": "product"}
    del request["count"], request["seed"]
    desk = desk_on(in_process)
    _, figures, failed, _ = finished(desk, request)
    assert failed == b'["", "unphysical-inertia", "invalid-parameter", ""]'
    assert np.isnan(np.frombuffer(figures).reshape(4, 2)[1:3]).all()


def test_faults_of_the_service_are_results_too(desk_on: Desks, in_process: str) -> None:
    values = ["well", "fail", "nan", "unreachable"]
    request = UNIFORM | {"vary": [{"pointer": "/behaviour", "values": values}], "design": "product"}
    request["question"] = {"path": "/v1/toy", "request": GOOD | {"behaviour": "well"}}
    request["quantities"] = ["/position/2/2"]
    del request["count"], request["seed"]
    _, _, failed, statistics = finished(desk_on(in_process), request)
    assert failed == b'["", "internal-error", "internal-error", "accuracy-unreachable"]'
    assert b'"failures": {"accuracy-unreachable": 1, "internal-error": 2}' in statistics


def test_a_killed_process_costs_what_it_was_computing(
    desk_on: Desks, in_process: str, processes: str, tmp_path: Path
) -> None:
    request = sleeping(0.004, 120)
    desk = desk_on(processes)
    identity = desk.submit(request, 0.02)
    desk.work(until=lambda: desk.study(identity).done)
    stored = set(desk.store.chunks(identity))
    for process in desk.cluster.client.run(os.getpid).values():
        os.kill(process, signal.SIGKILL)
    desk.work()
    assert stored < set(desk.store.chunks(identity))
    assert desk.study(identity).status == SUCCESSFUL
    assert desk.bits(identity) == finished(desk_on(in_process, tmp_path / "other"), request)


def test_a_member_that_ends_its_process_is_found_and_the_others_are_answered(desk_on: Desks, processes: str) -> None:
    values = ["well", "well", "die", "well"]
    request = UNIFORM | {"vary": [{"pointer": "/behaviour", "values": values}], "design": "product"}
    request["question"] = {"path": "/v1/toy", "request": GOOD | {"behaviour": "well"}}
    del request["count"], request["seed"]
    _, figures, failed, _ = finished(desk_on(processes), request, 0.01)
    assert failed == b'["", "", "worker-lost", ""]'
    assert np.isnan(np.frombuffer(figures).reshape(4, 2)).any(axis=1).tolist() == [False, False, True, False]


def test_another_engine_goes_on_where_one_has_stopped(desk_on: Desks, in_process: str, tmp_path: Path) -> None:
    first = desk_on(in_process)
    identity = first.submit(UNIFORM, 0.05)
    first.work(until=lambda: first.study(identity).done)
    first.engine.stop()
    stored = first.store.chunks(identity)
    assert 0 < first.study(identity).done < 300
    second = desk_on(in_process)
    second.work()
    assert set(stored) < set(second.store.chunks(identity))
    assert second.bits(identity) == finished(desk_on(in_process, tmp_path / "other"), UNIFORM)


@pytest.mark.parametrize("damage", ["turned", "cut", "gone", "swapped"])
def test_damaged_results_are_computed_again(desk_on: Desks, in_process: str, tmp_path: Path, damage: str) -> None:
    desk = desk_on(in_process)
    identity = desk.submit(UNIFORM, 0.1)
    desk.work(until=lambda: len(desk.store.chunks(identity)) > 1)
    assert desk.study(identity).unfinished
    (start, stop), other, *_ = desk.store.chunks(identity)
    file = tmp_path / "studies" / identity / f"{start}-{stop}.npz"
    data = bytearray(file.read_bytes())
    if damage == "gone":
        file.unlink()
    elif damage == "cut":
        file.write_bytes(data[:-100])
    elif damage == "swapped":
        file.write_bytes((tmp_path / "studies" / identity / f"{other[0]}-{other[1]}.npz").read_bytes())
    else:
        data[len(data) // 3] ^= 1
        file.write_bytes(data)
    desk.work()
    assert desk.bits(identity) == finished(desk_on(in_process, tmp_path / "other"), UNIFORM)


def test_a_full_disk_is_said_and_waited_for(desk_on: Desks, in_process: str, monkeypatch: pytest.MonkeyPatch) -> None:
    desk = desk_on(in_process)
    messages: list[str] = []
    full = iter([True, True])
    write = desk.files.write

    def writing(*arguments: Any) -> None:
        messages.append(desk.study(identity).message)
        if next(full, False):
            raise OSError(errno.ENOSPC, "No space left on device")
        write(*arguments)

    monkeypatch.setattr(desk.files, "write", writing)
    monkeypatch.setattr("service.studies.engine.PAUSE", 0.01)
    identity = desk.submit(UNIFORM)
    desk.work()
    assert "No space left on device" in messages[1]
    study = desk.study(identity)
    assert (study.status, study.done, study.message) == (SUCCESSFUL, 300, "")


def test_the_place_of_results_is_not_told(
    desk_on: Desks, in_process: str, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    desk = desk_on(in_process)
    secret = "https://user:secret@store.example"

    def write(*arguments: Any) -> None:
        raise OSError(f"{secret} does not answer")

    monkeypatch.setattr(desk.files, "write", write)
    monkeypatch.setattr("service.studies.engine.PAUSE", 0.01)
    identity = desk.submit(UNIFORM)
    desk.work(until=lambda: desk.study(identity).message)
    assert desk.study(identity).message == "results cannot be stored, which is tried again: it cannot be reached"
    assert any(secret in getattr(record, "reason", "") for record in caplog.records)


def test_a_scheduler_that_cannot_be_reached_is_said(
    desk_on: Desks, silent: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("service.studies.engine.PAUSE", 0.01)
    monkeypatch.setattr("service.studies.cluster.ANSWERING", 0.1)
    desk = desk_on(silent)
    identity = desk.submit(UNIFORM)
    assert desk.engine.turn()
    study = desk.study(identity)
    assert (study.status, study.message) == (ACCEPTED, f"{TRIED_AGAIN}: it cannot be reached")


def test_a_scheduler_that_has_gone_is_said(desk_on: Desks, in_process: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("service.studies.engine.PAUSE", 0.01)
    desk = desk_on(in_process)
    identity = desk.submit(UNIFORM, 0.1)
    desk.work(until=lambda: desk.study(identity).done)
    # As the client has it from the end of its connection on.
    desk.cluster.client.status = "connecting"
    assert desk.engine.turn()
    assert TRIED_AGAIN in desk.study(identity).message
    assert desk.cluster.client is None
    desk.work()
    assert desk.study(identity).status == SUCCESSFUL


def test_a_connection_that_breaks_while_processes_are_ended_is_made_again(
    desk_on: Desks, in_process: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("service.studies.engine.PAUSE", 0.01)
    desk = desk_on(in_process, longest=0.0)
    identity = desk.submit(sleeping(0.05, 20), 1e-6)

    def broken(client: object) -> None:
        raise ConnectionResetError

    monkeypatch.setattr("distributed.Client.processing", broken)
    desk.work(until=lambda: desk.study(identity).message)
    assert desk.cluster.client is None
    assert TRIED_AGAIN in desk.study(identity).message


def test_statistics_that_cannot_be_formed_are_not_tried_for_ever(
    desk_on: Desks, in_process: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def wrong(*_: object) -> None:
        raise KeyError

    monkeypatch.setattr("service.studies.engine.summary", wrong)
    desk = desk_on(in_process)
    identity = desk.submit(UNIFORM)
    desk.work()
    study = desk.study(identity)
    assert (study.status, study.message) == (FAILED, "its statistics could not be formed: KeyError")


def test_a_dismissed_study_lets_its_processes_go(desk_on: Desks, processes: str) -> None:
    desk = desk_on(processes)
    identity = desk.submit(sleeping(FOREVER, 3), FOREVER)
    client = desk.cluster.open()
    desk.work(until=lambda: sum(map(len, client.processing().values())) >= 2)
    assert desk.store.end(identity, DISMISSED, "")
    # Both processes sleep, but others take their places: the next study would have to wait for them.
    other = desk.submit(UNIFORM, 0.05)
    desk.work()
    assert desk.study(other).status == SUCCESSFUL
    assert desk.study(identity).status == DISMISSED


def test_a_member_that_takes_far_too_long_is_ended(desk_on: Desks, processes: str) -> None:
    _, _, failed, _ = finished(desk_on(processes, longest=0.1), sleeping(FOREVER, 1), 0.001)
    assert failed == b'["deadline-exceeded"]'


def test_an_answer_that_takes_far_too_long_is_ended(desk_on: Desks, processes: str) -> None:
    desk = desk_on(processes, longest=0.1)
    identity = desk.submit_question(json.dumps(sleeping(FOREVER, 1)["question"]["request"]).encode())
    desk.work()
    study = desk.study(identity)
    assert (study.status, study.message.split(":")[0]) == (FAILED, "deadline-exceeded")


def test_answers_leave_half_of_the_processes_to_members(desk_on: Desks, processes: str) -> None:
    desk = desk_on(processes, longest=FOREVER)
    asleep = json.dumps(sleeping(FOREVER, 1)["question"]["request"]).encode()
    answers = [desk.submit_question(asleep) for _ in range(2)]
    members = desk.submit(UNIFORM)
    desk.work(until=lambda: not desk.study(members).unfinished)
    assert all(desk.study(identity).unfinished for identity in answers)
    assert all(desk.store.end(identity, DISMISSED, "") for identity in answers)
    desk.work()


def test_studies_have_their_turns_in_rotation(desk_on: Desks, in_process: str) -> None:
    desk = desk_on(in_process)
    long, short = desk.submit(UNIFORM, 0.5), desk.submit(UNIFORM | {"count": 3}, 0.5)
    desk.work(until=lambda: not desk.study(short).unfinished)
    assert desk.study(long).unfinished


def test_what_is_computed_is_a_function_of_its_arguments() -> None:
    import json

    body = json.dumps(UNIFORM).encode()
    assert compute(TERMS, body, 3, 40).data == compute(TERMS, body, 3, 40).data


def product(pointer: str, values: list[Any], request: dict[str, Any]) -> dict[str, Any]:
    study = UNIFORM | {"vary": [{"pointer": pointer, "values": values}], "design": "product"}
    study["question"] = {"path": "/v1/toy", "request": request}
    del study["count"], study["seed"]
    return study


def test_a_study_of_which_all_members_are_refused_has_failed_with_the_reasons(desk_on: Desks, in_process: str) -> None:
    desk = desk_on(in_process)
    identity = desk.submit(product("/body/moments/2", [7.0, 7.0, 7.0, -1.0], GOOD))
    desk.work()
    study = desk.study(identity)
    assert study.status == FAILED
    assert study.message.startswith("nearly all members are refused: 3 of 4 members tried: unphysical-inertia, such as")
    assert "member 0: " in study.message
    assert "; 1 of 4 members tried: invalid-parameter, such as member 3: " in study.message


def test_the_rest_of_a_study_whose_members_are_refused_is_not_computed(desk_on: Desks, in_process: str) -> None:
    desk = desk_on(in_process)
    study = UNIFORM | {"question": {"path": "/v1/toy", "request": GOOD | {"angular_velocity": [0, 0, "x"]}}}
    identity = desk.submit(study | {"count": 1_000_000}, 0.01)
    desk.work()
    assert desk.study(identity).status == FAILED
    assert "64 of 64 members tried: invalid-parameter" in desk.study(identity).message
    assert desk.study(identity).done < 1000


def test_one_member_with_an_answer_is_enough(desk_on: Desks, in_process: str) -> None:
    desk = desk_on(in_process)
    identity = desk.submit(product("/body/moments/2", [7.0, 7.0, 7.0, 3.0], GOOD))
    desk.work()
    assert (desk.study(identity).status, desk.study(identity).failed) == (SUCCESSFUL, 3)


def test_the_sample_does_not_have_one_value_of_an_inner_input(desk_on: Desks, in_process: str) -> None:
    """Of 64 times 10 members in row order, every tenth is refused no more than the others."""
    desk = desk_on(in_process)
    study = product("/body/moments/2", [7.0] * 9 + [3.0], GOOD)
    study["vary"].insert(0, {"pointer": "/angular_velocity/1", "min": 0.1, "max": 1.0, "count": 64})
    identity = desk.submit(study)
    desk.work()
    assert (desk.study(identity).status, desk.study(identity).failed) == (SUCCESSFUL, 576)


def test_a_sample_that_ends_its_process_decides_nothing(desk_on: Desks, processes: str) -> None:
    desk = desk_on(processes)
    identity = desk.submit(product("/behaviour", ["die", "well"], GOOD | {"behaviour": "well"}), 0.01)
    desk.work()
    assert (desk.study(identity).status, desk.study(identity).failed) == (SUCCESSFUL, 1)
