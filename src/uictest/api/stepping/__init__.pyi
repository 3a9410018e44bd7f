from .rig import Rig as Rig
from .state import RigState as RigState
