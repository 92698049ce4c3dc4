#pragma once

/// \file
/// The planted faults of faults.txt: copies of parts of the project with one fault each, for the
/// tests of the parts and for the fuzzer (hunt.hpp). TOUCHSTONE_FAULTS names those that a build
/// plants.

#include <istream>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "exact/checker/checker.hpp"
#include "fast/broad_phase/float_bounds.hpp"
#include "fast/broad_phase/search.hpp"
#include "fast/certified/exact/exact_stage.hpp"
#include "fast/certified/fixed_point_vertices.hpp"
#include "fast/certified/kernel.hpp"
#include "fast/distance/contact_enclosure.hpp"
#include "fast/intersections/filter_kernel.hpp"
#include "fast/method.hpp"
#include "fast/tight_inclusion/box_kernel.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/curved_query.hpp"
#include "touchstone/intersections.hpp"
#include "touchstone/inversion.hpp"
#include "touchstone/mesh.hpp"
#include "touchstone/query.hpp"
#include "touchstone/tight_inclusion.hpp"

namespace touchstone::tests {

struct FaultInfo {
  std::string_view name;
  std::string_view what;
  /// The separation of queries that show the fault.
  Separation separation = {};
  /// The reason why it is not a fault; empty if it is one.
  std::string_view harmless = {};
  /// The queries that show it, if they are so rare that neither hunter is expected to find one;
  /// otherwise empty.
  std::string_view rare = {};

  /// True if only the fuzzer has to find it, not the tests of the part.
  bool is_for_fuzzer = false;

  [[nodiscard]] bool is_to_be_found() const { return harmless.empty() && rare.empty(); }
};

template <class PartType>
struct Fault : FaultInfo {
  using Part = PartType;
  Part* part;  ///< never null
};

template <class Part>
using Faults = std::vector<Fault<Part>>;

// The types of the parts: functions and constants.
using MakeBounds = std::vector<fast::VertexBounds>(const fast::Motion&, double end,
                                                   double distance);
using ExactDistance = fast::Distance(ContactKind, const Query&, double, Norm);
using FilteredDistance = std::optional<fast::Distance>(ContactKind, const Query&, double, Norm);
using KeepsDistance = bool(ContactKind, const Query&, double t_max, const fast::KeptDistance&);
using FindActive = std::vector<fast::ActiveContact>(const fast::Step&, const Separation&);
using EncloseContact = fast::ContactEnclosure(ContactKind, const Query&, const fast::TimeEnclosure&,
                                              const fast::exact_stage::Parameters&,
                                              bool is_touching);
using FindIntersections = std::vector<fast::Intersection>(fast::Motion, const fast::Mesh&,
                                                          const fast::IntersectionOptions&);
using DecideCells = void(fast::CellInput, double t_limit, const fast::InversionOptions&,
                         const fast::CertifiedKernel&, const std::function<Query(std::size_t)>&,
                         const std::function<void(std::size_t, const fast::Inversion&)>&);
using LimitStep = fast::LineSearchLimit(const fast::Step&, double, const fast::LineSearchOptions&);
using Check = checker::Report(std::istream&, const checker::Options&);
using DecideRescaled = void(const fast::KernelInput&, fast::KernelFunction&, std::span<const Query>,
                            fast::KernelOutput&);
using DecideExactly = std::optional<fast::ExactImpact>(ContactKind, const Query&, const Separation&,
                                                       double toi_tolerance, double t_max);
using DecideCurvesExactly = std::optional<fast::ExactImpact>(ContactKind, const CurvedQuery&,
                                                             const Separation&,
                                                             double toi_tolerance, double t_max);
using MakeFixedPoint = fast::FixedPointVertices(const fast::Motion&, double end, double distance);
using MakeTightInclusion = std::unique_ptr<fast::Method>(const fast::TightInclusionOptions&);
using MakeCertified = std::unique_ptr<fast::Method>(const fast::CertifiedOptions&);

/// All faults that this build plants, in the order of faults.txt.
struct PlantedFaults {
  Faults<MakeBounds> float_bounds;
  Faults<const fast::SearchKernel> search, search_of_bodies, division;
  Faults<ExactDistance> exact_distance;
  Faults<FilteredDistance> filtered_distance;
  Faults<KeepsDistance> kept_distance;
  Faults<EncloseContact> contact_enclosure;
  Faults<FindActive> active_set;
  Faults<LimitStep> line_search;
  Faults<FindIntersections> intersections;
  Faults<const fast::TriangleKernel> triangle_filter;
  Faults<DecideCells> inversion;
  Faults<const fast::CertifiedKernel> inversion_kernel;
  Faults<Check> checker, mesh_checker;
  Faults<const fast::BoxKernel> box_kernel;
  Faults<MakeTightInclusion> tight_inclusion;
  Faults<const fast::CertifiedKernel> certified_kernel, single_precision, time_limit, curved_kernel;
  Faults<MakeFixedPoint> fixed_point_vertices;
  Faults<DecideRescaled> rescaling;
  Faults<DecideExactly> exact_stage;
  Faults<MakeCertified> certified;
  /// The part without a fault, with a count of its work (limb_products.hpp).
  Faults<DecideExactly> counting;
  Faults<DecideCurvesExactly> counting_on_curves;
};

[[nodiscard]] const PlantedFaults& planted_faults();

}  // namespace touchstone::tests
