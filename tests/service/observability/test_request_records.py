"""What is recorded of requests."""

import logging

import pytest

from service.observability.metrics import Metrics
from service.observability.request_records import Records


def test_ids_are_the_clients_where_they_are_plain_and_new_otherwise() -> None:
    records = Records(Metrics(), "none")
    for plain in (b"grading-17.a_b", b"x" * 64):
        assert records.id_of(plain) == plain
    made = [records.id_of(given) for given in (None, b"", b"a b", b"a\r\nb", b"a\n", b"x" * 65, b"\xff")]
    assert len(set(made)) == len(made)
    # A new one is as plain as those that are taken over.
    assert all(records.id_of(own) == own for own in made)
    assert records.id_of(None) != Records(Metrics(), "none").id_of(None)


@pytest.mark.parametrize(("which", "logged"), [("none", []), ("failures", [500]), ("all", [200, 404, 500])])
def test_the_requests_that_are_to_be_logged_are(
    which: str, logged: list[int], caplog: pytest.LogCaptureFixture
) -> None:
    metrics = Metrics()
    records = Records(metrics, which)
    with caplog.at_level(logging.INFO, "polhode"):
        for status in (200, 404, 500):
            records.finished(b"abc", "ask_toy", "POST", status, 0.25)
    assert [record.__dict__["status"] for record in caplog.records] == logged
    with caplog.at_level(logging.DEBUG, "polhode"):
        caplog.clear()
        records.finished(b"abc", "get_readiness", "GET", 503, 0.25)
    # As long as the service starts, probes fail all the time.
    assert [record.levelno for record in caplog.records] == [logging.DEBUG] * (which != "none")
    text = metrics.exposition().decode()
    for status in (200, 404, 500):
        assert f'polhode_request_seconds_count{{operation="ask_toy",status="{status}"}} 1.0' in text
        assert f'polhode_request_seconds_sum{{operation="ask_toy",status="{status}"}} 0.25' in text


def test_the_key_is_named_where_there_is_one(caplog: pytest.LogCaptureFixture) -> None:
    records = Records(Metrics(), "all")
    with caplog.at_level(logging.INFO, "polhode"):
        records.finished(b"abc", "ask_toy", "POST", 200, 0.25, "laboratory")
        records.finished(b"abc", "ask_toy", "POST", 200, 0.25)
    assert [record.__dict__.get("key") for record in caplog.records] == ["laboratory", None]
    assert not hasattr(caplog.records[1], "key")
