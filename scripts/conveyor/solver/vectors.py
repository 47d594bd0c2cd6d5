"""Arithmetic on vector registers that hold one number of each of several trajectories, to write intrinsics with.

A register of 512 bits holds eight numbers, and one instruction works on all of them. IEEE 754 defines the rounding of
each operation, and no operation is moved or merged with another. A lane therefore gives the same bits as scalar code
with the same operations, whatever its neighbours and the number of lanes are.
"""

from llvmlite import ir
from llvmlite.binding import get_host_cpu_features
from numba.core import cgutils

BIT, INTEGER, FLOAT = ir.IntType(1), ir.IntType(64), ir.DoubleType()


class Vector:
    """The numbers in one register of a function that is being compiled: operators append an LLVM instruction to it.

    A plain number stands for itself in every lane. Comparisons give a Vector of bits.
    """

    def __init__(self, builder: ir.IRBuilder, value: ir.Value):
        self.builder, self.value, self.lanes = builder, value, value.type.count

    def like(self, number):
        """`number` as a Vector of the same kind."""
        if isinstance(number, Vector):
            return number
        return Vector(self.builder, ir.Constant(self.value.type, [number] * self.lanes))

    def cast(self, instruction, element):
        """The lanes converted to another type of element by an instruction of the builder."""
        return Vector(self.builder, instruction(self.value, ir.VectorType(element, self.lanes)))

    def apply(self, instruction, other):
        return Vector(self.builder, instruction(self.value, self.like(other).value))

    def compare(self, sign, other):
        """False where a number is NaN."""
        return Vector(self.builder, self.builder.fcmp_ordered(sign, self.value, self.like(other).value))

    def __neg__(self):
        return Vector(self.builder, self.builder.fneg(self.value))

    def __abs__(self):
        return call("fabs", self)

    def __add__(self, other):
        return self.apply(self.builder.fadd, other)

    def __sub__(self, other):
        return self.apply(self.builder.fsub, other)

    def __mul__(self, other):
        return self.apply(self.builder.fmul, other)

    def __rmul__(self, other):
        return self.like(other) * self

    def __truediv__(self, other):
        return self.apply(self.builder.fdiv, other)

    def __lt__(self, other):
        return self.compare("<", other)

    def __le__(self, other):
        return self.compare("<=", other)

    def __gt__(self, other):
        return self.compare(">", other)

    def __eq__(self, other):
        return self.compare("==", other)

    def __and__(self, other):
        return self.apply(self.builder.and_, other)

    def __or__(self, other):
        return self.apply(self.builder.or_, other)

    def __xor__(self, other):
        return self.apply(self.builder.xor, other)

    def __invert__(self):
        return Vector(self.builder, self.builder.not_(self.value))

    def __lshift__(self, count):
        return self.apply(self.builder.shl, count)


def where(condition: Vector, yes: Vector, no: Vector | float) -> Vector:
    """In each lane `yes` if its bit is set, else `no`."""
    return Vector(yes.builder, yes.builder.select(condition.value, yes.value, yes.like(no).value))


def anywhere(condition: Vector) -> ir.Value:
    """One bit: whether a lane's bit is set."""
    every = ir.IntType(condition.lanes)
    return condition.builder.icmp_unsigned("!=", condition.builder.bitcast(condition.value, every), every(0))


def call(name: str, first: Vector, *others: Vector | float) -> Vector:
    """An LLVM function that works on whole registers."""
    type_, builder = first.value.type, first.builder
    values = [first.like(operand).value for operand in (first, *others)]
    signature = ir.FunctionType(type_, [type_] * len(values))
    function = cgutils.get_or_insert_function(builder.module, signature, f"llvm.{name}.v{first.lanes}f64")
    return Vector(builder, builder.call(function, values))


def fma(a: Vector, b: Vector | float, c: Vector | float) -> Vector:
    """The product and sum a b + c, rounded once."""
    return call("fma", a, b, c)


def power(x: Vector, exponent: Vector | float, wanted: Vector, otherwise: Vector | float) -> Vector:
    """x^exponent by the C library, one lane after the other, where it is `wanted`; else `otherwise`."""
    builder, exponent = x.builder, x.like(exponent)
    found = cgutils.alloca_once_value(builder, x.like(otherwise).value)
    function = cgutils.get_or_insert_function(builder.module, ir.FunctionType(FLOAT, [FLOAT, FLOAT]), "llvm.pow.f64")
    with builder.if_then(anywhere(wanted)):
        for lane in map(ir.IntType(32), range(x.lanes)):
            with builder.if_then(builder.extract_element(wanted.value, lane)):
                operands = [builder.extract_element(one.value, lane) for one in (x, exponent)]
                one = builder.call(function, operands)
                builder.store(builder.insert_element(builder.load(found), one, lane), found)
    return Vector(builder, builder.load(found))


class Memory:
    """The rows of an array of shape (rows, lanes), each a Vector.

    The first of the `arguments` of an intrinsic is lanes, the last one the array.
    """

    def __init__(self, context, builder, signature, arguments):
        lanes, *_, array = signature.args
        data = context.make_array(array)(context, builder, arguments[-1]).data
        self.builder = builder
        self.start = builder.bitcast(data, ir.VectorType(FLOAT, lanes.literal_value).as_pointer())

    def at(self, row):
        return self.builder.gep(self.start, [INTEGER(row)], inbounds=True)

    def __getitem__(self, row):
        return Vector(self.builder, self.builder.load(self.at(row), align=8))

    def __setitem__(self, row, vector):
        self.builder.store(vector.value, self.at(row), align=8)


def lanes_of_processor() -> int:
    """The number of float64 in the widest vector register of this machine; 1 if it is unknown."""
    present = get_host_cpu_features()
    widths = {"avx512f": 8, "avx": 4, "sse2": 2, "neon": 2}
    return max((lanes for name, lanes in widths.items() if present.get(name)), default=1)
