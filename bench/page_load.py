"""What pages that look on cost a live simulation: the time of its steps with one page, and with ten of which one has
stopped listening; and the program's memory over time.

    python3 bench/page_load.py examples/reach.yaml [--seconds 20] [--minutes 0] [--program build/release/sinew]
"""

from __future__ import annotations

import argparse
import base64
import json
import os
import re
import socket
import statistics
import struct
import subprocess
import threading
import time
from pathlib import Path
from urllib.parse import urlsplit


class Page:
    """Looks on over a WebSocket, and says that it has drawn what came."""

    def __init__(self, address: str) -> None:
        place = urlsplit(address)
        self.socket = socket.create_connection((place.hostname or "", place.port or 0))
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(
            f"GET /live?{place.query} HTTP/1.1\r\nHost: {place.netloc}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
        )
        self.left = b""
        while b"\r\n\r\n" not in self.left:
            self.left += self.socket.recv(4096)
        head, self.left = self.left.split(b"\r\n\r\n", 1)
        assert b"101" in head.split(b"\r\n")[0], head
        self.frames = 0
        self.steps: list[float] = []
        self.bytes = 0

    def _take(self, count: int) -> bytes:
        while len(self.left) < count:
            more = self.socket.recv(1 << 16)
            if not more:
                raise ConnectionError
            self.left += more
        own, self.left = self.left[:count], self.left[count:]
        return own

    def say(self, request: dict[str, object]) -> None:
        text = json.dumps(request).encode()
        assert len(text) < 126
        mask = b"\0\0\0\0"
        self.socket.sendall(bytes([0x81, 0x80 | len(text)]) + mask + text)

    def look(self, until: float) -> None:
        """Until then."""
        try:
            while time.monotonic() < until:
                first, second = self._take(2)
                size = second & 0x7F
                if size == 126:
                    size = struct.unpack(">H", self._take(2))[0]
                elif size == 127:
                    size = struct.unpack(">Q", self._take(8))[0]
                message = self._take(size)
                self.bytes += size
                if first & 0x0F != 2 or struct.unpack("<I", message[:4])[0] != 2:
                    continue
                length = struct.unpack("<I", message[4:8])[0]
                head = json.loads(message[8 : 8 + length])
                self.frames += 1
                self.steps.append(head["step_ms"])
                self.say({"do": "ack", "frame": head["frame"]})
        except (ConnectionError, OSError):
            pass


def resident(process: int) -> float:
    """[MiB]"""
    return int(Path(f"/proc/{process}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20


def watch(address: str, count: int, stalled: int, seconds: float) -> tuple[float, float]:
    """Median step [ms] and frames a second of a page, while so many look on."""
    idle = [Page(address) for _ in range(stalled)]
    pages = [Page(address) for _ in range(count)]
    until = time.monotonic() + seconds
    threads = [threading.Thread(target=page.look, args=(until,)) for page in pages]
    for own in threads:
        own.start()
    for own in threads:
        own.join()
    for page in [*idle, *pages]:
        page.socket.close()
    steps = pages[0].steps
    return statistics.median(steps[len(steps) // 4 :]), pages[0].frames / seconds


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("--program", default="build/release/sinew")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--minutes", type=float, default=0.0, help="to watch the memory for")
    options = parser.parse_args()
    with subprocess.Popen([options.program, "view", options.scene, "--threads", "1"], stdout=subprocess.PIPE, text=True) as own:
        assert own.stdout is not None
        match = re.match(r"Open (\S+)", own.stdout.readline())
        assert match is not None
        ones, tens = [], []
        for turn in range(3):  # in turns, as machines are noisy
            one, rate = watch(match[1], 1, 0, options.seconds)
            ten, rate_of_ten = watch(match[1], 9, 1, options.seconds)
            ones.append(one)
            tens.append(ten)
            print(f"step: one page {one:.3f} ms ({rate:.0f} frames/s), ten, one of them stalled {ten:.3f} ms ({rate_of_ten:.0f} frames/s)", flush=True)
        print(f"medians: {statistics.median(ones):.3f} and {statistics.median(tens):.3f} ms: "
              f"{100 * (statistics.median(tens) / statistics.median(ones) - 1):+.1f} %")
        if options.minutes > 0:
            page = Page(match[1])
            thread = threading.Thread(target=page.look, args=(time.monotonic() + 60 * options.minutes,))
            thread.start()
            begin = time.monotonic()
            while thread.is_alive():
                print(f"{(time.monotonic() - begin) / 60:5.1f} min: {resident(own.pid):.1f} MiB, {page.frames} frames", flush=True)
                thread.join(options.minutes * 6)
        own.terminate()


if __name__ == "__main__":
    main()
