/// \file
/// The step size of one step of a mesh by the IPC Toolkit's methods and by Touchstone, and the
/// processor time of each in one thread: step_sizes BEFORE.ply AFTER.ply [ROUNDS]
///
/// For a program of the toolkit's build: link ipc::toolkit, igl::core, TBB::tbb and
/// touchstone::ipc_toolkit_adapter.

#include <touchstone/ipc_toolkit_step.hpp>

#include <igl/edges.h>
#include <igl/readPLY.h>
#include <oneapi/tbb/global_control.h>
#include <ipc/ccd/additive_ccd.hpp>
#include <ipc/ipc.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

namespace ours = touchstone::adapters;

double processor_milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

struct Way {
  std::string name;
  std::function<double()> step_size;
  double answer = 0.0;
  std::vector<double> milliseconds = {};

  double median() {
    std::sort(milliseconds.begin(), milliseconds.end());
    return milliseconds[milliseconds.size() / 2];
  }
};

int main(int argc, char** argv) {
  Eigen::MatrixXd x0, x1;
  Eigen::MatrixXi faces, edges;
  if (argc < 3 || !igl::readPLY(argv[1], x0, faces) || !igl::readPLY(argv[2], x1, faces)) {
    std::fprintf(stderr, "step_sizes BEFORE.ply AFTER.ply [ROUNDS]\n");
    return 2;
  }
  igl::edges(faces, edges);
  const ipc::CollisionMesh mesh(x0, edges, faces);
  const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  const ipc::AdditiveCCD additive;
  const ours::NarrowPhaseCCD adapter(0.8);
  std::vector<Way> ways{
      {"toolkit, default", [&] { return ipc::compute_collision_free_stepsize(mesh, x0, x1); }},
      {"toolkit, AdditiveCCD",
       [&] { return ipc::compute_collision_free_stepsize(mesh, x0, x1, 0.0, nullptr, additive); }},
      {"toolkit, our narrow phase",
       [&] { return ipc::compute_collision_free_stepsize(mesh, x0, x1, 0.0, nullptr, adapter); }},
      {"our whole step", [&] { return ours::compute_collision_free_stepsize(mesh, x0, x1); }},
      {"our whole step, rescaling of AdditiveCCD", [&] {
         return ours::compute_collision_free_stepsize(mesh, x0, x1, 0.0, nullptr, additive);
       }}};
  for (int round = argc > 3 ? std::atoi(argv[3]) : 3; round > 0; --round) {
    for (Way& way : ways) {
      const double start = processor_milliseconds();
      way.answer = way.step_size();
      way.milliseconds.push_back(processor_milliseconds() - start);
    }
  }
  for (Way& way : ways) {
    std::printf("%-40s %9.1f ms, %6.2f times AdditiveCCD, step size %.17g\n", way.name.c_str(),
                way.median(), way.median() / ways[1].median(), way.answer);
  }
}
