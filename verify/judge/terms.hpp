#pragma once

/// \file
/// The queries that the terms of a promise are about (fast::Terms), and the form in which a solver
/// is asked them.

#include <string>

#include "fast/method.hpp"
#include "touchstone/any_kind.hpp"
#include "verify/base/any_query.hpp"

namespace touchstone::verify::judge {

/// True if the terms leave some queries of that shape out, or change them.
[[nodiscard]] bool select_queries(const fast::Terms& terms, const AnyShape& shape);

/// The query as a solver with these terms is asked it: rounded to float if it takes no more. A
/// number beyond all floats becomes infinite.
[[nodiscard]] base::AnyQuery as_asked(const fast::Terms& terms, base::AnyQuery query);

/// True if the query, which as_asked has returned, is within the terms: of a shape that the solver
/// answers, finite in the solver's precision, and far enough apart at t=0. The certified solver
/// decides the latter exactly, in the norm of the separation.
[[nodiscard]] bool admits(const fast::Terms& terms, const base::AnyQuery& query,
                          const Separation& separation);

/// ", vertex-face alone, starts apart, float coordinates, times are estimates": the terms that
/// differ from the usual ones, each behind a comma; empty if none does.
[[nodiscard]] std::string to_text(const fast::Terms& terms);

/// The same as words of a command line: " --answers-kinds vertex-face --starts-apart=0".
[[nodiscard]] std::string as_options(const fast::Terms& terms);

}  // namespace touchstone::verify::judge
