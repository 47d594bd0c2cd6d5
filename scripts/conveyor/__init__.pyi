# The front door: what a researcher uses, by task. `README.md` lists the modules of the second door, which the pipeline
# imports by their own names. `name as name` tells type checkers that a name is public.

__version__: str

# Conveyors, initial conditions, and tables of both
from .parameters import (
    DEFAULT_TOLERANCE as DEFAULT_TOLERANCE,
    PARAMETERS as PARAMETERS,
    RANGES as RANGES,
    UNITS as UNITS,
)
from .solver.model import (
    Conveyor as Conveyor,
    Harmonic as Harmonic,
    Start as Start,
)
from .packing import (
    conveyor_and_start as conveyor_and_start,
    parameter_table as parameter_table,
    replace_parameters as replace_parameters,
)

# Contacts from materials, and from how high a part bounces
from .materials import Material as Material, hertz_stiffness as hertz_stiffness, material as material
from .impact import damping_of as damping_of, restitution as restitution

# Trajectories: one, or one for each row of a table
from .simulation import Run as Run, plate_motion as plate_motion, simulate as simulate
from .ensemble import (
    restart as restart,
    sample_runs as sample_runs,
    sweep as sweep,
    transits as transits,
)
from .columns import Columns as Columns
from .analysis.amplitude_spectrum import (
    AmplitudeSpectrum as AmplitudeSpectrum,
    harmonic_spectrum as harmonic_spectrum,
    windowed_spectrum as windowed_spectrum,
)

# Parts as rigid bodies
from .blocks.block import (
    Block as Block,
    BlockRun as BlockRun,
    block_transits as block_transits,
    simulate_block as simulate_block,
)

# The stroboscopic map
from .analysis.map_states import initial_states as initial_states, start_at as start_at, strobes as strobes

# Attractors and their basins
from .analysis.attractors.labels import STATES as STATES, classify as classify
from .analysis.attractors.identity import Attractor as Attractor, Attractors as Attractors
from .interface import Basin as Basin, attractors as attractors, basin as basin
from .analysis.basins.basin_uncertainty import (
    basin_entropy as basin_entropy,
    uncertainty_exponent as uncertainty_exponent,
)

# Periodic orbits and bifurcations
from .analysis.bifurcations.periodic_orbits import Orbit as Orbit, periodic_orbit as periodic_orbit
from .analysis.bifurcations.continuation import (
    Bifurcation as Bifurcation,
    Branch as Branch,
    continue_orbit as continue_orbit,
    find_doubled_orbit as find_doubled_orbit,
)
from .analysis.bifurcations.doubling_cascade import (
    accumulation_point as accumulation_point,
    doubling_cascade as doubling_cascade,
    doubling_ratios as doubling_ratios,
)
from .analysis.bifurcations.bifurcation_curves import continue_bifurcation as continue_bifurcation
from .analysis.bifurcations.bifurcation_diagram import bifurcation_diagram as bifurcation_diagram

# Chaos and dimensions
from .analysis.chaos.lyapunov import lyapunov_spectrum as lyapunov_spectrum
from .analysis.fractals.box_counting import box_dimension as box_dimension
from .analysis.fractals.correlation_sum import correlation_dimension as correlation_dimension
from .analysis.fractals.scaling_region import Dimension as Dimension

# Dimensionless groups and textbook theory
from .analysis.dimensionless_groups import (
    amplitude_of as amplitude_of,
    groups_of as groups_of,
    length_and_speed_units as length_and_speed_units,
)
from .analysis.throw_theory import throw_number as throw_number, throw_velocity as throw_velocity
