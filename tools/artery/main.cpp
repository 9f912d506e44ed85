// SPDX-License-Identifier: GPL-3.0-or-later
// insula_artery: makes the arteries of a table, or prepares a real surface, for simulation.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "vessel.h"

using namespace insula;
using namespace insula::artery;

namespace {

int finish(const Vessel& v, const std::filesystem::path& folder) {
  const Quality q = quality(v.wall.mesh);
  const bool sound =
      q.closed && q.components == 1 && q.euler == 2 && !q.self_intersecting && !quality(v.picture).self_intersecting;
  std::printf("%s: %zu vertices, %zu triangles, least angle %.1f deg, %s\n", folder.filename().c_str(),
              v.wall.mesh.vertices.size(), v.wall.mesh.triangles.size(), q.min_angle_deg,
              sound ? "closed, one piece, no holes through it, no self-intersection" : "NOT SOUND");
  if (!sound)
    std::printf("  closed %d, pieces %d, Euler number %d, self-intersecting %d\n", q.closed, q.components, q.euler,
                q.self_intersecting);
  for (const auto& [name, value] : v.dimensions) std::printf("  %-22s %9.3f\n", name.c_str(), value);
  if (!sound) return 1;
  write_vessel(v, folder);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Makes arteries with an aneurysm for simulation. For training only, never for the care of patients."};
  app.require_subcommand(1);
  std::string table, only, file, out;
  std::vector<double> inlet;
  double edge = 0, unit = 1;
  auto* make = app.add_subcommand("make", "the cases of a table of dimensions");
  make->add_option("table", table, "arteries.json")->required();
  make->add_option("folder", out, "one folder a case is made in it")->required();
  make->add_option("--case", only, "this case alone");
  auto* import = app.add_subcommand("import", "a closed surface (STL, PLY, OBJ) whose openings are flat caps");
  import->add_option("surface", file)->required();
  import->add_option("folder", out)->required();
  import->add_option("--unit-mm", unit, "millimetres a unit of the file")->check(CLI::Range(1e-6, 1e6));
  import->add_option("--edge", edge, "edge length, mm; by default for about 1,700 vertices")
      ->check(CLI::Range(0.01, 10.0));
  import->add_option("--inlet", inlet, "a point near the inlet, mm; by default the widest cap")->expected(3);
  CLI11_PARSE(app, argc, argv);
  try {
    if (*make) {
      int status = 0, made = 0;
      for (const CaseSpec& c : read_case_table(table)) {
        if (!only.empty() && c.name != only) continue;
        status = std::max(status, finish(make_case(c), std::filesystem::path(out) / c.name));
        ++made;
      }
      if (made == 0) throw std::runtime_error("the table has no case \"" + only + "\"");
      return status;
    }
    ImportOptions options;
    options.edge_length = edge;
    if (inlet.size() == 3) options.inlet = Vec3(inlet[0], inlet[1], inlet[2]);
    return finish(import_surface(read_surface(file, unit), options), out);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return 2;
  }
}
