"""A model in Python: arrays, variants, studies, figures, tables; the notebook of the documents runs."""

from __future__ import annotations

import json
import pickle
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import reportgen
from reportgen import api
from reportgen.base.errors import AssignmentError, NotOfferedError, UnknownNameError
from reportgen.formula import Symbol
from reportgen.notebook import Model
from tests.export.ranges import deviations
from tests.lanes import proof

ROOT = Path(__file__).parents[2]
ASSIGNMENTS = ROOT / "assignments"
SHAPER = ASSIGNMENTS / "shaper-01.yaml"
OFF = 1e-9
"""Of a curve's maximum: a study and a file of its own count in another order."""


@pytest.fixture(scope="module")
def shaper() -> Model:
    return reportgen.open(SHAPER, "en")


# --- opening ------------------------------------------------------------------------------------------


def test_a_path_a_text_and_a_dict_are_one(shaper: Model) -> None:
    text = SHAPER.read_text(encoding="utf-8")
    plain = {
        "kind": "shaper",
        "positions": {"count": 12},
        "parameters": {
            "a": "270 mm",
            "b": "520 mm",
            "l3": "550 mm",
            "l4": "100 mm",
            "H": "420 mm",
            "n": "89 rpm",
            "cutting": {"F": "1000 N"},
        },
    }
    for source in (str(SHAPER), text, plain):
        assert np.array_equal(reportgen.open(source)["v.E"], shaper["v.E"])


def test_faults_are_those_of_a_file(shaper: Model) -> None:
    with pytest.raises(AssignmentError, match=r"shaper-01\.yaml:13:6: error\[missing-unit\]"):
        shaper.with_parameters(a="260")
    with pytest.raises(AssignmentError, match=r"shaper-01\.yaml:13:3: error\[unknown-key\]"):
        shaper.with_parameters(q="260 mm")
    with pytest.raises(AssignmentError, match=r"assignment\.yaml:4:\d+: error\[missing-unit\]"):
        reportgen.open({"kind": "shaper", "parameters": {"a": "270"}})
    with pytest.raises(AssignmentError, match="unreadable"):
        reportgen.open("nowhere.yaml")


def test_a_number_is_in_si_units_a_text_in_its_own(shaper: Model) -> None:
    for value in ("380 mm", "0.38 m", 0.38, np.float64(0.38)):
        assert shaper.with_parameters(H=value)["v.E"] == pytest.approx(shaper.with_parameters(H="38 cm")["v.E"])
    assert shaper.with_parameters(**{"cutting.F": 900.0})["P5"].max() == pytest.approx(0.9 * shaper["P5"].max())
    # The first one is as it was.
    assert shaper["P5"].max() == 1000.0


def test_figures_and_tables_print_on_one_line(shaper: Model) -> None:
    """The arrays and the drawing itself are not printed; the line says how to save them."""
    figure, table = repr(shaper.figure("scheme")), repr(shaper.table())
    assert re.fullmatch(r'<figure scheme, \d+ × \d+ mm; save it: \.save\("scheme\.svg"\)>', figure)
    assert re.fullmatch(r"<table of results, 12 rows × \d+ columns; save it: .*>", table)
    assert re.fullmatch(r"<scene, \d+ × \d+ mm, \d+ items>", repr(shaper.figure("scheme").scene))
    assert repr(shaper.diagram("v.E")) == "<diagram with 1 curve; draw it: .on(axes)>"


# --- quantities -----------------------------------------------------------------------------------------


def test_a_quantity_is_an_array_that_knows_what_it_is(shaper: Model) -> None:
    v = shaper["v.E"]
    assert (v.name, v.symbol, v.unit, v.shape) == ("v.E", Symbol("v", "E"), "m/s", (12,))
    positions = api.solve(shaper.assignment)["positions"]
    assert v == pytest.approx([one["points"]["E"]["v"][0] for one in positions])
    assert (shaper["dir.v.D"].unit, shaper["l.DE"].unit, shaper["l.DE"].shape) == ("rad", "m", (1,))
    # What is computed of it is in no unit that it knows.
    assert type(v * v) is np.ndarray
    assert type(v[2:4]).__name__ == "QuantityArray"
    with pytest.raises(UnknownNameError):
        shaper["v.X"]
    assert {"v.E", "omega.3", "M.eq"} <= set(shaper.ids)


def test_a_study_is_as_files_of_their_own(shaper: Model) -> None:
    """Also where a value is refused, and of lengths on paper, which no formula gives for all values."""
    lengths = np.array([0.30, 0.36, 2.0, 0.42])
    of = ["v.E", "omega.3", "M.eq", "seg.v.pe", "mu.v"]
    found = shaper.study(H=lengths, of=of)
    assert [found[id].shape for id in of] == [(4, 12)] * 4 + [(4, 1)]
    assert found["v.E"].unit == "m/s"
    for k, length in enumerate(lengths):
        if k == 2:
            assert all(np.isnan(found[id][k]).all() for id in of)
            continue
        alone = shaper.with_parameters(H=length)
        for id in of:
            assert np.abs(found[id][k] - alone[id]).max() <= OFF * np.abs(alone[id]).max()
    with pytest.raises(AssignmentError):
        shaper.study(H=[2.0, 3.0], of=["v.E"])
    with pytest.raises(ValueError, match="of equal length"):
        shaper.study(H=[0.3, 0.4], l4=[0.1], of=["v.E"])


@pytest.mark.parametrize(
    "name",
    [
        "four-bar-02.yaml",
        *(
            pytest.param(name, marks=proof)
            for name in ("engine-twin-05.yaml", "slider-crank-01.yaml", "linkage-8.yaml", "cam/roller-01.yaml")
        ),
    ],
)
def test_random_ranges_are_as_files_of_their_own(name: str) -> None:
    off = [one for seed in (1, 2) for one in deviations(ASSIGNMENTS / name, seed)]
    assert off
    assert [one for one in off if one.off > OFF] == []
    # Formulas tell a linkage, so its study takes no longer than it takes to read the values; a cam is designed anew.
    assert any(one.together for one in off) == ("cam" not in name)


# --- figures, curves, tables ------------------------------------------------------------------------------


def test_ranges_of_two_parameters_make_a_grid() -> None:
    """The pin's speed is ωr at each pair of values, worked out by hand; the slider's is that of a file of its own."""
    crank = reportgen.open(ASSIGNMENTS / "slider-crank-01.yaml", "en")
    speeds, radii = np.array([10.0, 20.0, 25.0]), np.array([0.1, 0.15])
    found = crank.study(of=["v.B", "v.C"], grid=True, omega1=speeds, r=radii)
    assert found["v.B"].shape == (3, 2, 1)
    assert np.allclose(found["v.B"][:, :, 0], np.outer(speeds, radii), rtol=1e-12)
    alone = crank.with_parameters(omega1=20.0, r=0.1)["v.C"]
    assert found["v.C"].shape == (3, 2, len(alone))
    assert np.allclose(found["v.C"][1, 0], alone, rtol=1e-12)
    assert found["v.C"].unit == "m/s"


@pytest.mark.parametrize("ranges", [{}, {"n": []}, {"n": [10.0, 20.0], "r": [0.1]}])
def test_a_study_without_ranges_or_with_unequal_ones_is_refused(ranges: dict[str, Any]) -> None:
    crank = reportgen.open(ASSIGNMENTS / "slider-crank-01.yaml", "en")
    with pytest.raises(UnknownNameError, match="parameter ranges of equal length") as caught:
        crank.study(of=["v.B"], **ranges)
    # Programs that catch what zip raises go on working.
    assert isinstance(caught.value, ValueError)


def test_a_parameter_takes_the_place_of_another_that_gives_the_same() -> None:
    """ω = 2πn/60: 300 rpm are 10π rad/s; a bare number has the unit of SI."""
    crank = reportgen.open(ASSIGNMENTS / "slider-crank-01.yaml", "en")
    assert crank.with_parameters(omega1=30)["omega.1"] == pytest.approx([30.0])
    back = crank.with_parameters(omega1="30 rad/s").with_parameters(n="300 rpm")
    assert back["omega.1"] == pytest.approx([10 * np.pi])
    # Mass and weight of a link, which the file has as G2.
    assert crank.with_parameters(m2=5.0).assignment.parameters.m2.si == 5.0
    with pytest.raises(AssignmentError, match="both-given"):
        crank.with_parameters(n="300 rpm", omega1=30)


def test_models_and_arrays_are_pickled(shaper: Model) -> None:
    shaper.figure("v", at=3)
    again = pickle.loads(pickle.dumps(shaper))
    assert repr(again) == repr(shaper)
    assert np.array_equal(again["v.E"], shaper["v.E"])
    array = pickle.loads(pickle.dumps(shaper["v.E"]))
    assert (array.name, array.symbol, array.unit) == ("v.E", shaper["v.E"].symbol, "m/s")


def test_numbers_of_any_length_are_faults_of_their_key() -> None:
    """Python writes no integer of more than 4,300 digits."""
    long = 10**5000
    with pytest.raises(AssignmentError, match="not-a-number"):
        reportgen.open({"kind": "slider-crank", "parameters": {"n": long, "r": np.int64(3), "l": (1, 2)}}, "en")
    crank = reportgen.open(ASSIGNMENTS / "slider-crank-01.yaml", "en")
    for name in ("n", "s", "omega1"):
        with pytest.raises(AssignmentError, match=r"error\["):
            crank.with_parameters(**{name: long})


def test_the_names_of_the_package_are_listed() -> None:
    assert set(reportgen.__all__) <= set(dir(reportgen))


def test_a_figure_is_saved_by_the_ending_of_its_name(shaper: Model, tmp_path: Path) -> None:
    plan = shaper.figure("v", at=3)
    assert plan.save(tmp_path / "plan.pdf").read_bytes().startswith(b"%PDF")
    assert plan.save(tmp_path / "plan.eps").read_bytes().startswith(b"%!PS")
    assert "<svg" in shaper.figure("groups")._repr_svg_()
    assert len(shaper.figure("groups").scenes) == 3
    with pytest.raises(UnknownNameError, match="png"):
        plan.save(tmp_path / "plan.pmg")
    with pytest.raises(NotOfferedError):
        shaper.figure("motion").save(tmp_path / "motion.gif")
    assert {"v.6", "motion", "machine"} <= set(shaper.figures)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["plan.eps", "plan.pdf"]


def test_plots_are_drawn_over_each_other(shaper: Model) -> None:
    import matplotlib

    matplotlib.use("agg")
    from matplotlib import pyplot

    try:
        axes = shaper.plot("v.E", label="H = 420 mm")
        assert axes is pyplot.gca()
        shaper.with_parameters(H="380 mm").plot("v.E", ax=axes, label="H = 380 mm", color="red")
        assert [line.get_label() for line in axes.lines] == ["H = 420 mm", "H = 380 mm"]
        assert [text.get_text() for text in axes.get_legend().get_texts()] == ["H = 420 mm", "H = 380 mm"]
        assert axes.lines[0].get_ydata().max() > axes.lines[1].get_ydata().max() > 0
        assert axes.lines[1].get_color() == "red"
    finally:
        pyplot.close("all")
    with pytest.raises(ValueError, match="one unit"):
        shaper.diagram("v.E", "a.E")


def test_a_table_has_the_columns_of_the_results(shaper: Model) -> None:
    table = shaper.table(8)
    assert table.columns[:3] == ("number", "crank_angle", "cycle_angle")
    assert table["points.E.v.x"].shape == (8,)
    with pytest.raises(KeyError):
        table["points.X"]
    assert table._repr_html_().count("<tr>") == 9
    assert "420 mm" in shaper._repr_html_()
    pandas = pytest.importorskip("pandas")
    assert isinstance(table.to_dataframe(), pandas.DataFrame)


# --- the documents ------------------------------------------------------------------------------------------


def _run(code: list[str], place: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    import matplotlib

    matplotlib.use("agg")
    from matplotlib import pyplot

    (place / "docs").mkdir()
    (place / "assignments").symlink_to(ASSIGNMENTS)
    (place / "docs" / "measured.csv").write_bytes((ROOT / "docs" / "measured.csv").read_bytes())
    monkeypatch.chdir(place)
    names: dict[str, Any] = {}
    try:
        for one in code:
            exec(one, names)
    finally:
        pyplot.close("all")
    return names


def test_the_notebook_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """From a file to three variants over measured points; the one that was measured is the nearest."""
    cells = json.loads((ROOT / "docs" / "variants.ipynb").read_text(encoding="utf-8"))["cells"]
    names = _run(["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"], tmp_path, monkeypatch)
    *curves, points = names["ax"].lines
    off = [np.abs(np.interp(points.get_xdata(), *one.get_data()) - points.get_ydata()).max() for one in curves]
    assert len(off) == 3
    assert off[1] == min(off)
    assert np.all(np.diff(names["ax2"].lines[0].get_ydata()) > 0)


def test_the_script_of_the_page_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (ROOT / "docs" / "reference" / "python.md").read_text(encoding="utf-8")
    scripts = re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    names = _run(scripts, tmp_path, monkeypatch)
    assert (tmp_path / "plan.pdf").exists()
    assert names["s"]["M.eq"].shape == (40, 12)
    assert capsys.readouterr().out.startswith("(40, 12)")
