from .pair import COMPARED as COMPARED, compared as compared
from .stops import Drawn as Drawn, drawn as drawn
from .study import Effort as Effort, FirmnessStudy as FirmnessStudy, HoldDraws as HoldDraws
