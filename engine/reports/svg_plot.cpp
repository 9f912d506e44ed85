// SPDX-License-Identifier: GPL-3.0-or-later
// Line plots as SVG text.
#include "engine/reports/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/text.h"

namespace insula {
namespace {

constexpr double width = 760, height = 250, left = 66, right = 14, top = 34, bottom = 44;

struct Axis {
  double low = 0, high = 1, from = 0, to = 1;
  bool log = false;
  double map(double v) const {
    v = std::clamp(v, low, high);
    const double a = log ? std::log10(v) : v, l = log ? std::log10(low) : low, h = log ? std::log10(high) : high;
    return from + (a - l) / (h - l) * (to - from);
  }
  bool shows(double v) const { return std::isfinite(v) && (!log || v > 0); }
};

Axis y_axis(const Plot& plot) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto& c : plot.curves)
    for (double v : c.y)
      if (std::isfinite(v) && (!plot.log_y || v > 0)) low = std::min(low, v), high = std::max(high, v);
  Axis axis{0, 1, height - bottom, top, plot.log_y};
  if (!(low <= high)) {
    if (plot.log_y) axis.low = 0.1;
    return axis;
  }
  if (plot.log_y) {
    // At most eight decades. Smaller values are drawn at the lower edge.
    axis.low = std::pow(10, std::floor(std::log10(std::max(low, 1e-8 * high))));
    axis.high = std::pow(10, std::ceil(std::log10(high)));
    if (axis.high <= axis.low) axis.high = 10 * axis.low;
  } else {
    axis.low = std::min(0.0, low);
    axis.high = high > axis.low ? high : axis.low + 1;
    const auto ticks = nice_ticks(axis.low, axis.high, 5);
    axis.low = std::min(axis.low, ticks.front());
    axis.high = std::max(axis.high, ticks.back());
  }
  return axis;
}

std::vector<double> ticks_of(const Axis& axis, int count) {
  if (!axis.log) return nice_ticks(axis.low, axis.high, count);
  std::vector<double> out;
  const int first = int(std::lround(std::log10(axis.low))), last = int(std::lround(std::log10(axis.high)));
  const int step = std::max(1, (last - first + 5) / 6);
  for (int e = first; e <= last; e += step) out.push_back(std::pow(10.0, e));
  return out;
}

/// 1, 2 and 5 times powers of ten.
std::vector<double> log_ticks(double low, double high) {
  std::vector<double> out;
  for (double power = std::pow(10, std::floor(std::log10(low))); power <= high; power *= 10)
    for (double k : {1.0, 2.0, 5.0}) out.push_back(k * power);
  return out;
}

std::string number(double v) { return fmt::format("{:.6g}", v == 0 ? 0.0 : v); }

void text(std::string& to, double x, double y, const char* anchor, const char* style, const std::string& content) {
  to += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" {}>{}</text>\n", x, y, anchor, style,
                    escaped(content));
}

void line(std::string& to, double x1, double y1, double x2, double y2, const std::string& style) {
  to += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x1, y1, x2, y2, style);
}

}  // namespace

std::string escaped(std::string_view raw) {
  std::string out;
  // Bytes that are not UTF-8 would make the whole document unreadable.
  const bool utf8 = find_invalid_utf8(raw) == std::string_view::npos;
  for (char c : raw) {
    const auto u = static_cast<unsigned char>(c);
    if (c == '&') out += "&amp;";
    else if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '"') out += "&quot;";
    else if ((u < 0x20 && c != '\n' && c != '\t') || (u >= 0x7F && !utf8)) out += '?';
    else out += c;
  }
  return out;
}

std::vector<double> nice_ticks(double low, double high, int count) {
  if (!(high > low)) return {low};
  const double rough = (high - low) / std::max(1, count);
  const double power = std::pow(10, std::floor(std::log10(rough)));
  const double ratio = rough / power;
  const double step = power * (ratio <= 1 ? 1 : ratio <= 2 ? 2 : ratio <= 5 ? 5 : 10);
  std::vector<double> out;
  const double first = std::floor(low / step + 1e-9), last = std::ceil(high / step - 1e-9);
  for (double k = first; k <= last; ++k) out.push_back(k == 0 ? 0.0 : k * step);
  return out;
}

namespace {

Axis x_axis(const Plot& plot) {
  Axis x{0, 1, left, width - right, plot.log_x};
  if (plot.log_x) x.low = 1, x.high = 10;
  if (!plot.x.empty()) {
    x.low = *std::min_element(plot.x.begin(), plot.x.end());
    x.high = *std::max_element(plot.x.begin(), plot.x.end());
    if (!(x.high > x.low)) x.high = plot.log_x ? 10 * x.low : x.low + 1;
  }
  return x;
}

/// Draws the title, the grid, and the axes with their numbers and labels.
void add_frame(std::string& out, const Plot& plot, const Axis& x, const Axis& y) {
  text(out, left, 18, "start", "font-size=\"13\" font-weight=\"bold\"", plot.title);
  for (double v : ticks_of(y, 5)) {
    line(out, left, y.map(v), width - right, y.map(v), "stroke=\"#e3e3e3\"");
    text(out, left - 6, y.map(v) + 4, "end", "", number(v));
  }
  for (double v : plot.log_x ? log_ticks(x.low, x.high) : nice_ticks(x.low, x.high, 8)) {
    if (v < x.low - 1e-9 || v > x.high + 1e-9) continue;
    line(out, x.map(v), height - bottom, x.map(v), height - bottom + 4, "stroke=\"#222\"");
    text(out, x.map(v), height - bottom + 17, "middle", "", number(v));
  }
  line(out, left, height - bottom, width - right, height - bottom, "stroke=\"#222\"");
  line(out, left, top, left, height - bottom, "stroke=\"#222\"");
  text(out, (left + width - right) / 2, height - 8, "middle", "", plot.x_label);
  out += fmt::format("<text transform=\"translate(14 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                     (top + height - bottom) / 2, escaped(plot.y_label));
}

void add_marks(std::string& out, const Plot& plot, const Axis& x) {
  for (const auto& m : plot.marks) {
    if (m.x < x.low || m.x > x.high) continue;
    out += fmt::format("<g><title>{}</title>", escaped(m.text));
    line(out, x.map(m.x), top, x.map(m.x), height - bottom,
         fmt::format("stroke=\"{}\" stroke-width=\"1\" stroke-dasharray=\"2 3\"", escaped(m.colour)));
    out += "</g>\n";
  }
}

std::string dash_of(const PlotCurve& c) {
  return c.dash.empty() ? "" : fmt::format(" stroke-dasharray=\"{}\"", escaped(c.dash));
}

void add_legend(std::string& out, const Plot& plot) {
  double legend = width - right;
  for (auto c = plot.curves.rbegin(); c != plot.curves.rend(); ++c) {
    legend -= 7.0 * double(c->name.size()) + 8;
    text(out, legend, 18, "start", "", c->name);
    line(out, legend - 22, 14, legend - 4, 14,
         fmt::format("stroke=\"{}\" stroke-width=\"2\"{}", escaped(c->colour), dash_of(*c)));
    legend -= 32;
  }
}

void add_curve(std::string& out, const Plot& plot, const PlotCurve& c, const Axis& x, const Axis& y) {
  std::string path;
  bool pen = false;
  for (std::size_t i = 0; i < std::min(c.y.size(), plot.x.size()); ++i) {
    if (!y.shows(c.y[i]) || !std::isfinite(plot.x[i])) {
      pen = false;
      continue;
    }
    path += fmt::format("{}{:.1f} {:.1f}", pen ? " L" : path.empty() ? "M" : " M", x.map(plot.x[i]), y.map(c.y[i]));
    pen = true;
  }
  if (path.empty()) return;
  out += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.4\" stroke-linejoin=\"round\"{}/>\n",
                     path, escaped(c.colour), dash_of(c));
}

}  // namespace

std::string svg(const Plot& plot) {
  const Axis x = x_axis(plot), y = y_axis(plot);
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" role=\"img\" font-family=\"sans-serif\" "
      "font-size=\"11\" fill=\"#222\">\n"
      "<title>{2}</title>\n<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
      width, height, escaped(plot.title));
  add_frame(out, plot, x, y);
  add_marks(out, plot, x);
  add_legend(out, plot);
  for (const auto& c : plot.curves) add_curve(out, plot, c, x, y);
  return out + "</svg>\n";
}

}  // namespace insula
