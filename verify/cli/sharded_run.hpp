#pragma once

/// \file
/// Parts of a run on many machines: the option --shard, and the sum of their results (touchstone
/// merge). Starting parts, and starting those again that failed, is the work of others (Slurm, MPI,
/// Dask, GNU parallel; examples/cluster).
///
/// The JSON of a part has `shard`: its `index` of `count` parts, its exit `status`, and what the
/// parts of one run have in common: `program`, `command`, `options`, digests of the files that
/// options name (`uses`), and a digest of the names and sizes of all inputs (`inputs`). Digests
/// find mistakes, no forgeries. The JSON of a part that did not come to its end has another name,
/// so that it cannot be taken for a whole one.

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "verify/cli/commands.hpp"
#include "verify/cli/files.hpp"
#include "verify/cli/sources.hpp"

namespace touchstone::verify::cli {

/// Sets the part of the sources that a command does.
/// \param shard "I/N", or empty: all sources
/// \throws std::invalid_argument if it is none of these.
void set_shard(const Command& command, const std::string& shard, SourceArguments& sources);

/// Completes the JSON of a run, if it has one.
/// \param status of a part
/// \param is_complete false for a part that did not come to its end
void write_results(Output& file, nlohmann::json results, const SourceArguments& sources,
                   const std::function<Status()>& status, bool is_complete);

}  // namespace touchstone::verify::cli
