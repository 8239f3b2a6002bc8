"""Batches on a real Dask scheduler with workers of their own, of which one is killed."""

from __future__ import annotations

import io
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from reportgen.classes.batch_run import Order, run_batch
from reportgen.classes.dask_cluster import ClusterError, cluster
from reportgen.classes.worker_pool import Results
from tests.classes.classes import Batch, tree, write_class
from tests.lanes import proof

ROOT = Path(__file__).parents[2]


@pytest.fixture
def scheduler() -> Iterator[Any]:
    """A cluster of its own for each test: killed workers come back late on a busy machine."""
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0") as running:
        yield running


@proof
def test_a_killed_worker_takes_nothing_along(scheduler: Any, tmp_path: Path) -> None:
    """One of two workers is killed when the first result comes, while both are busy."""
    batch = Batch(tmp_path, {f"K{k}": f"seconds: 0.{k}" for k in range(8)})
    pool = cluster(scheduler.scheduler_address, "en")

    def with_a_death(*arguments: Any) -> Results:
        results = pool(*arguments)
        yield next(results)
        os.kill(next(iter(scheduler.workers.values())).process.pid, signal.SIGKILL)
        yield from results

    done = batch.run(pool=with_a_death)
    assert (done.made, done.failures) == (8, [])
    plain = Batch(tmp_path, {f"K{k}": f"seconds: 0.{k}" for k in range(8)}, "plain")
    plain.run()
    assert tree(batch.out) == tree(plain.out)


@proof
def test_a_job_that_kills_every_worker_fails_alone(scheduler: Any, tmp_path: Path) -> None:
    batch = Batch(tmp_path, {"K1": "dies: always", "K2": "wrong: not so", "K3": "seconds: 0"})
    done = batch.run(pool=cluster(scheduler.scheduler_address, "en"))
    assert {failure.student for failure in done.failures} == {"K1", "K2"}
    assert batch.students("done") == ["K3"]
    assert done.exit_code == 3


@proof
def test_papers_of_the_cluster_are_those_made_here(scheduler: Any, tmp_path: Path) -> None:
    text = (ROOT / "assignments" / "slotted-lever-01.yaml").read_text(encoding="utf-8")
    roster, given = write_class(tmp_path, {"K1": text})
    for out, address in (("here", None), ("there", scheduler.scheduler_address)):
        order = Order(roster, None, given, tmp_path / out, ("task", "key"), jobs=1, cluster=address)
        assert run_batch(order, io.StringIO()).exit_code == 0
    assert tree(tmp_path / "here") == tree(tmp_path / "there")


@proof
def test_a_scheduler_that_goes_keeps_what_is_done(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    batch = Batch(tmp_path, {f"K{k}": f"seconds: 0.{k}" for k in range(8)})
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=":0"
    ) as running:
        pool = cluster(running.scheduler_address, "en")

        def with_an_end(*arguments: Any) -> Results:
            results = pool(*arguments)
            yield next(results)
            running.close()
            yield from results

        with pytest.raises(ClusterError, match="was lost"):
            batch.run(pool=with_an_end)
    before = batch.students("done")
    assert before
    batch.run()
    assert batch.students("kept") == before


def test_nobody_answers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("reportgen.classes.dask_cluster.ANSWER", 0.2)
    batch = Batch(tmp_path, {"K1": "seconds: 0"})
    for address in ("tcp://127.0.0.1:9", "nonsense://here"):
        with pytest.raises(ClusterError, match=address):
            batch.run(pool=cluster(address, "en"))


def test_without_dask_the_remedy_is_told(tmp_path: Path) -> None:
    roster, given = write_class(tmp_path, {"K1": "kind: ship"})
    script = "import sys; sys.modules['distributed'] = None\nfrom reportgen.cli import main; main()"
    command = (sys.executable, "-c", script, "batch", roster, "--assignments", given, "--lang", "en")
    done = subprocess.run(
        [*map(str, command), "--cluster", "tcp://127.0.0.1:9", "--out", str(tmp_path / "out")],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 3
    assert done.stderr == "reportgen: --cluster needs Dask: pip install 'reportgen[cluster]'\n"
    assert not (tmp_path / "out").exists()


@pytest.mark.proof
def test_a_cluster_without_workers_is_not_waited_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    distributed = pytest.importorskip("distributed")
    monkeypatch.setattr("reportgen.classes.dask_cluster.WORKERLESS", 1)
    batch = Batch(tmp_path, {"K1": "seconds: 0"})
    with (
        distributed.LocalCluster(n_workers=0, processes=False, dashboard_address=":0") as running,
        pytest.raises(ClusterError, match="no worker"),
    ):
        batch.run(pool=cluster(running.scheduler_address, "en"))
