from crossview.cases.model import Case as Case
from crossview.certificate import Certificate as Certificate
from crossview.library import batch as batch
from crossview.library import check as check
from crossview.library import complete as complete
from crossview.library import improve as improve
from crossview.library import layout as layout
from crossview.library import make_valid as make_valid
from crossview.library import natural as natural
from crossview.library import picture as picture
from crossview.library import quads as quads
from crossview.library import read as read
from crossview.library import read_surface as read_surface
from crossview.library import render as render
from crossview.library import report as report
from crossview.library import simplify as simplify
from crossview.library import snap as snap
from crossview.library import solve as solve
from crossview.library import write_case as write_case
from crossview.library import write_mesh as write_mesh
from crossview.library import write_solution as write_solution
from crossview.workflow.problem import Problem as Problem
from crossview.workflow.solution import Solution as Solution
from solvers import CrossviewError as CrossviewError
from solvers import Singularity as Singularity
from solvers import SurfacePoint as SurfacePoint
from solvers import TriSurface as TriSurface
from solvers import primitives as primitives
from solvers.layouts import QuadLayout as QuadLayout
from solvers.quads import QuadMesh as QuadMesh

__all__: list[str]
__version__: str
