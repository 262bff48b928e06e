"""Statistical checks of densities, samplers, albedos and hair fields, for any evaluator of the functions.

An evaluator is a set of callables on arrays: a float64 reference and a shader on a device are judged alike.
"""
