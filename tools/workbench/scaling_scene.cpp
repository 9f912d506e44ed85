// SPDX-License-Identifier: GPL-3.0-or-later
// Bricks of 30 mm, six tetrahedra a cube.
#include "tools/workbench/scaling_scene.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace insula {
namespace {

namespace fs = std::filesystem;

/// A folder that goes when it is no longer needed.
struct Folder {
  fs::path path;
  Folder() {
    static std::atomic<int> count{0};
    path = fs::temp_directory_path() / fmt::format("insula_bricks_{}_{}", ::getpid(), count++);
    fs::create_directories(path);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

/// gmsh 2.2, mm. The diagonals of all cubes have the same direction, so neighbours fit.
void write_brick(const fs::path& file, int cells, double low) {
  const int side = cells + 1;
  std::string out = fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", side * side * side);
  const double step = 30.0 / cells;
  int number = 0;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      for (int k = 0; k < side; ++k)
        out += fmt::format("{} {} {} {}\n", ++number, i * step - 15, j * step - 15, low + k * step);
  out += fmt::format("$EndNodes\n$Elements\n{}\n", 6 * cells * cells * cells);
  const int stride[3] = {side * side, side, 1};
  constexpr int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}};
  number = 0;
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j)
      for (int k = 0; k < cells; ++k)
        for (int o = 0; o < 6; ++o) {
          const int a = 1 + i * stride[0] + j * stride[1] + k, b = a + stride[orders[o][0]],
                    c = b + stride[orders[o][1]], d = c + stride[orders[o][2]];
          out += fmt::format("{} 4 2 1 1 {} {} {} {}\n", ++number, a, o < 3 ? b : c, o < 3 ? c : b, d);
        }
  std::ofstream(file, std::ios::binary) << out << "$EndElements\n";
}

}  // namespace

std::unique_ptr<Simulation> brick_scene(const Bricks& bricks, const Registry& registry, int threads) {
  const Folder folder;
  const bool lies = bricks.contacts > 0;
  const double gap = lies ? -0.3 : 6;  // mm; overlapping bricks stay pressed
  write_brick(folder.path / "lower.msh", bricks.cells, -30);
  write_brick(folder.path / "upper.msh", bricks.upper_cells, gap);
  std::string text = fmt::format(
      "<scene time_step=\"16.6667 ms\">\n"
      "<solver max_sweeps=\"80\" tolerance=\"1e-7 m\"/>\n"
      "<soft_body id=\"lower\" mesh=\"lower.msh\" mesh_unit=\"mm\"><corotational_fem young=\"3 kPa\"/>"
      "<fixed region=\"beyond\" centre=\"0 0 -29.9 mm\" normal=\"0 0 -1\"/><surface id=\"lower_skin\"/></soft_body>\n"
      "<soft_body id=\"upper\" mesh=\"upper.msh\" mesh_unit=\"mm\"><corotational_fem young=\"3 kPa\"/>"
      "<fixed region=\"beyond\" centre=\"0 0 {} mm\" normal=\"0 0 1\"/><surface id=\"upper_skin\"/></soft_body>\n",
      gap + 29.9);
  if (bricks.fibres > 0)
    text += fmt::format(
        "<strand_springs id=\"strands\" from=\"lower_skin\" to=\"upper_skin\" density=\"{} 1/cm2\" max_length=\"15 "
        "mm\" slack=\"0.9\"/>\n",
        bricks.fibres);
  if (lies)
    text += fmt::format(
        "<contact id=\"contact\" between=\"lower upper\" friction=\"0.3\" tissue_alarm=\"2 mm\" tissue_spacing=\"{} "
        "mm\" tissue_max_contacts=\"{}\"/>\n",
        bricks.contacts > 20 ? 0.5 : 4, bricks.contacts);
  text += "</scene>\n";
  SimulationResult made = load_simulation_text(text, folder.path / "bricks.xml", registry, threads);
  if (!made.simulation) throw std::runtime_error("the scene of measurement is wrong:\n" + made.diagnostics.format());
  return std::move(made.simulation);
}

}  // namespace insula
