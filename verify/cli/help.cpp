#include "verify/cli/help.hpp"

#include <algorithm>
#include <memory>
#include <numeric>
#include <sstream>
#include <utility>

namespace touchstone::verify::cli {
namespace {

/// The column of the descriptions of options.
constexpr std::size_t description_column = 26;
/// The separator between examples and notes in a footer, because CLI11 stores one text for both.
constexpr char separator = '\f';

std::string heading(std::string_view text) { return "\n" + std::string(text) + ":\n"; }

class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode /*mode*/) const override {
    const std::string footer = app->get_footer();
    const std::size_t end = std::min(footer.find(separator), footer.size());
    std::string help = wrapped(app->get_description(), 0, 0) +
                       "\n\nExample: " + footer.substr(0, end) + "\n\n" + usage(*app, name);
    for (const std::string& group : app->get_groups()) help += options_of(*app, group);
    help += make_subcommands(app, CLI::AppFormatMode::Normal);
    return help + "\n" + notes(footer.substr(std::min(end + 1, footer.size())));
  }

  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    return entry("  " + make_option_name(option, is_positional) + make_option_opts(option),
                 make_option_desc(option));
  }

  std::string make_option_opts(const CLI::Option* option) const override {
    std::string text = option->get_type_name().empty() ? "" : " " + option->get_type_name();
    if (!option->get_default_str().empty()) text += "=" + option->get_default_str();
    return option->get_required() ? text + " (required)" : text;
  }

  std::string make_subcommand(const CLI::App* command) const override {
    return entry("  " + command->get_name(), command->get_description());
  }

 private:
  [[nodiscard]] std::string usage(const CLI::App& app, const std::string& name) const {
    const std::string line = make_usage(&app, name);
    return line.substr(line.find_first_not_of('\n'));
  }

  /// A subcommand's help omits the help option itself, and options without a group.
  [[nodiscard]] std::string options_of(const CLI::App& app, const std::string& group) const {
    if (group.empty()) return {};
    std::string lines;
    for (const CLI::Option* option : app.get_options()) {
      if (option->get_group() != group) continue;
      if (option == app.get_help_ptr() && app.get_parent() != nullptr) continue;
      lines += make_option(option, !option->nonpositional());
    }
    return lines.empty() ? lines : heading(group) + lines;
  }

  static std::string entry(std::string name, const std::string& description) {
    const bool fits = name.size() + 1 < description_column;
    name += fits ? std::string(description_column - name.size(), ' ')
                 : "\n" + std::string(description_column, ' ');
    return name + wrapped(description, description_column, description_column) + "\n";
  }

  static std::string notes(const std::string& text) {
    std::string result, line;
    for (std::istringstream lines(text); std::getline(lines, line);)
      result += wrapped(line, 0, 0) + "\n";
    return result;
  }
};

/// The number of missing, wrong and additional letters (the Levenshtein distance).
std::size_t distance_between(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({replaced, row[j] + 1, row[j - 1] + 1}));
    }
  }
  return row.back();
}

}  // namespace

std::string nearest_name(std::string_view word, const std::vector<std::string>& names) {
  static constexpr std::size_t farthest = 2;
  std::string nearest;
  std::size_t least = std::min(farthest + 1, word.size());
  for (const std::string& name : names) {
    const std::size_t distance = distance_between(word, name);
    if (distance >= least) continue;
    least = distance;
    nearest = name;
  }
  return nearest;
}

std::string wrapped(std::string_view text, std::size_t start, std::size_t indent) {
  std::string result, word;
  std::size_t column = start;
  for (std::istringstream words{std::string(text)}; words >> word;) {
    const bool is_first = result.empty();
    if (!is_first && column + 1 + word.size() > help_width) {
      result += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (!is_first) {
      result += ' ';
      ++column;
    }
    result += word;
    column += word.size();
  }
  return result;
}

void set_help(CLI::App& command, std::string_view examples, std::string_view notes) {
  std::string text(examples);
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1)) {
    text.insert(at + 1, std::string("Example: ").size(), ' ');
  }
  command.footer(text + separator + std::string(notes));
}

void use_help_format(CLI::App& app) {
  app.formatter(std::make_shared<HelpFormatter>());
  app.set_help_flag("-h,--help", "Print this help");
}

}  // namespace touchstone::verify::cli
