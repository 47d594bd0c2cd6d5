# The public names of the library, by topic. Nothing else is imported by other parts of the project, except the methods
# that the solver is compared with (`conveyor.methods`) by the stage accuracy, and the certificates, a part of its own
# that needs python-flint (`conveyor.certificates`).

# Model and parameters
from .parameters import (
    DEFAULT_TOLERANCE,
    DESCRIPTIONS,
    FIXED_STEP_METHODS,
    HARMONIC,
    HARMONICS,
    LAST,
    MOST_HARMONICS,
    PARAMETERS,
    RANGES,
    TANGENTIAL,
    TENSION_MODES,
    UNITS,
    normal_gravity,
)
from .solver.model import Conveyor, Harmonic, Start, check_parameter, conveyor_motion
from .packing import (
    INITIAL_CONDITION,
    conveyor_and_start,
    parameter_table,
    plate_heights,
    plate_peaks,
    replace_parameters,
    set_parameters,
)

# One run, many runs, and their results
from .simulation import Run, simulate
from .ensemble import continued, sample_runs, sweep, transits
from .columns import Columns
from .parallel import for_each_chunk
from .progress import progress_bar

# Attractors
from .analysis.attractors.labels import LONG_FLIGHT, STATES, classify
from .analysis.attractors.attractor_table import NO_ATTRACTORS, AttractorTable, distinct_conveyors, find_places
from .analysis.attractors.search import find_attractors
from .analysis.attractors.sampling import sampled_initial_conditions

# The stroboscopic map
from .analysis.map_states import initial_states, start_at, strobes
from .analysis.stroboscopic_map import MAX_PERIOD
from .solver.pieces import BEGIN_OF_CYCLE

# Basins of attraction and their boundaries
from .interface import Basin, basin
from .analysis.basins.boundary_scan import count_decisions, find_crossings, locate_change, select_critical
from .analysis.basins.first_impact import first_impacts, on_conveyor
from .analysis.basins.hyperbola import Hyperbola, critical_height, mean_squared_error
from .analysis.basins.hyperbola_fit import fit_hyperbola, fit_hyperbola_by_pymoo, hyperbola_profile

# Periodic orbits, branches and bifurcations
from .interface import continue_orbit, periodic_orbit
from .analysis.bifurcations.periodic_orbits import ORBIT_TOLERANCE, Orbit, ReturnMap, find_orbit, settled_orbit
from .analysis.bifurcations.continuation import (
    SAME_ORBIT,
    Bifurcation,
    Branch,
    explore_bifurcations,
    find_doubled_orbit,
    follow_branch,
    on_branch,
)
from .analysis.bifurcations.doubling_cascade import accumulation_point, doubling_cascade, doubling_ratios
from .analysis.bifurcations.bifurcation_diagram import follow_attractor
from .analysis.bifurcations.bifurcation_points import (
    GRAZING,
    BifurcationPoint,
    at_phase_zero,
    find_bifurcation,
    touching_point,
)
from .analysis.bifurcations.bifurcation_curves import (
    BifurcationCurve,
    CurveEnd,
    ParameterPath,
    follow_bifurcation_curve,
    follow_grazing_curve,
)

# Chaos
from .analysis.chaos.lyapunov import lyapunov_spectrum, lyapunov_spectrum_on_attractors
from .analysis.chaos.pairs import finite_difference_exponent, renormalised_exponent
from .analysis.chaos.random_walk import NO_FLUCTUATIONS, RANDOM_WALK_STATUS, random_walk, relative_spread

# Dimensions
from .analysis.fractals.box_counting import box_dimension, box_dimension_of_paper
from .analysis.fractals.correlation_sum import correlation_dimension
from .analysis.fractals.reference_sets import REFERENCE_DIMENSIONS
from .analysis.fractals.scaling_region import Dimension

# Dimensionless groups, spectra and textbook theory
from .analysis.contact_groups import contact_of_groups, groups_of_contact
from .analysis.dimensionless_groups import (
    amplitude_of,
    groups_of,
    length_and_speed_units,
)
from .analysis.amplitude_spectrum import AmplitudeSpectrum, harmonic_spectrum, windowed_spectrum
from .analysis.throw_theory import throw_number, throw_velocity

# What the study of the solver reports of it
from .solver.record import SAMPLES
from .solver.polynomial import ORDER

# Integrators of others with which the solver is compared
