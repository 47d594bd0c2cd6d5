"""Numbers of captions that are neither tables nor settings: NAME.py has a function `numbers` for the figure NAME.

Its keyword arguments name the tables and settings that it reads. These modules are apart from the plots, because they
may use the library: a plot depends on its tables only, and is not drawn again after every change of the solver.
"""
