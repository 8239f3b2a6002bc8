"""Where the files lie that come with the package: words and frames."""

from __future__ import annotations

from pathlib import Path


def templates() -> Path:
    """The folder of words and frames: packed into the package, or beside it in a checkout."""
    package = Path(__file__).resolve().parent
    packed = package / "templates"
    return packed if packed.is_dir() else package.parent / "templates"
