// SPDX-License-Identifier: GPL-3.0-or-later
// VTK legacy files, ASCII and binary (big-endian), unstructured grids of version 1 to 5.1 ("VTK File Formats", VTK
// manual).
#include <string>

#include "core/base/text.h"
#include "core/model/formats/vtk_cells.h"

namespace insula {
namespace {

class VtkReader {
 public:
  VtkReader(const std::filesystem::path& file, std::string_view bytes) : in_(file, bytes) {}

  RawTets read() {
    if (in_.line().substr(0, 22) != "# vtk DataFile Version")
      in_.fail("is no legacy VTK file: its first line is wrong");
    in_.line();  // title
    const std::string_view coding = in_.word("ASCII or BINARY");
    if (coding != "ASCII" && coding != "BINARY")
      in_.fail("its third line must be ASCII or BINARY, not " + in_quotes(coding));
    binary_ = coding == "BINARY";
    if (in_.word("DATASET") != "DATASET") in_.fail("has no DATASET");
    const std::string_view kind = in_.word("the kind of data set");
    if (kind != "UNSTRUCTURED_GRID") in_.fail("is a data set of kind " + in_quotes(kind) + ", not UNSTRUCTURED_GRID");

    for (;;) {
      const std::string_view keyword = in_.try_word();
      if (keyword.empty() || keyword == "CELL_DATA" || keyword == "POINT_DATA") break;
      if (keyword == "POINTS") points();
      else if (keyword == "CELLS") cells();
      else if (keyword == "CELL_TYPES") cell_types();
      else if (keyword == "FIELD") field();
      else if (keyword == "METADATA") metadata();
      else in_.fail("has an unknown section " + in_quotes(keyword));
    }
    if (!points_) in_.fail("ends early: it has no POINTS");
    if (!cells_) in_.fail("ends early: it has no CELLS");
    if (!types_found_) in_.fail("ends early: it has no CELL_TYPES");
    add_vtk_cells(in_.file(), connectivity_, ends_, types_, std::int64_t(raw_.nodes.size()), 0, 0, raw_);
    return std::move(raw_);
  }

 private:
  VtkType type(std::string_view w) const {
    static constexpr std::pair<std::string_view, VtkType> names[] = {
        {"float", VtkType::f32},       {"double", VtkType::f64},         {"int", VtkType::i32},
        {"long", VtkType::i64},        {"unsigned_long", VtkType::u64},  {"vtktypeint64", VtkType::i64},
        {"vtkIdType", VtkType::i64},   {"vtktypeint32", VtkType::i32},   {"unsigned_int", VtkType::u32},
        {"short", VtkType::i16},       {"unsigned_short", VtkType::u16}, {"char", VtkType::i8},
        {"unsigned_char", VtkType::u8}};
    for (const auto& [name, t] : names)
      if (name == w) return t;
    in_.fail("uses an unknown type " + in_quotes(w));
  }

  std::size_t least(VtkType t) const { return binary_ ? size_of(t) : 2; }
  /// Numbers start on the next line.
  void begin_data() {
    if (binary_) in_.line();
  }
  double real(VtkType t, const char* what) {
    return binary_ ? read_value(in_, t, machine_is_little_endian, what) : in_.number(what);
  }
  std::int64_t whole(VtkType t, const char* what) {
    if (!binary_) return in_.integer(what);
    if (t == VtkType::i64) return in_.binary<std::int64_t>(machine_is_little_endian, what);
    const double v = read_value(in_, t, machine_is_little_endian, what);
    return v > -1e15 && v < 1e15 ? std::int64_t(v) : -1;
  }

  void points() {
    if (points_) in_.fail("has POINTS twice");
    points_ = true;
    const std::int64_t n = in_.integer("the number of points");
    const VtkType t = type(in_.word("the type of the points"));
    begin_data();
    in_.checked_count(n, "the number of points", 3 * least(t));
    for (std::int64_t i = 0; i < n; ++i) {
      Vec3 p;
      for (int k = 0; k < 3; ++k) p[k] = real(t, "a point");
      raw_.nodes.push_back(p);
      raw_.node_number.push_back(i);
    }
  }

  void cells() {
    if (cells_) in_.fail("has CELLS twice");
    cells_ = true;
    const std::int64_t a = in_.integer("the number of cells"), b = in_.integer("the size of the cells");
    ByteCursor ahead = in_;
    if (ahead.try_word() == "OFFSETS") {  // version 5: OFFSETS (one more than cells) and CONNECTIVITY
      in_ = ahead;
      const std::vector<std::int64_t> offsets = array(a, "the number of offsets");
      if (in_.word("CONNECTIVITY") != "CONNECTIVITY") in_.fail("has no CONNECTIVITY after its OFFSETS");
      connectivity_ = array(b, "the size of the cells");
      if (offsets.empty() || offsets[0] != 0) in_.fail("its first cell does not start at 0");
      ends_.assign(offsets.begin() + 1, offsets.end());
      return;
    }
    begin_data();
    const std::size_t min_int = least(VtkType::i32);
    in_.checked_count(a, "the number of cells", min_int);
    in_.checked_count(b, "the size of the cells", min_int);
    std::int64_t used = 0;
    for (std::int64_t c = 0; c < a; ++c) {
      const std::int64_t n = whole(VtkType::i32, "a cell");
      used += 1 + n;
      if (n < 0 || used > b) in_.fail("cell " + std::to_string(c) + " has a malformed list of nodes");
      for (std::int64_t k = 0; k < n; ++k) connectivity_.push_back(whole(VtkType::i32, "a cell's node"));
      ends_.push_back(std::int64_t(connectivity_.size()));
    }
    if (used != b)
      in_.fail("its cells take " + std::to_string(used) + " numbers and not the announced " + std::to_string(b));
  }

  std::vector<std::int64_t> array(std::int64_t n, const char* what) {
    const VtkType t = type(in_.word("the type of an array"));
    begin_data();
    in_.checked_count(n, what, least(t));
    std::vector<std::int64_t> out;
    for (std::int64_t i = 0; i < n; ++i) out.push_back(whole(t, what));
    return out;
  }

  void cell_types() {
    if (types_found_) in_.fail("has CELL_TYPES twice");
    types_found_ = true;
    const std::int64_t n = in_.integer("the number of cell types");
    begin_data();
    in_.checked_count(n, "the number of cell types", least(VtkType::i32));
    for (std::int64_t i = 0; i < n; ++i) types_.push_back(whole(VtkType::i32, "a cell's type"));
  }

  void field() {
    in_.word("the field's name");
    const std::size_t arrays = in_.count("the number of arrays", 8);
    for (std::size_t i = 0; i < arrays; ++i) {
      if (in_.word("an array's name") == "METADATA") metadata(), in_.word("an array's name");
      const std::int64_t parts = in_.integer("an array's components"), tuples = in_.integer("an array's size");
      const std::string_view name = in_.word("an array's type");
      if (name == "string" || name == "bit" || name == "variant")
        in_.fail("a field array of type " + in_quotes(name) + " is not read");
      const VtkType t = type(name);
      begin_data();
      if (parts < 0 || parts > 1000) in_.fail("a field array has a malformed size");
      in_.checked_count(tuples, "an array's size", std::size_t(parts) * least(t));
      for (std::int64_t k = 0; k < parts * tuples; ++k) real(t, "a field value");
    }
  }

  void metadata() {  // up to the next empty line
    in_.line();
    while (in_.left() > 0 && !trim(in_.line()).empty()) {
    }
  }

  ByteCursor in_;
  RawTets raw_;
  std::vector<std::int64_t> connectivity_, ends_, types_;
  bool binary_ = false, points_ = false, cells_ = false, types_found_ = false;
};

}  // namespace

RawTets read_vtk_legacy(const std::filesystem::path& file, std::string_view bytes) {
  return VtkReader(file, bytes).read();
}

}  // namespace insula
