// touchstone derive: the bounds of the filtered expressions, and the header that ships them.

#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "touchstone/derivation/bound_table.hpp"
#include "touchstone/derivation/catalogue.hpp"
#include "verify/cli/commands.hpp"
#include "verify/cli/files.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/cli/options.hpp"
#include "verify/io/json.hpp"
#include "verify/io/terminal.hpp"

namespace touchstone::verify::cli::derive_command {
namespace {

using filters::DeriveOptions;
using filters::DeriveResult;
using filters::DeriveRow;
using filters::Model;

const std::map<std::string, Model> models_by_name{{"published", Model::published},
                                                  {"rigorous", Model::rigorous},
                                                  {"gappa", Model::gappa},
                                                  {"observed", Model::observed}};

struct Arguments {
  std::vector<std::string> models;
  std::string precision;
  std::string header_file;
  std::string json_file;
  std::uint64_t seed = default_seed;
  std::uint64_t evaluations = filters::WorstCaseOptions{}.evaluations;
  unsigned threads = 0;
};

DeriveOptions to_options(const Arguments& arguments) {
  DeriveOptions options;
  if (!arguments.models.empty()) options.models.clear();
  for (const std::string& name : arguments.models) options.models.insert(models_by_name.at(name));
  if (!arguments.precision.empty()) {
    std::erase_if(options.formats, [&](const filters::Format& format) {
      return format.name != arguments.precision;
    });
  }
  options.search = {.seed = arguments.seed, .evaluations = arguments.evaluations};
  options.threads = arguments.threads;
  options.stop = [] { return io::interrupted().load(); };
  return options;
}

/// A bound as a multiple of u and as the constant itself.
void add_bound(nlohmann::json& row, const std::string& name, const std::optional<double>& units,
               const filters::Format& format) {
  row[name + "_units"] = io::number_to_json(units);
  row[name] =
      io::number_to_json(units ? std::optional(*units * format.unit_roundoff().get_d()) : units);
}

std::optional<double> to_double(const std::optional<mpq_class>& number) {
  if (!number) return std::nullopt;
  return number->get_d();
}

nlohmann::json to_json(const DeriveRow& row) {
  nlohmann::json json{{"expression", row.expression}, {"precision", row.format.name}};
  json["published_constant"] = io::text_or_null(row.published_constant);
  add_bound(json, "published", to_double(row.published), row.format);
  add_bound(json, "rigorous", to_double(row.rigorous), row.format);
  add_bound(json, "gappa", to_double(row.gappa), row.format);
  add_bound(json, "observed", row.observed ? std::optional(row.observed->units) : std::nullopt,
            row.format);
  if (row.observed) {
    json["worst_input"] = {{"coordinates", row.observed->inputs.coordinates},
                           {"weights", row.observed->inputs.weights}};
  }
  json["tightness"] = io::number_to_json(row.tightness());
  return json;
}

nlohmann::json to_json(const Arguments& arguments, const DeriveResult& result) {
  nlohmann::json rows = nlohmann::json::array();
  for (const DeriveRow& row : result.rows) rows.push_back(to_json(row));
  return {{"seed", arguments.seed},
          {"evaluations", arguments.evaluations},
          {"gappa_missing", result.gappa_missing},
          {"interrupted", result.stopped},
          {"bounds", std::move(rows)}};
}

Status status_of(const Arguments& arguments, const DeriveResult& result) {
  const bool gappa_wanted = std::ranges::find(arguments.models, "gappa") != arguments.models.end();
  if (result.gappa_missing) {
    report_error("gappa: not found, its column is empty; install the Debian package gappa");
  }
  if (result.stopped) return Status::interrupted;
  return result.gappa_missing && gappa_wanted ? Status::bad_input : Status::all_well;
}

Status derive(const Arguments& arguments) {
  Files files;
  Output header(files, arguments.header_file), json(files, arguments.json_file);
  DeriveOptions options = to_options(arguments);
  DeriveResult result;
  {
    io::ProgressBar progress("derive");
    options.progress = [&progress](double fraction) { progress.update(fraction); };
    result = filters::derive(options);
  }
  if (header) header.complete(filters::error_bounds_header());
  if (json) json.complete(io::json_document(to_json(arguments, result)));
  io::print(files.summary_stream(), to_table(result));
  return files.has_failed() ? Status::bad_input : status_of(arguments, result);
}

}  // namespace

void add(CLI::App& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("derive", "Derive the error bounds of filtered expressions");
  command->option_defaults()->group("Input");
  add_option(*command, "--model", arguments->models);
  add_option(*command, "--precision", arguments->precision);
  add_option(*command, "--seed", arguments->seed);
  add_option(*command, "--evaluations", arguments->evaluations);
  add_option(*command, "--threads", arguments->threads);
  command->option_defaults()->group("Output");
  add_option(*command, "--emit", arguments->header_file);
  add_option(*command, "--json", arguments->json_file);
  set_help(*command, "touchstone derive --model published --model rigorous --precision double",
           "Bounds are in units of u times a power of the greatest coordinate, the expression's "
           "degree. Without gappa its column is empty; --model gappa is then an error.\n" +
               std::string(writing_statuses));
  command->callback([arguments, &status] { status = derive(*arguments); });
}

}  // namespace touchstone::verify::cli::derive_command
