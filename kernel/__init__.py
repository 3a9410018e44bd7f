"""Writes the model of the rig as C++ and builds it; not part of the installed package."""
