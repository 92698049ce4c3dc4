/// \file
/// touchstone-check as a program: what it prints and its exit status.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

#include "tests/support/built_files.hpp"
#include "tests/support/folder_test.hpp"

namespace touchstone::checker::main_test {
namespace {

struct Outcome {
  int status = -1;
  /// What it writes to both its streams.
  std::string output;
};

/// Runs touchstone-check with these arguments and redirections, as a shell reads them.
Outcome run(const std::string& arguments) {
  const std::string command = "{ " + tests::checker_program() + " " + arguments + "; } 2>&1";
  std::FILE* const pipe = popen(command.c_str(), "r");  // NOLINT(cert-env33-c)
  Outcome outcome;
  if (pipe == nullptr) return outcome;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
    outcome.output += static_cast<char>(c);
  }
  const int status = pclose(pipe);
  if (WIFEXITED(status)) outcome.status = WEXITSTATUS(status);
  return outcome;
}

const std::string apart =
    "touchstone-certificates 2\nquery vertex_face\npoint 1 1 1\npoint 0 0 0\npoint 4 0 0\npoint 0 "
    "4 "
    "0\npoint 1 1 2\npoint 0 0 0\npoint 4 0 0\npoint 0 4 0\nclaim no_collision\nseparate 0 1 face "
    "+\nend\n";

class Command : public testing::Test {
 protected:
  const tests::TemporaryFolder folder_;
  /// One certificate, which is accepted, and others that are not.
  const std::string apart_ = folder_.file("apart.cert", apart + "certificates 1\n"),
                    broken_ =
                        folder_.file("broken.cert",
                                     apart + "query vertex_face\npoint 1 1 nan\nend\n" +
                                         "query vertex_face\npoint 1 1 " + std::string(5'000, '9') +
                                         "\nend\nquery edge_edge\n" + "label \x1b[2J\npoint 1 2");
};

TEST_F(Command, ReadsStandardInput) {
  EXPECT_EQ(run("- < " + apart_).status, 0);
  EXPECT_EQ(run("- < " + apart_).output, run(apart_).output);
  EXPECT_EQ(run("- < " + broken_).status, 1);
}

TEST_F(Command, NamesLinesLabelsAndReasons) {
  const auto [status, output] = run(broken_);
  EXPECT_EQ(status, 1);
  EXPECT_EQ(output,
            "accepted         1\n  no_collision   1\n  collision      0\n  time_of_impact "
            "0\nrejected         4\n"
            "  line 15: not a number: 'nan'\n"
            "  line 18: more than 4933 digits in a number: "
            "'9999999999999999999999999999999999999999...'\n"
            "  line 22 (\\x1b[2J): the last line is not ended by a newline\n"
            "  line 22: the stream is cut: it has no closing line 'certificates 4'\n");
}

TEST_F(Command, CountsInversionsIfThereAreAny) {
  const std::string flat = folder_.file(
      "flat.cert", apart +
                       "query tetrahedron\npoint 0 0 0\npoint 1 0 0\npoint 0 1 0\npoint 0 0 1\n" +
                       "point 0 0 0\npoint 1 0 0\npoint 0 1 0\npoint 0 0 0\nclaim inversion\n" +
                       "contact time 1\nat plane\nend\ncertificates 2\n");
  EXPECT_EQ(run(flat).output,
            "accepted         2\n  no_collision   1\n  collision      0\n  time_of_impact 0\n"
            "  no_inversion      0\n  inversion         1\n  time_of_inversion 0\n"
            "rejected         0\n");
  EXPECT_EQ(run("--claim inversion " + flat).status, 1);
  EXPECT_EQ(run("--claim time_of_inversion " + flat).status, 1);
}

TEST_F(Command, SaysHowManyRejectionsItDoesNotShow) {
  std::string text = "touchstone-certificates 2\n";
  for (int n = 0; n < 103; ++n) text += "query\n";
  const auto [status, output] = run(folder_.file("some.cert", text + "certificates 103\n"));
  EXPECT_EQ(status, 1);
  EXPECT_NE(output.find("rejected         103\n"), std::string::npos);
  EXPECT_NE(output.find("  line 101: the line has too few words\n  and 3 more\n"),
            std::string::npos);
}

TEST_F(Command, TellsBadInputFromRejection) {
  for (const auto& [arguments, reason] :
       {std::pair("/does/not/exist",
                  "touchstone-check: /does/not/exist: the file cannot be opened\n"),
        std::pair("/", "touchstone-check: /: the stream cannot be read\n"),
        std::pair("- < /", "touchstone-check: -: the stream cannot be read\n")}) {
    const auto [status, output] = run(arguments);
    EXPECT_EQ(status, 2) << arguments;
    EXPECT_EQ(output, reason);
  }
  EXPECT_EQ(run("/dev/null").status, 1);
}

TEST_F(Command, FailsIfItsOutputCannotBeWritten) {
  for (const std::string& arguments : {apart_, std::string("--help")}) {
    const auto [status, output] = run(arguments + " 2>&1 > /dev/full");
    EXPECT_EQ(status, 2) << arguments;
    EXPECT_TRUE(output.ends_with(": standard output cannot be written\n")) << output;
  }
}

TEST_F(Command, DemandsAClaimAndASeparation) {
  EXPECT_EQ(run("--claim no_collision " + apart_).status, 0);
  EXPECT_EQ(run("--claim collision " + apart_).status, 1);
  const auto [status, output] = run("--claim free --separation 1e-8 --norm l2 " + apart_);
  EXPECT_EQ(status, 1);
  EXPECT_NE(output.find("the claim is not the one demanded: "), std::string::npos) << output;
}

TEST_F(Command, KnowsItsUsage) {
  const auto [status, help] = run("--help");
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(help.starts_with("usage: touchstone-check [OPTIONS] FILE|- [SCENES]\n"));
  EXPECT_NE(help.find("Example: "), std::string::npos);
  for (const std::string arguments :
       {"", "--version", "-x", "a b c", "- -", "''", "--claim", "--claim nonsense a", "--norm l2 a",
        "--separation 1 --norm l1 a", "--separation x a"}) {
    EXPECT_EQ(run(arguments).status, 2) << arguments;
  }
}

}  // namespace
}  // namespace touchstone::checker::main_test
