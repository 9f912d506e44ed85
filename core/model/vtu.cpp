// SPDX-License-Identifier: GPL-3.0-or-later
// VTK XML unstructured grids, .vtu, of one or more pieces ("VTK XML Formats", VTK documentation).
#include <expat.h>

#include <cmath>
#include <memory>
#include <optional>

#include "core/base/text.h"
#include "core/model/vtu_data.h"

namespace insula {
namespace {

struct Piece {
  std::int64_t points = 0, cells = 0;
  std::optional<VtuArray> positions, connectivity, offsets, types;
};

/// Collects the arrays that matter; messages wait until expat has returned.
class VtuParser {
 public:
  VtuParser(const std::filesystem::path& file, std::string_view xml, VtuFormat& format)
      : file_(file), format_(format), parser_(XML_ParserCreate(nullptr), XML_ParserFree) {
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), on_start, on_end);
    XML_SetCharacterDataHandler(parser_.get(), on_text);
    XML_SetStartDoctypeDeclHandler(parser_.get(), on_doctype);
    constexpr std::size_t slice = std::size_t(1) << 24;
    for (std::size_t at = 0; at < xml.size() && error_.empty(); at += slice) {
      const std::string_view part = xml.substr(at, slice);
      const bool last = at + slice >= xml.size();
      if (XML_Parse(parser_.get(), part.data(), int(part.size()), last) != XML_STATUS_OK && error_.empty())
        error_ = std::string("is no well-formed XML or ends early: ") + XML_ErrorString(XML_GetErrorCode(parser_.get())) + " in line " +
                 std::to_string(XML_GetCurrentLineNumber(parser_.get()));
    }
    if (!error_.empty()) fail(file_, error_);
    if (!root_) fail(file_, "is no VTK XML file");
  }
  std::vector<Piece>& pieces() { return pieces_; }

 private:
  static std::string attribute(const char** list, std::string_view name) {
    for (; *list; list += 2)
      if (name == list[0]) return list[1];
    return {};
  }
  void stop(std::string text) {
    if (error_.empty()) error_ = std::move(text);
    XML_StopParser(parser_.get(), XML_FALSE);
  }
  std::int64_t count(const char** list, const char* name) {
    std::int64_t n = 0;
    const std::string text = attribute(list, name);
    if (!parse_integer(text, n) || n < 0 || n > 1'000'000'000) stop(std::string("its ") + name + " is malformed: " + in_quotes(text));
    return n;
  }

  void root(const char** list) {
    root_ = true;
    const std::string type = attribute(list, "type"), order = attribute(list, "byte_order"), header = attribute(list, "header_type"),
                      compressor = attribute(list, "compressor");
    if (type != "UnstructuredGrid") return stop("is of type " + in_quotes(type) + ", not UnstructuredGrid");
    if (!order.empty() && order != "LittleEndian" && order != "BigEndian") return stop("its byte_order " + in_quotes(order) + " is unknown");
    if (!order.empty()) format_.swap = (order == "LittleEndian") != machine_is_little_endian;
    if (!header.empty() && header != "UInt32" && header != "UInt64") return stop("its header_type " + in_quotes(header) + " is unknown");
    format_.header64 = header == "UInt64";
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
      return stop("its compressor " + in_quotes(compressor) + " is not read; use vtkZLibDataCompressor or none");
    format_.zlib = !compressor.empty();
  }

  void start(std::string_view name, const char** list) {
    if (path_.size() > 16) return stop("is nested too deeply");
    if (path_.empty()) {
      if (name != "VTKFile") return stop("is no VTK XML file: its root is " + in_quotes(name));
      root(list);
    } else if (name == "Piece") {
      pieces_.emplace_back();
      pieces_.back().points = count(list, "NumberOfPoints");
      pieces_.back().cells = count(list, "NumberOfCells");
    } else if (name == "AppendedData") {
      format_.appended_raw = attribute(list, "encoding") != "base64";
    } else if (name == "DataArray" && !pieces_.empty()) {
      VtuArray array{attribute(list, "Name"), attribute(list, "type"), attribute(list, "format"), 0, {}};
      std::optional<VtuArray>* slot = nullptr;
      if (path_.back() == "Points") {
        slot = &pieces_.back().positions;
        if (array.name.empty()) array.name = "Points";
        if (attribute(list, "NumberOfComponents") != "3") return stop("its points do not have three components");
      } else if (path_.back() == "Cells") {
        if (array.name == "connectivity") slot = &pieces_.back().connectivity;
        if (array.name == "offsets") slot = &pieces_.back().offsets;
        if (array.name == "types") slot = &pieces_.back().types;
      }
      if (slot) {
        if (*slot) return stop("has the array " + in_quotes(array.name) + " twice");
        if (array.format.empty()) array.format = "ascii";
        if (array.format == "appended") {
          std::int64_t offset = 0;
          const std::string text = attribute(list, "offset");
          if (!parse_integer(text, offset) || offset < 0) return stop("the array " + in_quotes(array.name) + " has a malformed offset");
          array.offset = std::size_t(offset);
        }
        *slot = std::move(array);
        current_ = &**slot;
      }
    }
    path_.emplace_back(name);
  }

  static void on_start(void* me, const char* name, const char** list) { static_cast<VtuParser*>(me)->start(name, list); }
  static void on_end(void* me, const char*) {
    auto& p = *static_cast<VtuParser*>(me);
    if (!p.path_.empty()) p.path_.pop_back();
    p.current_ = nullptr;
  }
  static void on_text(void* me, const char* text, int n) {
    auto& p = *static_cast<VtuParser*>(me);
    if (p.current_ && p.current_->format != "appended") p.current_->text.append(text, std::size_t(n));
  }
  static void on_doctype(void* me, const char*, const char*, const char*, int) {
    static_cast<VtuParser*>(me)->stop("has a document type, which is not allowed");
  }

  const std::filesystem::path& file_;
  VtuFormat& format_;
  std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser_;
  std::vector<std::string> path_;
  std::vector<Piece> pieces_;
  VtuArray* current_ = nullptr;
  std::string error_;
  bool root_ = false;
};

std::vector<std::int64_t> whole(const std::filesystem::path& file, const VtuFormat& format, const std::optional<VtuArray>& array,
                                const char* name, std::int64_t expected) {
  if (!array) fail(file, std::string("ends early: the array \"") + name + "\" is missing");
  std::vector<std::int64_t> out;
  for (double v : vtu_numbers(file, format, *array, expected)) {
    if (!(std::abs(v) < 9e15) || v != std::floor(v)) fail(file, std::string("the array \"") + name + "\" holds a number that is not whole");
    out.push_back(std::int64_t(v));
  }
  return out;
}

}  // namespace

RawTets read_vtu(const std::filesystem::path& file, std::string_view bytes) {
  VtuFormat format;
  // Raw appended data is no XML: it is cut out, from its underscore on.
  std::string_view xml = bytes;
  std::string head;
  const std::size_t appended = bytes.find("<AppendedData");
  if (appended != std::string_view::npos) {
    const std::size_t close = bytes.find('>', appended);
    const std::size_t underscore = close == std::string_view::npos ? close : bytes.find('_', close);
    const std::size_t end = bytes.rfind("</AppendedData>");
    if (underscore == std::string_view::npos || end == std::string_view::npos || end < underscore ||
        bytes.find("</VTKFile>", end) == std::string_view::npos)
      fail(file, "ends early: its appended data are not complete");
    format.appended = bytes.substr(underscore + 1, end - underscore - 1);
    head = std::string(bytes.substr(0, close + 1)) + std::string(bytes.substr(end));
    xml = head;
  }
  VtuParser parser(file, xml, format);

  RawTets raw;
  std::int64_t cells = 0;
  for (const Piece& piece : parser.pieces()) {
    if (!piece.positions) fail(file, "ends early: it has no points");
    const std::vector<double> x = vtu_numbers(file, format, *piece.positions, 3 * piece.points);
    const auto offsets = whole(file, format, piece.offsets, "offsets", piece.cells);
    const auto types = whole(file, format, piece.types, "types", piece.cells);
    const auto connectivity = whole(file, format, piece.connectivity, "connectivity", offsets.empty() ? 0 : offsets.back());
    const auto first = std::int64_t(raw.nodes.size());
    for (std::int64_t i = 0; i < piece.points; ++i) {
      raw.nodes.emplace_back(x[std::size_t(3 * i)], x[std::size_t(3 * i + 1)], x[std::size_t(3 * i + 2)]);
      raw.node_number.push_back(first + i);
    }
    add_vtk_cells(file, connectivity, offsets, types, piece.points, first, cells, raw);
    cells += piece.cells;
  }
  return raw;
}

}  // namespace insula
