#include "verify/report/published.hpp"

#include <array>
#include <span>

namespace touchstone::verify::report {
namespace {

/// A row of a published table.
struct Row {
  std::string_view dataset;
  Kind kind;
  std::string_view method;
  PublishedNumbers numbers;
  double distance = 0.0;
};

constexpr std::string_view hand = "handcrafted";
constexpr std::string_view simulation = "simulation";
constexpr Kind vf = Kind::vertex_face;
constexpr Kind ee = Kind::edge_edge;

/// Table 1.
constexpr auto field = std::to_array<Row>({
    {hand, vf, "irf", {"14942.40", "87", "0"}},
    {hand, vf, "uirf", {"124242.00", "146", "0"}},
    {hand, vf, "fprf", {"2.18", "9", "70"}},
    {hand, vf, "tccd", {"0.38", "903", "0"}},
    {hand, vf, "rp", {"1.41", "3", "5"}},
    {hand, vf, "rrp", {"928.08", "0", "5"}},
    {hand, vf, "bsc", {"176.17", "11", "13"}},
    {hand, vf, "msrf", {"12.90", "16", "386"}},
    {hand, vf, "tight_inclusion", {"1532.54", "108", "0"}},

    {hand, ee, "irf", {"12452.60", "141", "0"}},
    {hand, ee, "uirf", {"18755.80", "268", "0"}},
    {hand, ee, "fprf", {"0.48", "5", "147"}},
    {hand, ee, "tccd", {"0.33", "404", "0"}},
    {hand, ee, "rp", {"2.33", "3", "8"}},
    {hand, ee, "rrp", {"1271.32", "0", "8"}},
    {hand, ee, "bsc", {"121.80", "28", "47"}},
    {hand, ee, "msrf", {"2.72", "14", "335"}},
    {hand, ee, "tight_inclusion", {"3029.83", "214", "0"}},

    {simulation, vf, "irf", {"115.89", "2", "0"}},
    {simulation, vf, "uirf", {"6191.98", "18", "0"}},
    {simulation, vf, "fprf", {"7.53", "0", "5184"}},
    {simulation, vf, "tccd", {"0.24", "95638", "0"}},
    {simulation, vf, "rp", {"0.25", "0", "0"}},
    {simulation, vf, "rrp", {"1085.13", "0", "0"}},
    {simulation, vf, "bsc", {"34.21", "23015", "0"}},
    {simulation, vf, "msrf", {"51.07", "75", "0"}},
    {simulation, vf, "tight_inclusion", {"0.74", "2", "0"}},

    {simulation, ee, "irf", {"215.80", "71", "0"}},
    {simulation, ee, "uirf", {"846.57", "16781", "0"}},
    {simulation, ee, "fprf", {"0.23", "0", "2317"}},
    {simulation, ee, "tccd", {"0.23", "82277", "0"}},
    {simulation, ee, "rp", {"0.37", "0", "7"}},
    {simulation, ee, "rrp", {"1468.70", "0", "7"}},
    {simulation, ee, "bsc", {"12.87", "4593", "27"}},
    {simulation, ee, "msrf", {"10.39", "228", "1"}},
    {simulation, ee, "tight_inclusion", {"0.78", "17", "0"}},
});

/// Tables 2 and 3, by method; what both say of Tight-Inclusion is the same.
constexpr auto separation = std::to_array<Row>({
    {hand, vf, "msrf", {"12.89", "854", "114"}, 1e-2},
    {hand, vf, "msrf", {"15.05", "216", "2"}, 1e-8},
    {hand, vf, "msrf", {"13.90", "151", "35"}, 1e-16},
    {hand, vf, "msrf", {"13.59", "87", "141"}, 1e-30},
    {hand, vf, "msrf", {"14.45", "16", "384"}, 1e-100},
    {hand, ee, "msrf", {"3.84", "774", "189"}, 1e-2},
    {hand, ee, "msrf", {"2.89", "230", "18"}, 1e-8},
    {hand, ee, "msrf", {"2.90", "231", "21"}, 1e-16},
    {hand, ee, "msrf", {"2.89", "118", "157"}, 1e-30},
    {hand, ee, "msrf", {"3.05", "14", "335"}, 1e-100},
    {simulation, vf, "msrf", {"55.47", "156.8K", "18.3K"}, 1e-2},
    {simulation, vf, "msrf", {"55.26", "75", "0"}, 1e-8},
    {simulation, vf, "msrf", {"54.83", "4", "3.8K"}, 1e-16},
    {simulation, vf, "msrf", {"53.73", "0", "10.2K"}, 1e-30},
    {simulation, vf, "msrf", {"53.53", "0", "18.6K"}, 1e-100},
    {simulation, ee, "msrf", {"14.42", "354.1K", "7.0K"}, 1e-2},
    {simulation, ee, "msrf", {"11.12", "228", "1"}, 1e-8},
    {simulation, ee, "msrf", {"10.70", "10", "4"}, 1e-16},
    {simulation, ee, "msrf", {"10.68", "0", "1.7K"}, 1e-30},
    {simulation, ee, "msrf", {"10.59", "0", "5.0K"}, 1e-100},

    {hand, vf, "fprf", {"2.41", "1.8K", "4"}, 1e-2},
    {hand, vf, "fprf", {"4.53", "83", "3"}, 1e-8},
    {hand, vf, "fprf", {"2.23", "29", "69"}, 1e-16},
    {hand, vf, "fprf", {"2.24", "9", "70"}, 1e-30},
    {hand, vf, "fprf", {"2.31", "9", "70"}, 1e-100},
    {hand, ee, "fprf", {"1.16", "3.3K", "19"}, 1e-2},
    {hand, ee, "fprf", {"0.60", "160", "28"}, 1e-8},
    {hand, ee, "fprf", {"0.55", "45", "145"}, 1e-16},
    {hand, ee, "fprf", {"0.58", "5", "147"}, 1e-30},
    {hand, ee, "fprf", {"0.80", "5", "147"}, 1e-100},
    {simulation, vf, "fprf", {"8.04", "869.1K", "1"}, 1e-2},
    {simulation, vf, "fprf", {"8.00", "4", "2"}, 1e-8},
    {simulation, vf, "fprf", {"7.78", "0", "5.2K"}, 1e-16},
    {simulation, vf, "fprf", {"7.77", "0", "5.2K"}, 1e-30},
    {simulation, vf, "fprf", {"7.75", "0", "5.2K"}, 1e-100},
    {simulation, ee, "fprf", {"8.01", "1.1M", "0"}, 1e-2},
    {simulation, ee, "fprf", {"0.77", "16", "0"}, 1e-8},
    {simulation, ee, "fprf", {"0.25", "0", "2.3K"}, 1e-16},
    {simulation, ee, "fprf", {"0.25", "0", "2.3K"}, 1e-30},
    {simulation, ee, "fprf", {"0.25", "0", "2.3K"}, 1e-100},

    {hand, vf, "tight_inclusion", {"18.86K", "2.6K", "0"}, 1e-2},
    {hand, vf, "tight_inclusion", {"1.60K", "159", "0"}, 1e-8},
    {hand, vf, "tight_inclusion", {"1.51K", "108", "0"}, 1e-16},
    {hand, vf, "tight_inclusion", {"1.39K", "108", "0"}, 1e-30},
    {hand, vf, "tight_inclusion", {"1.43K", "108", "0"}, 1e-100},
    {hand, ee, "tight_inclusion", {"9.64K", "4.8K", "0"}, 1e-2},
    {hand, ee, "tight_inclusion", {"3.42K", "309", "0"}, 1e-8},
    {hand, ee, "tight_inclusion", {"2.92K", "214", "0"}, 1e-16},
    {hand, ee, "tight_inclusion", {"2.79K", "214", "0"}, 1e-30},
    {hand, ee, "tight_inclusion", {"2.82K", "214", "0"}, 1e-100},
    {simulation, vf, "tight_inclusion", {"12.04", "8.1M", "0"}, 1e-2},
    {simulation, vf, "tight_inclusion", {"0.72", "8", "0"}, 1e-8},
    {simulation, vf, "tight_inclusion", {"0.71", "2", "0"}, 1e-16},
    {simulation, vf, "tight_inclusion", {"0.66", "2", "0"}, 1e-30},
    {simulation, vf, "tight_inclusion", {"0.66", "2", "0"}, 1e-100},
    {simulation, ee, "tight_inclusion", {"19.12", "8.3M", "0"}, 1e-2},
    {simulation, ee, "tight_inclusion", {"0.73", "40", "0"}, 1e-8},
    {simulation, ee, "tight_inclusion", {"0.72", "17", "0"}, 1e-16},
    {simulation, ee, "tight_inclusion", {"0.67", "17", "0"}, 1e-30},
    {simulation, ee, "tight_inclusion", {"0.68", "17", "0"}, 1e-100},
});

/// The published dataset that a group of queries stands beside.
std::string_view published_name(std::string_view dataset) {
  return dataset == "own-simulation" ? simulation : dataset;
}

std::optional<PublishedNumbers> find(std::span<const Row> table, const Row& wanted) {
  for (const Row& row : table) {
    if (row.dataset == wanted.dataset && row.kind == wanted.kind && row.method == wanted.method &&
        row.distance == wanted.distance) {
      return row.numbers;
    }
  }
  return std::nullopt;
}

}  // namespace

std::string_view published_size(std::string_view dataset, Kind kind) {
  dataset = published_name(dataset);
  if (dataset == hand) return kind == vf ? "12K" : "15K";
  if (dataset == simulation) return kind == vf ? "18M" : "41M";
  return {};
}

std::optional<PublishedNumbers> published_field(std::string_view dataset, Kind kind,
                                                std::string_view method) {
  return find(field, {published_name(dataset), kind, method, {}, 0.0});
}

std::optional<PublishedNumbers> published_separation(std::string_view dataset, Kind kind,
                                                     std::string_view method, double distance) {
  return find(separation, {published_name(dataset), kind, method, {}, distance});
}

}  // namespace touchstone::verify::report
