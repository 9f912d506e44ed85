// SPDX-License-Identifier: GPL-3.0-or-later
// Walks a PLY file (Turk, "The PLY Polygon File Format") and checks that everything its header announces is there.
#include "core/model/formats/ply_check.h"

#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "core/model/formats/file_bytes.h"

namespace insula {
namespace {

enum class PlyType { i8, u8, i16, u16, i32, u32, f32, f64 };

struct Property {
  std::string name;
  bool is_list = false;
  PlyType count = PlyType::u8, value = PlyType::f32;
};

struct PlyElement {
  std::string name;
  std::int64_t count = 0;
  std::vector<Property> properties;
};

class PlyWalker {
 public:
  PlyWalker(const std::filesystem::path& file, std::string_view bytes) : bytes_(bytes), in_(file, bytes) {}

  /// `opposite`: receives the file in the opposite byte order, if it is binary.
  void walk(std::string* opposite = nullptr) {
    header();
    if (opposite && !ascii_) {
      opposite_ = opposite;
      *opposite = bytes_.substr(0, bytes_.size() - in_.left());
      const std::string_view now = swap_ != machine_is_little_endian ? "little" : "big";
      opposite->replace(opposite->find(now), now.size(), now == "big" ? "little" : "big");
    }
    std::int64_t vertices = 0, faces = 0;
    for (const auto& e : elements_) {
      if (e.name == "vertex") vertices = e.count;
      if (e.name == "face") faces = e.count;
    }
    if (vertices == 0 || faces == 0) in_.fail("holds no triangles");
    for (const auto& e : elements_) {
      in_.checked_count(e.count, "a number of elements", e.properties.empty() ? 0 : e.properties.size());
      const bool is_face = e.name == "face";
      for (std::int64_t i = 0; i < e.count && !e.properties.empty(); ++i)
        for (const auto& p : e.properties) property(p, is_face, vertices, i);
    }
  }

 private:
  void header() {
    if (trim(in_.line()) != "ply") in_.fail("is no PLY file: it does not start with \"ply\"");
    for (;;) {
      if (in_.left() == 0) in_.fail("ends early: \"end_header\" is missing");
      const auto words = split_blanks(in_.line());
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format" && words.size() >= 2) {
        if (words[1] != "ascii" && words[1] != "binary_little_endian" && words[1] != "binary_big_endian")
          in_.fail("its format " + in_quotes(words[1]) + " is not known");
        ascii_ = words[1] == "ascii";
        swap_ = !ascii_ && (words[1] == "binary_little_endian") != machine_is_little_endian;
        formatted_ = true;
      } else if (words[0] == "element" && words.size() == 3) {
        PlyElement e;
        e.name = std::string(words[1]);
        if (!parse_integer(words[2], e.count) || e.count < 0)
          in_.fail("its header has a malformed count " + in_quotes(words[2]));
        elements_.push_back(e);
      } else if (words[0] == "property" && !elements_.empty() && words.size() == 3) {
        elements_.back().properties.push_back({std::string(words[2]), false, PlyType::u8, type(words[1])});
      } else if (words[0] == "property" && !elements_.empty() && words.size() == 5 && words[1] == "list") {
        elements_.back().properties.push_back({std::string(words[4]), true, type(words[2]), type(words[3])});
      } else {
        in_.fail("its header has a malformed line that starts with " + in_quotes(words[0]));
      }
    }
    if (!formatted_) in_.fail("its header names no format");
  }

  PlyType type(std::string_view w) const {
    static constexpr std::pair<std::string_view, PlyType> names[] = {
        {"char", PlyType::i8},   {"int8", PlyType::i8},     {"uchar", PlyType::u8},   {"uint8", PlyType::u8},
        {"short", PlyType::i16}, {"int16", PlyType::i16},   {"ushort", PlyType::u16}, {"uint16", PlyType::u16},
        {"int", PlyType::i32},   {"int32", PlyType::i32},   {"uint", PlyType::u32},   {"uint32", PlyType::u32},
        {"float", PlyType::f32}, {"float32", PlyType::f32}, {"double", PlyType::f64}, {"float64", PlyType::f64}};
    for (const auto& [name, t] : names)
      if (name == w) return t;
    in_.fail("its header names an unknown type " + in_quotes(w));
  }

  template <class T>
  double binary(const char* what) {
    const T v = in_.binary<T>(swap_, what);
    if (opposite_) {
      const auto native = std::bit_cast<std::array<char, sizeof(T)>>(v);
      if (swap_) opposite_->append(native.begin(), native.end());
      else opposite_->append(native.rbegin(), native.rend());
    }
    return double(v);
  }

  double value(PlyType t) {
    constexpr const char* what = "a value that its header announces";
    if (ascii_) return in_.number(what);
    switch (t) {
      case PlyType::i8: return binary<std::int8_t>(what);
      case PlyType::u8: return binary<std::uint8_t>(what);
      case PlyType::i16: return binary<std::int16_t>(what);
      case PlyType::u16: return binary<std::uint16_t>(what);
      case PlyType::i32: return binary<std::int32_t>(what);
      case PlyType::u32: return binary<std::uint32_t>(what);
      case PlyType::f32: return binary<float>(what);
      case PlyType::f64: return binary<double>(what);
    }
    return 0;
  }

  void property(const Property& p, bool is_face, std::int64_t vertices, std::int64_t element) {
    if (!p.is_list) {
      const double v = value(p.value);
      if ((p.name == "x" || p.name == "y" || p.name == "z") && !std::isfinite(v))
        in_.fail("vertex " + std::to_string(element) + " is not finite");
      return;
    }
    const double announced = value(p.count);
    if (!(announced >= 0) || announced > 1e9) in_.fail("has a malformed list");
    const bool indices = is_face && (p.name == "vertex_indices" || p.name == "vertex_index");
    if (indices && announced < 3) in_.fail("face " + std::to_string(element) + " has fewer than three vertices");
    for (std::int64_t k = 0, n = std::int64_t(announced); k < n; ++k) {
      const double v = value(p.value);
      if (indices && !(v >= 0 && v < double(vertices)))
        in_.fail("face " + std::to_string(element) + " names a vertex that does not exist");
    }
  }

  std::string_view bytes_;
  ByteCursor in_;
  std::string* opposite_ = nullptr;
  std::vector<PlyElement> elements_;
  bool ascii_ = true, swap_ = false, formatted_ = false;
};

}  // namespace

void check_ply(const std::filesystem::path& file, std::string_view bytes) { PlyWalker(file, bytes).walk(); }

bool begins_with_line_end(std::string_view ply) {
  constexpr std::string_view end = "\nend_header";
  const std::size_t at = ply.find(end);
  if (at == std::string_view::npos || ply.substr(0, at).find("format binary") == std::string_view::npos) return false;
  const std::size_t line = ply.find('\n', at + end.size());
  return line + 1 < ply.size() && (ply[line + 1] == '\n' || ply[line + 1] == '\r');
}

std::string with_opposite_byte_order(const std::filesystem::path& file, std::string_view bytes) {
  std::string out;
  PlyWalker(file, bytes).walk(&out);
  return out;
}

}  // namespace insula
