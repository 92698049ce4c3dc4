#pragma once

/// \file
/// All public headers of the library touchstone::fast.

#include "touchstone/broad_phase.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/intersections.hpp"
#include "touchstone/inversion.hpp"
#include "touchstone/mesh.hpp"
#include "touchstone/query.hpp"
#include "touchstone/step.hpp"
#include "touchstone/tight_inclusion.hpp"
