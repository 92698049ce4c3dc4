#pragma once

/// \file
/// All public headers of the library touchstone::fast.

#include "touchstone/active_set.hpp"
#include "touchstone/broad_phase.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/curved_step.hpp"
#include "touchstone/distance.hpp"
#include "touchstone/filter.hpp"
#include "touchstone/intersections.hpp"
#include "touchstone/line_search.hpp"
#include "touchstone/mesh.hpp"
#include "touchstone/primitive_pairs.hpp"
#include "touchstone/query.hpp"
#include "touchstone/step.hpp"
#include "touchstone/tight_inclusion.hpp"
#include "touchstone/verdict.hpp"
