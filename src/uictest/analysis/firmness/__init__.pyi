from .study import (
    Drawn as Drawn,
    Effort as Effort,
    FirmnessStudy as FirmnessStudy,
    drawn as drawn,
)
