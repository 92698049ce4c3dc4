#include "exact/checker/summary.hpp"

#include <algorithm>
#include <tuple>

namespace touchstone::checker {

std::string contact_text(const Separation& separation, bool is_thick) {
  if (!is_thick && separation.distance == 0) return "touch";
  std::string text = is_thick ? "come within their thickness" : "come within";
  if (separation.distance != 0) text += (is_thick ? " + " : " ") + to_text(separation.distance);
  return text + (separation.is_l2 ? " (l2)" : " (linf)");
}

bool does_follow(const Scene& last, const Scene& scene) {
  const bool has_its_places =
      std::ranges::equal(last.vertices, scene.vertices, {}, &Motion::end, &Motion::start);
  const auto lists = [](const Scene& s) {
    return std::tie(s.faces, s.edges, s.points, s.groups, s.apart, s.radii, s.separations,
                    s.tetrahedra, s.plane_triangles);
  };
  return has_its_places && lists(last) == lists(scene);
}

void Summary::add(const Statement& statement, bool does_follow) {
  ++count_;
  if (count_ == 1) {
    common_ = statement;
    return;
  }
  common_.is_free = common_.is_free && statement.is_free;
  // Whatever is not within a distance does not touch.
  if (common_.contact != statement.contact) common_.contact = "touch";
  if (common_.rules != statement.rules) common_.rules = "the rules differ";
  if (does_follow) return;
  if (gaps_ == 0) first_gap_ = count_;
  ++gaps_;
}

std::string Summary::gaps_text() const {
  if (gaps_ == 0) return "";
  std::string text = "; step " + std::to_string(first_gap_) + " does not begin where step " +
                     std::to_string(first_gap_ - 1) + " ended";
  if (gaps_ == 1) return text;
  return text + (gaps_ == 2 ? ", nor does " : ", nor do ") + counted(gaps_ - 1, "other", "others");
}

std::string Summary::text() const {
  const bool is_step = time_ == Time::step;
  const bool is_sequence = is_step && count_ > 1;
  if (count_ == 0 || (!common_.is_free && !is_sequence)) return "";
  std::string text = is_step ? counted(count_, "step", "steps") : counted(count_, "mesh", "meshes");
  if (is_sequence) text += gaps_ == 0 ? ", each from where the last one ended" : ", each by itself";
  if (common_.is_free) {
    const bool has_rules = !common_.rules.empty();
    text += is_step ? ": no two primitives" : ": no two elements";
    if (has_rules) text += is_step ? " that can collide" : " that can meet";
    text += ' ' + common_.contact;
    if (has_rules) text += "; " + common_.rules;
  }
  return text + gaps_text();
}

}  // namespace touchstone::checker
