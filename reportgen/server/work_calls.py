"""The functions of `work` by name, so that the process of the pages does not load what they compute with."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from reportgen.base.records import Record


class WorkCall(Record):
    """A function of `work`, found in the process that runs it."""

    name: str

    def __call__(self, *arguments: Any) -> Any:
        from reportgen.server import work

        function: Callable[..., Any] = getattr(work, self.name)
        return function(*arguments)


make_sheet = WorkCall("make_sheet")
filled_sheet = WorkCall("filled_sheet")
check = WorkCall("check")
read_upload = WorkCall("read_upload")
draw = WorkCall("draw")
fix = WorkCall("fix")
make_products = WorkCall("make_products")
make_file = WorkCall("make_file")
grade = WorkCall("grade")
key_values = WorkCall("key_values")
fill_gradebook = WorkCall("fill_gradebook")
prepare = WorkCall("prepare")
begin_reading = WorkCall("begin_reading")
