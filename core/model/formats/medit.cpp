// SPDX-License-Identifier: GPL-3.0-or-later
// Medit .mesh, ASCII (Frey, "MEDIT: an interactive mesh visualization software", INRIA RT-0253).
#include <string>

#include "core/base/text.h"
#include "core/model/formats/file_bytes.h"
#include "core/model/formats/raw_tets.h"

namespace insula {
namespace {

bool is_keyword(std::string_view w) {
  const bool letter = !w.empty() && ((w[0] >= 'A' && w[0] <= 'Z') || (w[0] >= 'a' && w[0] <= 'z'));
  double value;
  return letter && !parse_double(w, value);  // "nan" and "inf" are numbers
}

std::string without_comments(std::string_view bytes) {
  std::string text;
  text.reserve(bytes.size());
  bool comment = false;
  for (char c : bytes) {
    if (c == '#') comment = true;
    if (c == '\n') comment = false;
    if (!comment) text += c;
  }
  return text;
}

}  // namespace

RawTets read_medit(const std::filesystem::path& file, std::string_view bytes) {
  const std::string text = without_comments(bytes);
  ByteCursor in(file, text);
  RawTets raw;
  if (in.word("MeshVersionFormatted") != "MeshVersionFormatted")
    in.fail("is no Medit file: it does not start with MeshVersionFormatted");
  in.integer("the version");
  bool vertices = false, tets = false, ended = false;
  std::string_view word = in.try_word();
  while (!word.empty() && !ended) {
    const std::string keyword(word);
    if (keyword == "Dimension") {
      if (in.integer("the dimension") != 3) in.fail("is not three-dimensional");
    } else if (keyword == "Vertices") {
      if (vertices) in.fail("has Vertices twice");
      vertices = true;
      const std::size_t n = in.count("the number of vertices", 8);
      raw.nodes.reserve(n);
      for (std::size_t i = 0; i < n; ++i) {
        Vec3 p;
        for (int k = 0; k < 3; ++k) p[k] = in.number("a vertex");
        in.number("a vertex's reference");
        raw.nodes.push_back(p);
        raw.node_number.push_back(std::int64_t(i) + 1);
      }
    } else if (keyword == "Tetrahedra") {
      tets = true;
      const std::size_t n = in.count("the number of tetrahedra", 10);
      for (std::size_t i = 0; i < n; ++i) {
        std::array<std::int64_t, 4> t;
        for (auto& v : t) v = in.integer("a tetrahedron's vertex") - 1;
        in.number("a tetrahedron's reference");
        raw.tets.push_back(t);
        raw.tet_number.push_back(std::int64_t(raw.tet_number.size()) + 1);
      }
    } else if (keyword == "End") {
      ended = true;
      break;
    } else if (is_keyword(keyword)) {
      // Not used here, but other volume elements would leave holes.
      const bool volume = keyword == "Hexahedra" || keyword == "Prisms" || keyword == "Pyramids";
      std::string_view next = in.try_word();
      std::int64_t n = 0;
      if (volume && parse_integer(next, n) && n > 0)
        in.fail("holds " + keyword + "; only tetrahedra can fill a volume here");
      while (!next.empty() && !is_keyword(next)) next = in.try_word();
      word = next;
      continue;
    } else {
      in.fail("expected a keyword, found " + in_quotes(word));
    }
    word = in.try_word();
  }
  if (!ended) in.fail("ends early: End is missing");
  if (!vertices) in.fail("has no Vertices");
  if (!tets) in.fail("holds no tetrahedra");
  return raw;
}

}  // namespace insula
