#pragma once

/// \file
/// The oracle's verdict on a query at a separation, whichever oracle gives it: at distance 0 the
/// plain one (exact/oracle.hpp), which knows the place of the contact too, else the one for distances
/// (exact/distance/distance_oracle.hpp).

#include <variant>

#include "exact/algebra/algebraic_number.hpp"
#include "exact/certificate.hpp"
#include "exact/distance/distance_oracle.hpp"
#include "exact/oracle.hpp"
#include "exact/query.hpp"

namespace touchstone::verify {

/// What is true of a query at a separation.
class Decision {
 public:
  /// \throws std::invalid_argument if a coordinate is NaN or infinite, or the separation not valid.
  Decision(Kind kind, const Query& query, const Separation& separation);

  [[nodiscard]] bool collides() const;

  /// The exact time of impact. \pre it collides.
  [[nodiscard]] const exact::AlgebraicNumber& toi() const;

  /// The certificate of the verdict. \pre the arguments are those that were decided.
  /// \throws exact::CertificateLimitError as exact::prove does.
  [[nodiscard]] exact::Certificate prove(Kind kind, const Query& query,
                                         const exact::ProveOptions& options) const;

 private:
  Separation separation_;
  std::variant<exact::Verdict, exact::DistanceVerdict> verdict_;
};

}  // namespace touchstone::verify
