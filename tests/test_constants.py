"""Every constant says what it is of."""

import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def undocumented(source: str) -> Iterator[str]:
    """The constants of a module without a string after them; type variables are none."""
    body = ast.parse(source).body
    value: ast.expr | None
    for statement, following in zip(body, [*body[1:], ast.Pass()], strict=True):
        match statement:
            case ast.Assign(targets=[target], value=value):
                pass
            case ast.AnnAssign(target=target, value=value):
                pass
            case _:
                continue
        names = [name.id for name in ast.walk(target) if isinstance(name, ast.Name)]
        described = isinstance(following, ast.Expr) and isinstance(following.value, ast.Constant)
        if names[0].isupper() and not described and "TypeVar" not in ast.unparse(value or target):
            yield names[0]


def test_constants_say_what_they_are_of() -> None:
    silent = {
        path.relative_to(ROOT): found
        for path in (*ROOT.glob("crossview/**/*.py"), *ROOT.glob("solvers/**/*.py"))
        if (found := list(undocumented(path.read_text(encoding="utf-8"))))
    }
    assert not silent


def test_silent_constants_are_found() -> None:
    source = 'NEAR = 1e-3\n"""Radians."""\nFAR, FARTHER = 1, 2\nT = TypeVar("T")\nMOST: int = 3\n'
    assert list(undocumented(source)) == ["FAR", "MOST"]
