"""crossview check: whether a quad mesh, whoever made it, is what was wanted."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Annotated

from cyclopts import Parameter

from crossview.certificate import Certificate, certify
from crossview.cli.options import QUADS, FeatureOptions, Json
from crossview.cli.terminal import say, say_json
from crossview.workflow.certification import faces_in, reference
from crossview.workflow.problem import problems_of
from solvers.errors import CrossviewError, counted
from solvers.number_checks import whole_number


def check(
    quads: str,
    /,
    *,
    against: str | None = None,
    case: str | None = None,
    chosen: FeatureOptions = FeatureOptions(),
    target_quads: Annotated[int | None, Parameter(group=QUADS)] = None,
    as_json: Json = False,
) -> int:
    """Check a quad mesh of any origin; exit status 1 if something is wrong with it.

    Parameters
    ----------
    quads
        A file of the mesh; its faces are taken as they stand there.
    against
        The surface that it should cover: a surface file, or what names a case.
    case
        Whose singularities, corners and features it should have; also the surface, if no other is
        given.
    target_quads
        How many quads were wanted.
    as_json
        Print JSON, with all that was measured.
    """
    named = case or against
    if named is None:
        raise CrossviewError("nothing to check against", "", "add --against SURFACE")
    posed = chosen.case(named)
    if against is not None:
        posed = replace(posed, surface=chosen.case(against).surface)
    if target_quads is not None:
        target_quads = whole_number("--target-quads", target_quads, 1)
    mesh = faces_in(quads)
    found = certify(mesh, reference(problems_of(posed), case is not None, target_quads))
    if as_json:
        say_json(found.to_json())
    else:
        say("\n".join(_lines(quads, found)))
    return 0 if found.right else 1


def _lines(name: str, found: Certificate) -> Iterator[str]:
    """What was measured, for people."""
    measures, corners = found.measures, found.measures["corners"]
    counts, edge = measures["counts"], measures["mean_edge"]
    verdict = "right" if found.right else counted(len(found.faults), "fault")
    others = f" and {counts['non_quads']} other faces" if counts["non_quads"] else ""
    yield f"{name}: {counted(counts['quads'], 'quad')}{others}, {verdict}"
    for fault in found.faults:
        yield f"  fault: {fault}"
    yield (
        f"  corners of {corners['min_degrees']:.1f} to {corners['max_degrees']:.1f} degrees, "
        f"scaled Jacobian at least {corners['min_scaled_jacobian']:.2f}, "
        f"mean {corners['mean_scaled_jacobian']:.3f}"
    )
    if corners["excused_at_valence_2"]:
        number = counted(corners["excused_at_valence_2"], "vertex")
        yield f"  {number} of valence 2 with a corner of 180 degrees or more, as flat ones have"
    yield f"  irregular vertices {_numbers(measures['irregular']['found'])}"
    yield f"  on the boundary {_numbers(measures['irregular_on_boundary']['found'])}"
    distances = dict(measures["distances"])
    yield f"  area {distances.pop('area_ratio'):.4f} of the surface's"
    yield f"  largest distances in mean edges, of {edge:.4g}"
    for what, far in distances.items():
        said = "none there" if far is None else f"{far / edge:.3f}"
        yield f"    {what.replace('_', ' ')} {said}"


def _numbers(found: dict[str, int]) -> str:
    """How many there are of each number of faces."""
    return ", ".join(f"{n} of {number} quads" for number, n in found.items()) or "none"
