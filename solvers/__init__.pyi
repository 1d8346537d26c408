from solvers.errors import CrossviewError as CrossviewError
from solvers.errors import SingularityError as SingularityError
from solvers.errors import SolveError as SolveError
from solvers.errors import SurfaceError as SurfaceError
from solvers.fields import CrossField as CrossField
from solvers.fields import IsotropicSolver as IsotropicSolver
from solvers.progress import Progress as Progress
from solvers.progress import run as run
from solvers.remedies import MakeValid as MakeValid
from solvers.remedies import Remedy as Remedy
from solvers.remedies import RepairSurface as RepairSurface
from solvers.remedies import TakeLargest as TakeLargest
from solvers.remedies import UseMethod as UseMethod
from solvers.singularities import Singularity as Singularity
from solvers.surface import SurfacePoint as SurfacePoint
from solvers.surface import TriSurface as TriSurface

__all__: list[str]
