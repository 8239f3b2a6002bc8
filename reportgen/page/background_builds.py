"""Make the products of a file on its page, one after another, each in a separate process that can be ended."""

from __future__ import annotations

import os
import subprocess
import threading
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from reportgen.base.progress import ASKED, MARK, SOURCE

LAST_LINES = 12
"""Number of lines of a process's error output that are reported."""
PATIENCE = 5.0
"""Seconds that a process has to clean up after it was asked to end."""


@dataclass
class Maker:
    """Makes products by commands that print the paths of their files; `tell` is called with each step."""

    commands: Mapping[str, Sequence[str]]
    """The command of each product, by its name."""
    tell: Callable[[Mapping[str, Any]], None]
    source: Path | None = None
    """File into which the typst source of a PDF is put."""
    files: dict[str, Path] = field(default_factory=dict)
    """Files made, by the names under which a page may request them."""
    _process: subprocess.Popen[str] | None = None
    _lock: threading.Lock = field(default_factory=threading.Lock)
    _ended: bool = False

    def make(self, product: str) -> bool:
        """Begin to make a product unless another is being made; raise `KeyError` for an unknown product."""
        command = self.commands[product]
        with self._lock:
            if self._process is not None or self._ended:
                return False
            self._process = subprocess.Popen(
                command,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                stdin=subprocess.DEVNULL,
                text=True,
                env={**os.environ, ASKED: "yes", **({SOURCE: str(self.source)} if self.source else {})},
            )
        self.tell({"product": product, "state": "running"})
        threading.Thread(target=self._wait, args=(product, self._process), daemon=True).start()
        return True

    def _wait(self, product: str, process: subprocess.Popen[str]) -> None:
        complaint = deque[str](maxlen=LAST_LINES)
        assert process.stdout is not None
        assert process.stderr is not None
        with ThreadPoolExecutor(1) as reader:
            printed = reader.submit(process.stdout.read)
            for line in map(str.rstrip, process.stderr):
                if line.startswith(MARK):
                    self.tell({"product": product, "state": "running", "step": line.removeprefix(MARK)})
                else:
                    complaint.append(line)
        process.wait()
        with self._lock:
            self._process = None
        paths = [Path(line) for line in printed.result().splitlines() if Path(line).is_file()]
        self.files |= {path.name: path.absolute() for path in paths}
        state = "ended" if process.returncode < 0 or process.returncode > 128 else "failed"
        self.tell(
            {
                "product": product,
                "state": "done" if process.returncode == 0 else state,
                "files": [[path.name, str(path)] for path in paths],
                "complaint": "\n".join(complaint) if process.returncode else "",
            }
        )

    def end(self) -> None:
        """End the process that is running; no file is left half written."""
        with self._lock:
            process = self._process
        if process is not None:
            process.terminate()

    def close(self) -> None:
        """End the process that is running, and wait for it."""
        self._ended = True
        with self._lock:
            process = self._process
        if process is not None:
            process.terminate()
            try:
                process.wait(PATIENCE)
            except subprocess.TimeoutExpired:
                process.kill()
