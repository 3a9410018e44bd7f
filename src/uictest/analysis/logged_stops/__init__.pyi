from .together import StopsTogether as StopsTogether
