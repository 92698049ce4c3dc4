#include "python/bindings/step.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "python/bindings/arguments.hpp"
#include "python/bindings/background.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/intersections.hpp"
#include "touchstone/inversion.hpp"
#include "touchstone/step.hpp"

namespace touchstone::python {
namespace {

// ---- Arrays -------------------------------------------------------------------------------------

/// The rows of an array of integers of shape (n, k), or of shape (n,) for k = 1.
template <class Row>
std::vector<Row> rows_of(const Integers& array) {
  constexpr std::size_t width = sizeof(Row) / sizeof(std::int32_t);
  const bool is_table = width > 1;
  if (array.ndim() != (is_table ? 2 : 1) || (is_table && std::size_t(array.shape(1)) != width)) {
    throw std::invalid_argument("an array of indices has the wrong shape");
  }
  std::vector<Row> rows(std::size_t(array.shape(0)));
  if (!rows.empty()) std::memcpy(rows.data(), array.data(), rows.size() * sizeof(Row));
  return rows;
}

/// \throws std::invalid_argument unless both are of the same shape (n, 3).
fast::MovingVertices vertices_of(const Doubles& before, const Doubles& after) {
  if (before.ndim() != 2 || after.ndim() != 2) {
    throw std::invalid_argument("vertices must have the shape (n, 3)");
  }
  using Rows =
      Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
  return {Rows(before.data(), before.shape(0), before.shape(1)),
          Rows(after.data(), after.shape(0), after.shape(1))};
}

/// An array of items as numpy.dtype(layout) has them.
template <class Item>
py::array array_of(const std::vector<Item>& items, const py::dict& layout) {
  py::array array(py::dtype::from_args(layout),
                  std::vector<py::ssize_t>{py::ssize_t(items.size())});
  if (!items.empty()) std::memcpy(array.mutable_data(), items.data(), items.size() * sizeof(Item));
  return array;
}

using Collision = fast::StepCollision;

template <class Item>
Layout collision_fields() {
  Layout layout(sizeof(Item));
  layout.add("kind", "u1", offsetof(Item, kind)).add("pair", "(2,)i4", offsetof(Item, pair));
  return layout;
}

py::dict collision_layout() {
  return collision_fields<Collision>()
      .add("toi_lower", "f8", offsetof(Collision, toi_lower))
      .add("toi_upper", "f8", offsetof(Collision, toi_upper))
      .add("u", "f8", offsetof(Collision, u))
      .add("v", "f8", offsetof(Collision, v))
      .dict();
}

/// fast::ActiveContact in one piece.
struct Contact {
  fast::PairKind kind;
  fast::IndexPair pair;
  double toi_lower, toi_upper, u, v;
  std::array<double, 3> first, second, normal;
};

Contact contact_from(const fast::ActiveContact& from) {
  const auto array = [](const Eigen::Vector3d& x) { return std::array{x.x(), x.y(), x.z()}; };
  return {from.kind, from.pair,         from.toi_lower,     from.toi_upper,    from.u,
          from.v,    array(from.first), array(from.second), array(from.normal)};
}

py::dict contact_layout() {
  return collision_fields<Contact>()
      .add("toi_lower", "f8", offsetof(Contact, toi_lower))
      .add("toi_upper", "f8", offsetof(Contact, toi_upper))
      .add("u", "f8", offsetof(Contact, u))
      .add("v", "f8", offsetof(Contact, v))
      .add("first", "(3,)f8", offsetof(Contact, first))
      .add("second", "(3,)f8", offsetof(Contact, second))
      .add("normal", "(3,)f8", offsetof(Contact, normal))
      .dict();
}

struct Pair {
  fast::PairKind kind;
  fast::IndexPair pair;

  friend auto operator<=>(const Pair&, const Pair&) = default;
};

py::dict pair_layout() { return collision_fields<Pair>().dict(); }

// ---- The step -----------------------------------------------------------------------------------

/// What a step refers to.
struct Elements {
  std::vector<fast::Edge> edges;
  std::vector<fast::Face> faces;
  std::vector<std::int32_t> points;
  std::vector<std::int32_t> groups;
  std::vector<std::array<std::int32_t, 2>> apart;
  /// Ends the searches of all steps of these elements.
  mutable std::atomic<bool> stop = false;

  [[nodiscard]] fast::MeshElements mesh() const {
    return {.edges = edges, .faces = faces, .points = points};
  }
};

Elements elements_from(const Integers& faces, const Integers& edges, const Integers& points,
                       const Integers& groups, const Integers& apart) {
  return {.edges = rows_of<fast::Edge>(edges),
          .faces = rows_of<fast::Face>(faces),
          .points = rows_of<std::int32_t>(points),
          .groups = rows_of<std::int32_t>(groups),
          .apart = rows_of<std::array<std::int32_t, 2>>(apart)};
}

/// The result of work(); `progress`, unless None, is called now and then. \throws as
/// in_background().
template <class Work>
auto searched(const Elements& elements, const py::object& progress, const Work& work) {
  if (is_forked()) {
    // The threads of the pool that the search uses are in the parent.
    const py::gil_scoped_release unlocked;
    return work();
  }
  return in_background(work, elements.stop, progress);
}

/// A step with the elements that it refers to.
class OwningStep {
  /// The result of work(step), as searched() has it.
  template <class Work>
  [[nodiscard]] auto search(const py::object& progress, const Work& work) const {
    return searched(*elements_, progress, [&] { return work(*step_); });
  }

 public:
  OwningStep(const Doubles& before, const Doubles& after, const Integers& faces,
             const Integers& edges, const Integers& points, const Integers& groups,
             const Integers& apart, double separation, const std::string& norm,
             double toi_tolerance, double t_max, int threads)
      : elements_(new Elements(elements_from(faces, edges, points, groups, apart))) {
    fast::MovingVertices vertices = vertices_of(before, after);
    const fast::StepOptions options{
        .separation = separation_from(separation, norm),
        .toi_tolerance = toi_tolerance,
        .t_max = t_max,
        .max_threads = is_forked() ? 1 : threads,
        .groups = {.of_vertices = elements_->groups, .apart = elements_->apart},
        .stop = &elements_->stop};
    const py::gil_scoped_release unlocked;
    step_ = std::make_shared<const fast::Step>(std::move(vertices), elements_->mesh(), options);
  }

  [[nodiscard]] OwningStep moved(const Doubles& before, const Doubles& after, double separation,
                                 const std::string& norm) const {
    OwningStep result = *this;
    fast::MovingVertices vertices = vertices_of(before, after);
    const Separation of_result = separation_from(separation, norm);
    const py::gil_scoped_release unlocked;
    result.step_ =
        std::make_shared<const fast::Step>(step_->with_places(std::move(vertices), of_result));
    return result;
  }

  /// (toi_lower, toi_upper, collisions), or None.
  [[nodiscard]] py::object earliest(const py::object& progress) const {
    const auto impact = search(progress, [](const fast::Step& step) { return step.earliest(); });
    if (!impact) return py::none();
    return py::make_tuple(impact->toi_lower, impact->toi_upper,
                          array_of(impact->pairs, collision_layout()));
  }
  [[nodiscard]] py::array collisions(const py::object& progress) const {
    return array_of(search(progress, [](const fast::Step& step) { return step.collisions(); }),
                    collision_layout());
  }
  [[nodiscard]] bool is_free(const py::object& progress) const {
    return search(progress, [](const fast::Step& step) { return step.is_free(); });
  }
  [[nodiscard]] std::optional<double> free_step_size(const py::object& progress) const {
    return search(progress, [](const fast::Step& step) { return step.free_step_size(); });
  }
  [[nodiscard]] py::array active_set(double eta, const std::string& norm,
                                     const py::object& progress) const {
    const Separation separation = separation_from(eta, norm);
    const auto contacts = search(progress, [separation](const fast::Step& step) {
      std::vector<Contact> result;
      for (const auto& contact : fast::active_set(step, separation)) {
        result.push_back(contact_from(contact));
      }
      return result;
    });
    return array_of(contacts, contact_layout());
  }
  /// (status, step size, (lower, upper) of the distance, pairs).
  [[nodiscard]] py::tuple line_search_limit(double p, const std::string& norm, bool of_pair,
                                            const py::object& progress) const {
    const fast::LineSearchOptions options{
        .norm = separation_from(0.0, norm).norm,
        .start_distance = of_pair ? fast::StartDistance::of_pair : fast::StartDistance::of_scene};
    const auto limit = search(progress, [p, options](const fast::Step& step) {
      return fast::line_search_limit(step, p, options);
    });
    constexpr std::array statuses{"whole", "limited", "in_contact", "too_small"};
    return py::make_tuple(statuses.at(static_cast<std::size_t>(limit.status)), limit.step_size,
                          py::make_tuple(limit.distance.lower, limit.distance.upper),
                          array_of(limit.pairs, collision_layout()));
  }
  [[nodiscard]] py::array candidates(const py::object& progress) const {
    const auto pairs = search(progress, [](const fast::Step& step) {
      std::vector<Pair> all;
      std::mutex guard;
      step.candidates([&](const fast::StepCandidates& some) {
        const std::scoped_lock lock(guard);
        for (const fast::IndexPair& pair : some.pairs) all.push_back({some.kind, pair});
      });
      // Threads find them in any order.
      std::ranges::sort(all);
      return all;
    });
    return array_of(pairs, pair_layout());
  }
  /// (lower, upper, pairs), or None.
  [[nodiscard]] py::object least_distance(double t, const std::string& norm,
                                          const py::object& progress) const {
    const Norm of_distance = separation_from(0.0, norm).norm;
    const auto least = search(progress, [t, of_distance](const fast::Step& step) {
      return fast::least_distance(step, t, of_distance);
    });
    if (!least) return py::none();
    std::vector<Pair> pairs;
    for (const fast::PairDistance& pair : least->pairs) pairs.push_back({pair.kind, pair.pair});
    return py::make_tuple(least->distance.lower, least->distance.upper,
                          array_of(pairs, pair_layout()));
  }

  [[nodiscard]] py::array_t<std::int32_t> edges() const {
    const auto edges = step_->edges();
    py::array_t<std::int32_t> array({py::ssize_t(edges.size()), py::ssize_t(2)});
    if (!edges.empty()) std::memcpy(array.mutable_data(), edges.data(), edges.size_bytes());
    return array;
  }
  [[nodiscard]] py::array_t<double> query(int kind, std::int32_t first, std::int32_t second) const {
    const Query query = step_->query_of(static_cast<fast::PairKind>(kind), {first, second});
    py::array_t<double> array({py::ssize_t(8), py::ssize_t(3)});
    std::memcpy(array.mutable_data(), query.coordinates.data(), sizeof query);
    return array;
  }

 private:
  std::shared_ptr<const Elements> elements_;
  std::shared_ptr<const fast::Step> step_;
};

// ---- At rest ------------------------------------------------------------------------------------

py::dict intersection_layout() {
  using Item = fast::Intersection;
  static_assert(sizeof(Item::place) == 12 * sizeof(double));
  return Layout(sizeof(Item))
      .add("kind", "u1", offsetof(Item, kind))
      .add("elements", "(2,)u1", offsetof(Item, elements))
      .add("numbers", "(2,)i4", offsetof(Item, numbers))
      .add("place", "(2,2,3)f8", offsetof(Item, place))
      .dict();
}

py::array intersections(const Doubles& vertices, const Integers& faces, const Integers& edges,
                        const Integers& points, const Integers& groups, const Integers& apart,
                        bool weld, int threads, const py::object& progress) {
  const Elements elements = elements_from(faces, edges, points, groups, apart);
  const fast::MovingVertices at_rest = vertices_of(vertices, vertices);
  const fast::IntersectionOptions options{
      .groups = {.of_vertices = elements.groups, .apart = elements.apart},
      .weld = weld,
      .max_threads = is_forked() ? 1 : threads,
      .stop = &elements.stop};
  const auto found = searched(
      elements, progress, [&] { return fast::intersections(at_rest, elements.mesh(), options); });
  return array_of(found, intersection_layout());
}

// ---- Elements -----------------------------------------------------------------------------------

py::dict inversion_layout() {
  using Item = fast::Inversion;
  using Result = fast::InversionResult;
  constexpr std::size_t result = offsetof(Item, result);
  return Layout(sizeof(Item))
      .add("element", "u8", offsetof(Item, element))
      .add("start", "i1", result + offsetof(Result, start))
      .add("toi_lower", "f8", result + offsetof(Result, toi_lower))
      .add("toi_upper", "f8", result + offsetof(Result, toi_upper))
      .dict();
}

/// Of tetrahedra, or of triangles in the plane.
py::array inversions(const Doubles& before, const Doubles& after, const Integers& elements,
                     double toi_tolerance, double t_max, int threads) {
  const fast::MovingVertices vertices = vertices_of(before, after);
  const fast::InversionOptions options{
      .toi_tolerance = toi_tolerance, .t_max = t_max, .max_threads = is_forked() ? 1 : threads};
  const auto found = [&](const auto& rows) {
    const py::gil_scoped_release release;
    return fast::inversions(vertices, rows, options);
  };
  return array_of(elements.ndim() == 2 && elements.shape(1) == 3
                      ? found(rows_of<fast::Face>(elements))
                      : found(rows_of<fast::Tetrahedron>(elements)),
                  inversion_layout());
}

}  // namespace

void define_step(py::module_& m) {
  using py::arg;
  watch_forks();
  // A class of the usual kind, as its stub has it.
  py::class_<OwningStep>(m, "Step", py::metaclass(reinterpret_cast<PyObject*>(&PyType_Type)))
      .def(py::init<const Doubles&, const Doubles&, const Integers&, const Integers&,
                    const Integers&, const Integers&, const Integers&, double, const std::string&,
                    double, double, int>(),
           arg("before").noconvert(), arg("after").noconvert(), arg("faces").noconvert(),
           arg("edges").noconvert(), arg("points").noconvert(), arg("groups").noconvert(),
           arg("apart").noconvert(), arg("separation"), arg("norm"), arg("toi_tolerance"),
           arg("t_max"), arg("threads"))
      .def("moved", &OwningStep::moved, arg("before").noconvert(), arg("after").noconvert(),
           arg("separation"), arg("norm"))
      .def("earliest", &OwningStep::earliest, arg("progress"))
      .def("collisions", &OwningStep::collisions, arg("progress"))
      .def("is_free", &OwningStep::is_free, arg("progress"))
      .def("free_step_size", &OwningStep::free_step_size, arg("progress"))
      .def("active_set", &OwningStep::active_set, arg("eta"), arg("norm"), arg("progress"))
      .def("line_search_limit", &OwningStep::line_search_limit, arg("p"), arg("norm"),
           arg("of_pair"), arg("progress"))
      .def("candidates", &OwningStep::candidates, arg("progress"))
      .def("least_distance", &OwningStep::least_distance, arg("t"), arg("norm"), arg("progress"))
      .def("edges", &OwningStep::edges)
      .def("query", &OwningStep::query, arg("kind"), arg("first"), arg("second"));
  m.def("intersections", &intersections, arg("vertices").noconvert(), arg("faces").noconvert(),
        arg("edges").noconvert(), arg("points").noconvert(), arg("groups").noconvert(),
        arg("apart").noconvert(), arg("weld"), arg("threads"), arg("progress"));
  m.def("inversions", &inversions, arg("before").noconvert(), arg("after").noconvert(),
        arg("elements").noconvert(), arg("toi_tolerance"), arg("t_max"), arg("threads"));
}

}  // namespace touchstone::python
