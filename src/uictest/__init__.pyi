from .stepping import Rig as Rig

__version__: str
