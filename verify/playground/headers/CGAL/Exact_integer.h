#pragma once

#include <gmpxx.h>

namespace CGAL {
using Exact_integer = mpz_class;
}
