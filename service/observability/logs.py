"""Log lines: JSON objects, one per line, or plain text where a person reads them."""

from __future__ import annotations

import logging
import sys
import time
from typing import Any

import orjson

LOG = logging.getLogger("polhode")

_OWN = frozenset(vars(logging.makeLogRecord({}))) | {"message", "asctime", "color_message", "taskName"}


class JsonLines(logging.Formatter):
    """Formats a record as one JSON object; what is passed as `extra` becomes its members."""

    def format(self, record: logging.LogRecord) -> str:
        """Return the record as one line."""
        line = {
            "time": time.strftime("%Y-%m-%dT%H:%M:%S", time.gmtime(record.created)) + f".{int(record.msecs):03d}Z",
            "level": record.levelname.lower(),
            "logger": record.name,
            "message": record.getMessage(),
        }
        line |= {name: value for name, value in vars(record).items() if name not in _OWN}
        if record.exc_info:
            line["traceback"] = self.formatException(record.exc_info)
        try:
            return orjson.dumps(line, default=str).decode()
        except TypeError:
            return orjson.dumps({name: _writable(value) for name, value in line.items()}).decode()


def _writable(value: Any) -> Any:
    """Return a member as it is, or as text where JSON has no form for it, so that no line is lost."""
    try:
        return orjson.Fragment(orjson.dumps(value, default=str))
    except TypeError:
        # Large integers, keys that are no texts, halves of surrogate pairs.
        return str(value).encode(errors="backslashreplace").decode()


class TextLines(logging.Formatter):
    """Formats a record for a terminal: the time, the message, what else is known about it."""

    def __init__(self) -> None:
        super().__init__("%(asctime)s %(message)s", "%H:%M:%S")

    def formatMessage(self, record: logging.LogRecord) -> str:
        """Return the line, without a traceback."""
        level = f"{record.levelname.lower()}: " if record.levelno >= logging.WARNING else ""
        more = "".join(f" {name}={value}" for name, value in vars(record).items() if name not in _OWN)
        return f"{record.asctime} {level}{record.message}{more}"


def configure(level: str) -> None:
    """Send all logging and warnings of this process to standard error: as text to a terminal, otherwise as JSON."""
    handler = logging.StreamHandler(sys.stderr)
    terminal = sys.stderr.isatty()
    handler.setFormatter(TextLines() if terminal else JsonLines())
    logging.basicConfig(level=level.upper(), handlers=[handler], force=True)
    logging.captureWarnings(True)
    if terminal:
        # The service logs its own start and stop.
        logging.getLogger("uvicorn.error").setLevel(logging.WARNING)
