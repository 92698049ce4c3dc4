#pragma once

/// \file
/// All public headers of the library touchstone::exact.

#include "touchstone/algebraic_number.hpp"
#include "touchstone/cell.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/certificate_text.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/polynomial.hpp"
#include "touchstone/query.hpp"
