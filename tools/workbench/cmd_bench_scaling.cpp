// SPDX-License-Identifier: GPL-3.0-or-later
// insula bench --scaling: how the stages of a step grow with nodes, rows and strands.
#include <fmt/ostream.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/linalg/kernels.h"
#include "core/mechanics/soft_body.h"
#include "engine/reports/report_writer.h"
#include "engine/reports/svg_plot.h"
#include "tools/workbench/scaling_scene.h"
#include "tools/workbench/workbench.h"

namespace insula {
namespace {

/// One curve of a plot: a quantity at each size, and the power of the size that theory gives it.
struct Quantity {
  std::string name, unit;
  double theory;  ///< exponent; not finite: none
  std::string why;
  std::string colour;  ///< empty: not drawn
  std::vector<double> value;
};

struct Series {
  std::string title, size_name;
  std::vector<double> size;
  std::vector<Quantity> quantities;
};

/// Least squares of log(value) over log(size), from the size on at which costs that do not grow have faded: the upper
/// half.
double slope(const std::vector<double>& size, const std::vector<double>& value) {
  std::vector<std::pair<double, double>> points;
  for (std::size_t i = 0; i < size.size(); ++i)
    if (size[i] > 0 && value[i] > 0) points.emplace_back(std::log(size[i]), std::log(value[i]));
  if (points.size() > 3) points.erase(points.begin(), points.begin() + std::ptrdiff_t(points.size() / 2 - 1));
  if (points.size() < 2) return std::nan("");
  double mx = 0, my = 0, xx = 0, xy = 0;
  for (auto [x, y] : points) mx += x, my += y;
  mx /= double(points.size()), my /= double(points.size());
  for (auto [x, y] : points) xx += (x - mx) * (x - mx), xy += (x - mx) * (y - my);
  return xx > 0 ? xy / xx : std::nan("");
}

struct MeasuredSteps {
  std::array<double, stage_count> stage{};
  double step = 0, rows = 0, sweeps = 0, strands = 0, nodes = 0, assembly = 0, flops = 0, entries = 0;
};

/// Medians over some steps.
MeasuredSteps measure(Simulation& s, int warm_up, double seconds) {
  using Clock = std::chrono::steady_clock;
  for (int i = 0; i < warm_up; ++i) s.step();
  std::array<std::vector<double>, stage_count> stage;
  std::vector<double> step, rows, sweeps;
  const auto begin = Clock::now();
  for (int i = 0; i < 3 || (i < 60 && std::chrono::duration<double>(Clock::now() - begin).count() < seconds); ++i) {
    s.step();
    const StepReport& r = s.report();
    for (std::size_t k = 0; k < stage_count; ++k) stage[k].push_back(r.stage_ms[k]);
    step.push_back(r.step_ms);
    rows.push_back(r.rows);
    sweeps.push_back(r.solve.sweeps);
  }
  MeasuredSteps m;
  for (std::size_t k = 0; k < stage_count; ++k) m.stage[k] = percentile(stage[k], 0.5);
  m.step = percentile(step, 0.5);
  m.rows = percentile(rows, 0.5);
  m.sweeps = percentile(sweeps, 0.5);
  if (s.channels().find("strands.standing")) m.strands = s.channel("strands.standing");
  auto* body = const_cast<SoftBody*>(s.scene().find_as<SoftBody>("lower"));
  m.nodes = body->nodes();
  m.flops = body->solver_cost().factor_flops;
  m.entries = double(body->solver_cost().factor_entries);
  // Elements by themselves, into a copy of the matrix.
  BlockMatrix a = body->system();
  std::vector<double> force(3 * std::size_t(body->nodes())), assembly;
  for (int i = 0; i < 5; ++i) {
    const auto from = Clock::now();
    for (ForceModel* f : body->forces()) f->linearise(body->q().data(), force.data(), &a, s.h(), Tangent::system);
    assembly.push_back(std::chrono::duration<double, std::milli>(Clock::now() - from).count());
  }
  m.assembly = percentile(assembly, 0.5);
  return m;
}

void add(Series& to, double size, std::initializer_list<double> values) {
  to.size.push_back(size);
  std::size_t i = 0;
  for (double v : values) to.quantities[i++].value.push_back(v);
}

constexpr double none = NAN;

Series against_nodes(const CommandContext& context, const ScalingOptions& options) {
  Series out{"Against nodes",
             "nodes",
             {},
             {{"elements", "ms", 1, "six tetrahedra a node", "#2e9e6b", {}},
              {"factor flops", "Mflop", 2, "nested dissection in three dimensions", "", {}},
              {"factor entries", "10^6", 4.0 / 3, "nested dissection in three dimensions", "", {}},
              {"free motion", "ms", 2, "the factor; less while fronts are too small for full speed", "#1f6fb2", {}},
              {"collision", "ms", 2.0 / 3, "surface", "#b0862a", {}},
              {"build", "ms", 4.0 / 3, "entries of the factor that the rows reach", "#a03c78", {}},
              {"correct", "ms", 4.0 / 3, "entries of the factor", "#d0532f", {}},
              {"step", "ms", 2, "the factor", "#222222", {}}}};
  std::vector<int> cells{7, 9, 12, 16, 21, 27, 36};
  if (options.quick) cells.resize(4);
  for (int c : cells) {
    const auto s = brick_scene({c, 7, 7, 0}, context.registry, options.threads);
    const MeasuredSteps m = measure(*s, c > 20 ? 1 : 5, 2);
    add(out, m.nodes,
        {m.assembly, m.flops * 1e-6, m.entries * 1e-6, m.stage[stage_free_motion], m.stage[stage_collision],
         m.stage[stage_build], m.stage[stage_correct], m.step});
    if (!options.json) fmt::print(context.err, "  {:.0f} nodes: {:.1f} ms a step\n", m.nodes, m.step);
  }
  return out;
}

Series against_rows(const CommandContext& context, const ScalingOptions& options) {
  Series out{"Against rows",
             "rows",
             {},
             {{"collision", "ms", none, "the same surfaces", "#b0862a", {}},
              {"build", "ms", 1, "what each row reaches of the factor; rows^2 from some 600 on", "#a03c78", {}},
              {"sweeps", "", none, "", "", {}},
              {"one sweep", "us", 2, "rows^2 from some 300 on; before, what a block costs", "", {}},
              {"solve", "ms", 2, "sweeps by rows^2", "#1f6fb2", {}},
              {"correct", "ms", none, "the factor read once, and one product a row", "#d0532f", {}},
              {"step", "ms", none, "", "#222222", {}}}};
  std::vector<int> contacts{3, 6, 12, 25, 50, 100, 200};
  if (options.quick) contacts.resize(4);
  for (int k : contacts) {
    const auto s = brick_scene({11, 10, 0, k}, context.registry, options.threads);
    const MeasuredSteps m = measure(*s, 20, 2);
    add(out, m.rows,
        {m.stage[stage_collision], m.stage[stage_build], m.sweeps,
         1000 * m.stage[stage_solve] / std::max(1.0, m.sweeps), m.stage[stage_solve], m.stage[stage_correct], m.step});
    if (!options.json) fmt::print(context.err, "  {:.0f} rows: {:.2f} ms a step\n", m.rows, m.step);
  }
  return out;
}

Series against_strands(const CommandContext& context, const ScalingOptions& options) {
  Series out{"Against strands",
             "strands",
             {},
             {{"collision", "ms", none, "blades near a strand: there is none here", "#b0862a", {}},
              {"build", "ms", 1, "as rows", "#a03c78", {}},
              {"solve", "ms", 2, "sweeps by rows^2", "#1f6fb2", {}},
              {"correct", "ms", none, "the factor read once, and one product a row", "#d0532f", {}},
              {"step", "ms", none, "", "#222222", {}}}};
  std::vector<double> density{0, 1, 3, 8, 20, 40, 62};
  if (options.quick) density.resize(4);
  for (double d : density) {
    const auto s = brick_scene({10, 10, d, 0}, context.registry, options.threads);
    const MeasuredSteps m = measure(*s, 10, 2);
    add(out, m.strands,
        {m.stage[stage_collision], m.stage[stage_build], m.stage[stage_solve], m.stage[stage_correct], m.step});
    if (!options.json) fmt::print(context.err, "  {:.0f} strands: {:.2f} ms a step\n", m.strands, m.step);
  }
  return out;
}

void print(std::ostream& out, const Series& s) {
  fmt::print(out, "\n{}\n  {:<20}", s.title, s.size_name);
  for (double v : s.size) fmt::print(out, "{:>9.0f}", v);
  fmt::print(out, "{:>9}{:>9}\n", "slope", "theory");
  for (const Quantity& q : s.quantities) {
    fmt::print(out, "  {:<20}", q.unit.empty() ? q.name : q.name + ", " + q.unit);
    for (double v : q.value)
      fmt::print(out, "{:>9}", fmt::format("{:.{}f}", v, v < 0.1 ? 4 : v < 10 ? 2 : v < 1000 ? 1 : 0));
    fmt::print(out, "{:>9}{:>9}  {}\n", std::isfinite(q.theory) ? fmt::format("{:.2f}", slope(s.size, q.value)) : "",
               std::isfinite(q.theory) ? fmt::format("{:.2f}", q.theory) : "", q.why);
  }
}

nlohmann::json as_json(const Series& s) {
  nlohmann::json j{{"title", s.title}, {s.size_name, s.size}};
  for (const Quantity& q : s.quantities) {
    nlohmann::json& to = j["quantities"][q.name];
    to = {{"unit", q.unit}, {"value", q.value}, {"why", q.why}};
    if (std::isfinite(q.theory)) to["theory"] = q.theory, to["slope"] = slope(s.size, q.value);
  }
  return j;
}

/// One plot below the other.
std::string svg_of(const std::vector<Series>& all) {
  std::string inner;
  double y = 0;
  for (const Series& s : all) {
    Plot plot;
    plot.title = s.title;
    plot.x_label = s.size_name;
    plot.y_label = "ms";
    plot.log_x = plot.log_y = true;
    plot.x = s.size;
    for (const Quantity& q : s.quantities)
      if (!q.colour.empty()) plot.curves.push_back({q.name, q.colour, q.value, ""});
    // Sizes of nothing have no place on a logarithmic axis.
    while (!plot.x.empty() && plot.x.front() <= 0) {
      plot.x.erase(plot.x.begin());
      for (PlotCurve& c : plot.curves) c.y.erase(c.y.begin());
    }
    std::string one = svg(plot);
    one.replace(0, 4, fmt::format("<svg y=\"{}\" width=\"760\" height=\"250\"", y));
    inner += one;
    y += 260;
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 760 {0}\" role=\"img\">\n<rect width=\"760\" "
      "height=\"{0}\" fill=\"#fff\"/>\n{1}</svg>\n",
      y, inner);
}

}  // namespace

int cmd_bench_scaling(const CommandContext& context, const ScalingOptions& options) {
  std::vector<Series> all;
  all.push_back(against_nodes(context, options));
  all.push_back(against_rows(context, options));
  all.push_back(against_strands(context, options));
  nlohmann::json j{{"kernels", kernels().name}, {"threads", options.threads}};
  for (const Series& s : all) j["series"].push_back(as_json(s));
  if (options.json) context.out << j.dump(2) << '\n';
  else
    for (const Series& s : all) print(context.out, s);
  if (options.output.empty()) return 0;
  std::error_code ignored;
  std::filesystem::create_directories(options.output, ignored);
  for (const auto& [name, text] : {std::pair{"scaling.json", j.dump(2) + "\n"}, std::pair{"scaling.svg", svg_of(all)}})
    if (!(std::ofstream(options.output / name, std::ios::binary) << text).flush()) {
      fmt::print(context.err, "error: cannot write {}\n", (options.output / name).string());
      return 1;
    }
  return 0;
}

}  // namespace insula
