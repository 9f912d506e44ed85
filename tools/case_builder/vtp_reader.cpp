// SPDX-License-Identifier: GPL-3.0-or-later
// The XML is read with expat; the numbers by the reader of .vtu files, which knows all ways of storing them.
#include "tools/case_builder/vtp_reader.h"

#include <expat.h>

#include <cmath>
#include <memory>
#include <optional>

#include "core/base/text.h"
#include "core/model/vtu_data.h"

namespace insula::case_builder {
namespace {

struct Cells {
  std::int64_t count = 0;
  std::optional<VtuArray> connectivity, offsets;
};
struct Piece {
  std::int64_t points = 0;
  std::optional<VtuArray> positions;
  Cells polygons, strips;
};

class Parser {
 public:
  Parser(const std::filesystem::path& file, std::string_view xml, VtuFormat& format) : file_(file), format_(format), parser_(XML_ParserCreate(nullptr), XML_ParserFree) {
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), [](void* me, const char* n, const char** a) { static_cast<Parser*>(me)->start(n, a); },
                          [](void* me, const char*) { static_cast<Parser*>(me)->end(); });
    XML_SetCharacterDataHandler(parser_.get(), [](void* me, const char* t, int n) { static_cast<Parser*>(me)->text(t, n); });
    XML_SetStartDoctypeDeclHandler(parser_.get(), [](void* me, const char*, const char*, const char*, int) { static_cast<Parser*>(me)->stop("has a document type, which is not allowed"); });
    constexpr std::size_t slice = std::size_t(1) << 24;
    for (std::size_t at = 0; at < xml.size() && error_.empty(); at += slice) {
      const std::string_view part = xml.substr(at, slice);
      if (XML_Parse(parser_.get(), part.data(), int(part.size()), at + slice >= xml.size()) != XML_STATUS_OK && error_.empty())
        error_ = std::string("is no well-formed XML or ends early: ") + XML_ErrorString(XML_GetErrorCode(parser_.get()));
    }
    if (error_.empty() && !root_) error_ = "is no VTK XML file";
    if (!error_.empty()) fail(file_, error_);
  }
  std::vector<Piece> pieces;

 private:
  static std::string attribute(const char** list, std::string_view name) {
    for (; *list; list += 2)
      if (name == list[0]) return list[1];
    return {};
  }
  void stop(std::string why) {
    if (error_.empty()) error_ = std::move(why);
    XML_StopParser(parser_.get(), XML_FALSE);
  }
  std::int64_t count(const char** list, const char* name) {
    std::int64_t n = 0;
    const std::string text = attribute(list, name);
    if (text.empty()) return 0;
    if (!parse_integer(text, n) || n < 0 || n > 100'000'000) stop(std::string("its ") + name + " is malformed: " + in_quotes(text));
    return n;
  }
  void root(const char** list) {
    root_ = true;
    const std::string type = attribute(list, "type"), order = attribute(list, "byte_order"), compressor = attribute(list, "compressor");
    if (type != "PolyData") return stop("holds " + in_quotes(type) + ", not PolyData");
    if (!order.empty()) format_.swap = (order == "LittleEndian") != machine_is_little_endian;
    format_.header64 = attribute(list, "header_type") == "UInt64";
    format_.zlib = !compressor.empty();
    if (format_.zlib && compressor != "vtkZLibDataCompressor") stop("its compressor " + in_quotes(compressor) + " is not read; use vtkZLibDataCompressor or none");
  }
  void start(std::string_view name, const char** list) {
    if (path_.size() > 16) return stop("is nested too deeply");
    if (path_.empty()) {
      if (name != "VTKFile") return stop("is no VTK XML file: its root is " + in_quotes(name));
      root(list);
    } else if (name == "Piece") {
      Piece& p = pieces.emplace_back();
      p.points = count(list, "NumberOfPoints"), p.polygons.count = count(list, "NumberOfPolys"), p.strips.count = count(list, "NumberOfStrips");
    } else if (name == "AppendedData") {
      format_.appended_raw = attribute(list, "encoding") != "base64";
    } else if (name == "DataArray" && !pieces.empty()) {
      data_array(list);
    }
    path_.emplace_back(name);
  }
  void data_array(const char** list) {
    VtuArray array{attribute(list, "Name"), attribute(list, "type"), attribute(list, "format"), 0, {}};
    std::optional<VtuArray>* slot = nullptr;
    Piece& p = pieces.back();
    if (path_.back() == "Points") {
      slot = &p.positions;
      if (array.name.empty()) array.name = "Points";
      if (attribute(list, "NumberOfComponents") != "3") return stop("its points do not have three components");
    } else if (path_.back() == "Polys" || path_.back() == "Strips") {
      Cells& c = path_.back() == "Polys" ? p.polygons : p.strips;
      if (array.name == "connectivity") slot = &c.connectivity;
      if (array.name == "offsets") slot = &c.offsets;
    }
    if (!slot) return;
    if (*slot) return stop("has the array " + in_quotes(array.name) + " twice");
    if (array.format.empty()) array.format = "ascii";
    if (array.format == "appended") {
      std::int64_t offset = 0;
      if (!parse_integer(attribute(list, "offset"), offset) || offset < 0) return stop("the array " + in_quotes(array.name) + " has a malformed offset");
      array.offset = std::size_t(offset);
    }
    *slot = std::move(array);
    current_ = &**slot;
  }
  void end() {
    if (!path_.empty()) path_.pop_back();
    current_ = nullptr;
  }
  void text(const char* t, int n) {
    if (current_ && current_->format != "appended") current_->text.append(t, std::size_t(n));
  }

  const std::filesystem::path& file_;
  VtuFormat& format_;
  std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser_;
  std::vector<std::string> path_;
  VtuArray* current_ = nullptr;
  std::string error_;
  bool root_ = false;
};

std::vector<std::int64_t> whole(const std::filesystem::path& file, const VtuFormat& format, const std::optional<VtuArray>& array, const char* name, std::int64_t expected) {
  if (!array) fail(file, std::string("ends early: the array \"") + name + "\" is missing");
  std::vector<std::int64_t> out;
  for (const double v : vtu_numbers(file, format, *array, expected)) {
    if (!(std::abs(v) < 9e15) || v != std::floor(v)) fail(file, std::string("the array \"") + name + "\" holds a number that is not whole");
    out.push_back(std::int64_t(v));
  }
  return out;
}

void add_cells(const std::filesystem::path& file, const VtuFormat& format, const Cells& cells, bool strip, std::int64_t points, int first, TriMesh& mesh) {
  if (cells.count == 0) return;
  const auto offsets = whole(file, format, cells.offsets, "offsets", cells.count);
  const auto nodes = whole(file, format, cells.connectivity, "connectivity", offsets.back());
  std::int64_t begin = 0;
  for (const std::int64_t end : offsets) {
    if (end < begin || std::uint64_t(end) > nodes.size()) fail(file, "a polygon has a malformed list of points");
    const auto at = [&](std::int64_t k) {
      const std::int64_t i = nodes[std::size_t(k)];
      if (i < 0 || i >= points) fail(file, "a polygon names point " + std::to_string(i) + " of " + std::to_string(points));
      return first + int(i);
    };
    for (std::int64_t k = begin + 2; k < end; ++k) {
      const bool odd = strip && (k - begin) % 2 == 1;
      const int a = strip ? at(k - 2) : at(begin), b = at(k - 1), c = at(k);
      if (odd) mesh.triangles.push_back({b, a, c});
      else mesh.triangles.push_back({a, b, c});
    }
    begin = end;
  }
}

}  // namespace

TriMesh read_vtp(const std::filesystem::path& file) {
  const std::string bytes = read_file_bytes(file);
  VtuFormat format;
  std::string head;
  std::string_view xml = bytes;
  // Raw appended data are no XML: they are cut out, from their underscore on.
  if (const std::size_t appended = bytes.find("<AppendedData"); appended != std::string::npos) {
    const std::size_t close = bytes.find('>', appended), underscore = close == std::string::npos ? close : bytes.find('_', close), end = bytes.rfind("</AppendedData>");
    if (underscore == std::string::npos || end == std::string::npos || end < underscore || bytes.find("</VTKFile>", end) == std::string::npos)
      fail(file, "ends early: its appended data are not complete");
    format.appended = std::string_view(bytes).substr(underscore + 1, end - underscore - 1);
    head = bytes.substr(0, close + 1) + bytes.substr(end);
    xml = head;
  }
  Parser parser(file, xml, format);
  TriMesh mesh;
  for (const Piece& piece : parser.pieces) {
    if (piece.points == 0) continue;
    if (!piece.positions) fail(file, "ends early: it has no points");
    const std::vector<double> x = vtu_numbers(file, format, *piece.positions, 3 * piece.points);
    const int first = int(mesh.vertices.size());
    for (std::size_t i = 0; i + 2 < x.size(); i += 3) {
      mesh.vertices.emplace_back(x[i], x[i + 1], x[i + 2]);
      if (!mesh.vertices.back().allFinite()) fail(file, "point " + std::to_string(i / 3) + " is not finite");
    }
    add_cells(file, format, piece.polygons, false, piece.points, first, mesh);
    add_cells(file, format, piece.strips, true, piece.points, first, mesh);
  }
  if (mesh.triangles.empty()) fail(file, "holds no triangles");
  return mesh;
}

}  // namespace insula::case_builder
