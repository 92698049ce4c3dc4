"""The command line tool as the engine of judging: files in, JSON out."""

from __future__ import annotations

import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from typing import Any, Callable, Dict, List, Tuple

FOLDER = pathlib.Path(__file__).parent / "bin"


def tool() -> str:
    """Return the path of the command line tool.
    """
    inside = FOLDER / "touchstone"
    found = str(inside) if inside.exists() else shutil.which("touchstone")
    if found is None:
        raise FileNotFoundError(
            "touchstone: judging needs the command line tool, which a package that pip builds does not have:"
            " build all of it by ./run python in the sources, or put `touchstone` on the PATH"
        )
    return found


class Progress:
    """A bar on standard error, from the first second on, as tqdm draws it.

    The whole is a number of queries, of seconds, or unknown.
    """

    def __init__(self, title: str, show: bool | None, *, seconds: float = 0.0, queries: int = 0) -> None:
        self._title, self._seconds, self._queries = title, seconds, queries
        self._started = time.monotonic()
        in_notebook = "ipykernel" in sys.modules
        self._show = (sys.stderr.isatty() or in_notebook) if show is None else show
        self._drawn = False

    @property
    def callback(self) -> Callable[..., None] | None:
        """The function that draws; None if nothing is shown."""
        return self.draw if self._show else None

    def draw(self, done: int = 0) -> None:
        """Draw the time that has passed, and the part that is done if that is known."""
        passed = time.monotonic() - self._started
        if not self._show or passed < 1.0:
            return
        line = f"{self._title}: {passed:.0f}s"
        part = done / self._queries if self._queries else 0.0
        part = min(passed / self._seconds, 1.0) if self._seconds else part
        if part > 0.0:
            bar = ("#" * int(30 * part)).ljust(30)
            left = max(passed / part - passed, 0.0)
            line = f"{self._title}: {100 * part:3.0f}%|{bar}| [{passed:.0f}s<{left:.0f}s]"
        print(f"\r{line}", end="", file=sys.stderr, flush=True)
        self._drawn = True

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *_: Any) -> None:
        """End the line."""
        if self._drawn:
            print(file=sys.stderr, flush=True)


class Run:
    """A run of the tool in a temporary folder."""

    def __init__(self) -> None:
        self._temporary = tempfile.TemporaryDirectory(prefix="touchstone-")
        self.folder = pathlib.Path(self._temporary.name)
        self.environment: Dict[str, str] = dict(os.environ)

    def __enter__(self) -> Run:
        return self

    def __exit__(self, *_: Any) -> None:
        self._temporary.cleanup()

    def call(
        self, arguments: List[Any], title: str = "", seconds: float = 0.0, show: bool | None = None
    ) -> Tuple[str, str, bool]:
        """Return what the tool prints, on both streams, and whether Ctrl-C ended it.

        Raises
        ------
        ValueError
            If the tool refuses its input, with its reason.
        """
        out, errors = self.folder / "out.txt", self.folder / "errors.txt"
        with open(out, "wb") as out_file, open(errors, "wb") as error_file:
            # A session of its own: Ctrl-C reaches it by this process alone, once.
            process = subprocess.Popen(
                [tool(), *map(str, arguments)],
                stdin=subprocess.DEVNULL,
                stdout=out_file,
                stderr=error_file,
                env=self.environment,
                start_new_session=True,
            )
            with Progress(title or str(arguments[0]), show, seconds=seconds) as progress:
                interrupted = self._wait(process, progress.draw)
        texts = out.read_text(errors="replace"), errors.read_text(errors="replace")
        if process.returncode not in (0, 1, 130):
            reasons = [line for line in texts[1].splitlines() if line.strip()]
            raise ValueError("\n".join(reasons) or f"touchstone ended with status {process.returncode}")
        return (*texts, interrupted)

    @staticmethod
    def _wait(process: subprocess.Popen[bytes], draw: Callable[[], None]) -> bool:
        """Wait for the end. Return True if Ctrl-C made it."""
        try:
            while True:
                try:
                    process.wait(timeout=0.1)
                    return False
                except subprocess.TimeoutExpired:
                    draw()
        except KeyboardInterrupt:
            process.send_signal(signal.SIGINT)
            try:
                process.wait()
            except BaseException:  # a second Ctrl-C
                process.kill()
                process.wait()
                raise
            return True
        except BaseException:
            process.kill()
            process.wait()
            raise
