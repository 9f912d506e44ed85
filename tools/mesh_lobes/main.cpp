// SPDX-License-Identifier: GPL-3.0-or-later
// insula_mesh_volume: turns labels of a NIfTI volume into tetrahedral meshes and fine surfaces. See usage() below.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>

#include "cleft.h"
#include "labels.h"
#include "mesh_data.h"
#include "meshing.h"
#include "part_fields.h"
#include "part_meshes.h"
#include "separate.h"

namespace insula::mesh_tool {
namespace {

const char* const usage_text = R"(usage: insula_mesh_volume --labels FILE.nii[.gz] --part NAME=LABELS ... [options]

Input (lengths in mm, positions in the volume's right-anterior-superior frame)
  --labels FILE          label volume; 0 is background
  --part NAME=LIST       a part: labels to unite, e.g. frontal=2,4,10-16 (repeat; parts are kept apart)
  --more-labels FILE     another label volume: its label N is called 1000 + N, and where a part has it, it wins
  --intensity FILE       image of the same head: sharpens the border of tissue and steers the borders between parts
  --tissue VALUE         intensity at which tissue begins
  --tissue-slope VALUE   change of intensity a millimetre across that border (25)
Region and shape
  --roi X,Y,Z,R          only inside this sphere
  --spacing MM           working grid (0.5)
  --gap MM               free space between the fine surfaces of two parts (1)
  --smooth MM            Gaussian on the fine shape (0.6);  --border-smooth MM  on borders between parts (1.2)
  --close MM             radius of sulci filled in the fine shape (1);  --open MM  of specks taken off it (1)
  --coarse-close MM      the same in the tetrahedral shape (2.5);  --coarse-smooth MM (1.5)
  --coarse-outset MM     how far the tetrahedral shape reaches past the fine one (0.6)
  --coarse-gap MM        free space between tetrahedral parts (0.35)
Sizes: edge length NEAR,FAR in mm, growing from the one to the other along the distance D to the focus
  --focus R0,R1          D below R0: near; above R1: far. D is the distance to the other parts (0 with a
                         single part) or, when greater, to ...
  --focus-point X,Y,Z,R  ... this ball
  --cell NEAR,FAR        tetrahedra (4,9);  --cell-error NEAR,FAR  distance of their boundary to the shape (0.5,1.5)
  --edge NEAR,FAR        triangles of the fine surfaces (1,3);  --edge-error MM (0.1)
  --cell-of NAME=NEAR,FAR, --edge-of NAME=NEAR,FAR   the same for one part
Output
  --tet NAME=FILE[:2.2|:4.1|:4.1b]   gmsh file: 2.2 ASCII, 4.1 ASCII (default) or 4.1 binary
  --surface NAME=FILE.ply
  --cleft NAME,NAME=FILE.json        superficial line, depth and outward normal of the cleft between two parts
  --view X,Y,Z           direction from the field to the observer, for --cleft (1,0,0)
)";

std::vector<double> numbers(const std::string& text, std::size_t count, const std::string& option) {
  std::vector<double> out;
  std::stringstream stream(text);
  std::string item;
  while (std::getline(stream, item, ',')) {
    std::size_t used = 0;
    double value = 0;
    try {
      value = std::stod(item, &used);
    } catch (const std::exception&) {
      used = 0;
    }
    if (!used || used != item.size() || !std::isfinite(value))
      throw std::runtime_error(option + ": '" + item + "' is not a number");
    out.push_back(value);
  }
  if (out.size() != count)
    throw std::runtime_error(option + " takes " + std::to_string(count) + " numbers separated by commas");
  return out;
}

struct Job {
  std::string labels, more_labels, intensity;
  std::vector<Part> parts;
  FieldOptions fields;
  bool has_tissue = false;  ///< whether the intensity threshold of tissue was given
  Sizes focus{2, 20}, cell{4, 9}, cell_error{0.5, 1.5}, edge{1, 3};
  double edge_error = 0.1, focus_radius = -1;
  Vec3 focus_point{}, view{1, 0, 0};
  std::map<std::string, Sizes> edge_of, cell_of;
  std::vector<std::pair<std::string, std::string>> tets, surfaces, clefts;

  std::size_t part(const std::string& name) const {
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (parts[i].name == name) return i;
    throw std::runtime_error("there is no part called '" + name + "'");
  }
};

std::pair<std::string, std::string> split(const std::string& text, const std::string& option) {
  const auto at = text.find('=');
  if (at == std::string::npos || at == 0 || at + 1 == text.size())
    throw std::runtime_error(option + " takes NAME=VALUE");
  return {text.substr(0, at), text.substr(at + 1)};
}

/// One option of the command line, with its value.
struct Given {
  std::string option, value;
  double one() const { return numbers(value, 1, option)[0]; }
  double length() const {
    const double v = one();
    if (v < 0) throw std::runtime_error(option + " must not be negative");
    return v;
  }
  Sizes sizes(const std::string& text) const {
    const auto v = numbers(text, 2, option);
    if (!(v[0] > 0 && v[1] >= v[0])) throw std::runtime_error(option + " takes NEAR,FAR with 0 < NEAR <= FAR");
    return {v[0], v[1]};
  }
  std::pair<std::string, std::string> named() const { return split(value, option); }
};

void add_part(Job& job, const Given& g) {
  const auto [name, list] = g.named();
  for (const Part& p : job.parts)
    if (p.name == name) throw std::runtime_error("--part: '" + name + "' is given twice");
  try {
    job.parts.push_back({name, label_list(list)});
  } catch (const std::runtime_error& e) {
    throw std::runtime_error("--part " + name + ": " + e.what());
  }
}

void set_region(Job& job, const Given& g) {
  const auto v = numbers(g.value, 4, g.option);
  job.fields.centre = {v[0], v[1], v[2]};
  job.fields.radius = v[3];
  if (!(v[3] > 0)) throw std::runtime_error("--roi: the radius must be positive");
}

void set_focus_point(Job& job, const Given& g) {
  const auto v = numbers(g.value, 4, g.option);
  job.focus_point = {v[0], v[1], v[2]};
  job.focus_radius = v[3];
}

void set_view(Job& job, const Given& g) {
  const auto v = numbers(g.value, 3, g.option);
  job.view = {v[0], v[1], v[2]};
}

void set_tissue(Job& job, const Given& g) {
  job.fields.tissue = g.one();
  job.has_tissue = true;
}

using Setter = void (*)(Job&, const Given&);
const std::map<std::string, Setter> setters = {
    {"--labels", [](Job& j, const Given& g) { j.labels = g.value; }},
    {"--more-labels", [](Job& j, const Given& g) { j.more_labels = g.value; }},
    {"--intensity", [](Job& j, const Given& g) { j.intensity = g.value; }},
    {"--part", add_part},
    {"--tissue", set_tissue},
    {"--tissue-slope", [](Job& j, const Given& g) { j.fields.tissue_slope = g.one(); }},
    {"--roi", set_region},
    {"--spacing", [](Job& j, const Given& g) { j.fields.spacing = g.one(); }},
    {"--gap", [](Job& j, const Given& g) { j.fields.gap = g.length(); }},
    {"--smooth", [](Job& j, const Given& g) { j.fields.smoothing = g.length(); }},
    {"--border-smooth", [](Job& j, const Given& g) { j.fields.border_smoothing = g.length(); }},
    {"--close", [](Job& j, const Given& g) { j.fields.fine_closing = g.length(); }},
    {"--open", [](Job& j, const Given& g) { j.fields.fine_opening = g.length(); }},
    {"--coarse-close", [](Job& j, const Given& g) { j.fields.coarse_closing = g.length(); }},
    {"--coarse-smooth", [](Job& j, const Given& g) { j.fields.coarse_smoothing = g.length(); }},
    {"--coarse-outset", [](Job& j, const Given& g) { j.fields.coarse_outset = g.length(); }},
    {"--coarse-gap", [](Job& j, const Given& g) { j.fields.coarse_gap = g.length(); }},
    {"--focus", [](Job& j, const Given& g) { j.focus = g.sizes(g.value); }},
    {"--focus-point", set_focus_point},
    {"--cell", [](Job& j, const Given& g) { j.cell = g.sizes(g.value); }},
    {"--cell-error", [](Job& j, const Given& g) { j.cell_error = g.sizes(g.value); }},
    {"--edge", [](Job& j, const Given& g) { j.edge = g.sizes(g.value); }},
    {"--edge-error", [](Job& j, const Given& g) { j.edge_error = g.one(); }},
    {"--edge-of", [](Job& j, const Given& g) { j.edge_of[g.named().first] = g.sizes(g.named().second); }},
    {"--cell-of", [](Job& j, const Given& g) { j.cell_of[g.named().first] = g.sizes(g.named().second); }},
    {"--tet", [](Job& j, const Given& g) { j.tets.push_back(g.named()); }},
    {"--surface", [](Job& j, const Given& g) { j.surfaces.push_back(g.named()); }},
    {"--cleft", [](Job& j, const Given& g) { j.clefts.push_back(g.named()); }},
    {"--view", set_view},
};

Job parse(int argc, char** argv) {
  Job job;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--help" || option == "-h") {
      std::fputs(usage_text, stdout);
      std::exit(0);
    }
    if (i + 1 >= argc) throw std::runtime_error(option + ": unknown option or missing value (see --help)");
    const auto setter = setters.find(option);
    if (setter == setters.end()) throw std::runtime_error(option + ": unknown option (see --help)");
    setter->second(job, {option, argv[++i]});
  }
  if (job.labels.empty() || job.parts.empty())
    throw std::runtime_error("--labels and at least one --part are needed (see --help)");
  if (!job.intensity.empty() && !job.has_tissue) throw std::runtime_error("--intensity needs --tissue");
  if (!(job.fields.spacing > 0) || !(job.fields.tissue_slope > 0) || !(job.edge_error > 0))
    throw std::runtime_error("--spacing, --tissue-slope and --edge-error must be positive");
  for (const auto* list : {&job.tets, &job.surfaces})
    for (const auto& [name, file] : *list) job.part(name);
  for (const auto* list : {&job.edge_of, &job.cell_of})
    for (const auto& [name, sizes] : *list) job.part(name);
  return job;
}

// The size field of a part, with the part's own sizes where they are given.
SizeField sizes(const Job& job, const PartFields& fields, std::size_t part, Sizes size,
                const std::map<std::string, Sizes>& own) {
  const auto at = own.find(job.parts[part].name);
  return growing(fields, part, at == own.end() ? size : at->second, {job.focus, job.focus_point, job.focus_radius});
}

void make_tets(const Job& job, const PartFields& fields) {
  std::vector<SizeField> cell, error;
  for (std::size_t a = 0; a < job.parts.size(); ++a)
    cell.push_back(sizes(job, fields, a, job.cell, job.cell_of)),
        error.push_back(sizes(job, fields, a, job.cell_error, {}));
  const auto [meshes, shape] = mesh_parts(fields, cell, error, job.fields.coarse_gap);
  std::vector<TriangleMesh> borders;
  for (const TetMesh& mesh : meshes) borders.push_back(boundary_mesh(mesh));
  for (std::size_t a = 0; a < meshes.size(); ++a)
    for (std::size_t b = a + 1; b < meshes.size(); ++b) {
      const Clearance c = clearance(borders[a], borders[b]);
      std::printf("tetrahedra %s - %s: gap %.3f mm%s\n", job.parts[a].name.c_str(), job.parts[b].name.c_str(),
                  c.distance, c.intersect ? ", INTERSECT" : "");
      std::fflush(stdout);
      if (c.intersect)
        throw std::runtime_error(
            "parts intersect; take smaller cells, a smaller --cell-error or a greater --coarse-gap");
    }
  for (const auto& [name, target] : job.tets) {
    std::string file = target;
    MshFormat format = MshFormat::v4_ascii;
    if (const auto colon = file.rfind(':'); colon != std::string::npos) {
      const std::string version = file.substr(colon + 1);
      if (version == "2.2") format = MshFormat::v2_ascii;
      else if (version == "4.1b") format = MshFormat::v4_binary;
      else if (version != "4.1") throw std::runtime_error("--tet: '" + version + "' is not 2.2, 4.1 or 4.1b");
      file.resize(colon);
    }
    const TetMesh& mesh = meshes[job.part(name)];
    write_msh(file, mesh, format);
    const DihedralRange angles = dihedral_range(mesh);
    std::printf("%s: %zu nodes, %zu tetrahedra, dihedral %.2f to %.2f deg, volume %.0f mm3, boundary %s, %s\n",
                name.c_str(), mesh.points.size(), mesh.tets.size(), angles.min_deg, angles.max_deg, volume(mesh),
                is_closed(boundary_triangles(mesh)) ? "closed" : "NOT A CLOSED MANIFOLD", file.c_str());
    const Embedding e = embedding({shape[job.part(name)], {}}, mesh);
    std::printf("  fine shape outside the tetrahedra: %.1f %% of its border, at most %.2f mm\n", 100 * e.share_outside,
                e.furthest);
  }
}

void make_surfaces(const Job& job, const PartFields& fields) {
  std::vector<TriangleMesh> meshes;
  std::vector<std::string> names;
  for (const auto& [name, file] : job.surfaces) {
    const std::size_t part = job.part(name);
    meshes.push_back(
        mesh_surface(fields.grid, fields.fine[part], sizes(job, fields, part, job.edge, job.edge_of), job.edge_error));
    names.push_back(name);
    write_ply(file, meshes.back());
    double shortest = 1e30, longest = 0;
    for (const Triangle& t : meshes.back().triangles)
      for (std::size_t e = 0; e < 3; ++e) {
        const double d = norm(meshes.back().points[static_cast<std::size_t>(t[e])] -
                              meshes.back().points[static_cast<std::size_t>(t[(e + 1) % 3])]);
        shortest = std::min(shortest, d), longest = std::max(longest, d);
      }
    std::printf("%s surface: %zu points, %zu triangles, edges %.2f to %.2f mm, volume %.0f mm3, closed, %s\n",
                name.c_str(), meshes.back().points.size(), meshes.back().triangles.size(), shortest, longest,
                signed_volume(meshes.back()), file.c_str());
  }
  for (std::size_t a = 0; a < meshes.size(); ++a)
    for (std::size_t b = a + 1; b < meshes.size(); ++b) {
      const Clearance c = clearance(meshes[a], meshes[b]);
      std::printf("surfaces %s - %s: gap %.3f mm%s\n", names[a].c_str(), names[b].c_str(), c.distance,
                  c.intersect ? ", INTERSECT" : "");
      if (c.intersect) throw std::runtime_error("surfaces intersect; take a greater --gap");
    }
}

int run(int argc, char** argv) {
  const Job job = parse(argc, argv);
  NiftiVolume labels = read_nifti(job.labels);
  if (!job.more_labels.empty()) add_labels(labels, read_nifti(job.more_labels), job.parts);
  NiftiVolume intensity;
  if (!job.intensity.empty()) intensity = read_nifti(job.intensity);
  const PartFields fields =
      build_part_fields(labels, job.intensity.empty() ? nullptr : &intensity, job.parts, job.fields);
  std::printf("working grid %d x %d x %d at %.2f mm\n", fields.grid.size[0], fields.grid.size[1], fields.grid.size[2],
              fields.grid.spacing);
  std::fflush(stdout);
  if (!job.surfaces.empty()) make_surfaces(job, fields);
  std::fflush(stdout);
  for (const auto& [names, file] : job.clefts) {
    const auto comma = names.find(',');
    if (comma == std::string::npos) throw std::runtime_error("--cleft takes NAME,NAME=FILE");
    const std::string a = names.substr(0, comma), b = names.substr(comma + 1);
    const Cleft cleft = describe_cleft(fields, job.part(a), job.part(b), job.fields, job.view);
    write_cleft_json(file, cleft, a, b, job.fields);
    std::printf("cleft %s - %s: %zu stations, %.1f mm long, %s\n", a.c_str(), b.c_str(), cleft.stations.size(),
                cleft.length, file.c_str());
  }
  if (!job.tets.empty()) make_tets(job, fields);
  return 0;
}

}  // namespace
}  // namespace insula::mesh_tool

int main(int argc, char** argv) {
  try {
    return insula::mesh_tool::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "insula_mesh_volume: error: %s\n", error.what());
    return 2;
  }
}
