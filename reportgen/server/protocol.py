"""The HTTP protocol of uvicorn with a limit for silence: a connection that asks for nothing is closed."""

from __future__ import annotations

import asyncio
from typing import Any

from uvicorn.protocols.http.h11_impl import H11Protocol

SILENCE = 20.0
"""Seconds within which a new connection must have sent the head of a request."""


class TimedProtocol(H11Protocol):
    """Closes connections on which no request has begun in time."""

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        self._silence: Any = self.loop.call_later(SILENCE, self._close_silent)

    def connection_lost(self, exc: Exception | None) -> None:
        self._silence.cancel()
        super().connection_lost(exc)

    def _close_silent(self) -> None:
        if self.cycle is None and not self.transport.is_closing():
            self.transport.close()
