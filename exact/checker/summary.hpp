#pragma once

/// \file
/// What the accepted certificates of a stream of steps or meshes prove together.

#include <cstddef>
#include <string>

#include "exact/checker/scene.hpp"

namespace touchstone::checker {

/// What one certificate claims, as far as a sentence about all needs it.
struct Statement {
  /// True if it is about all pairs, and a step's about all of [0,1].
  bool is_free = false;
  /// What they do not: `touch`, `come within D (NORM)`; of meshes `intersect`.
  std::string contact;
  /// What of the scene is left out, as rules_text() says it.
  std::string rules;
};

/// What an accepted certificate proves.
struct Proved {
  /// Label, size of the scene, rules, separation and claim, a line each.
  std::string text;
  Statement statement;
  Scene scene;
};

/// What two do not do in a step without a contact. \param is_thick there are radii or separations
[[nodiscard]] std::string contact_text(const Separation& separation, bool is_thick);

/// True if the step begins where the last one ended: its vertices at t=0 are those at t=1, by
/// value, and all lists are the same.
[[nodiscard]] bool does_follow(const Scene& last, const Scene& scene);

class Summary {
 public:
  explicit Summary(Time time) : time_(time) {}

  /// \param does_follow of a step: it is the first, or begins where the last one ended
  void add(const Statement& statement, bool does_follow);

  /// "184 steps, each from where the last one ended: no two primitives touch", or what is less than
  /// this; empty if nothing is to be said of all.
  [[nodiscard]] std::string text() const;

 private:
  [[nodiscard]] std::string gaps_text() const;

  Time time_;
  std::size_t count_ = 0;
  /// The first step that does not follow, from 2, or 0; and how many do not.
  std::size_t first_gap_ = 0;
  std::size_t gaps_ = 0;
  Statement common_;
};

}  // namespace touchstone::checker
