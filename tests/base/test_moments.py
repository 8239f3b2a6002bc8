"""Moments as ISO 8601, Vietnamese usage, and Moodle's `strftimedaydatetime` in both languages write them."""

from __future__ import annotations

import datetime

import pytest

from reportgen.base.timestamps import moment


@pytest.mark.parametrize(
    "text",
    [
        "2026-11-20 21:05",
        "2026-11-20T21:05:00",
        "20/11/2026 21:05",
        "20-11-2026, 9:05 PM",
        "20.11.26 21:05",
        "21h05 ngày 20/11/2026",
        "Friday, 20 November 2026, 9:05 PM",
        "November 20, 2026 09:05 pm",
        "Thứ Sáu, 20 Tháng mười một 2026, 9:05 CH",
        "thứ sáu, 20 tháng 11 năm 2026, 21:05",
        "2026年11月20日 星期五 21:05",
        "2026 年 11 月 20 日 下午 9:05",
    ],
)
def test_a_moment_is_read_however_it_is_written(text: str) -> None:
    assert moment(text) == datetime.datetime(2026, 11, 20, 21, 5)


@pytest.mark.parametrize(
    ("text", "day"), [("5 tháng 01 2026", (5, 1)), ("1 tháng mười 2026", (1, 10)), ("Mon, 2 Feb 2026", (2, 2))]
)
def test_a_month_is_not_taken_for_another_whose_name_it_begins(text: str, day: tuple[int, int]) -> None:
    found = moment(text)
    assert found is not None
    assert (found.day, found.month) == day


def test_a_day_alone_begins_or_is_over() -> None:
    assert moment("2026-11-20") == datetime.datetime(2026, 11, 20)
    assert moment("2026-11-20", end=True) == datetime.datetime(2026, 11, 20, 23, 59, 59)
    assert moment("9:00 SA 20/11/2026", end=True) == datetime.datetime(2026, 11, 20, 9)


@pytest.mark.parametrize(
    "text", ["", "-", "yes", "31/2/2026", "2026-13-01", "Monday, 2 June", "25:00 1/1/2026", "13 PM"]
)
def test_what_no_calendar_has_is_no_moment(text: str) -> None:
    assert moment(text) is None
