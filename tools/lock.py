"""Write requirements-lock.txt: the version of each package that is installed here.

usage: python tools/lock.py
"""

import platform
import subprocess
import sys
from pathlib import Path

LOCK = Path(__file__).parents[1] / "requirements-lock.txt"

HEAD = """\
# What the tests were last seen to pass with, by Python {python} on {system}:
# pip install -r requirements-lock.txt && pip install --no-deps -e .
# Made by `make lock`.
"""


def main() -> None:
    """Ask pip what there is."""
    command = [sys.executable, "-m", "pip", "freeze", "--exclude-editable"]
    ran = subprocess.run(command, capture_output=True, text=True, check=True)
    head = HEAD.format(python=platform.python_version(), system=platform.system())
    LOCK.write_text(head + ran.stdout, encoding="utf-8")


if __name__ == "__main__":
    main()
