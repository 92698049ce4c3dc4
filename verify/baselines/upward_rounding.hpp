#pragma once

/// \file
/// The rounding mode that intervals of upward_interval.hpp are computed in.

namespace touchstone::baselines {

/// While it lives, this thread rounds towards +∞; then the mode before it is back, also where an
/// exception ended its life. (BSC's published code forgets that, bsc.hpp.)
///
/// The compiler knows of no mode, and may move arithmetic across the guard within a function. So
/// the arithmetic belongs in a function that is called, and not inlined, while the guard lives, and
/// in a file compiled with -frounding-math.
class UpwardRounding {
 public:
  UpwardRounding();
  ~UpwardRounding();
  UpwardRounding(const UpwardRounding&) = delete;
  UpwardRounding& operator=(const UpwardRounding&) = delete;
  UpwardRounding(UpwardRounding&&) = delete;
  UpwardRounding& operator=(UpwardRounding&&) = delete;

 private:
  int callers_;
};

}  // namespace touchstone::baselines
