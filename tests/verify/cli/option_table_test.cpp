#include "verify/cli/option_table.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "verify/cli/commands.hpp"

// Every option of every command, as its row says, through the parser: values at the limits are
// taken, those beyond and words are refused.

namespace touchstone::verify::cli::option_table_test {
namespace {

/// The commands, which end before one runs.
class Parser : public CLI::App {
 public:
  Parser() { add_commands(*this, status_); }

  /// What the parser says of a value; empty if it takes it.
  [[nodiscard]] std::string fault(const std::string& command, const std::string& option,
                                  const std::string& value) {
    // The last word first.
    std::vector<std::string> words{value, option, command};
    if (option_row(command, option).name.ends_with('}')) words = {option + "=" + value, command};
    try {
      parse(words);
    } catch (const CLI::ValidationError& error) {
      return error.what();
    } catch (const CLI::ConversionError& error) {
      return error.what();
    } catch (const CLI::Error&) {  // success, or other options that this one needs
    }
    return {};
  }

 protected:
  void pre_callback() override { throw CLI::Success(); }

 private:
  Status status_ = Status::all_well;
};

/// Values that an option takes, and that it refuses.
struct Samples {
  std::vector<std::string> good;
  std::vector<std::string> bad;
};

Samples samples(const Text& /*any*/) { return {}; }

Samples samples(const Whole& range) {
  const std::string above =
      range.greatest == UINT64_MAX ? "18446744073709551616" : std::to_string(range.greatest + 1);
  return {.good = {std::to_string(range.least), std::to_string(range.greatest)},
          .bad = {range.least == 0 ? "-1" : std::to_string(range.least - 1), above, "1.5", "word"}};
}

Samples samples(const Real& range) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return {.good = {fmt::format("{}", range.least), fmt::format("{}", range.greatest)},
          .bad = {fmt::format("{}", std::nextafter(range.least, -infinity)),
                  fmt::format("{}", std::nextafter(range.greatest, infinity)), "nan", "word"}};
}

Samples samples(const Distance& /*any*/) {
  return {.good = {"0", "-0.0", "0x1p-1074", "1.7976931348623157e308"},
          .bad = {"-5e-324", "1e-999", "1e309", "inf", "nan", "word", ""}};
}

Samples samples(const OneOf& one_of) {
  Samples result{.good = one_of.words, .bad = {"word", ""}};
  for (const std::string& word : one_of.words) result.bad.push_back(word + word);
  return result;
}

TEST(OptionTable, EveryOptionOfEveryCommandTakesWhatItsRowSaysAndNothingElse) {
  Parser parser;
  std::set<const OptionRow*> unused;
  for (const OptionRow& row : option_table()) unused.insert(&row);
  std::size_t tried = 0;
  for (const CLI::App* command : static_cast<const CLI::App&>(parser).get_subcommands({})) {
    for (const CLI::Option* option : command->get_options()) {
      if (option == command->get_help_ptr()) continue;
      const std::vector<std::string>& names = option->get_lnames();
      const std::string name = names.empty() ? option->get_name() : "--" + names.front();
      const OptionRow& row = option_row(command->get_name(), name);
      unused.erase(&row);
      EXPECT_EQ(option->get_description(), row.text) << command->get_name() << name;
      const Samples values = std::visit([](const auto& of) { return samples(of); }, row.values);
      for (const std::string& good : values.good) {
        EXPECT_EQ(parser.fault(command->get_name(), name, good), "");
      }
      for (const std::string& bad : values.bad) {
        EXPECT_EQ(parser.fault(command->get_name(), name, bad),
                  option->get_name() + ": " + fault_of_value(row.values, bad))
            << command->get_name();
        EXPECT_NE(fault_of_value(row.values, bad), "") << name << bad;
      }
      tried += values.bad.empty() ? 0U : 1U;
    }
  }
  EXPECT_GT(tried, 100U);
  for (const OptionRow* row : unused) ADD_FAILURE() << row->commands << row->name << ": unused";
}

TEST(OptionTable, FaultsNameTheValueAndTheRange) {
  EXPECT_EQ(fault_of_value(Whole{1, 7}, "8"), "8 is not a whole number from 1 to 7");
  EXPECT_EQ(fault_of_value(Whole{1, 7}, "7"), "");
  EXPECT_EQ(fault_of_value(Real{1e-6, 0.5}, "nan"), "nan is not a number from 1e-06 to 0.5");
  EXPECT_EQ(fault_of_value(Distance{}, "-1"), "-1 must be a finite number ≥ 0");
  EXPECT_EQ(fault_of_value(OneOf{{"linf", "l2"}}, "L2"), "L2 not in {linf,l2}");
  EXPECT_THROW((void)option_row("certify", "--nonsense"), std::logic_error);
}

}  // namespace
}  // namespace touchstone::verify::cli::option_table_test
