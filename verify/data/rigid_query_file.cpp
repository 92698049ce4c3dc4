#include "verify/data/rigid_query_file.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "verify/io/dataset_error.hpp"
#include "verify/io/json.hpp"

namespace touchstone::verify::data {
namespace {

using nlohmann::json;

constexpr std::size_t longest_query = std::size_t{1} << 16U;

/// A member of a file, with its name for errors.
class Member {
 public:
  Member(const std::filesystem::path& file, const json& value, std::string name)
      : file_(file), value_(value), name_(std::move(name)) {}

  [[nodiscard]] Member operator[](const char* key) const {
    if (!value_.is_object() || !value_.contains(key)) fail("has no member " + std::string(key));
    return {file_, value_[key], name_.empty() ? key : name_ + '.' + key};
  }

  [[nodiscard]] std::array<double, 3> point() const {
    std::array<double, 3> result{};
    if (!value_.is_array() || value_.size() != result.size()) fail("must be three numbers");
    for (std::size_t k = 0; k < result.size(); ++k) {
      if (!value_[k].is_number()) fail("must be three numbers");
      result[k] = value_[k].get<double>();
      if (!std::isfinite(result[k])) fail("has a number that is not finite");
    }
    return result;
  }

  [[nodiscard]] exact::RigidPose pose() const {
    return {.position = (*this)["position"].point(), .rotation = (*this)["rotation"].point()};
  }
  [[nodiscard]] exact::RigidMotion motion() const {
    return {.start = (*this)["pose_t0"].pose(), .end = (*this)["pose_t1"].pose()};
  }

  [[nodiscard]] Kind kind() const {
    if (value_ == "fv") return Kind::vertex_face;
    if (value_ == "ee") return Kind::edge_edge;
    fail(R"(must be "fv" or "ee")");
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw io::DatasetError(file_, {}, (name_.empty() ? "the query" : name_) + ' ' + reason);
  }

  const std::filesystem::path& file_;
  const json& value_;
  std::string name_;
};

}  // namespace

KindOfRigidQuery read_rigid_query(const std::filesystem::path& file) {
  const json text = io::read_json(file, longest_query);
  const Member query(file, text, "");
  KindOfRigidQuery result;
  result.kind = query["type"].kind();
  const bool is_face = result.kind == Kind::vertex_face;
  const Member first = query[is_face ? "vertex" : "edge0"];
  const Member second = query[is_face ? "face" : "edge1"];
  result.query.bodies = {first.motion(), second.motion()};
  if (is_face) {
    result.query.points = {first["vertex"].point(), second["vertex0"].point(),
                           second["vertex1"].point(), second["vertex2"].point()};
  } else {
    result.query.points = {first["vertex0"].point(), first["vertex1"].point(),
                           second["vertex0"].point(), second["vertex1"].point()};
  }
  return result;
}

}  // namespace touchstone::verify::data
