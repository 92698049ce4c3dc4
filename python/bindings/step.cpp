#include "python/bindings/step.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "python/bindings/arguments.hpp"
#include "python/bindings/background.hpp"
#include "python/bindings/mesh_arguments.hpp"
#include "touchstone/contacts.hpp"
#include "touchstone/intersections.hpp"
#include "touchstone/step.hpp"

namespace touchstone::python {
namespace {

// ---- Arrays -------------------------------------------------------------------------------------

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

/// \throws std::invalid_argument for an array of another layout, or a kind that there is not.
std::vector<Collision> collisions_from(const py::array& array) {
  if (array.ndim() != 1 || array.itemsize() != py::ssize_t{sizeof(Collision)} ||
      !(array.flags() & py::array::c_style)) {
    throw std::invalid_argument("collisions must be an array as Step.collisions returns it");
  }
  std::vector<Collision> collisions(std::size_t(array.shape(0)));
  if (collisions.empty()) return collisions;
  std::memcpy(collisions.data(), array.data(), collisions.size() * sizeof(Collision));
  for (const Collision& one : collisions) {
    if (one.kind > ContactKind::vertex_vertex) {
      throw std::invalid_argument("collisions: no kind has the number " +
                                  std::to_string(static_cast<int>(one.kind)));
    }
  }
  return collisions;
}

/// fast::ActiveContact in one piece.
struct Contact {
  ContactKind kind;
  fast::IndexPair pair;
  double toi_lower, toi_upper, u, v;
  std::array<std::array<double, 3>, 2> points;
  std::array<double, 3> normal;
  double point_error, normal_error;
  bool has_side;
};

Contact contact_from(const fast::ActiveContact& from) {
  const auto array = [](const Eigen::Vector3d& x) { return std::array{x.x(), x.y(), x.z()}; };
  return {.kind = from.kind,
          .pair = from.pair,
          .toi_lower = from.toi_lower,
          .toi_upper = from.toi_upper,
          .u = from.u,
          .v = from.v,
          .points = {array(from.first), array(from.second)},
          .normal = array(from.normal),
          .point_error = from.point_error,
          .normal_error = from.normal_error,
          .has_side = from.has_side};
}

std::vector<Contact> contacts_from(const std::vector<fast::ActiveContact>& from) {
  std::vector<Contact> result;
  result.reserve(from.size());
  for (const fast::ActiveContact& one : from) result.push_back(contact_from(one));
  return result;
}

py::dict contact_layout() {
  return collision_fields<Contact>()
      .add("toi_lower", "f8", offsetof(Contact, toi_lower))
      .add("toi_upper", "f8", offsetof(Contact, toi_upper))
      .add("u", "f8", offsetof(Contact, u))
      .add("v", "f8", offsetof(Contact, v))
      .add("points", "(2,3)f8", offsetof(Contact, points))
      .add("normal", "(3,)f8", offsetof(Contact, normal))
      .add("point_error", "f8", offsetof(Contact, point_error))
      .add("normal_error", "f8", offsetof(Contact, normal_error))
      .add("has_side", "?", offsetof(Contact, has_side))
      .dict();
}

py::dict step_inversion_layout() {
  using Item = fast::StepInversion;
  return Layout(sizeof(Item))
      .add("kind", "u1", offsetof(Item, kind))
      .add("cell", "i4", offsetof(Item, cell))
      .add("start", "i1", offsetof(Item, start))
      .add("toi_lower", "f8", offsetof(Item, toi_lower))
      .add("toi_upper", "f8", offsetof(Item, toi_upper))
      .dict();
}

struct Pair {
  ContactKind kind;
  fast::IndexPair pair;

  friend auto operator<=>(const Pair&, const Pair&) = default;
};

py::dict pair_layout() { return collision_fields<Pair>().dict(); }

// ---- The step -----------------------------------------------------------------------------------

/// A rule of Python for pairs of vertices; None: empty. Called and freed with Python's lock.
std::function<bool(std::int32_t, std::int32_t)> rule_from(const py::object& can_collide) {
  if (can_collide.is_none()) return nullptr;
  const std::shared_ptr<py::object> rule(new py::object(can_collide), [](py::object* one) {
    const py::gil_scoped_acquire lock;
    delete one;  // NOLINT(cppcoreguidelines-owning-memory)
  });
  return [rule](std::int32_t a, std::int32_t b) {
    const py::gil_scoped_acquire lock;
    const py::object answer = (*rule)(a, b);
    const int is_true = PyObject_IsTrue(answer.ptr());
    if (is_true < 0) throw py::error_already_set();
    return is_true != 0;
  };
}

/// The result of work(); `progress`, unless None, is called now and then. \throws as
/// in_background().
template <class Work>
auto searched(std::atomic<bool>& stop, const py::object& progress, const Work& work) {
  if (is_forked()) {
    // The threads of the pool that the search uses are in the parent.
    const py::gil_scoped_release unlocked;
    return work();
  }
  return in_background(work, stop, progress);
}

/// A step, with a flag that ends its searches and those of all steps made from it.
class StoppableStep {
  /// The result of work(step), as searched() has it.
  template <class Work>
  [[nodiscard]] auto search(const py::object& progress, const Work& work) const {
    return searched(*stop_, progress, [&] { return work(*step_); });
  }

 public:
  StoppableStep(const Doubles& before, const Doubles& after, const Integers& faces,
                const Integers& edges, const Integers& points, const Integers& groups,
                const Integers& apart, const CellLists& cells, const Doubles& radii,
                const Integers& separated, const Doubles& separations,
                const py::object& can_collide, double separation, const std::string& norm,
                double toi_tolerance, double t_max, int threads)
      : stop_(std::make_shared<std::atomic<bool>>(false)) {
    fast::Mesh mesh = mesh_from(faces, edges, points, cells);
    fast::Motion vertices = motion_of(before, after);
    const fast::StepOptions options{
        .solve = {.toi_tolerance = toi_tolerance,
                  .t_max = t_max,
                  .separation = separation_from(separation, norm),
                  .max_threads = is_forked() ? 1 : threads},
        .groups = groups_from(groups, apart, radii, separated, separations),
        .can_collide = rule_from(can_collide),
        .stop = stop_.get()};
    const py::gil_scoped_release unlocked;
    step_ = std::make_shared<const fast::Step>(std::move(vertices), std::move(mesh), options);
  }

  [[nodiscard]] StoppableStep moved(const Doubles& before, const Doubles& after, double separation,
                                    const std::string& norm) const {
    StoppableStep result = *this;
    fast::Motion vertices = motion_of(before, after);
    const Separation of_result = separation_from(separation, norm);
    const py::gil_scoped_release unlocked;
    result.step_ =
        std::make_shared<const fast::Step>(step_->with_places(std::move(vertices), of_result));
    return result;
  }

  /// (toi_lower, toi_upper, collisions, inversions), or None.
  [[nodiscard]] py::object earliest(const py::object& progress) const {
    const auto impact = search(progress, [](const fast::Step& step) { return step.earliest(); });
    if (!impact) return py::none();
    return py::make_tuple(impact->toi_lower, impact->toi_upper,
                          array_of(impact->pairs, collision_layout()),
                          array_of(impact->inversions, step_inversion_layout()));
  }
  [[nodiscard]] py::array collisions(const py::object& progress) const {
    return array_of(search(progress, [](const fast::Step& step) { return step.collisions(); }),
                    collision_layout());
  }
  [[nodiscard]] py::array inversions(const py::object& progress) const {
    return array_of(search(progress, [](const fast::Step& step) { return step.inversions(); }),
                    step_inversion_layout());
  }
  [[nodiscard]] bool starts_free(const py::object& progress) const {
    return search(progress, [](const fast::Step& step) { return step.starts_free(); });
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
      return contacts_from(fast::active_set(step, separation));
    });
    return array_of(contacts, contact_layout());
  }
  /// Of these collisions, or of all.
  [[nodiscard]] py::array contacts(const std::optional<py::array>& given,
                                   const py::object& progress) const {
    std::optional<std::vector<Collision>> collisions;
    if (given) collisions = collisions_from(*given);
    const auto found = search(progress, [&collisions](const fast::Step& step) {
      return contacts_from(fast::contacts_of(step, collisions ? *collisions : step.collisions()));
    });
    return array_of(found, contact_layout());
  }
  /// (status, step size, (lower, upper) of the distance, pairs, inversions).
  [[nodiscard]] py::tuple line_search_limit(double p, const std::string& norm, bool of_pair,
                                            double kept_volume, const py::object& progress) const {
    const fast::LineSearchOptions options{
        .norm = separation_from(0.0, norm).norm,
        .start_distance = of_pair ? fast::StartDistance::of_pair : fast::StartDistance::of_scene,
        .kept_volume = kept_volume};
    const auto limit = search(progress, [p, options](const fast::Step& step) {
      return fast::line_search_limit(step, p, options);
    });
    constexpr std::array statuses{"whole", "limited", "in_contact", "too_small", "inverted"};
    return py::make_tuple(statuses.at(static_cast<std::size_t>(limit.status)), limit.step_size,
                          py::make_tuple(limit.distance.lower, limit.distance.upper),
                          array_of(limit.pairs, collision_layout()),
                          array_of(limit.inversions, step_inversion_layout()));
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
    const std::vector<fast::Edge>& edges = step_->mesh().edges;
    py::array_t<std::int32_t> array({py::ssize_t(edges.size()), py::ssize_t(2)});
    if (!edges.empty())
      std::memcpy(array.mutable_data(), edges.data(), edges.size() * sizeof(fast::Edge));
    return array;
  }
  [[nodiscard]] py::array_t<double> query(int kind, std::int32_t first, std::int32_t second) const {
    const Query query = step_->query_of(static_cast<ContactKind>(kind), {first, second});
    py::array_t<double> array({py::ssize_t(8), py::ssize_t(3)});
    std::memcpy(array.mutable_data(), query.coordinates.data(), sizeof query);
    return array;
  }

 private:
  std::shared_ptr<std::atomic<bool>> stop_;
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
  const fast::Mesh mesh = mesh_from(faces, edges, points);
  std::atomic<bool> stop = false;
  const fast::Motion at_rest = motion_of(vertices, vertices);
  const fast::IntersectionOptions options{.groups = groups_from(groups, apart),
                                          .weld = weld,
                                          .max_threads = is_forked() ? 1 : threads,
                                          .stop = &stop};
  const auto found =
      searched(stop, progress, [&] { return fast::intersections(at_rest, mesh, options); });
  return array_of(found, intersection_layout());
}

}  // namespace

void define_step(py::module_& m) {
  using py::arg;
  watch_forks();
  py::class_<StoppableStep>(m, "Step")
      .def(py::init<const Doubles&, const Doubles&, const Integers&, const Integers&,
                    const Integers&, const Integers&, const Integers&, const CellLists&,
                    const Doubles&, const Integers&, const Doubles&, const py::object&, double,
                    const std::string&, double, double, int>(),
           arg("before").noconvert(), arg("after").noconvert(), arg("faces").noconvert(),
           arg("edges").noconvert(), arg("points").noconvert(), arg("groups").noconvert(),
           arg("apart").noconvert(), arg("cells").noconvert(), arg("radii").noconvert(),
           arg("separated").noconvert(), arg("separations").noconvert(), arg("can_collide"),
           arg("separation"), arg("norm"), arg("toi_tolerance"), arg("t_max"), arg("threads"))
      .def("moved", &StoppableStep::moved, arg("before").noconvert(), arg("after").noconvert(),
           arg("separation"), arg("norm"))
      .def("earliest", &StoppableStep::earliest, arg("progress"))
      .def("collisions", &StoppableStep::collisions, arg("progress"))
      .def("inversions", &StoppableStep::inversions, arg("progress"))
      .def("starts_free", &StoppableStep::starts_free, arg("progress"))
      .def("is_free", &StoppableStep::is_free, arg("progress"))
      .def("free_step_size", &StoppableStep::free_step_size, arg("progress"))
      .def("contacts", &StoppableStep::contacts, arg("collisions"), arg("progress"))
      .def("active_set", &StoppableStep::active_set, arg("eta"), arg("norm"), arg("progress"))
      .def("line_search_limit", &StoppableStep::line_search_limit, arg("p"), arg("norm"),
           arg("of_pair"), arg("kept_volume"), arg("progress"))
      .def("candidates", &StoppableStep::candidates, arg("progress"))
      .def("least_distance", &StoppableStep::least_distance, arg("t"), arg("norm"), arg("progress"))
      .def("edges", &StoppableStep::edges)
      .def("query", &StoppableStep::query, arg("kind"), arg("first"), arg("second"));
  m.def("is_forked", &is_forked);
  m.def("collision_layout", &collision_layout);
  m.def("intersections", &intersections, arg("vertices").noconvert(), arg("faces").noconvert(),
        arg("edges").noconvert(), arg("points").noconvert(), arg("groups").noconvert(),
        arg("apart").noconvert(), arg("weld"), arg("threads"), arg("progress"));
}

}  // namespace touchstone::python
