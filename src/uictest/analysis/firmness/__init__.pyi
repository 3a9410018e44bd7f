from .pair import COMPARED as COMPARED, compared as compared
from .study import (
    Drawn as Drawn,
    Effort as Effort,
    FirmnessStudy as FirmnessStudy,
    drawn as drawn,
)
