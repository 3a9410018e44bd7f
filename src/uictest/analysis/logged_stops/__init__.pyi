from .together import StopsTogether as StopsTogether, stops_table as stops_table
