"""Loops over lanes are vector code, in the widest registers that the compiler uses on this machine."""

import re

import numba
import numpy as np
import pytest

from conveyor import Conveyor, Start
from conveyor.methods import fixed_step, fixed_step_lanes
from conveyor.solver import contact_lanes
from conveyor.solver.model import pack

pytestmark = pytest.mark.long  # all code is compiled once more

# Of x86, with the number of float64 in a register.
REGISTERS = {"zmm": 8, "ymm": 4, "xmm": 2}


@numba.njit
def simple_loop(x):
    for k in range(len(x)):
        x[k] = 2.0 * x[k] + 1.0


def vector_instructions(function) -> dict[str, int]:
    """The numbers of multiplications, sums and roots of whole registers in the machine code, by the registers.

    function : compiled, and called before
    """
    # Compiled once more, because numba cannot show machine code from its cache.
    signature = function.signatures[0]
    again = numba.njit(error_model="numpy", nogil=True)(function.py_func)
    again.compile(signature)
    code = again.inspect_asm(signature)
    operations = re.findall(r"\bv?(?:f?n?m(?:add|sub)\d*|mul|add|sub|sqrt)pd\s[^\n]*?%([xyz]mm)", code)
    return {register: operations.count(register) for register in REGISTERS}


@pytest.fixture(scope="module")
def widest():
    """The widest registers in which the compiler makes vector code of the simplest loop."""
    simple_loop(np.ones(8))
    found = vector_instructions(simple_loop)
    if not any(found.values()):
        pytest.skip("this test reads the machine code of x86 processors only")
    return next(register for register in REGISTERS if found[register])


@pytest.mark.parametrize(("harmonics", "least"), [(None, 500), (2, 1500)])
def test_contact_steps_are_vector_code(widest, harmonics, least):
    """The expansion has about 360 products and sums, and each harmonic adds some 500 vector instructions."""

    @numba.njit(error_model="numpy", nogil=True)
    def step(memory, lanes):
        return contact_lanes.step(memory, lanes, harmonics)

    memory, _ = contact_lanes.new_memory(contact_lanes.row_count(harmonics))
    step(memory, contact_lanes.LANES)
    assert vector_instructions(step)[widest] > least


@pytest.mark.parametrize(
    ("method", "least", "plate"),
    [
        ("euler", 20, {}),
        ("euler", 20, {"harmonics": [{"order": 2, "normal": 0.1}, {"order": 5, "along": 0.1}]}),
        ("rk4", 90, {"inclination": 0.1, "phase_shift": 0.5, "static_friction": 0.5}),
    ],
)
def test_fixed_steps_are_vector_code(widest, method, least, plate):
    """A step has about twenty products and sums, and each evaluation of the forces in RK4 another twenty."""

    def count(runs):
        parameters = np.array([pack(Conveyor(**plate), Start())] * runs)
        fixed_step.run(parameters, 1e-5, 1e-6, method)
        kind = fixed_step_lanes.kind_of(fixed_step.METHODS.index(method), parameters)
        return vector_instructions(fixed_step_lanes.compiled_for(kind).__wrapped__)[widest]

    single = count(1)
    assert count(2) - single > least
    # The sines of several steps; without registers of at least four numbers, there are no fused multiply-adds either.
    if method == "euler" and REGISTERS[widest] > 2:
        assert single > 20
