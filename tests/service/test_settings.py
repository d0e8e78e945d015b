import signal
import socket

import pytest
from pydantic import ValidationError

from service.__main__ import free_port, main, parser, unknown_settings
from service.settings import LONGEST, Settings


@pytest.mark.parametrize("name", Settings.model_fields)
def test_every_setting_is_documented_in_the_help(name: str) -> None:
    field = Settings.model_fields[name]
    assert field.description is not None
    assert field.description.endswith(".")
    assert f"POLHODE_{name.upper()}" in parser().format_help()
    assert field.description in parser().format_help()


def test_settings_come_from_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("POLHODE_MAX_SAMPLES", "17")
    monkeypatch.setenv("POLHODE_LOG_REQUESTS", "all")
    settings = Settings()
    assert (settings.max_samples, settings.log_requests) == (17, "all")


@pytest.mark.parametrize(
    ("name", "value"), [("PORT", "70000"), ("MAX_SAMPLES", "0"), ("LOG_LEVEL", "loud"), ("PORT", "x")]
)
def test_settings_out_of_range_stop_the_start(monkeypatch: pytest.MonkeyPatch, name: str, value: str) -> None:
    monkeypatch.setenv(f"POLHODE_{name}", value)
    with pytest.raises(ValidationError):
        Settings()


@pytest.mark.parametrize("name", ["DEADLINE_SECONDS", "BODY_SECONDS", "STALLED_SECONDS", "SHUTDOWN_SECONDS"])
@pytest.mark.parametrize("value", ["inf", "nan", "-1", "1e400", "9" * 30, ""])
def test_times_are_those_that_a_timer_can_keep(monkeypatch: pytest.MonkeyPatch, name: str, value: str) -> None:
    monkeypatch.setenv(f"POLHODE_{name}", value)
    with pytest.raises(ValidationError):
        Settings()
    monkeypatch.setenv(f"POLHODE_{name}", str(LONGEST))
    signal.setitimer(signal.ITIMER_REAL, getattr(Settings(), name.lower()) + 1e3)
    signal.setitimer(signal.ITIMER_REAL, 0.0)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("KEYS_FILE", ""),
        ("KEYS_FILE", "/none/such"),
        ("KEYS_FILE", "/"),
        ("FORWARDED_ALLOW_IPS", "*"),
        ("FORWARDED_ALLOW_IPS", "127.0.0.1,proxy"),
    ],
)
def test_paths_and_proxies_lead_somewhere_or_stop_the_start(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], name: str, value: str
) -> None:
    """An empty name of the file of keys must not let everybody in."""
    monkeypatch.setenv(f"POLHODE_{name}", value)
    with pytest.raises(SystemExit) as stop:
        main([])
    assert str(stop.value.code).startswith(f"POLHODE_{name}: ")
    assert str(stop.value.code).endswith(f"given '{value}'")


def test_misspelt_settings_stop_the_start(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("POLHODE_MAX_SAMPLE", "17")
    with pytest.raises(SystemExit) as stop:
        main([])
    assert stop.value.code == "POLHODE_MAX_SAMPLE is no setting; did you mean POLHODE_MAX_SAMPLES?"


def test_other_variables_with_the_prefix_do_not() -> None:
    given = ("POLHODE_PORT", "POLHODE_URL", "POLHODE_COUNTS", "POLHODE_ROWS", "POLHODE_FUZZ", "PATH")
    assert unknown_settings(dict.fromkeys(given, "")) == dict.fromkeys(given[1:5])


def test_defaults() -> None:
    settings = Settings()
    assert (settings.host, settings.port, settings.workers) == ("127.0.0.1", 8000, 1)


def test_help_and_version(capsys: pytest.CaptureFixture[str]) -> None:
    for option, text in (("--help", "POLHODE_PORT"), ("--version", "1.0.0")):
        with pytest.raises(SystemExit) as stop:
            main([option])
        assert stop.value.code == 0
        assert text in capsys.readouterr().out


def test_a_port_in_use_is_one_clear_line() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(SystemExit) as stop:
            main(["--port", str(port)])
    message = str(stop.value.code)
    assert message.startswith(f"cannot listen on 127.0.0.1, port {port}: Address already in use; ")
    assert "\n" not in message


def test_an_address_of_another_machine_is_one_clear_line() -> None:
    with pytest.raises(SystemExit) as stop:
        main(["--host", "192.0.2.1"])
    assert str(stop.value.code).startswith("cannot listen on 192.0.2.1, port 8000: ")


def test_any_free_port_is_found() -> None:
    port = free_port("127.0.0.1", 0)
    socket.create_server(("127.0.0.1", port)).close()
