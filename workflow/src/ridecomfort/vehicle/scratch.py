"""Small arrays on the stack of a compiled function, and loops over them that are made at once."""

from __future__ import annotations

from llvmlite import binding, ir
from numba import types
from numba.core import cgutils, typing
from numba.extending import intrinsic
from numba.np.arrayobj import make_array, populate_array

# A loop over four wheels would be unrolled before the compiler looks for loops whose rounds can be made at once.
binding.set_option("ridecomfort", "-unroll-full-max-count=3")


@intrinsic(prefer_literal=True)
def zeros(typing_context, *shape):
    """An array of zeros for numba-compiled functions; sizes are literal numbers, and it must not outlive the function that makes it.

    No pointer of other arrays leads to it, so that its values stay in registers where they can.
    """
    shape = shape[0] if isinstance(shape[0], types.BaseTuple) else shape
    sizes = tuple(size.literal_value for size in shape)
    kind = types.Array(types.float64, len(sizes), "C")
    strides = [8]
    for size in sizes[:0:-1]:
        strides.insert(0, size * strides[0])

    def generate(context, builder, _, arguments):
        words = lambda numbers: [context.get_constant(types.intp, number) for number in numbers]
        place = cgutils.alloca_once(builder, ir.ArrayType(ir.DoubleType(), sizes[0] * strides[0] // 8), zfill=True)
        made = make_array(kind)(context, builder)
        populate_array(
            made, data=builder.bitcast(place, ir.DoubleType().as_pointer()), shape=words(sizes), strides=words(strides),
            itemsize=words([8])[0], meminfo=None,
        )  # fmt: skip
        return made._getvalue()

    return typing.signature(kind, types.StarArgTuple(shape)), generate
