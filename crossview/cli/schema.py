"""crossview schema: the format of case files, for other programs."""

from __future__ import annotations

from crossview.cases.schema import schema as schema_of_cases
from crossview.cli.terminal import say_json


def schema() -> None:
    """Print the JSON Schema of case files, by which editors complete and check them."""
    say_json(schema_of_cases())
