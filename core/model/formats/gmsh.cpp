// SPDX-License-Identifier: GPL-3.0-or-later
// gmsh .msh 2.2 and 4.1, ASCII and binary (gmsh reference manual, "MSH file format").
#include <string>
#include <unordered_map>

#include "core/base/text.h"
#include "core/model/formats/file_bytes.h"
#include "core/model/formats/raw_tets.h"

namespace insula {
namespace {

constexpr int tet4 = 4;

/// Nodes of a gmsh element type; 0 unknown.
int nodes_of(std::int64_t type) {
  static constexpr int table[] = {0, 2,  3,  4,  4, 8,  6,  5,  3,  6,  9, 10, 27, 18, 14, 1,
                                  8, 20, 15, 13, 9, 10, 12, 15, 15, 21, 4, 5,  6,  20, 35, 56};
  return type > 0 && type < std::int64_t(std::size(table)) ? table[type] : 0;
}

/// Volume elements other than linear tetrahedra would leave holes, so they are refused.
bool other_volume(std::int64_t type) {
  return (type >= 5 && type <= 7) || (type >= 11 && type <= 14) || (type >= 17 && type <= 19) ||
         (type >= 29 && type <= 31);
}

class GmshReader {
 public:
  GmshReader(const std::filesystem::path& file, std::string_view bytes) : in_(file, bytes) {}

  RawTets read() {
    header();
    bool nodes = false, elements = false;
    for (;;) {
      const std::string_view name = in_.try_word();
      if (name.empty()) break;
      if (name.front() != '$') in_.fail("expected a section that starts with $, found " + in_quotes(name));
      if (name == "$Nodes") {
        if (nodes) in_.fail("has two $Nodes sections");
        nodes = true;
        version4_ ? nodes4() : nodes2();
        end_of("$EndNodes");
      } else if (name == "$Elements") {
        elements = true;
        version4_ ? elements4() : elements2();
        end_of("$EndElements");
      } else {
        in_.skip_past("$End" + std::string(name.substr(1)));
      }
    }
    if (!nodes) in_.fail("ends early: it has no $Nodes section");
    if (!elements) in_.fail("ends early: it has no $Elements section");
    for (auto& tet : raw_.tets)
      for (auto& tag : tet) {
        const auto found = place_.find(tag);
        tag = found == place_.end() ? -1 : found->second;
      }
    return std::move(raw_);
  }

 private:
  void header() {
    if (in_.word("$MeshFormat") != "$MeshFormat") in_.fail("is no gmsh file: it does not start with $MeshFormat");
    const std::string_view version = in_.word("version");
    if (version == "2.2" || version == "2.1" || version == "2") {
      version4_ = false;
    } else if (version == "4.1") {
      version4_ = true;
    } else {
      in_.fail("gmsh format " + in_quotes(version) + " is not read; save it as 2.2 or 4.1");
    }
    const std::int64_t kind = in_.integer("file type");
    if (kind != 0 && kind != 1) in_.fail("its file type must be 0 (ASCII) or 1 (binary)");
    binary_ = kind == 1;
    if (in_.integer("data size") != 8) in_.fail("its data size must be 8");
    if (binary_) {
      in_.line();
      const auto one = in_.binary<std::int32_t>(false, "the byte order mark");
      if (one != 1 && one != 0x01000000) in_.fail("its byte order mark is wrong");
      swap_ = one != 1;
    }
    end_of("$EndMeshFormat");
  }

  void end_of(const char* mark) {
    const std::string_view w = in_.word(mark);
    if (w != mark) in_.fail(std::string("expected ") + mark + ", found " + in_quotes(w));
  }

  std::int64_t int32(const char* what) { return binary_ ? in_.binary<std::int32_t>(swap_, what) : in_.integer(what); }
  std::int64_t size(const char* what) {
    return binary_ ? std::int64_t(in_.binary<std::uint64_t>(swap_, what)) : in_.integer(what);
  }
  double real(const char* what) { return binary_ ? in_.binary<double>(swap_, what) : in_.number(what); }
  std::size_t least(std::size_t binary_bytes, std::size_t text_bytes) const {
    return binary_ ? binary_bytes : text_bytes;
  }

  void add_node(std::int64_t tag, const Vec3& p) {
    if (!place_.emplace(tag, std::int64_t(raw_.nodes.size())).second)
      in_.fail("node " + std::to_string(tag) + " stands there twice");
    raw_.nodes.push_back(p);
    raw_.node_number.push_back(tag);
  }

  Vec3 point() {
    Vec3 p;
    for (int i = 0; i < 3; ++i) p[i] = real("a node's coordinate");
    return p;
  }

  void nodes2() {
    const std::size_t n = in_.count("the number of nodes", least(28, 7));
    if (binary_) in_.line();
    for (std::size_t i = 0; i < n; ++i) {
      const std::int64_t tag = int32("a node's number");
      add_node(tag, point());
    }
  }

  void nodes4() {
    if (binary_) in_.line();
    const std::size_t blocks =
        in_.checked_count(size("the number of node blocks"), "the number of node blocks", least(20, 4));
    for (int i = 0; i < 3; ++i) size("the range of node numbers");
    std::vector<std::int64_t> tags;
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::int64_t dim = int32("a block's dimension");
      int32("a block's entity");
      const std::int64_t parametric = int32("a block's parametric mark");
      if (dim < 0 || dim > 3 || parametric < 0 || parametric > 1) in_.fail("has a malformed block of nodes");
      const std::size_t n =
          in_.checked_count(size("a block's number of nodes"), "a block's number of nodes", least(32, 7));
      tags.clear();
      for (std::size_t i = 0; i < n; ++i) tags.push_back(size("a node's number"));
      for (std::int64_t tag : tags) {
        const Vec3 p = point();
        for (std::int64_t k = 0; parametric && k < dim; ++k) real("a node's parameter");
        add_node(tag, p);
      }
    }
  }

  /// True when the element is wanted.
  bool is_tet(std::int64_t type, std::int64_t tag) const {
    if (other_volume(type))
      in_.fail("element " + std::to_string(tag) + " has gmsh type " + std::to_string(type) +
               "; only linear tetrahedra (type 4) can fill a volume here");
    return type == tet4;
  }

  void elements2() {
    const std::size_t n = in_.count("the number of elements", least(4, 6));
    if (binary_) {
      in_.line();
      for (std::size_t done = 0; done < n;) {
        const std::int64_t type = int32("an element's type"), follow = int32("a count of elements"),
                           tags = int32("a count of tags");
        const int nodes = checked_type(type);
        if (follow < 1 || std::uint64_t(follow) > n - done) in_.fail("has a malformed block of elements");
        if (tags < 0 || tags > 1000) in_.fail("has a malformed block of elements");
        for (std::int64_t i = 0; i < follow; ++i) {
          const std::int64_t tag = int32("an element's number");
          for (std::int64_t k = 0; k < tags; ++k) int32("an element's tag");
          element(type, tag, nodes);
        }
        done += std::size_t(follow);
      }
    } else {
      for (std::size_t i = 0; i < n; ++i) {
        const std::int64_t tag = int32("an element's number"), type = int32("an element's type"),
                           tags = int32("a count of tags");
        if (tags < 0 || tags > 1000) in_.fail("element " + std::to_string(tag) + " has a malformed count of tags");
        for (std::int64_t k = 0; k < tags; ++k) int32("an element's tag");
        element(type, tag, checked_type(type));
      }
    }
  }

  void elements4() {
    if (binary_) in_.line();
    const std::size_t blocks =
        in_.checked_count(size("the number of element blocks"), "the number of element blocks", least(20, 4));
    for (int i = 0; i < 3; ++i) size("the range of element numbers");
    for (std::size_t b = 0; b < blocks; ++b) {
      int32("a block's dimension");
      int32("a block's entity");
      const std::int64_t type = int32("an element's type");
      const int nodes = checked_type(type);
      const std::size_t n =
          in_.checked_count(size("a block's number of elements"), "a block's number of elements", least(16, 4));
      for (std::size_t i = 0; i < n; ++i) element(type, size("an element's number"), nodes);
    }
  }

  int checked_type(std::int64_t type) const {
    const int nodes = nodes_of(type);
    if (nodes == 0) in_.fail("has an element of unknown gmsh type " + std::to_string(type));
    return nodes;
  }

  void element(std::int64_t type, std::int64_t tag, int nodes) {
    const bool wanted = is_tet(type, tag);
    std::array<std::int64_t, 4> tet{};
    for (int k = 0; k < nodes; ++k) {
      const std::int64_t node = version4_ ? size("an element's node") : int32("an element's node");
      if (wanted) tet[k] = node;
    }
    if (!wanted) return;
    raw_.tets.push_back(tet);
    raw_.tet_number.push_back(tag);
  }

  ByteCursor in_;
  RawTets raw_;
  std::unordered_map<std::int64_t, std::int64_t> place_;  // only looked up, never iterated
  bool version4_ = false, binary_ = false, swap_ = false;
};

}  // namespace

RawTets read_gmsh(const std::filesystem::path& file, std::string_view bytes) { return GmshReader(file, bytes).read(); }

}  // namespace insula
