// What a simulator includes: the vocabulary and fast code, found under the installed prefix.

#include <exact/query.hpp>
#include <fast/arithmetic_check.hpp>

int main() {
  const touchstone::Query query{};
  touchstone::fast::require_strict_arithmetic();
  return query.at(0, 0, 0) == 0.0 ? 0 : 1;
}
