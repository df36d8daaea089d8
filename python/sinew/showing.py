"""The page in the browser, from Python."""

from __future__ import annotations

import atexit
import html
import json
import os
import re
import shutil
import subprocess
import sysconfig
import tempfile
import threading
import warnings
import webbrowser
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from sinew import _engine
from sinew._engine import Run
from sinew.errors import InputError
from sinew.parts import assignments
from sinew.running import Changes
from sinew.scene import Scene


def program() -> str:
    """The program `sinew` that came with the package."""
    found = shutil.which("sinew", path=sysconfig.get_path("scripts")) or shutil.which("sinew")
    if found is None:
        raise FileNotFoundError("the program `sinew` is neither beside this Python nor in PATH; install the package again")
    return found


class Shown:
    """A page that is being served. In a notebook it shows itself; `close` ends it, as does the end of Python."""

    def __init__(self, arguments: list[str], folder: tempfile.TemporaryDirectory[str], height: int) -> None:
        self._folder = folder
        self.height = height
        self._process = subprocess.Popen(
            [program(), "view", *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, encoding="utf-8"
        )
        atexit.register(self.close)
        assert self._process.stdout is not None and self._process.stderr is not None
        told = self._process.stdout.readline()
        match = re.match(r"Open (\S+)", told)
        if match is None:
            wrong = self._process.stderr.read()
            self.close()
            raise InputError(wrong.strip() or "the page could not be served")
        self.address: str = match[1]
        """Where a browser finds it."""
        threading.Thread(target=self._hear, daemon=True).start()

    def _hear(self) -> None:
        """What the program has to say: warnings of the scene, pages that were refused."""
        assert self._process.stderr is not None
        for line in self._process.stderr:
            warnings.warn(line.strip().removeprefix("warning: "), stacklevel=1)

    def close(self) -> None:
        """Ends it, after the step that it is making, or five seconds."""
        if self._process.poll() is None:
            self._process.terminate()
            try:
                self._process.wait(5)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        self._folder.cleanup()
        atexit.unregister(self.close)

    def __enter__(self) -> Shown:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _repr_html_(self) -> str:
        return f'<iframe src="{html.escape(self.address)}" width="100%" height="{self.height}" style="border:0"></iframe>'

    def __repr__(self) -> str:
        return f"<sinew.Shown at {self.address}>"


def show(
    what: Scene | str | os.PathLike[str] | Mapping[str, Any] | Run,
    *,
    changes: Changes = (),
    browser: bool | None = None,
    port: int = 0,
    height: int = 600,
    embed_in: Sequence[str] | None = None,
) -> Shown:
    """Opens the page of a scene, live, or of a run, to be played: drag targets, pull at bodies, move motors.

    what: a scene, its file, the folder of a run, or a run in memory.
    browser: opens one; if left out, unless this is a notebook, where the value of a cell shows the page in it.
    height: [px] in a notebook.
    embed_in: origins of pages that may show it in a frame, as "https://hub.example:8000"; if left out, the notebook's where
    that is known, else those of this machine and of VS Code."""
    folder: tempfile.TemporaryDirectory[str] = tempfile.TemporaryDirectory(prefix="sinew-show-")
    arguments = [f"--port={port}", *(f"--set={own}" for own in assignments(changes))]
    arguments += [f"--embed-in={origin}" for origin in (_notebook_origins() if embed_in is None else embed_in)]
    if isinstance(what, Run):
        place = Path(folder.name) / "run"
        what.save(place)
        arguments.append(os.fspath(place))
    elif isinstance(what, str | os.PathLike):
        arguments.append(os.fspath(what))
    else:
        if not isinstance(what, Scene | Mapping):
            folder.cleanup()
            raise TypeError(f"show: a scene, its file, the folder of a run, or a run, not {what!r}")
        scene = what if isinstance(what, Scene) else Scene.from_tree(what)
        meshes: dict[str, bytes] = {}
        tree = scene._tree(meshes)
        for name, content in meshes.items():
            (Path(folder.name) / name).write_bytes(content)
        names = {name: os.fspath(Path(folder.name) / name) for name in meshes}
        file = Path(folder.name) / "scene.yaml"
        file.write_text(_engine.write_tree(_renamed(tree, names)), encoding="utf-8")
        arguments += [os.fspath(file), f"--folder={os.path.abspath(scene.folder)}"]
    shown = Shown(arguments, folder, height)
    if not _in_notebook() if browser is None else browser:
        webbrowser.open(shown.address)
    return shown


def _renamed(value: Any, names: Mapping[str, str]) -> Any:
    if isinstance(value, dict):
        return {key: _renamed(own, names) for key, own in value.items()}
    if isinstance(value, list):
        return [_renamed(own, names) for own in value]
    return names.get(value, value) if isinstance(value, str) else value


def _notebook_origins() -> list[str]:
    """Where the notebook that this is the kernel of is opened from: a Jupyter server names its process to its kernels, and
    writes its address into a file."""
    local = ["http://localhost:*", "http://127.0.0.1:*", "vscode-webview:", "vscode-file:"]
    server = os.environ.get("JPY_PARENT_PID", "")
    try:
        from jupyter_core.paths import jupyter_runtime_dir  # type: ignore[import-not-found, unused-ignore]

        facts = json.loads((Path(jupyter_runtime_dir()) / f"jpserver-{server}.json").read_text(encoding="utf-8"))
        address = urlsplit(str(facts["url"]))
        name, port = address.hostname or "", address.port
    except (ImportError, OSError, ValueError, KeyError, TypeError):
        return local
    if not re.fullmatch(r"[A-Za-z0-9.-]+", name) or address.scheme not in ("http", "https"):
        return local
    hosts = {"localhost", "127.0.0.1", name}
    return [f"{address.scheme}://{host}:{port}" if port else f"{address.scheme}://{host}" for host in sorted(hosts)]


def _in_notebook() -> bool:
    try:
        from IPython import get_ipython  # type: ignore[import-not-found, unused-ignore]
    except ImportError:
        return False
    shell = get_ipython()  # type: ignore[no-untyped-call, unused-ignore]
    return shell is not None and type(shell).__name__ == "ZMQInteractiveShell"
