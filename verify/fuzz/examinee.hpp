#pragma once

/// \file
/// A solver in a child process that lives on: asked block after block, at the price of a message
/// each.
///
/// The child is a copy of this process made by fork(). Queries and answers lie in memory shared
/// with it, along with the number of the query that it is at. It works in steps, of one query at
/// first and of more as they prove to be fast. If it dies in a step, or a step takes longer than a
/// query may, a new child solves the step's queries one by one. A query that ends it again, alone,
/// is asked a last time in a child of its own (isolation.hpp) for confirmation, and the next child
/// goes on behind it.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "exact/query.hpp"
#include "fast/method.hpp"

namespace touchstone::verify {

struct ExamineeOptions {
  fast::MethodOptions method = {};
  /// Wall-clock seconds that a query may take, or five times as many where it gets little processor
  /// time; 0: no limit. Not negative.
  double query_limit_seconds = 0.0;
  /// Of these in one call the rest is left unanswered. At least 1.
  std::size_t most_incidents = 4;
  /// May be null. Once true, the child is ended within a quarter of a second.
  const std::atomic<bool>* stop = nullptr;
};

/// A query at which the solver ended its process, or took too long: it does so alone too.
struct Incident {
  std::size_t position;
  bool hang;
};

/// What came of one call.
struct Sitting {
  /// Queries answered, from the first on; those with an incident count.
  std::size_t answered = 0;
  /// Ascending positions. What is answered there has no meaning.
  std::vector<Incident> incidents = {};
  /// Times it ended its process at queries none of which does it alone.
  std::uint64_t unplaced = 0;
};

/// Asks one method. For one thread at a time, the one that made it.
class Examinee {
 public:
  /// The method must live as long as this object. Makes no process yet.
  explicit Examinee(const fast::Method& method, const ExamineeOptions& options = {});
  Examinee(const Examinee&) = delete;
  Examinee& operator=(const Examinee&) = delete;
  Examinee(Examinee&&) = delete;
  Examinee& operator=(Examinee&&) = delete;
  ~Examinee();

  /// Answers query i in answers[i]; fewer if stopped, or at the limit of incidents.
  /// \param seconds after this much wall-clock time, or a quarter of a second more, it stops; infinite:
  /// no limit
  /// \pre both spans have the same length.
  /// \throws std::system_error if the system has no memory or no process left to give.
  [[nodiscard]] Sitting answer(Kind kind, std::span<const Query> queries,
                               std::span<fast::Answer> answers,
                               double seconds = std::numeric_limits<double>::infinity());

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchstone::verify
