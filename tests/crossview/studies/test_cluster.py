"""Studies on a cluster: a real scheduler, and workers that are processes of their own."""

import json
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import crossview as library
from crossview.studies.ledger import LINES
from tests.command_line import Crossview


@contextmanager
def started(*words: object) -> Iterator[subprocess.Popen[bytes]]:
    """Run a program until the end of the block."""
    with subprocess.Popen(
        [sys.executable, *map(str, words)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    ) as process:
        try:
            yield process
        finally:
            process.kill()


def wait_for(what: Any, process: subprocess.Popen[bytes]) -> None:
    while not what():
        assert process.poll() is None
        time.sleep(0.01)


def test_a_lost_worker_loses_nothing_and_nothing_is_done_twice(tmp_path: Path) -> None:
    surface, study, out = tmp_path / "annulus.obj", tmp_path / "study.json", tmp_path / "out"
    made = library.primitives.annulus(inner=0.4, n=96)
    corners = [f"v {x} {y} {z}" for x, y, z in made.vertices]
    surface.write_text("\n".join([*corners, *(f"f {a} {b} {c}" for a, b, c in made.faces + 1)]))
    places = [[0.6 * np.cos(a), 0.6 * np.sin(a), 0] for a in np.linspace(0.1, 3, 16)]
    placed = [{"position": [0.8, 0, 0], "valence": 3}, {"position": [0.6, 0, 0], "valence": 5}]
    case = {"surface": "annulus.obj", "singularities": placed}
    vary = {"singularities[1].position": places}
    study.write_text(json.dumps({"cases": [case], "vary": vary}))
    told = tmp_path / "scheduler.json"
    named = ("--scheduler-file", told)
    with ExitStack() as running:
        dask = ("-m", "distributed.cli.dask_scheduler", "--port", 0, "--no-dashboard", *named)
        scheduler = running.enter_context(started(*dask))
        wait_for(lambda: told.exists() and told.read_text().endswith("}"), scheduler)
        worker = ("-m", "distributed.cli.dask_worker", "--nthreads", 1, "--no-nanny")
        crew = [
            running.enter_context(
                started(*worker, "--no-dashboard", "--local-directory", tmp_path / str(i), *named)
            )
            for i in range(2)
        ]
        address = json.loads(told.read_text())["address"]
        program = "import sys; from crossview.cli import main; sys.exit(main(sys.argv[1:]))"
        command = ("-c", program, "batch", study, "-o", out, "--scheduler", address)
        batch = running.enter_context(started(*command))
        lines = out / LINES
        wait_for(lambda: lines.exists() and len(lines.read_bytes().splitlines()) >= 3, batch)
        crew[0].kill()
        assert batch.wait() == 0
    done = [json.loads(line) for line in lines.read_text().splitlines()]
    assert set(Counter(entry["key"] for entry in done).values()) == {1}
    assert [entry["status"] for entry in done] == ["done"] * 16
    # the same cases here: all of them are known, and none is worked on again
    rows = library.batch(study, out, workers=1)
    assert len(lines.read_text().splitlines()) == 16
    defects = [abs(row["holonomy.defect_degrees.max"]) for row in rows]
    theory = np.degrees(np.linspace(0.1, 3, 16)) / 4
    assert defects == pytest.approx(theory, rel=1e-3)


def test_a_scheduler_that_is_not_there_is_told(crossview: Crossview, tmp_path: Path) -> None:
    study = tmp_path / "study.json"
    study.write_text(json.dumps({"cases": ["disk-4"]}))
    ran = crossview("batch", study, "-o", tmp_path / "out", "--scheduler", "nowhere")
    assert (ran.status, ran.err.count("\n")) == (2, 1)
    assert "the scheduler does not answer (nowhere)" in ran.err
