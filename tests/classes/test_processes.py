"""The processes of a batch: one that dies takes no other along, and a killed batch loses nothing."""

from __future__ import annotations

import io
import multiprocessing
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from reportgen.api import Engine, Maker
from reportgen.base.files import put_file, put_set
from reportgen.base.records import replace
from reportgen.base.units import Language
from reportgen.classes import cleanup
from reportgen.classes import worker_pool as pools
from reportgen.classes.batch_run import Order, run_batch
from reportgen.classes.worker_pool import Job, local, making, run_job
from tests.classes.classes import Batch, tree, write_class
from tests.classes.little import little
from tests.lanes import proof

ROOT = Path(__file__).parents[2]


def test_a_dead_worker_costs_only_its_own_job(tmp_path: Path) -> None:
    flag = tmp_path / "died"
    students = {f"K{k}": "seconds: 0" for k in range(4)}
    batch = Batch(tmp_path, {**students, "K1": "dies: always", "K3": f"dies: {flag}"})
    done = batch.run(pool=local(2))
    assert sorted(batch.students("done")) == ["K0", "K2", "K3"]
    assert sorted(batch.students("retried")) == ["K1", "K3"]
    assert [failure.student for failure in done.failures] == ["K1"]
    assert done.exit_code == 3


@proof
def test_a_job_that_hangs_is_given_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pools, "LIMIT", 1.5)
    batch = Batch(tmp_path, {"K1": "seconds: 600", "K2": "seconds: 0", "K3": "seconds: 0"})
    done = batch.run(pool=local(2))
    assert [event for event in batch.events if event[0] == "K1"][-2:] == [
        ("K1", "little", "retried"),
        ("K1", "little", "failed"),
    ]
    assert (done.made, done.exit_code) == (2, 3)


def jobs_of(maker: Maker, *names: str) -> list[Job]:
    return [Job(name, name, "little", maker, f"{name}.yaml", b"", making("typst", "en")) for name in names]


def retried_never(job: Job) -> None:
    raise AssertionError(f"{job.student} had to begin anew")


class Deadly:
    """Kills the process that sends it."""

    def __reduce__(self) -> str:
        os.kill(os.getpid(), signal.SIGKILL)
        return ""


def deadly_result(path: Path, _engine: Engine, _language: Language | None) -> Mapping[str, Any]:
    return {"a.pdf": Deadly() if path.stem == "K1" else b""}


@pytest.mark.parametrize(("workers", "count"), [(2, 5), (1, 8)])
def test_a_worker_that_dies_as_it_sends_leaves_the_way_free_for_others(workers: int, count: int) -> None:
    """With a pipe or a lock that workers share, half a result or a lock held for ever would stop them all.

    Of eight jobs, the first three share a process; after it has died, each of them runs alone.
    """
    retried: list[str] = []
    jobs = jobs_of(deadly_result, *(f"K{k}" for k in range(count)))
    results = local(workers)(jobs, lambda job: retried.append(job.student))
    codes = {job.student: outcome.exit_code for job, outcome in results}
    assert codes == {f"K{k}": 3 if k == 1 else 0 for k in range(count)}
    assert retried == ["K1"]


def processes(_path: Path, _engine: Engine, _language: Language | None) -> Mapping[str, bytes]:
    """Which process made it, and which one started that."""
    return {"ids": f"{os.getpid()} {os.getppid()}".encode()}


def test_a_process_runs_a_few_jobs_and_fewer_towards_the_end() -> None:
    """So little memory is kept from one to the next; all come from one process that has everything loaded."""
    jobs = jobs_of(processes, *(f"K{k}" for k in range(11)))
    made = [outcome.files["ids"].split() for _, outcome in local(1)(jobs, retried_never)]
    assert list(Counter(process for process, _ in made).values()) == [3, 3, 2, 1, 1, 1]
    starters = {int(starter) for _, starter in made}
    assert len(starters) == 1
    if "forkserver" in multiprocessing.get_all_start_methods():
        assert os.getpid() not in starters


used: list[str] = []
"""Jobs that a process has run, whose memory it may keep."""


def room_for_one(path: Path, _engine: Engine, _language: Language | None) -> Mapping[str, bytes]:
    used.append(path.stem)
    if len(used) > 1 or path.stem == "K4":
        raise MemoryError
    return {"a.pdf": b""}


def test_a_job_for_which_memory_is_left_only_alone_runs_alone() -> None:
    jobs = jobs_of(room_for_one, *(f"K{k}" for k in range(7)))
    codes = {job.student: outcome.exit_code for job, outcome in local(1)(jobs, lambda job: None)}
    assert codes == {f"K{k}": 3 if k == 4 else 0 for k in range(7)}


named_sockets = pytest.mark.skipif(not hasattr(socket, "AF_UNIX"), reason="no sockets with names")


@named_sockets
def test_sockets_have_a_place_however_long_the_way_to_temporary_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / ("t" * 90)))
    monkeypatch.setitem(multiprocessing.current_process()._config, "tempdir", None)
    folder = cleanup.sockets()
    assert folder is not None
    with closing(socket.socket(socket.AF_UNIX)) as listener:
        listener.bind(f"{folder}/listener-12345678")


@proof
@named_sockets
@pytest.mark.parametrize("method", ["forkserver", "spawn"])
def test_a_long_way_to_temporary_files_stops_no_batch(method: str, tmp_path: Path) -> None:
    """The name of a socket has a hundred letters; where it finds no short place, processes begin without one."""
    write_class(tmp_path, {"K1": "seconds: 0"})
    temporary = tmp_path / ("t" * 90)
    temporary.mkdir()
    out = tmp_path / "out"
    nowhere = "cleanup.SHORT = (); " if method == "spawn" else ""
    code = f"from reportgen.classes import cleanup; {nowhere}import sys, tests.classes.little as l; sys.exit(l.main())"
    command = (sys.executable, "-c", code, tmp_path / "roster.csv", tmp_path / "given", out)
    ended = subprocess.run(list(map(str, command)), cwd=ROOT, env=os.environ | {"TMPDIR": str(temporary)}, text=True)
    assert (ended.returncode, [*temporary.iterdir()]) == (0, [])
    assert (out / "K1" / "a.pdf").is_file()


def deaf(_path: Path, _engine: Engine, _language: Language | None) -> Mapping[str, bytes]:
    """Whether Ctrl-C was held back from this process when it began."""
    return {"deaf": b"yes" if signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, ()) else b"no"}


@pytest.mark.skipif(not hasattr(signal, "pthread_sigmask"), reason="no signals to hold back")
def test_ctrl_c_reaches_no_worker_even_as_it_starts() -> None:
    ((_, outcome),) = local(1)(jobs_of(deaf, "K1"), retried_never)
    assert outcome.files["deaf"] == b"yes"


def lingering(path: Path, _engine: Engine, _language: Language | None) -> Mapping[str, bytes]:
    """K2 tells in a file where it works and goes on for ever; K1 ends once it has been told."""
    told_in = Path(path.read_text(encoding="utf-8"))
    if path.stem == "K2":
        put_file(told_in, str(path.parent).encode())
        time.sleep(600)
    while not told_in.exists():
        time.sleep(0.01)
    return {}


def test_who_is_no_longer_waited_for_ends_and_tidies_up(tmp_path: Path) -> None:
    told_in = tmp_path / "where"
    jobs = [replace(job, content=str(told_in).encode()) for job in jobs_of(lingering, "K1", "K2")]
    with closing(local(2)(jobs, retried_never)) as results:
        job, _ = next(results)
        assert job.student == "K1"
        scratch = Path(told_in.read_text(encoding="utf-8"))
        assert scratch.is_dir()
    assert not scratch.exists()
    assert [child for child in multiprocessing.active_children() if child.name == pools.NAME] == []


def test_a_worker_with_other_templates_makes_nothing() -> None:
    job = Job("K1", "K1", "little", little, "K1.yaml", b"seconds: 0", making("typst", "en"))
    other = replace(job, making=replace(job.making, templates="0"))
    assert run_job(job).exit_code == 0
    assert (run_job(other).exit_code, run_job(other).files) == (3, {})


class Process:
    """A batch in a process group of its own, to be killed."""

    def __init__(self, tmp_path: Path, out: Path) -> None:
        command = (sys.executable, "-m", "tests.classes.little", tmp_path / "roster.csv", tmp_path / "given", out)
        self.process = subprocess.Popen(
            list(map(str, command)), cwd=ROOT, stderr=subprocess.PIPE, text=True, start_new_session=True
        )

    def events(self, count: int) -> list[list[str]]:
        assert self.process.stderr is not None
        return [self.process.stderr.readline().split() for _ in range(count)]

    def finish(self, seconds: float = 60) -> int:
        assert self.process.stderr is not None
        self.process.stderr.read()
        return self.process.wait(seconds)


Put = Callable[[Mapping[Path, bytes], Collection[Path]], None]


def putting(monkeypatch: pytest.MonkeyPatch, put: Put) -> None:
    """Let a batch put its sets of files and its manifest in place so."""

    def puts(files: Mapping[Path, bytes], gone: Collection[Path] = ()) -> None:
        put(files, gone)

    monkeypatch.setattr("reportgen.classes.batch_run.put_set", puts)
    monkeypatch.setattr("reportgen.classes.batch_manifest.put_file", lambda target, content: put({target: content}, ()))


class Killed(BaseException):
    """What nothing in the program catches, as it could not catch its end."""


@pytest.mark.parametrize("placed", [False, True], ids=["half a file", "a whole file"])
def test_an_end_at_any_file_is_made_good(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, placed: bool) -> None:
    """Three students with a set of files each and two manifests: the run ends at each of them in turn."""
    students = {f"K{k}": "seconds: 0" for k in range(3)}
    straight = Batch(tmp_path, students, "straight")
    straight.run()
    ends = 0
    for end in range(100):
        puts = iter(range(100))

        def ending(
            files: Mapping[Path, bytes], gone: Collection[Path], end: int = end, puts: Iterator[int] = puts
        ) -> None:
            last = next(puts) == end
            if last and not placed:
                for target, content in files.items():
                    target.with_name(f".{target.name}.a1b2c3d4").write_bytes(content[:5])
                raise Killed
            put_set(files, gone)
            if last:
                raise Killed

        batch = Batch(tmp_path, students, f"ended at {end}")
        putting(monkeypatch, ending)
        try:
            batch.run()
        except Killed:
            ends += 1
        else:
            break
        done = batch.students("done")
        putting(monkeypatch, put_set)
        batch.run()
        assert set(done) <= set(batch.students("kept"))
        assert tree(batch.out) == tree(straight.out)
    assert ends == 3 + 2


@proof
def test_killed_again_and_again_nothing_is_lost(tmp_path: Path) -> None:
    """Whatever was told as done before the kill is not made again; the tree ends as if nothing had happened."""
    log, count = tmp_path / "log", 8
    write_class(tmp_path, {f"K{k}": f"log: {log}\nseconds: 0.05" for k in range(count)})
    out = tmp_path / "out"
    told: dict[str, int] = {}

    def begun() -> list[str]:
        return [line.split()[0] for line in log.read_text().splitlines()]

    for _ in range(3):
        batch = Process(tmp_path, out)
        while (event := batch.events(1)[0])[2] != "done":
            assert event[2] == "kept"
        batch.process.kill()
        batch.finish()
        told[event[0]] = len(begun())
        (out / event[0] / ".a.pdf.abc_d3fg").write_bytes(b"half of it")
    assert Process(tmp_path, out).finish() == 0
    assert len(told) == 3
    assert all(student not in begun()[since:] for student, since in told.items())
    # At most what the two workers had in hand at each kill, and one result on its way, was begun again.
    assert len(begun()) <= count + 3 * 3
    assert len(set(begun())) == count
    assert Process(tmp_path, tmp_path / "straight").finish() == 0
    assert tree(out) == tree(tmp_path / "straight")


@proof
def test_ctrl_c_ends_all_processes_and_keeps_what_is_done(tmp_path: Path) -> None:
    text = (ROOT / "assignments" / "slotted-lever-01.yaml").read_text(encoding="utf-8")
    roster, given = write_class(tmp_path, {f"K{k}": text for k in range(9)})
    command = (sys.executable, "-m", "reportgen.cli", "batch", roster, "--assignments", given)
    with subprocess.Popen(
        [*map(str, command), "--out", str(tmp_path / "out"), "--jobs", "2", "--lang", "en", "--make", "report"],
        cwd=ROOT,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        # A shell's background jobs, this test run perhaps, ignore the key.
        preexec_fn=partial(signal.signal, signal.SIGINT, signal.SIG_DFL),
    ) as process:
        assert process.stderr is not None
        student, product, event = process.stderr.readline().split()
        assert (product, event) == ("report", "done")
        # To all of the terminal's foreground processes, as a terminal does.
        os.killpg(process.pid, signal.SIGINT)
        *_, last = process.stderr.read().splitlines()
        assert last == "reportgen: stopped; run the same command again to continue"
        assert process.wait(20) == 130
    assert (tmp_path / "out" / student / "report.pdf").read_bytes().startswith(b"%PDF")
    deadline = time.monotonic() + 10
    while lives(process.pid):
        assert time.monotonic() < deadline
        time.sleep(0.05)


@proof
@pytest.mark.parametrize(("end", "code"), [("SIGKILL", -9), ("SIGTERM", 143), ("SIGHUP", 129)])
def test_a_batch_that_is_ended_leaves_no_process_and_no_folder(
    tmp_path: Path, tmp_path_factory: pytest.TempPathFactory, end: str, code: int
) -> None:
    """Itself alone is hit, as by a lack of memory: its workers and the process that they come from tidy up."""
    text = (ROOT / "assignments" / "slotted-lever-01.yaml").read_text(encoding="utf-8")
    roster, given = write_class(tmp_path, {f"K{k}": text for k in range(9)})
    # The name of a socket has a hundred letters at most, its folder's among them.
    out, temporary = tmp_path / "out", tmp_path_factory.mktemp("t")
    command = (sys.executable, "-m", "reportgen.cli", "batch", roster, "--assignments", given, "--out", out)
    with subprocess.Popen(
        [*map(str, command), "--jobs", "2", "--make", "report"],
        cwd=ROOT,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        env=os.environ | {"TMPDIR": str(temporary)},
    ) as process:
        assert process.stderr is not None
        process.stderr.readline()
        assert any(temporary.iterdir())
        process.send_signal(getattr(signal, end))
        try:
            assert process.wait(20) == code
        finally:
            # Nobody waits for one that does not end.
            process.kill()
        deadline = time.monotonic() + 30
        while lives(process.pid):
            assert time.monotonic() < deadline
            time.sleep(0.05)
    assert not [*temporary.iterdir()]
    assert not [*out.glob(".reportgen-*")]


def lives(group: int) -> bool:
    """Whether there still is a process in the group."""
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    return True


@proof
def test_reports_are_the_same_whoever_makes_them(tmp_path: Path) -> None:
    """Two real reports, by one process and by two."""
    text = (ROOT / "assignments" / "slotted-lever-01.yaml").read_text(encoding="utf-8")
    roster, given = write_class(tmp_path, {"K1": text, "K2": text.replace("variant:", "variant: 9 #", 1)})
    for jobs in (1, 2):
        order = Order(roster, None, given, tmp_path / str(jobs), ("report",), jobs=jobs)
        assert run_batch(order, io.StringIO()).exit_code == 0
    one, two = (tree(tmp_path / str(jobs)) for jobs in (1, 2))
    assert one == two
    assert one["K1/report.pdf"].startswith(b"%PDF")
    assert one["K1/report.pdf"] != one["K2/report.pdf"]
