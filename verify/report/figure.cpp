#include "verify/report/figure.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "verify/io/json.hpp"

namespace touchstone::verify::report {
namespace {

nlohmann::json json_of(const std::vector<FigurePoint>& points) {
  nlohmann::json list = nlohmann::json::array();
  for (const FigurePoint& point : points) {
    nlohmann::json& json = list.emplace_back(nlohmann::json{{"x", io::number_to_json(point.x)},
                                                            {"y", io::number_to_json(point.y)},
                                                            {"label", point.label},
                                                            {"open", point.open}});
    if (!point.tip.empty()) json["tip"] = point.tip;
  }
  return list;
}

nlohmann::json json_of(const FigurePanel& panel) {
  nlohmann::json all = nlohmann::json::array();
  for (const FigureSeries& series : panel.series) {
    all.push_back({{"name", series.name},
                   {"role", series.role},
                   {"slot", series.slot},
                   {"points", json_of(series.points)}});
  }
  return {{"title", panel.title},
          {"caption", panel.caption},
          {"powers", panel.powers},
          {"series", std::move(all)},
          {"front", json_of(panel.front)}};
}

}  // namespace

FigureSeries& series_of(FigurePanel& panel, const std::string& name, const std::string& role,
                        int slot) {
  const auto is_it = [&](const FigureSeries& s) { return s.name == name && s.role == role; };
  const auto found = std::ranges::find_if(panel.series, is_it);
  if (found != panel.series.end()) return *found;
  return panel.series.emplace_back(
      FigureSeries{.name = name, .role = role, .slot = slot, .points = {}});
}

std::string_view to_string(FigureForm form) {
  static constexpr std::array<std::string_view, 6> names{"points", "lines", "ridges",
                                                         "bars",   "marks", "shades"};
  return names.at(static_cast<std::size_t>(form));
}

std::vector<std::size_t> pareto_front(std::span<const FigurePoint> points) {
  const auto beats = [](const FigurePoint& a, const FigurePoint& b) {
    return a.x <= b.x && a.y <= b.y && (a.x < b.x || a.y < b.y);
  };
  std::vector<std::size_t> front;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto beats_it = [&](const FigurePoint& other) { return beats(other, points[i]); };
    if (std::ranges::none_of(points, beats_it)) front.push_back(i);
  }
  std::ranges::stable_sort(front, {}, [&](std::size_t i) { return points[i].x; });
  return front;
}

nlohmann::json to_json(const std::vector<Figure>& figures) {
  nlohmann::json list = nlohmann::json::array();
  for (const Figure& figure : figures) {
    nlohmann::json panels = nlohmann::json::array();
    for (const FigurePanel& panel : figure.panels) panels.push_back(json_of(panel));
    list.push_back({{"id", figure.id},
                    {"title", figure.title},
                    {"description", figure.description},
                    {"form", to_string(figure.form)},
                    {"x_label", figure.x_label},
                    {"y_label", figure.y_label},
                    {"x_log", figure.x_log},
                    {"x_even", figure.x_even},
                    {"y_log", figure.y_log},
                    {"panels", std::move(panels)}});
  }
  return list;
}

}  // namespace touchstone::verify::report
