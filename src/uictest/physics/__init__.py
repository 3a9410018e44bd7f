"""The parts of the rig, one per module, as pure scalar functions of floats.

Every function is written once, in terms of the operations of :mod:`uictest.physics.arithmetic`, so that
the same source runs as plain Python, compiled scalar code and SIMD lanes. Nothing here knows about
records, scenarios or units other than SI. Pressures are absolute unless a name says ``gauge``.
"""
