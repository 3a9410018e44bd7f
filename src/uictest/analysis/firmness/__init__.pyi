from .stops import Drawn as Drawn, drawn as drawn
from .study import Effort as Effort, FirmnessStudy as FirmnessStudy, HoldDraws as HoldDraws
