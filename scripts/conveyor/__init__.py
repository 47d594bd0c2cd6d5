"""Dynamics of a point mass on a vibratory conveyor: exact events, and the analysis of the motion.

The public names are those in `__init__.pyi`; each is imported when it is first used, so that a program which needs
names and units alone does not wait for NumPy and Numba. `README.md` says how the library works and what to read first.

Functions check their arguments. They raise ValueError or TypeError, which names the argument that cannot be used. All
other errors are in the docstrings.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
__version__ = "1.0.0"
