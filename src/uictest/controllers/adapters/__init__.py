"""Adapters: each makes controllers of one kind callable as a C function.

The rig knows one face: ``step(handle, inputs, outputs)`` at an address, with the memory of
:mod:`uictest.controllers.exchange`. An adapter is one module with a function
``open_controller(program, config)`` that returns an :class:`~.instance.ControllerInstance`.
"""
