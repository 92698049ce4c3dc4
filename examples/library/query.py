"""A query from Python, through the C interface: a vertex falls through a resting triangle.

    python3 query.py path/to/libtouchstone_c.so
"""

import ctypes
import sys


class Impact(ctypes.Structure):
    """TouchstoneImpact of touchstone.h."""

    _fields_ = [("verdict", ctypes.c_int32), ("toi_lower", ctypes.c_double), ("toi_upper", ctypes.c_double),
                ("u", ctypes.c_double), ("v", ctypes.c_double)]


touchstone = ctypes.CDLL(sys.argv[1])
touchstone.touchstone_last_error.restype = ctypes.c_char_p
touchstone.touchstone_solve.argtypes = [ctypes.c_int32, ctypes.c_size_t, ctypes.POINTER(ctypes.c_double),
                                        ctypes.c_void_p, ctypes.POINTER(Impact)]

query = [1, 1, 1, 0, 0, 0, 4, 0, 0, 0, 4, 0,  # v, f0, f1, f2 at t=0
         1, 1, -2, 0, 0, 0, 4, 0, 0, 0, 4, 0]  # and at t=1
impact = Impact()
if touchstone.touchstone_solve(0, 1, (ctypes.c_double * 24)(*query), None, impact) != 0:
    sys.exit(touchstone.touchstone_last_error().decode())
print(f"verdict {impact.verdict}, time of impact from {impact.toi_lower} to {impact.toi_upper}, "
      f"at u = {impact.u}, v = {impact.v}")
