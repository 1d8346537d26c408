"""The verbs of the command line and of the window as functions, for scripts.

Each takes and returns values that nothing changes afterwards: `read` makes a `Problem`, `natural`,
`complete`, `make_valid`, `improve`, `snap` and `simplify` make others of it, `solve` a
`Solution`, `layout` a `QuadLayout`, `quads` a `QuadMesh`. What takes long calls `progress`, if it
is given, with each `solvers.Progress`.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from crossview.cases.gallery import find_case
from crossview.cases.model import Builtin, Case, CaseError, check_method
from crossview.certificate import Certificate, certify
from crossview.studies import TIME_LIMIT, Limits, Study
from crossview.studies import batch as run_study
from crossview.workflow import configurations
from crossview.workflow import layout as layouts
from crossview.workflow import quads as meshes
from crossview.workflow.certification import faces_in, faces_of, reference
from crossview.workflow.pipeline import Pipeline
from crossview.workflow.problem import Problem
from crossview.workflow.solution import Solution
from solvers import CrossviewError, Progress, TriSurface, run
from solvers.fields import CURVATURE_WEIGHT, MOST_VALENCE
from solvers.kind_checks import one_of_kind
from solvers.layouts import QuadLayout
from solvers.number_checks import whole_number
from solvers.quads import MAX_CHORD, MAX_SIZE_RATIO, QuadMesh

if TYPE_CHECKING:
    from crossview.export.notebook import NotebookPicture

Watch = Callable[[Progress], object] | None
"""What is called with each step of a long computation."""

Target = str | os.PathLike[str] | Case
"""A case, or what names one on the command line."""


def read_surface(
    path: str | os.PathLike[str], *, component: int | str | None = None, repair: bool = False
) -> TriSurface:
    r"""Return the surface in a file.

    Parameters
    ----------
    path : path-like
        OBJ, PLY, STL, OFF, VTK, VTP, VTU, glTF, GLB or MSH.
    component : int or str, optional
        Of a surface in several pieces: "largest" or a number (0 is the largest).
    repair : bool, optional
        Also cut the surface apart at non-manifold edges and vertices.

    Returns
    -------
    TriSurface
        What is in it, repaired where that loses nothing.

    Raises
    ------
    CrossviewError
        It cannot be read or is no surface; the offending elements are named.

    Examples
    --------
    >>> from pathlib import Path
    >>> import crossview
    >>> corners = "v 0 0 0\n v 2 0 0\n v 2 1 0\n v 0 1 0\n"
    >>> _ = Path("rectangle.obj").write_text(corners + "f 1 2 3 4")
    >>> crossview.read_surface("rectangle.obj").area
    2.0
    """
    return read(Case(str(_path("surface", path))), component=component, repair=repair).surface


def read(
    target: Target,
    *,
    method: str | None = None,
    features: float | None = None,
    component: int | str | None = None,
    repair: bool = False,
) -> Problem:
    """Return the problem that a case poses.

    Parameters
    ----------
    target : str, path or Case
        A case file, a surface file (a case without singularities), the name of a gallery case or
        of a built-in surface; or a case.
    method : {"isotropic", "aligned", "anisotropic", "alternating"}, optional
        Instead of the case's.
    features : float, optional
        Edges over which the surface bends by more degrees are to be followed, as are the curves
        that the case marks.
    component : int or str, optional
        Of a surface in several pieces: "largest" or a number (0 is the largest).
    repair : bool, optional
        Also cut the surface apart at non-manifold edges and vertices.

    Returns
    -------
    Problem
        Its surface read, and its singularities and corners put on it.

    Raises
    ------
    CrossviewError
        There is no such thing, or something in it is wrong; one line says what and where.

    Examples
    --------
    >>> import crossview
    >>> problem = crossview.read("disk-4")
    >>> [s.valence for s in problem.singularities], problem.surface.euler_characteristic
    ([3, 3, 3, 3], 1)
    """
    case = target if isinstance(target, Case) else find_case(str(_path("case", target)))
    return Problem.from_case(
        case.with_choices(method=method, features=features, component=component, repair=repair)
    )


def natural(
    problem: Problem,
    method: str = "mbo",
    seed: int = 0,
    *,
    alignment: str = "smoothness",
    weight: float = CURVATURE_WEIGHT,
    most_valence: int = MOST_VALENCE,
    fewest: bool = False,
    most: int | None = None,
    scale: float | None = None,
    progress: Watch = None,
) -> Problem:
    """Put the singularities of a smooth cross-field in place of a problem's.

    Parameters
    ----------
    problem : Problem
        Its surface and features count.
    method : {"mbo", "ginzburg-landau", "globally-optimal"}, optional
        How the cross-field is smoothed.
    seed : int, optional
        Of the random start of the first two methods.
    alignment : {"smoothness", "curvature"}, optional
        Whether the crosses are also drawn towards the directions of principal curvature.
    weight : float, optional
        How strongly.
    most_valence : int, optional
        Of a singularity; none has less than 2.
    fewest : bool, optional
        Whether as few singularities are to be left as the index budget allows.
    most : int, optional
        How many singularities at most.
    scale : float, optional
        Length below which details of the surface do not count, in its units; 0.03 roots of its
        area if not given. With 0 all count.
    progress : callable, optional
        Called with each step.

    Returns
    -------
    Problem
        The same but for singularities and corners.

    Raises
    ------
    CrossviewError
        The method or the alignment is unknown, the weight is negative or not finite, the most
        valence is below 5, the scale is not above 0, or the singularities cannot be as few as that.

    Examples
    --------
    A sphere's smoothest cross-field has eight singularities of index 1:

    >>> import crossview
    >>> problem = crossview.natural(crossview.Problem(crossview.primitives.sphere(subdivisions=3)))
    >>> [s.valence for s in problem.singularities]
    [3, 3, 3, 3, 3, 3, 3, 3]
    """
    _require("problem", problem, Problem)
    computation = configurations.natural(
        problem,
        method,
        seed,
        alignment=alignment,
        weight=weight,
        most_valence=most_valence,
        fewest=fewest,
        most=most,
        scale=scale,
    )
    return run(computation, progress)


def complete(problem: Problem, *, progress: Watch = None) -> Problem:
    """Add the valences 3 or 5 that the index budget lacks, where they even out the sizes most.

    Parameters
    ----------
    problem : Problem
        Perhaps with some singularities already.
    progress : callable, optional
        Called with each step.

    Returns
    -------
    Problem
        The added ones come last.

    Raises
    ------
    CrossviewError
        There is no room for them.

    Examples
    --------
    >>> import crossview
    >>> surface = crossview.primitives.disk(edge_length=0.1)
    >>> [s.valence for s in crossview.complete(crossview.Problem(surface)).singularities]
    [3, 3, 3, 3]
    """
    return run(configurations.complete(_require("problem", problem, Problem)), progress)


def make_valid(problem: Problem, *, progress: Watch = None) -> Problem:
    """Move unlocked singularities as little as need be until every holonomy defect vanishes.

    Parameters
    ----------
    problem : Problem
        Whose index budget holds.
    progress : callable, optional
        Called with each step.

    Returns
    -------
    Problem
        The same with its singularities moved.

    Raises
    ------
    SingularityError
        They cannot be made valid; its remedies are what helps, tried before.

    Examples
    --------
    >>> import crossview
    >>> from crossview import Problem, Singularity
    >>> surface = crossview.primitives.annulus(inner=0.4, n=48)
    >>> places = [surface.closest_point(place) for place in ([0.85, 0.1, 0], [0.55, 0, 0])]
    >>> pair = [Singularity(place, valence) for place, valence in zip(places, (3, 5))]
    >>> crossview.solve(crossview.make_valid(Problem(surface, pair))).valid
    True
    """
    _require("problem", problem, Problem)
    return run(configurations.make_valid(problem), progress)[0]


def improve(problem: Problem, *, progress: Watch = None) -> Problem:
    """Move unlocked singularities to where sizes are most even, all holonomy defects kept at zero.

    Parameters
    ----------
    problem : Problem
        Whose index budget holds; if it is not valid it is made valid first. With a size map, sizes
        come nearest to it.
    progress : callable, optional
        Called with each step; those that are `solvers.validity.Improved` have the sizes.

    Returns
    -------
    Problem
        The same with its singularities moved.

    Raises
    ------
    SingularityError
        None may move, or they cannot be made valid.

    Examples
    --------
    >>> import crossview
    >>> from crossview import Problem, Singularity
    >>> surface = crossview.primitives.disk(edge_length=0.1)
    >>> places = [surface.closest_point(x) for x in ([0.2, 0, 0], [0, 0.3, 0], [-0.5, 0, 0])]
    >>> start = crossview.complete(Problem(surface, [Singularity(x, 3) for x in places]))
    >>> better = crossview.improve(start)
    >>> spread = [float(crossview.solve(p).field.H.std()) for p in (start, better)]
    >>> spread[1] < spread[0]
    True
    """
    _require("problem", problem, Problem)
    return run(configurations.improve(problem), progress)[0]


def snap(problem: Problem, *, progress: Watch = None) -> Problem:
    """Move unlocked singularities until separatrices meet what they nearly meet.

    Parameters
    ----------
    problem : Problem
        Whose index budget holds; if it is not valid it is made valid first.
    progress : callable, optional
        Called with each step; those that are `solvers.layouts.Snapped` have the connections.

    Returns
    -------
    Problem
        The same with its singularities moved, valid, and what is joined as its connections.

    Raises
    ------
    SingularityError
        None may move, none is nearly met, or they cannot be made valid.

    Examples
    --------
    >>> import crossview
    >>> from crossview import Problem, Singularity
    >>> surface = crossview.primitives.disk(edge_length=0.1)
    >>> places = [[0.5, 0.03, 0], [0, 0.5, 0], [-0.5, 0, 0], [0, -0.5, 0]]
    >>> threes = [Singularity(surface.closest_point(place), 3) for place in places]
    >>> crossview.layout(crossview.solve(crossview.snap(Problem(surface, threes)))).patches
    5
    """
    _require("problem", problem, Problem)
    return run(configurations.snap(problem), progress)[0]


def simplify(
    problem: Problem, most: int, *, most_valence: int = MOST_VALENCE, progress: Watch = None
) -> Problem:
    """Merge unlocked singularities, those of least worth first, and make what is left valid.

    Parameters
    ----------
    problem : Problem
        Whose index budget holds.
    most : int
        How many singularities may be left.
    most_valence : int, optional
        Of a singularity that others are merged to.
    progress : callable, optional
        Called with each step.

    Returns
    -------
    Problem
        The same with fewer singularities; none were merged across its features.

    Raises
    ------
    SingularityError
        So few cannot be left, or they cannot be made valid.

    Examples
    --------
    A torus needs no singularities, and the natural ones are not that few:

    >>> import crossview
    >>> torus = crossview.natural(crossview.Problem(crossview.primitives.torus(n=24)))
    >>> fewer = crossview.simplify(torus, 4)
    >>> len(torus.singularities), len(fewer.singularities)
    (10, 4)
    >>> crossview.solve(fewer).valid
    True
    """
    _require("problem", problem, Problem)
    return run(configurations.simplify(problem, most, most_valence=most_valence), progress)[0]


def solve(problem: Problem, method: str | None = None, *, progress: Watch = None) -> Solution:
    """Solve for the cross-field of a problem.

    Parameters
    ----------
    problem : Problem
        Whose index budget holds.
    method : {"isotropic", "aligned", "anisotropic", "alternating"}, optional
        Instead of the problem's.
    progress : callable, optional
        Called with each step.

    Returns
    -------
    Solution
        The field, what it was solved on, and what it is worth.

    Raises
    ------
    CrossviewError
        The index budget is missed, a singularity is on the boundary, two coincide, the turns are
        too many or too few, or the size map is wrong.

    Examples
    --------
    Four valence 3 are what the index budget of a disk asks for:

    >>> import crossview
    >>> solution = crossview.solve(crossview.read("disk-4"))
    >>> solution.field.index_sum, solution.valid, solution.verdict.status
    (4, True, 'valid')
    """
    _require("problem", problem, Problem)
    if method is not None:
        problem = replace(problem, method=check_method(method, "method"))
    return run(Pipeline().solve(problem), progress)


def layout(solution: Solution, *, progress: Watch = None) -> QuadLayout:
    """Cut the surface of a solution into rectangles along its separatrices.

    Parameters
    ----------
    solution : Solution
        Aligned and integrable, as its verdict says.
    progress : callable, optional
        Called with each step.

    Returns
    -------
    QuadLayout
        The rectangles and the separatrices around them.

    Raises
    ------
    LayoutError
        The field misses a boundary or is not integrable, there is no quad mesh with these
        singularities, or triangles are inverted in the map.

    Examples
    --------
    >>> import crossview
    >>> layout = crossview.layout(crossview.solve(crossview.read("disk-4")))
    >>> layout.patches, layout.conforming
    (5, True)
    """
    return run(layouts.layout(_require("solution", solution, Solution)), progress)


def quads(
    layout: QuadLayout,
    target_quads: int | None = None,
    *,
    edge_length: float | None = None,
    smooth: bool = True,
    max_chord: float = MAX_CHORD,
    max_size_ratio: float = MAX_SIZE_RATIO,
    progress: Watch = None,
) -> QuadMesh:
    """Fill a layout with quads.

    Parameters
    ----------
    layout : QuadLayout
        What to fill.
    target_quads : int, optional
        About how many; 5 000 if no edge length is given either.
    edge_length : float, optional
        Mean length of their edges.
    smooth : bool, optional
        Whether vertices slide along the surface to better quads.
    max_chord : float, optional
        Largest distance of an edge from the boundary or feature that it follows, in radii of its
        bend; at most 1.
    max_size_ratio : float, optional
        How much longer than the mean edge of all those along an arc of the layout may be, on
        average, as far as the number of quads allows; above 1.
    progress : callable, optional
        Called with each step.

    Returns
    -------
    QuadMesh
        Conforming, on the surface of the layout.

    Raises
    ------
    CrossviewError
        Both a number and a length are given, they do not fit the surface, a singularity has
        valence 1, or no numbers of quads were found.

    Examples
    --------
    Irregular vertices are just where singularities were imposed:

    >>> import crossview
    >>> layout = crossview.layout(crossview.solve(crossview.read("disk-4")))
    >>> crossview.quads(layout, 300).irregular
    {3: 4}
    """
    _require("layout", layout, QuadLayout)
    options = meshes.MeshOptions(edge_length, target_quads, smooth, max_chord, max_size_ratio)
    return run(meshes.quads(layout, options), progress)


def batch(
    study: str | os.PathLike[str] | Study | Mapping[str, Any],
    directory: str | os.PathLike[str],
    *,
    workers: int | None = None,
    time_limit: float = TIME_LIMIT,
    memory_limit: float | None = None,
    scheduler: str | None = None,
    progress: Watch = None,
) -> list[dict[str, Any]]:
    """Run the cases of a study in several processes; write a table and a page of all figures.

    Parameters
    ----------
    study : path-like, Study or mapping
        What is wanted: a study file, or what one says, with paths relative to the working folder.
    directory : path-like
        For table.csv, index.html and what is kept of each case; what has ended there before is not
        worked on again.
    workers : int, optional
        Number of processes; one for each core if it is not given.
    time_limit : float, optional
        Seconds that a case may take.
    memory_limit : float, optional
        Memory that a case may take, in 1e9 bytes; a process's share of the machine if not given.
    scheduler : str, optional
        Address of the scheduler of a dask.distributed cluster, to work there.
    progress : callable, optional
        Called as each case ends.

    Returns
    -------
    list of dict
        The rows of the table: case, status, reason, step, seconds and files, what varies, figures.

    Raises
    ------
    CrossviewError
        The study cannot be begun, or the directory cannot be written. A case that goes wrong is a
        row.

    Examples
    --------
    >>> import crossview
    >>> study = {"cases": ["disk-4"], "vary": {"singularities[0].valence": [3, 4]}}
    >>> [row["status"] for row in crossview.batch(study, "results", workers=1)]
    ['done', 'failed']
    """
    if isinstance(study, Mapping):
        study = Study.from_json(study)
    elif not isinstance(study, Study):
        study = Study.load(_path("study", study))
    limits = Limits(time_limit, memory_limit)
    if workers is not None:
        workers = whole_number("the number of workers", workers, 1)
    folder = _path("folder", directory)
    computation = run_study(study, folder, workers=workers, limits=limits, scheduler=scheduler)
    return run(computation, progress)


def write_case(
    problem: Problem,
    path: str | os.PathLike[str],
    *,
    surface: str | Builtin | None = None,
    title: str = "",
) -> None:
    """Write the case file of a problem, whole or not at all.

    Parameters
    ----------
    problem : Problem
        What to write.
    path : path-like
        The new file.
    surface : str or Builtin, optional
        What the problem's surface is read from; by default what it was.
    title : str, optional
        One line on what the case shows.

    Raises
    ------
    CrossviewError
        The file cannot be written, or the surface was made in Python and none is named.

    Examples
    --------
    >>> import crossview
    >>> crossview.write_case(crossview.read("disk-4"), "mine.json")
    >>> [s.valence for s in crossview.read("mine.json").singularities]
    [3, 3, 3, 3]
    """
    _require("problem", problem, Problem)
    path = _path("case file", path)
    source = problem.source if surface is None else surface
    if source is None:
        raise CaseError(
            "a case names what its surface is read from, and this one was made in Python",
            str(path),
            "give surface=, a file or a built-in",
        )
    problem.to_case(source, title).save(path)


def write_mesh(
    mesh: QuadMesh, path: str | os.PathLike[str], *, allow_inverted: bool = False
) -> None:
    """Write a quad mesh to a file; none with an inverted quad unless that is allowed.

    Parameters
    ----------
    mesh : QuadMesh
        What to write.
    path : path-like
        OBJ, VTK, VTU, PLY, glTF, GLB or MSH (Gmsh, with named boundaries).
    allow_inverted : bool, optional
        Write the mesh although a quad is inverted.

    Raises
    ------
    CrossviewError
        The format is unknown, a quad is inverted, or the file cannot be written.

    Examples
    --------
    >>> import crossview
    >>> layout = crossview.layout(crossview.solve(crossview.read("disk-4")))
    >>> crossview.write_mesh(crossview.quads(layout, 300), "quads.obj")
    """
    from crossview.export.meshes import write_mesh as write  # VTK is loaded when it is wanted

    mesh, path = _require("mesh", mesh, QuadMesh), _path("mesh file", path)
    write(mesh, path, allow_inverted=allow_inverted)


def write_solution(
    solution: Solution,
    directory: str | os.PathLike[str],
    *,
    layout: QuadLayout | None = None,
    quads: QuadMesh | None = None,
    formats: Sequence[str] = ("vtk", "obj"),
    allow_inverted: bool = False,
) -> None:
    """Write report.json and the fields and curves of a solution as .vtp files for ParaView.

    Parameters
    ----------
    solution : Solution
        What to write.
    directory : path-like
        Made if it is not there; all files are written, or none.
    layout : QuadLayout, optional
        Of the solution: separatrices that are exact.
    quads : QuadMesh, optional
        Of the layout: also them, and layout.vtp.
    formats : sequence of str, optional
        Those of `write_mesh` for the quads.
    allow_inverted : bool, optional
        Write the quads although one is inverted.

    Raises
    ------
    CrossviewError
        The folder cannot be made or written, a format is unknown, a quad is inverted, or layout or
        quads are of another solution.

    Examples
    --------
    >>> import json, pathlib
    >>> import crossview
    >>> crossview.write_solution(crossview.solve(crossview.read("disk-4")), "out")
    >>> json.loads(pathlib.Path("out/report.json").read_text())["index_sum"]
    4
    """
    from crossview.export.report import write_solution as write  # VTK is loaded when it is wanted

    _require_together(solution, layout, quads)
    folder = _path("folder", directory)
    write(solution, folder, layout, quads, formats, allow_inverted=allow_inverted)


def report(
    solution: Solution, layout: QuadLayout | None = None, quads: QuadMesh | None = None
) -> dict[str, Any]:
    """Return what is known of a solution as JSON values, as report.json has it.

    Parameters
    ----------
    solution : Solution
        What to tell of.
    layout : QuadLayout, optional
        Of the solution.
    quads : QuadMesh, optional
        Of the layout.

    Returns
    -------
    dict
        Angles in degrees, indices in quarter turns.

    Examples
    --------
    >>> import crossview
    >>> crossview.report(crossview.solve(crossview.read("disk-4")))["isotropically_valid"]
    True
    """
    from crossview.export.report import report as told  # VTK is loaded when it is wanted

    _require_together(solution, layout, quads)
    return told(solution, layout, quads)


def check(
    mesh: QuadMesh | str | os.PathLike[str],
    against: Problem,
    *,
    imposed: bool = False,
    target_quads: int | None = None,
) -> Certificate:
    """Check a quad mesh of any origin by a judge that shares nothing with what makes quads.

    Parameters
    ----------
    mesh : QuadMesh or path-like
        The mesh, or a file of one; its faces are taken as they stand there.
    against : Problem
        Whose surface it should cover, and whose features its edges should follow.
    imposed : bool, optional
        Whether its irregular vertices should be the problem's singularities and corners.
    target_quads : int, optional
        How many quads were wanted.

    Returns
    -------
    Certificate
        All that was measured, and what is wrong.

    Raises
    ------
    CrossviewError
        The file cannot be read, or there is no mesh in it.

    Examples
    --------
    >>> import crossview
    >>> problem = crossview.read("disk-4")
    >>> mesh = crossview.quads(crossview.layout(crossview.solve(problem)), 300)
    >>> crossview.check(mesh, problem, imposed=True).right
    True
    >>> print(crossview.check(mesh, problem, target_quads=400).faults[0])  # doctest: +ELLIPSIS
    3... faces, 400 were wanted
    """
    _require("problem", against, Problem)
    wanted = None if target_quads is None else whole_number("target_quads", target_quads, 1)
    faces = faces_of(mesh) if isinstance(mesh, QuadMesh) else faces_in(_path("mesh file", mesh))
    return certify(faces, reference([against], imposed, wanted))


def render(
    solution: Solution,
    path: str | os.PathLike[str],
    *,
    layout: QuadLayout | None = None,
    quads: QuadMesh | None = None,
    **how: Any,
) -> Path:
    """Draw a solution to a PNG, SVG or PDF file, without a display.

    Parameters
    ----------
    solution : Solution
        What to draw.
    path : path-like
        The new file.
    layout : QuadLayout, optional
        For the layer layout, and for separatrices that are exact.
    quads : QuadMesh, optional
        For the layer quads.
    **how
        Layers, size, scale, transparent, camera and background, as of
        `crossview.export.figures.render`.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    CrossviewError
        A layer, the camera or the file's suffix is unknown, the size cannot be drawn, or there is
        nothing to draw with.

    Examples
    --------
    >>> import crossview
    >>> solution = crossview.solve(crossview.read("disk-4"))
    >>> crossview.render(solution, "figure.png", size=(320, 240)).name
    'figure.png'
    """
    from crossview.export.figures import render as draw  # VTK is loaded when it is wanted

    _require_together(solution, layout, quads)
    return draw(solution, _path("figure", path), layout=layout, quads=quads, **how)


def picture(
    solution: Solution,
    *,
    layers: Sequence[str] | None = None,
    layout: QuadLayout | None = None,
    quads: QuadMesh | None = None,
    camera: str = "auto",
    height: int = 480,
) -> NotebookPicture:
    """Return a picture of a solution that turns in a Jupyter notebook.

    Parameters
    ----------
    solution : Solution
        What to draw.
    layers : sequence of str, optional
        Names of the layers drawn, as of `render`.
    layout : QuadLayout, optional
        For the layer layout, and for separatrices that are exact.
    quads : QuadMesh, optional
        For the layer quads.
    camera : str, optional
        From where it is seen at first, as of `render`.
    height : int, optional
        Pixels.

    Returns
    -------
    NotebookPicture
        As the last value of a cell it is shown.

    Raises
    ------
    CrossviewError
        A layer or the camera is unknown.

    Examples
    --------
    >>> import crossview
    >>> solution = crossview.solve(crossview.read("disk-4"))
    >>> crossview.picture(solution, layers=["H", "singularities"])  # doctest: +ELLIPSIS
    <picture of ... bytes>
    """
    # VTK is loaded when it is wanted
    from crossview.export.figures import solution_view
    from crossview.export.notebook import NotebookPicture
    from crossview.export.web import web_page

    _require_together(solution, layout, quads)
    height = whole_number("height", height, 16)
    view = solution_view(solution, layers=layers, layout=layout, quads=quads)
    return NotebookPicture(web_page(view, (4 * height // 3, height), camera), height)


MADE_BY: dict[type, str] = {
    Problem: "crossview.read or Problem(surface, singularities) makes one",
    Solution: "crossview.solve makes one",
    QuadLayout: "crossview.layout makes one",
    QuadMesh: "crossview.quads makes one",
}
"""How to come by the values that the verbs take."""

Kind = TypeVar("Kind")


def _require(name: str, value: object, kind: type[Kind]) -> Kind:
    """Return what a verb was given, or tell which verb makes what it wants."""
    return one_of_kind(f"the {name}", value, kind, MADE_BY[kind])


def _require_together(
    solution: Solution, layout: QuadLayout | None, quads: QuadMesh | None
) -> None:
    """Refuse a layout or quads that were not made of the solution they are told or drawn with."""
    _require("solution", solution, Solution)
    if layout is not None:
        _require("layout", layout, QuadLayout)
        if layout.integrated.field.singularities != solution.singularities or (
            layout.surface.mark != solution.surface.mark
        ):
            raise CrossviewError(
                "the layout is of another solution", advice="give crossview.layout(solution)"
            )
    if quads is not None:
        _require("quads", quads, QuadMesh)
        if quads.surface.mark != solution.surface.mark:
            raise CrossviewError(
                "the quads are of another solution", advice="make them of this one's layout"
            )


def _path(name: str, given: object) -> Path:
    """Return a path that may name a file or a folder."""
    if isinstance(given, str | os.PathLike):
        text = os.fspath(given)
        if isinstance(text, str) and text.strip() and "\0" not in text:
            return Path(text)
        raise CrossviewError(f"the name of the {name} is {text!r}", advice="name a file")
    raise CrossviewError(
        f"the name of the {name} must be a text or a Path, not {given!r:.40}",
        advice="name a file",
    )
