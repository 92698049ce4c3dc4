#include "fast/platform/instruction_set.hpp"

namespace touchstone::fast {

std::string_view to_string(InstructionSet instructions) {
  switch (instructions) {
    case InstructionSet::scalar:
      return "scalar";
    case InstructionSet::avx2:
      return "avx2";
    case InstructionSet::avx512:
      return "avx512";
    case InstructionSet::neon:
      break;
  }
  return "neon";
}

bool is_supported(InstructionSet instructions) {
  if (instructions == InstructionSet::scalar) return true;
#ifdef TOUCHSTONE_NEON
  return instructions == InstructionSet::neon;
#elif defined(TOUCHSTONE_X86_64)
  if (!static_cast<bool>(__builtin_cpu_supports("fma"))) return false;
  if (instructions == InstructionSet::avx2)
    return static_cast<bool>(__builtin_cpu_supports("avx2"));
  return instructions == InstructionSet::avx512 &&
         static_cast<bool>(__builtin_cpu_supports("avx512f"));
#else
  return false;
#endif
}

}  // namespace touchstone::fast
