// clang-format off
// c++ -std=c++17 FILE.cpp -ldl && ./a.out ./libsolver.so
#include <dlfcn.h>

#include <cmath>
#include <cstdint>
#include <cstdio>

struct Options {
  double tolerance;
  std::int64_t max_checks;
  double min_separation, t_max;
  std::int32_t norm;
};
struct Answer {
  std::int32_t verdict;  // 0 no, 1 yes, 2 undecided, 3 error
  double toi_lower, toi_upper, tolerance;
};

int main(int, char** argv) {
  const double x[8][3] = {  // at t=0, then at t=1
      {1, 1, 1},  // v
      {0, 0, 0},  // f0
      {4, 0, 0},  // f1
      {0, 4, 0},  // f2
      {1, 1, -2},  // v
      {0, 0, 0},  // f0
      {4, 0, 0},  // f1
      {0, 4, 0},  // f2
  };
  void* const library = argv[1] ? dlopen(argv[1], RTLD_NOW) : nullptr;
  void* const solve = library ? dlsym(library, "touchstone_plugin_solve") : nullptr;
  if (solve == nullptr) return 2;
  const Options options{1e-06, 1000, 0, 1, 0};
  Answer answer{3, NAN, NAN, NAN};
  using Solve = void(std::int32_t, const double*, const Options*, Answer*);
  reinterpret_cast<Solve*>(solve)(0, x[0], &options, &answer);  // vertex-face
  std::printf("verdict %d, toi_lower %.17g, toi_upper %.17g; truth: collision after 0.3333333333333333 and before 0.33333333333333337\n", answer.verdict,
              answer.toi_lower, answer.toi_upper);
  return answer.verdict == 0 ? 1 : 0;
}
