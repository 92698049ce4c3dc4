#include "fast/kernels.hpp"

namespace touchstone::fast {

Kernels& chosen_kernels() {
  thread_local Kernels chosen;
  return chosen;
}

}  // namespace touchstone::fast
