"""What is installed: the version of the package, and the words and frames that come with it."""

from __future__ import annotations

from functools import cache
from hashlib import sha256
from importlib import metadata
from pathlib import Path


@cache
def version() -> str:
    """The version as installed; "0" in a checkout that is not installed."""
    try:
        return metadata.version("reportgen")
    except metadata.PackageNotFoundError:
        return "0"


def templates() -> Path:
    """The folder of words and frames: packed into the package, or beside it in a checkout."""
    package = Path(__file__).resolve().parent
    packed = package / "templates"
    return packed if packed.is_dir() else package.parent / "templates"


def templates_hash() -> str:
    """SHA-256 of the names and contents of all templates, those of schools included, in sorted order."""
    root = templates()
    digest = sha256()
    for path in sorted(path for path in root.rglob("*") if path.is_file()):
        for part in (path.relative_to(root).as_posix().encode(), path.read_bytes()):
            digest.update(len(part).to_bytes(8, "big") + part)
    return digest.hexdigest()


def schools() -> list[str]:
    """The folders of templates that belong to a school, such as `tnut` with its `vi` and `en`."""
    return sorted(
        folder.name
        for folder in templates().iterdir()
        if folder.name not in {"vi", "en", "frames"} and any((folder / name).is_dir() for name in ("vi", "en"))
    )
