"""What the processes of tests do: the first word of a request says how, the rest comes back as the reply."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import time
from pathlib import Path

from service.execution.messages import BEGUN, LENGTH


def framed(message: bytes) -> bytes:
    """Return a message as it travels."""
    return len(message).to_bytes(LENGTH, "little") + message


def main(channel: socket.socket, folder: str) -> None:
    """Answer requests as `service.execution.worker.serve` does; what is begun is noted in a file of the folder."""
    place = Path(folder)
    if used_up(place / "stillborn"):
        os._exit(3)
    with contextlib.suppress(ConnectionError), channel, channel.makefile("rb") as requests:
        channel.sendall(BEGUN)
        while header := requests.read(LENGTH):
            word, _, rest = requests.read(int.from_bytes(header, "little")).partition(b" ")
            if word == b"vanish" and used_up(place / "vanish"):
                os._exit(4)
            # A request whose process dies before it has said so goes to another.
            channel.sendall(BEGUN)
            with (place / "begun").open("ab") as notes:
                notes.write(rest[:20] + b"\n")
            behave(word, rest, channel, place)
            channel.sendall(framed(rest))
            if word == b"last":
                os._exit(5)


def behave(word: bytes, rest: bytes, channel: socket.socket, place: Path) -> None:
    if word == b"exit":
        os._exit(int(rest))
    if word == b"die":
        os.kill(os.getpid(), signal.SIGKILL)
    if word == b"tear":
        channel.sendall(framed(rest)[:-1])
        os._exit(6)
    while word == b"spin" and not (place / "gate").exists():
        pass
    while word == b"wait" and not (place / "gate").exists():
        time.sleep(0.002)


def used_up(mark: Path) -> bool:
    """Return whether a mark was there, of which each is good for one process."""
    try:
        mark.unlink()
    except FileNotFoundError:
        return False
    return True
