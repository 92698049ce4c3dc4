#include "verify/cli/help.hpp"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace touchstone::verify::cli::help_test {
namespace {

TEST(Wrapped, BreaksBetweenWordsAtTheWidth) {
  const std::string word(49, 'a');
  EXPECT_EQ(wrapped(word + " " + word + "b", 0, 2), word + " " + word + "b");
  EXPECT_EQ(wrapped(word + " " + word + "bc", 0, 2), word + "\n  " + word + "bc");
  EXPECT_EQ(wrapped(word + " b " + word, 1, 4), word + " b\n    " + word);
}

TEST(Wrapped, KeepsAWordThatIsLongerThanALine) {
  const std::string word(2 * help_width, 'a');
  EXPECT_EQ(wrapped("x " + word + " y", 0, 0), "x\n" + word + "\ny");
  EXPECT_EQ(wrapped("", 5, 5), "");
}

TEST(NearestName, IsTheOneThatAWordMayBeMeantFor) {
  const std::vector<std::string> names{"solve", "prove", "step"};
  for (const std::string word : {"prove", "prov", "proove", "provvee"}) {
    EXPECT_EQ(nearest_name(word, names), "prove") << word;
  }
  EXPECT_EQ(nearest_name("nonsense", names), "");
  EXPECT_EQ(nearest_name("se", {"st"}), "st");
  EXPECT_EQ(nearest_name("x", {"st"}), "") << "no letter in common";
  EXPECT_EQ(nearest_name("", names), "");
}

TEST(HelpFormat, HasExamplesFirstAndGroupsInOrder) {
  CLI::App app{"Does something", "tool"};
  use_help_format(app);
  std::string number, file;
  app.option_defaults()->group("Input");
  app.add_option("PATH", file, "A file")->type_name("");
  app.option_defaults()->group("Solver");
  app.add_option("--number", number, "A number")->type_name("N")->required();
  app.option_defaults()->group("Output");
  app.add_option("--a-name-longer-than-the-column", file, "Write")->type_name("FILE");
  set_help(app, "tool a\ntool b", "One note.\nAnother.");
  EXPECT_EQ(app.help(),
            "Does something\n\n"
            "Example: tool a\n"
            "         tool b\n\n"
            "Usage: tool [OPTIONS] [PATH]\n\n"
            "Options:\n"
            "  -h,--help               Print this help\n\n"
            "Input:\n"
            "  PATH                    A file\n\n"
            "Solver:\n"
            "  --number N (required)   A number\n\n"
            "Output:\n"
            "  --a-name-longer-than-the-column FILE\n"
            "                          Write\n\n"
            "One note.\nAnother.\n");
}

}  // namespace
}  // namespace touchstone::verify::cli::help_test
