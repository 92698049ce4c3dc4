#pragma once

#include <gmpxx.h>

namespace CGAL {
using Exact_rational = mpq_class;
}
