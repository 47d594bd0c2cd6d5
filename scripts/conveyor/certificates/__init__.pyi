from .balls import Refused, bounds, exactly, precision
from .brackets import bracket_doubling, bracket_fold
from .covering import Horseshoe, prove_horseshoe
from .excursion import plan_sets
from .law import Accuracy, Law, System, law_of
from .orbit import ProvedOrbit, check_near, prove_orbit
from .shooting import Shooting
