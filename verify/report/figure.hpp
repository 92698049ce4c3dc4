#pragma once

/// \file
/// A figure of a report as data: the drawn numbers, their places, and in words what they show.

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "verify/report/tables.hpp"

namespace touchstone::verify::report {

/// The form in which page.js draws a panel.
enum class FigureForm : std::uint8_t {
  points,  ///< named points and curves, with a front
  lines,   ///< curves
  ridges,  ///< a row a method: misses above its line, hits below it
  bars,    ///< stacked shares, a row a label
  marks,   ///< a grid of cells coloured by what is wrong, a row a series
  shades,  ///< a grid of cells shaded by their number, a row a series
};

/// "points", "lines", "ridges", "bars", "marks" or "shades".
[[nodiscard]] std::string_view to_string(FigureForm form);

struct FigurePoint {
  double x = 0.0;
  double y = 0.0;
  std::string label;
  bool open = false;     ///< drawn hollow: the method misses collisions here
  std::string tip = {};  ///< more about it, shown where one points at it

  friend bool operator==(const FigurePoint&, const FigurePoint&) = default;
};

/// The series drawn in one colour.
struct FigureSeries {
  std::string name;
  std::string role;  ///< "point", "curve", "hits", "misses", "stage", or the row of a grid
  int slot = 0;      ///< which colour: the same for a method in all figures
  std::vector<FigurePoint> points;
};

struct FigurePanel {
  std::string title;
  std::string caption;  ///< what the data say, in a sentence
  bool powers = true;   ///< of a grid: Are the values of x binary exponents, or what they are?
  std::vector<FigureSeries> series;
  std::vector<FigurePoint> front;  ///< the Pareto front, by ascending x
};

struct Figure {
  std::string id;  ///< unique, snake_case: of the element and the CSV file
  std::string title;
  std::string description;
  FigureForm form = FigureForm::lines;
  std::string x_label;
  std::string y_label;
  bool x_log = true;
  bool x_even = false;  ///< the values of x stand evenly spaced, whatever they are
  bool y_log = true;
  std::vector<FigurePanel> panels;
  Table data;  ///< all numbers that are drawn; its title is empty
};

/// The colour of each method, the same in all figures.
using MethodSlots = std::map<std::string, int>;

/// The series of that name and role in a panel, made if there is none.
FigureSeries& series_of(FigurePanel& panel, const std::string& name, const std::string& role,
                        int slot);

/// Which of the points are on the Pareto front, by ascending x: no other point is at least as small
/// in both coordinates and smaller in one. Of equal points all are.
[[nodiscard]] std::vector<std::size_t> pareto_front(std::span<const FigurePoint> points);

/// The figures as page.js reads them, without their tables; numbers are as number_to_json
/// (io/json.hpp) writes them.
[[nodiscard]] nlohmann::json to_json(const std::vector<Figure>& figures);

}  // namespace touchstone::verify::report
