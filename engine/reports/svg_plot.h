// SPDX-License-Identifier: GPL-3.0-or-later
// Line plots as SVG text, for reports that need no other file.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace insula {

struct PlotCurve {
  std::string name;
  std::string colour;     ///< "#1f6fb2"
  std::vector<double> y;  ///< one value for each x; values that are not finite break the line
  std::string dash;       ///< SVG dash pattern, empty: solid
};

/// A vertical line at a moment.
struct PlotMark {
  double x = 0;
  std::string text;
  std::string colour;
};

struct Plot {
  std::string title;
  std::string x_label = "time (s)";
  std::string y_label;  ///< with the unit: "force (N)"
  std::vector<double> x;
  std::vector<PlotCurve> curves;
  std::vector<PlotMark> marks;
  bool log_y = false;  ///< decades; values that are not positive break the line
  bool log_x = false;  ///< all x must be positive
};

/// Dark on white, 760 wide; well-formed XML.
std::string svg(const Plot& plot);

/// Text escaped for XML and HTML.
std::string escaped(std::string_view text);

/// Round numbers that cover [low, high]: about `count` steps of 1, 2 or 5 times a power of ten.
std::vector<double> nice_ticks(double low, double high, int count);

}  // namespace insula
