"""The HTTP protocol of uvicorn with a limit for silence: a connection that asks for nothing is closed."""

from __future__ import annotations

import asyncio

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

SILENCE = 20.0
"""Seconds within which a new connection, and one that has begun another request, must have sent its head."""


class TimedProtocol(H11Protocol):
    """Closes connections on which the head of a request is not whole in time; single bytes give no more time."""

    _silence: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        self._watch(True)

    def connection_lost(self, exc: Exception | None) -> None:
        self._watch(False)
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        super().data_received(data)
        self._watch(self._lacks_head)

    def on_response_complete(self) -> None:
        super().on_response_complete()
        # Half a head may have come before the answer to the request before it.
        self._watch(self._lacks_head and bool(self.conn.trailing_data[0]))

    @property
    def _lacks_head(self) -> bool:
        return self.conn.their_state is h11.IDLE

    def _watch(self, waits: bool) -> None:
        """Start the time for a head, unless it runs, or end it."""
        if not waits and self._silence is not None:
            self._silence.cancel()
            self._silence = None
        elif waits and self._silence is None:
            self._silence = self.loop.call_later(SILENCE, self._close_silent)

    def _close_silent(self) -> None:
        if self._lacks_head and not self.transport.is_closing():
            self.transport.close()
