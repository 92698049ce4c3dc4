#include "exact/checker/checker.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <system_error>

#include "exact/checker/certificate.hpp"
#include "exact/checker/mesh.hpp"
#include "exact/checker/proof.hpp"
#include "exact/checker/step.hpp"
#include "exact/checker/summary.hpp"

namespace touchstone::checker {
namespace {

constexpr std::string_view header = "touchstone-certificates 2";
constexpr std::string_view steps_header = "touchstone-steps 2";
constexpr std::string_view meshes_header = "touchstone-meshes 1";
constexpr std::string_view closing_word = "certificates";

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t end = text.find(' ');
    words.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return words;
    text.remove_prefix(end + 1);
  }
}

class StreamCheck {
 public:
  StreamCheck(std::istream& stream, const Options& options) : reader_(stream), options_(options) {}

  Report run() {
    attempt("", [&] {
      reader_.advance();
      if (reader_.text() == steps_header) {
        check_scenes(Time::step, check_step, report_.steps);
      } else if (reader_.text() == meshes_header) {
        check_scenes(Time::rest, check_mesh, report_.meshes);
      } else if (options_.scenes != nullptr) {
        reject("the first line is not '" + std::string(steps_header) + "' or '" +
                   std::string(meshes_header) + "', as for scenes",
               1);
      } else if (reader_.text() == header) {
        check_certificates();
      } else {
        reject("the first line is not '" + std::string(header) + "'", 1);
      }
    });
    return std::move(report_);
  }

 private:
  /// Runs work that may be rejected, and counts a rejection.
  template <class Work>
  void attempt(const std::string& label, const Work& work) {
    try {
      work();
    } catch (const Rejection& thrown) {
      ++report_.rejected;
      if (report_.rejections.size() == options_.max_rejections) return;
      const std::size_t line = thrown.line != 0 ? thrown.line : reader_.number();
      report_.rejections.push_back({line, printable(label), thrown.reason});
    }
  }

  void check_certificates() {
    std::uint64_t queries = 0;
    reader_.advance();
    while (!reader_.at_end() && reader_.first_word() != closing_word) {
      if (reader_.first_word() == "query") ++queries;
      check_one();
    }
    check_end(closing_word, queries);
  }

  /// Checks the certificate that begins at the current line, and goes to the line after it or, if
  /// it cannot be read, to the next `query` line or closing line.
  void check_one() {
    const std::size_t first = reader_.number();
    Certificate certificate;
    bool is_read = false;
    attempt(certificate.label, [&] {
      read_certificate(reader_, certificate);
      is_read = true;
      require_demanded(options_, to_text(certificate), to_text(certificate.separation), "",
                       certificate.line);
      std::int64_t work_bits_left = options_.max_work_bits;
      verify(certificate, work_bits_left);
      count(certificate);
    });
    if (is_read) return;
    const auto may_begin = [&] {
      return reader_.first_word() == "query" || reader_.first_word() == closing_word;
    };
    while (!reader_.at_end() && (reader_.number() == first || !may_begin())) reader_.advance();
  }

  void count(const Certificate& certificate) {
    const bool is_tetrahedron = certificate.query.kind == Kind::tetrahedron;
    using Count = std::uint64_t Report::*;
    static constexpr std::array<std::array<Count, 3>, 2> counts{
        {{&Report::no_collision, &Report::collision, &Report::time_of_impact},
         {&Report::no_inversion, &Report::inversion, &Report::time_of_inversion}}};
    ++(report_.*counts.at(is_tetrahedron ? 1 : 0).at(static_cast<std::size_t>(certificate.claim)));
  }

  using CheckScene = Proved(Reader&, Reader*, const Options&);

  /// Checks the certificates of steps or of meshes to the first that is rejected.
  void check_scenes(Time time, CheckScene& check, std::vector<std::string>& texts) {
    std::optional<Reader> scenes;
    if (options_.scenes != nullptr) {
      scenes.emplace(*options_.scenes);
      scenes->advance();
    }
    Summary summary(time);
    std::optional<Scene> last;
    reader_.advance();
    while (reader_.first_word() == (time == Time::step ? "step" : "mesh")) {
      const std::size_t line = reader_.number();
      Proved proved = check(reader_, scenes ? &*scenes : nullptr, options_);
      const bool follows = !last || does_follow(*last, proved.scene);
      if (!follows && options_.claim == "sequence") {
        reject("the step does not begin where the last one ended", line);
      }
      texts.push_back(std::move(proved.text));
      summary.add(proved.statement, follows);
      last = std::move(proved.scene);
    }
    check_end(time == Time::step ? "steps" : "meshes", texts.size());
    if (scenes && !scenes->at_end()) reject("not all scenes are proved");
    report_.summary = summary.text();
  }

  /// Checks the closing line, with this number of certificates, and that nothing follows.
  void check_end(std::string_view word, std::uint64_t certificates) {
    const std::string expected = std::string(word) + ' ' + std::to_string(certificates);
    if (reader_.at_end()) reject("the stream is cut: it has no closing line '" + expected + "'");
    const bool is_demanded = options_.scenes != nullptr || !options_.claim.empty() ||
                             !options_.separation.empty() || !options_.rules.empty();
    if (certificates == 0 && is_demanded) reject("there is no certificate of what is demanded");
    reader_.begin(word);
    if (reader_.text() != expected) {
      reject("expected the closing line '" + expected + "', found " + quoted(reader_.text()));
    }
    reader_.advance();
    if (!reader_.at_end()) reject("a line after the closing line");
  }

  Reader reader_;
  const Options& options_;
  Report report_;
};

}  // namespace

std::string demanded_claim(std::string_view words) {
  if (words == "free" || words == "sequence") return std::string(words);
  struct Form {
    std::string_view name;
    std::size_t numbers;
    bool may_be_without;
  };
  static constexpr std::array forms{
      Form{"no_collision", 0, true},   Form{"collision", 0, true},
      Form{"time_of_impact", 2, true}, Form{"no_inversion", 0, true},
      Form{"inversion", 0, true},      Form{"time_of_inversion", 2, true},
      Form{"no_contact", 1, false},    Form{"earliest", 2, true},
      Form{"intersections", 1, true},  Form{"welded_intersections", 1, true}};
  const std::vector<std::string_view> parts = words_of(words);
  for (const auto& [name, numbers, may_be_without] : forms) {
    if (parts[0] != name) continue;
    const std::size_t count = parts.size() - 1;
    if (count != numbers && !(count == 0 && may_be_without)) break;
    std::string claim(name);
    for (std::size_t i = 1; i < parts.size(); ++i) claim += ' ' + to_text(parse_number(parts[i]));
    return claim;
  }
  reject("not a claim: " + quoted(words));
}

std::string demanded_separation(std::string_view distance, std::string_view norm) {
  if (norm != "linf" && norm != "l2") reject("not a norm: " + quoted(norm));
  double decimal = 0.0;
  const char* const last = distance.data() + distance.size();
  const auto [end, error] = std::from_chars(distance.data(), last, decimal);
  const bool is_decimal = error == std::errc() && end == last && std::isfinite(decimal);
  Separation separation;
  separation.distance = is_decimal ? mpq_class(decimal) : parse_number(distance);
  separation.is_l2 = norm == "l2";
  if (separation.distance < 0) reject("a distance below 0");
  return to_text(separation, true);
}

void require_demanded(const Options& options, const std::string& claim,
                      const std::string& separation, const std::string& rules, std::size_t line) {
  const auto is_demanded = [](const std::string& demand, const std::string& text) {
    return demand.empty() || text == demand || text.starts_with(demand + ' ');
  };
  const bool is_sequence = options.claim == "sequence",
             is_free = options.claim == "free" || is_sequence;
  const bool is_claim =
      is_free ? claim == "no_contact 1" || (claim == "intersections 0" && !is_sequence)
              : is_demanded(options.claim, claim);
  if (!is_claim) {
    const bool is_welded = options.claim == "free" && claim.starts_with("welded_");
    reject("the claim is not the one demanded: " + claim +
               (is_welded ? "; --claim 'welded_intersections 0' counts vertices at one place as one"
                          : ""),
           line);
  }
  // Where the norm does not matter it is not named.
  const bool is_separation = options.separation.empty() || options.separation == separation ||
                             options.separation.starts_with(separation + ' ');
  if (!is_separation) reject("the separation is not the one demanded: " + separation, line);
  const bool are_rules = options.rules.empty()
                             ? !is_free || options.scenes != nullptr || rules.empty()
                             : options.rules == rules;
  if (!are_rules)
    reject("the rules are not those demanded: " + (rules.empty() ? "none" : rules), line);
}

Report check(std::istream& certificates, const Options& options) {
  if (!certificates) throw std::runtime_error("the stream cannot be read");
  return StreamCheck(certificates, options).run();
}

}  // namespace touchstone::checker
