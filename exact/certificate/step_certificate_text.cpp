#include "exact/certificate/step_certificate_text.hpp"

#include "touchstone/certificate_text.hpp"

namespace touchstone::exact {

std::string_view step_certificates_header() { return "touchstone-steps 2\n"; }

std::string step_certificates_closing_line(std::uint64_t steps) {
  return "steps " + std::to_string(steps) + '\n';
}

void write_step_head(std::string& text, std::string_view label, std::size_t vertices) {
  text.append("step ").append(label_text(label)).append("\n");
  text.append("vertices ").append(std::to_string(vertices)).append("\n");
}

void write_step_vertex(std::string& text, std::span<const double, 3> start,
                       std::span<const double, 3> end) {
  for (const double x : start) {
    write_hexadecimal(text, x);
    text += ' ';
  }
  for (const double x : end) {
    write_hexadecimal(text, x);
    text += ' ';
  }
  text.back() = '\n';
}

void write_step_numbers(std::string& text, std::span<const std::int32_t> numbers) {
  for (const std::int32_t number : numbers) text.append(std::to_string(number)).append(" ");
  text.back() = '\n';
}

std::string to_text(const StepClaim& claim) {
  std::string text = claim.earliest ? "earliest " : "no_contact ";
  write_number(text, claim.end);
  if (claim.earliest) write_number(text += ' ', claim.earliest->upper);
  return text;
}

void write_step_claim(std::string& text, const StepClaim& claim) {
  text += "separation ";
  write_hexadecimal(text, claim.separation.distance);
  text.append(" ").append(to_string(claim.separation.norm)).append("\n");
  text.append("claim ").append(to_text(claim)).append("\n");
  if (!claim.earliest) return;
  text.append(claim.earliest->name).append("\n");
  write_contact(text, claim.earliest->proof);
}

}  // namespace touchstone::exact
