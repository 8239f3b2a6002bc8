"""The functions of `work` by name, so that the process of the pages does not load what they compute with."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class Call:
    """A function of `work`, found in the process that runs it."""

    name: str

    def __call__(self, *arguments: Any) -> Any:
        from reportgen.server import work

        function: Callable[..., Any] = getattr(work, self.name)
        return function(*arguments)


make_sheet = Call("make_sheet")
filled_sheet = Call("filled_sheet")
check = Call("check")
read_upload = Call("read_upload")
draw = Call("draw")
fix = Call("fix")
make_products = Call("make_products")
make_file = Call("make_file")
grade = Call("grade")
key_values = Call("key_values")
fill_gradebook = Call("fill_gradebook")
begin_reading = Call("begin_reading")
