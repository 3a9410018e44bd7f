from .rig import Rig as Rig, RigState as RigState
