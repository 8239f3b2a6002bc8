"""Curves of quantities: their values are those of the results, their axes say what they are, measured points too."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.api.figures import plot_files
from reportgen.base.errors import AssignmentError, NotOfferedError, UnknownNameError
from reportgen.case import Case
from reportgen.cases import open_case, opened
from reportgen.export.curves import dense, diagrams, read_measured
from reportgen.formula import Chain, Symbol
from tests.report import built

ROOT = Path(__file__).parents[2]
ASSIGNMENTS = ROOT / "assignments"
SHAPER = ASSIGNMENTS / "shaper-01.yaml"
EXACT = 1e-9
"""Of the greatest value over the turn."""


@pytest.fixture(scope="module")
def shaper() -> Case:
    return built.case(SHAPER, "en")


def test_curves_are_the_results(shaper: Case) -> None:
    """The ram's velocity is the signed one of `solve`, the torque that of equilibrium; both end where they begin."""
    shown = diagrams([shaper], ["v.E", "M.eq"])
    assert list(shown) == ["v.E", "M.eq"]
    positions = api.solve(api.load(SHAPER))["positions"]
    true = {
        "v.E": [one["points"]["E"]["v"][0] for one in positions],
        "M.eq": [one["balancing_torque"]["equilibrium"] for one in positions],
    }
    for id, diagram in shown.items():
        (curve,) = diagram.curves
        x, y = np.asarray(curve.x), np.asarray(curve.y)
        assert x == pytest.approx([*(np.degrees(one["cycle_angle"]) for one in positions), 360.0])
        assert np.abs(y[:-1] - true[id]).max() < EXACT * np.abs(true[id]).max()
        assert y[-1] == y[0]
    assert isinstance(shown["v.E"].y, Chain)
    assert "positive: to the right" in shown["v.E"].y.note


def test_a_chart_for_each_unit_and_a_curve_for_each_file(shaper: Case) -> None:
    other = built.case(ASSIGNMENTS / "shaper-02.yaml", "en")
    shown = diagrams([shaper, other], ["v.E", "a.E", "v.D"])
    assert list(shown) == ["v.E-v.D", "a.E"]
    assert [curve.label for curve in shown["a.E"].curves] == [
        Chain((Symbol("a", "E"),), name) for name in ("shaper-01", "shaper-02")
    ]
    assert len(shown["v.E-v.D"].curves) == 4


def test_over_time_the_last_point_is_the_time_of_a_cycle() -> None:
    """A turn at n rpm takes 60/n s; a sliding driver runs through its way once, and does not begin anew."""
    case = built.case(ASSIGNMENTS / "engine-twin-05.yaml", "vi")
    (curve,) = diagrams([case], ["v.B"], "time")["v.B"].curves
    assert np.asarray(curve.x)[-1] == pytest.approx(2 * 60 / case.ledger["n"].values[0])
    slide = built.case(built.SLIDE, "en")
    diagram = diagrams([slide], ["v.F"])["v.F"]
    x = np.asarray(diagram.curves[0].x)
    with pytest.raises(NotOfferedError):
        diagrams([open_case(ASSIGNMENTS / "cam" / "knife-01.yaml")], ["cam.s"], "time")
    # The speed of a crank that accelerates holds at each position by itself.
    accelerated = open_case(ASSIGNMENTS / "four-bar-03.yaml")
    with pytest.raises(NotOfferedError):
        diagrams([accelerated], ["v.C"], "time")
    # Millimetres from the first position.
    assert (x[0], x[-1]) == (0.0, pytest.approx(abs(slide.analysis.machine.span) * 1e3))
    assert not diagram.turn


def test_quantities_go_by_symbol_too_and_parts_have_theirs(shaper: Case) -> None:
    assert list(diagrams([shaper], ["M.bal"])) == ["M.eq"]
    with pytest.raises(UnknownNameError, match=r"v\.E"):
        diagrams([shaper], ["v.F"])
    with pytest.raises(NotOfferedError, match=r"l\.AB"):
        diagrams([shaper], ["l.AB"])
    with pytest.raises(NotOfferedError):
        diagrams([open_case(ASSIGNMENTS / "gears" / "pair-least-shift.yaml")], ["gears.rho.1"])
    whole = opened(dense(api.load(ASSIGNMENTS / "coursework" / "shaper.yaml"), 48))
    (curve,) = diagrams([whole], ["cam.psi"])["cam.psi"].curves
    assert np.asarray(curve.y).size >= 49


HEAD = "phi (deg),v.E (mm/s)\n"


def test_measured_values_are_in_the_units_of_the_chart(shaper: Case, tmp_path: Path) -> None:
    table = tmp_path / "rig.csv"
    table.write_text("t (ms),note,v.E (mm/s)\n0,a,1500\n20,b,\n40,c,-250\n")
    measured = read_measured(table, shaper, ["v.E"])
    curve = diagrams([shaper], ["v.E"], measured=measured)["v.E"].curves[-1]
    assert curve.dots
    assert curve.label == Chain((Symbol("v", "E"),), "rig")
    speed = float(shaper.ledger["omega.1"].values[0])
    assert curve.x == pytest.approx(np.degrees(abs(speed) * np.array([0.0, 0.02, 0.04])))
    assert np.asarray(curve.y)[[0, 2]] == pytest.approx([1.5, -0.25])
    assert np.isnan(np.asarray(curve.y)[1])


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("v.E (m/s)\n1\n", r"rig\.csv:1:1: error\[measured-no-axis"),
        ("phi (deg),v.D (m/s)\n0,1\n", r"rig\.csv:1:1: error\[measured-nothing"),
        ("phi (deg),v.E\n0,1\n", r"rig\.csv:1:11: error\[missing-unit"),
        ("phi (deg),v.E (N)\n0,1\n", r"rig\.csv:1:11: error\[wrong-unit"),
        (HEAD + "0,1\n10,one\n", r"rig\.csv:3:\d+: error\[not-a-number"),
    ],
)
def test_faults_of_a_table_are_located(shaper: Case, tmp_path: Path, text: str, told: str) -> None:
    table = tmp_path / "rig.csv"
    table.write_text(text)
    with pytest.raises(AssignmentError, match=told):
        read_measured(table, shaper, ["v.E"])


# --- on axes ------------------------------------------------------------------------------------------


def test_a_diagram_is_drawn_on_axes_as_on_paper() -> None:
    """The report's chart of the torque: the same curve, its mean, its marks, the names of its axes."""
    from matplotlib.figure import Figure

    scene = dict(built.scenes(built.written(SHAPER, "en").document))["fig.M"]
    diagram = scene.diagram
    assert diagram is not None
    axes = diagram.on(Figure().subplots(), "en")
    curve, level = axes.lines
    assert curve.get_xydata() == pytest.approx(np.column_stack((diagram.curves[0].x, diagram.curves[0].y)))
    assert list(curve.get_markevery()) == list(diagram.curves[0].marks)
    assert level.get_ydata()[0] == pytest.approx(diagram.levels[0][0])
    assert axes.get_xticks()[1] == 45.0
    assert axes.get_ylabel().startswith("$")
    assert "N·m" in axes.get_ylabel()
    # Over it another one, with a legend of both.
    diagram.on(axes, "vi", label="again")
    assert len(axes.lines) == 4
    assert "−100" in [axes.yaxis.get_major_formatter()(-100.0, 0)]
    assert axes.yaxis.get_major_formatter()(0.5, 0) == "0,5"


def test_all_charts_of_a_report_are_diagrams() -> None:
    scenes = list(built.scenes(built.written(ASSIGNMENTS / "engine-twin-05.yaml", "vi").document))
    for key in ("fig.motion", "fig.M", "fig.polar"):
        assert all(scene.diagram is not None for own, scene in scenes if own == key)


def test_a_plot_is_a_file(caplog: pytest.LogCaptureFixture) -> None:
    """The same one each time, of which no library has anything to say."""
    files = plot_files([SHAPER, SHAPER], ["v.E", "M.eq"], formats=["svg", "eps"])
    assert list(files) == ["v.E.svg", "v.E.eps", "M.eq.svg", "M.eq.eps"]
    assert files == plot_files([SHAPER, SHAPER], ["v.E", "M.eq"], formats=["svg", "eps"])
    assert caplog.records == []
