"""Every example in the documents runs and prints what is said."""

from pathlib import Path

import pytest

from tools.documents import WrongExample, examples, run_examples

ROOT = Path(__file__).resolve().parents[1]
DOCUMENTS = [
    path
    for path in (*sorted(ROOT.glob("*.md")), *sorted(ROOT.glob("docs/**/*.md")))
    if "written" not in path.parts and any(examples(path.read_text(encoding="utf-8")))
]


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.stem)
def test_the_examples_of_a_document_do_what_it_says(document: Path, tmp_path: Path) -> None:
    run_examples(document, tmp_path)


@pytest.mark.parametrize(
    "wrong",
    [
        "```python\nprint(1 + 1)  # 3\n```\n",
        "```python\nprint(1 + 1)\n```\n",
        "```python\nprint(2)\nprint(3)  # 2\n```\n",
        "```sh\ncrossview info no-such-thing\n```\n",
        "```sh\ncrossview gallery --list disk-4\n```\n\n```text\nanother title\n```\n",
    ],
)
def test_an_example_that_does_not_is_found(wrong: str, tmp_path: Path) -> None:
    document = tmp_path / "wrong.md"
    document.write_text(wrong, encoding="utf-8")
    with pytest.raises(WrongExample, match=r"wrong\.md, line 1"):
        run_examples(document, tmp_path)


def test_a_case_in_a_document_is_read(tmp_path: Path) -> None:
    document = tmp_path / "case.md"
    document.write_text('```json disk.json\n{"surface": "disk"}\n```\n', encoding="utf-8")
    run_examples(document, tmp_path)
    assert (tmp_path / "disk.json").read_text(encoding="utf-8") == '{"surface": "disk"}\n'
    document.write_text('```json\n{"surfaces": "disk"}\n```\n', encoding="utf-8")
    with pytest.raises(Exception, match="surfaces"):
        run_examples(document, tmp_path)
