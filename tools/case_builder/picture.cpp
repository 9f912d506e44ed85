// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace insula::case_builder {

TriMesh disc(const Vec3& centre, const Vec3& normal, double radius) {
  TriMesh m;
  const Vec3 u = normal.unitOrthogonal(), w = normal.normalized().cross(u);
  m.vertices.push_back(centre);
  constexpr int n = 36;
  for (int k = 0; k < n; ++k) {
    const double a = 2 * std::numbers::pi * k / n;
    m.vertices.push_back(centre + radius * (std::cos(a) * u + std::sin(a) * w));
    m.triangles.push_back({0, 1 + k, 1 + (k + 1) % n});
  }
  return m;
}

std::string svg_picture(const std::vector<Drawn>& things, const Vec3& from, const Vec3& up, const Vec3& centre,
                        double radius, int width) {
  const Vec3 z = from.normalized(), x = up.cross(z).normalized(), y = z.cross(x);
  struct Face {
    double depth;
    std::string text;
  };
  std::vector<Face> faces;
  const double scale = width / (2 * radius);
  for (const Drawn& d : things)
    for (std::size_t t = 0; t < d.mesh.triangles.size(); ++t) {
      Vec3 p[3];
      for (std::size_t k = 0; k < 3; ++k) p[k] = d.mesh.vertices[std::size_t(d.mesh.triangles[t][k])] - centre;
      const Vec3 n = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
      const double lit = n.dot(z);
      if (!d.flat && !(lit > 0)) continue;  // turned away
      bool seen = false;
      std::string points;
      for (const Vec3& q : p) {
        seen = seen || (std::abs(q.dot(x)) < radius && std::abs(q.dot(y)) < radius);
        points += fmt::format("{:.1f},{:.1f} ", scale * (q.dot(x) + radius), scale * (radius - q.dot(y)));
      }
      if (!seen) continue;
      const auto& c = d.colour.size() == 1 ? d.colour[0] : d.colour[t];
      const double light = d.flat ? 1 : 0.35 + 0.65 * lit;
      const std::string colour =
          fmt::format("#{:02x}{:02x}{:02x}", int(c[0] * light), int(c[1] * light), int(c[2] * light));
      faces.push_back({(p[0] + p[1] + p[2]).dot(z),
                       fmt::format("<path d=\"M{}Z\" fill=\"{}\" stroke=\"{}\" stroke-width=\".4\"{}/>", points, colour,
                                   colour, d.opacity < 1 ? fmt::format(" opacity=\"{:.2f}\"", d.opacity) : "")});
    }
  std::stable_sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.depth < b.depth; });
  std::string out = fmt::format(
      "<svg viewBox=\"0 0 {0} {0}\" width=\"{0}\" height=\"{0}\" xmlns=\"http://www.w3.org/2000/svg\"><rect "
      "width=\"{0}\" height=\"{0}\" fill=\"#10151c\"/>",
      width);
  for (const Face& f : faces) out += f.text;
  // A bar of 5 mm.
  out += fmt::format(
      "<rect x=\"12\" y=\"{}\" width=\"{:.1f}\" height=\"3\" fill=\"#fff\"/><text x=\"12\" y=\"{}\" fill=\"#fff\" "
      "font-size=\"12\" font-family=\"sans-serif\">5 mm</text></svg>",
      width - 14, 5 * scale, width - 20);
  return out;
}

}  // namespace insula::case_builder
