"""Damage small files of every format by the thousand, and see that none does harm.

``python -m tools.fuzz 20000`` takes so many inputs, the same at each run; ``--first 20000`` goes on
from there. Each is a file of the corpus with some bytes, words or lines changed, given to
``crossview info`` (size maps to what reads them). A fault is anything but an answer or one line of
refusal: the end of the process, a traceback or warning, more than 10 s, more than 2 GB.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import re
import resource
import signal
import subprocess
import sys
import tempfile
import traceback
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from crossview.cli import main
from crossview.workflow.sizes import read_sizes
from solvers.errors import CrossviewError

CORPUS = Path(__file__).resolve().parents[1] / "tests" / "corpus"
"""Small valid files of every format and, named after their faults, those that once did harm."""

SIZE_MAPS = {".npy", ".txt"}
"""Endings of files that are no surfaces."""

SLOW = {".vtk", ".vtp", ".vtu"}
"""Endings of files that take a process each: only a few of the inputs are of these."""

SECONDS, MEMORY = 10, 2 << 30
"""Processor time and addresses that reading a small file may take."""

PATIENCE = 120
"""Seconds by the clock after which one that only waits hangs, too; the machine may be busy."""

WORD = re.compile(rb"[^\s\",:{}\[\]<>=]+")
"""What counts as a word in any of the formats."""

WORDS = (
    b"0 -1 1 2 3 4 99 -2147483648 4294967295 9007199254740993 900000000000 1e90 1e308 1e400 nan "
    b"inf -0 1e-320 0.5 x null true [] {} \xff"
).split() + [b"", b"1" * 400, b"\x1b[31m", b"k" * 5000]
"""What words are replaced with."""

NUMBERS = [0, 1, -1, 2, 127, 255, 2**16, 2**31 - 1, -(2**31), 2**40, -(2**63)]
"""What stands instead of some bytes of a binary file."""


def damaged(data: bytes, other: bytes, rng: np.random.Generator) -> bytes:
    """Change a file in one to four places."""
    for _ in range(rng.integers(1, 5)):
        data = _once(data, other, rng)
    return data


def _once(data: bytes, other: bytes, rng: np.random.Generator) -> bytes:
    size = len(data)
    a, b = sorted(rng.integers(0, size + 1, 2).tolist())
    match rng.integers(9):
        case 0:
            return data[:a] + bytes([rng.integers(256)]) + data[a + 1 :]
        case 1:
            return data[:a] + data[min(b, a + 64) :]
        case 2:
            return data[:b] + data[a : a + 256] + data[b:]
        case 3:
            return data[:a]
        case 4:
            c = int(rng.integers(len(other) + 1))
            return data[:a] + other[c : c + 256] + data[a:]
        case 5:
            width = int(rng.choice([1, 2, 4, 8]))
            number = int(rng.choice(NUMBERS)) % 256**width
            return data[:a] + int.to_bytes(number, width, "little") + data[a + width :]
        case 6:
            lines = data.split(b"\n")
            one, two = rng.integers(len(lines), size=2)
            lines[one], lines[two] = lines[two], lines[one]
            return b"\n".join(lines)
        case _:
            words = list(WORD.finditer(data))
            if not words:
                return data
            word = words[rng.integers(len(words))]
            new = WORDS[int(rng.integers(len(WORDS)))]
            return data[: word.start()] + new + data[word.end() :]


def inputs(first: int, stop: int) -> Iterator[tuple[int, str, bytes]]:
    """Yield the numbers, names and contents of inputs, and the corpus itself before the first."""
    seeds = [(path.name, path.read_bytes()) for path in sorted(CORPUS.iterdir())]
    quick = [seed for seed in seeds if Path(seed[0]).suffix not in SLOW]
    slow = [seed for seed in seeds if Path(seed[0]).suffix in SLOW]
    for number in range(first, stop):
        if number < len(seeds):
            yield number, *seeds[number]
            continue
        rng = np.random.default_rng(number)
        some = slow if number % (len(quick) // 2) == 0 else quick
        name, data = some[rng.integers(len(some))]
        other = seeds[rng.integers(len(seeds))][1]
        yield number, name, damaged(data, other, rng)


def fault(path: Path) -> str:
    """Say what is wrong with how a file is taken; nothing if it is answered or refused."""
    if path.suffix in SIZE_MAPS:
        try:
            read_sizes(str(path), 9)
        except CrossviewError as error:
            return _fault_of_line(str(error))
        return ""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        status = main(["info", str(path)])
    said = err.getvalue()
    if status not in (0, 1, 2):
        return f"status {status}"
    if not out.getvalue():
        return _fault_of_line(said.removesuffix("\n")) if status == 2 else "says nothing"
    return f"besides the answer: {said}" if said else ""


def _fault_of_line(said: str) -> str:
    if not said or not said.isprintable() or len(said) > 6000:
        return f"no line that can be read: {said[:200]!r}"
    return f"too much memory: {said}" if "memory" in said and "VTK" not in said else ""


def work(first: int, stop: int) -> None:
    """Take inputs; print the number of each before, and what is wrong with it."""
    hard = resource.getrlimit(resource.RLIMIT_AS)[1]
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, hard))
    with tempfile.TemporaryDirectory() as folder:
        for number, name, data in inputs(first, stop):
            path = Path(folder) / name
            path.write_bytes(data)
            print(number, name, flush=True)
            signal.setitimer(signal.ITIMER_PROF, SECONDS)  # the signal ends this process
            signal.alarm(PATIENCE)
            try:
                said = fault(path)
            except BaseException:  # whatever it is, it is a fault
                said = traceback.format_exc()
            signal.setitimer(signal.ITIMER_PROF, 0)
            signal.alarm(0)
            if said:
                print(f"fault {said!r}", flush=True)


def run(first: int, stop: int) -> tuple[Counter[str], list[tuple[int, str]]]:
    """Return how many inputs of each format were taken, and the faults by number."""
    taken: Counter[str] = Counter()
    faults: list[tuple[int, str]] = []
    while first < stop:
        end = min(first + 500, stop)
        command = [sys.executable, "-W", "error", "-m", "tools.fuzz", "--work"]
        worker = subprocess.Popen(
            [*command, "--first", str(first), str(end - first)], stdout=subprocess.PIPE, text=True
        )
        number = first - 1
        for line in worker.stdout or ():
            if line.startswith("fault "):
                faults.append((number, line[6:].rstrip()))
            else:
                number, name = int(line.split()[0]), line.split()[1]
                taken[Path(name).suffix] += 1
        if worker.wait():
            number = max(number, first)
            faults.append((number, f"the process ended: {worker.returncode}"))
            end = number + 1
        first = end
    return taken, faults


def keep(number: int, folder: Path) -> Path:
    """Write an input into a folder, to look at it."""
    ((_, name, data),) = inputs(number, number + 1)
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{number}-{name}"
    path.write_bytes(data)
    return path


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("count", type=int)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--work", action="store_true", help=argparse.SUPPRESS)
    asked = parser.parse_args()
    stop = asked.first + asked.count
    if asked.work:
        work(asked.first, stop)
        sys.exit()
    counts, found = run(asked.first, stop)
    for number, said in found:
        print(f"{keep(number, Path('build/fuzz'))}: {said}")
    print(f"{len(found)} faults in {counts.total()} inputs: {dict(sorted(counts.items()))}")
    sys.exit(bool(found))
