#pragma once

/// \file
/// The register of a thread's floating-point modes: MXCSR of x86-64, FPCR of AArch64.

#include <cstdint>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace touchstone::tests {

#ifdef __SSE2__
inline constexpr std::uint64_t default_modes = 0x1F80;
inline constexpr std::uint64_t flush_to_zero = 0x8000, subnormals_are_zero = 0x0040;
inline constexpr std::uint64_t round_up = 0x4000;
inline std::uint64_t floating_point_modes() { return _mm_getcsr(); }
inline void set_floating_point_modes(std::uint64_t modes) {
  _mm_setcsr(static_cast<unsigned>(modes));
}
#elif defined(__aarch64__)
inline constexpr std::uint64_t default_modes = 0;
/// One bit for operands and results.
inline constexpr std::uint64_t flush_to_zero = 0x100'0000, subnormals_are_zero = flush_to_zero;
inline constexpr std::uint64_t round_up = 0x40'0000;
inline std::uint64_t floating_point_modes() {
  std::uint64_t modes = 0;
  __asm__ volatile("mrs %0, fpcr" : "=r"(modes));
  return modes;
}
inline void set_floating_point_modes(std::uint64_t modes) {
  __asm__ volatile("msr fpcr, %0" : : "r"(modes) : "memory");
}
#endif

/// During its lifetime, some further bits of the register are set.
class ChangedModes {
 public:
  explicit ChangedModes(std::uint64_t bits) : before_(floating_point_modes()) {
    set_floating_point_modes(before_ | bits);
  }
  ChangedModes(const ChangedModes&) = delete;
  ChangedModes& operator=(const ChangedModes&) = delete;
  ChangedModes(ChangedModes&&) = delete;
  ChangedModes& operator=(ChangedModes&&) = delete;
  ~ChangedModes() { set_floating_point_modes(before_); }

 private:
  std::uint64_t before_;
};

}  // namespace touchstone::tests
