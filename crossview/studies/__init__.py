"""Studies: many cases, each on its own and within limits, into one table."""

from crossview.studies.batch import batch
from crossview.studies.limits import TIME_LIMIT, Limits
from crossview.studies.study import Study

__all__ = ["TIME_LIMIT", "Limits", "Study", "batch"]
