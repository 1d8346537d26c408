"""MSH as Gmsh writes it: every version, physical groups, parametric nodes, higher orders."""

from pathlib import Path

import pytest

from crossview.io import RawSurface, read_surface
from solvers.errors import CrossviewError
from solvers.repair import repair

NODES = "1 0 0 0\n2 1 0 0\n3 1 1 0\n7 0 1 0\n"

VERSION_1 = f"""$NOD
4
{NODES}$ENDNOD
$ELM
3
1 1 1 1 2 1 2
2 2 5 6 3 1 2 3
3 2 5 6 3 1 3 7
$ENDELM
"""

GROUPS = f"""$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 1 "top of $Nodes"
2 2 "all"
$EndPhysicalNames
$Nodes
4
{NODES}$EndNodes
$Elements
4
1 2 2 1 6 1 2 3
2 2 2 1 6 1 3 7
3 2 2 2 6 1 2 3
4 2 2 2 6 1 3 7
$EndElements
"""

PARAMETRIC = """$MeshFormat
4.1 0 8
$EndMeshFormat
$Entities
1 1 1 0
1 0 0 0 0
1 0 0 0 1 1 0 0 2 1 -1
1 0 0 0 1 1 0 0 0
$EndEntities
$Nodes
3 4 1 7
0 1 0 1
1
0 0 0
1 1 1 2
2
3
1 0 0 0.25
1 1 0 0.5
2 1 1 1
7
0 1 0 0.125 0.5
$EndNodes
$Elements
2 3 1 3
1 1 1 1
1 1 2
2 1 2 2
2 1 2 3
3 1 3 7
$EndElements
"""

VERSION_4_0 = """$MeshFormat
4 0 8
$EndMeshFormat
$Nodes
1 4
1 2 0 4
1 0 0 0
2 1 0 0
3 1 1 0
7 0 1 0
$EndNodes
$Elements
1 2
1 2 2 2
1 1 2 3
2 1 3 7
$EndElements
"""

THIRD_ORDER = (
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n13\n"
    + NODES
    + "".join(f"{10 + i} {i} 5 5\n" for i in range(9))
    + "$EndNodes\n$Elements\n2\n1 21 2 0 1 1 2 3 10 11 12 13 14 15 16\n"
    "2 21 2 0 1 1 3 7 10 11 12 13 14 15 16\n$EndElements\n"
)

TEXTS = {
    "1.0": VERSION_1,
    "physical groups": GROUPS,
    "parametric": PARAMETRIC,
    "4.0": VERSION_4_0,
    "third order": THIRD_ORDER,
}


def read(folder: Path, text: str) -> RawSurface:
    path = folder / "x.msh"
    path.write_text(text)
    return read_surface(path)


@pytest.mark.parametrize("name", TEXTS)
def test_each_kind_gives_the_same_square(name: str, tmp_path: Path) -> None:
    raw = read(tmp_path, TEXTS[name])
    surface = repair(raw.vertices, raw.faces).surface
    assert (surface.n_vertices, surface.n_faces) == (4, 2)
    assert surface.area == pytest.approx(1)


def test_elements_of_several_groups_are_taken_once(tmp_path: Path) -> None:
    assert "left out 2 elements listed again" in read(tmp_path, GROUPS).notes


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("2.2 0 8", "3.7 0 8", "version 3.7"),
        ("1 2 2 1 6 1 2 3", "1 2 2 1 6 1 2 9", "node 9"),
        ("1 2 2 1 6 1 2 3", "1 2 -2 1 6 1 2 3", "negative number of tags"),
        ("$Elements\n4", "$Elements\n400000000000", "cut short"),
        ("$Nodes\n4", "$Nodes\n-4", "cut short"),
        ("$EndElements", "", "cut short"),
    ],
)
def test_what_is_wrong_is_told(old: str, new: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(CrossviewError, match=said):
        read(tmp_path, GROUPS.replace(old, new))
