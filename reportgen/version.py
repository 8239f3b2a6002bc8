"""Which version of the package is at work."""

from __future__ import annotations

from functools import cache
from importlib import metadata


@cache
def version() -> str:
    """The version as installed; "0" in a checkout that is not installed."""
    try:
        return metadata.version("reportgen")
    except metadata.PackageNotFoundError:
        return "0"
