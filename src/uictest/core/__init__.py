"""What everything else is built on: physics, measures, recordings, units, files; knows no scenario."""
