"""A connection that never finishes the head of a request is closed, also after a whole request."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest
from uvicorn import Config
from uvicorn.server import ServerState

from reportgen.server import protocol

REQUEST = b"GET / HTTP/1.1\r\nHost: a\r\n\r\n"


async def answered(scope: Any, receive: Any, send: Any) -> None:
    await send({"type": "http.response.start", "status": 200, "headers": [(b"content-length", b"2")]})
    await send({"type": "http.response.body", "body": b"ok"})


async def closed_after(first: bytes) -> bool:
    """Whether a connection is closed that sends something at once, and then half a head byte by byte."""
    loop, config = asyncio.get_running_loop(), Config(answered, timeout_keep_alive=60, lifespan="off")
    config.load()
    server = await loop.create_server(lambda: protocol.TimedProtocol(config, ServerState(), {}), "127.0.0.1", 0)
    reader, writer = await asyncio.open_connection(*server.sockets[0].getsockname())
    writer.write(first)
    if first:
        assert (await reader.readuntil(b"ok")).startswith(b"HTTP/1.1 200")
    end = asyncio.create_task(reader.read())
    for sign in b"GET / HTTP/1.1\r\nHost: aaaaaaaaaaaaaaaaaaaaaaa":
        if (await asyncio.wait([end], timeout=0.05))[0]:
            break
        writer.write(bytes([sign]))
    closed = end.done()
    writer.close()
    server.close()
    end.cancel()
    return closed


@pytest.mark.parametrize("first", [b"", REQUEST, REQUEST + b"GET"])
def test_half_a_head_is_not_waited_for(monkeypatch: pytest.MonkeyPatch, first: bytes) -> None:
    monkeypatch.setattr(protocol, "SILENCE", 0.4)
    assert asyncio.run(closed_after(first))


async def stays_open() -> bool:
    loop, config = asyncio.get_running_loop(), Config(answered, timeout_keep_alive=60, lifespan="off")
    config.load()
    server = await loop.create_server(lambda: protocol.TimedProtocol(config, ServerState(), {}), "127.0.0.1", 0)
    reader, writer = await asyncio.open_connection(*server.sockets[0].getsockname())
    for _ in range(3):
        writer.write(REQUEST)
        await reader.readuntil(b"ok")
        await asyncio.sleep(0.15)
    closed = reader.at_eof()
    writer.close()
    server.close()
    return not closed


def test_a_connection_between_whole_requests_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(protocol, "SILENCE", 0.1)
    assert asyncio.run(stays_open())
