// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/model/formats/vtk_xml.h"

#include <expat.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/base/text.h"

namespace insula {
namespace {

/// Collects the wanted arrays. Errors are reported after expat has returned.
class Parser {
 public:
  Parser(const std::filesystem::path& file, std::string_view xml, const VtkXmlWanted& wanted, VtuFormat& format,
         std::vector<VtkXmlFile::Piece>& pieces)
      : wanted_(wanted), format_(format), pieces_(pieces), parser_(XML_ParserCreate(nullptr), XML_ParserFree) {
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), on_start, on_end);
    XML_SetCharacterDataHandler(parser_.get(), on_text);
    XML_SetStartDoctypeDeclHandler(parser_.get(), on_doctype);
    constexpr std::size_t slice = std::size_t(1) << 24;
    for (std::size_t at = 0; at < xml.size() && error_.empty(); at += slice) {
      const std::string_view part = xml.substr(at, slice);
      const bool last = at + slice >= xml.size();
      if (XML_Parse(parser_.get(), part.data(), int(part.size()), last) != XML_STATUS_OK && error_.empty())
        error_ = std::string("is no well-formed XML or ends early: ") +
                 XML_ErrorString(XML_GetErrorCode(parser_.get())) + " in line " +
                 std::to_string(XML_GetCurrentLineNumber(parser_.get()));
    }
    if (error_.empty() && !root_) error_ = "is no VTK XML file";
    if (!error_.empty()) fail(file, error_);
  }

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
  std::int64_t count(const char** list, const std::string& name, bool needed) {
    std::int64_t n = 0;
    const std::string text = attribute(list, name);
    if (text.empty() && !needed) return 0;
    if (!parse_integer(text, n) || n < 0 || n > 1'000'000'000)
      stop("its " + name + " is malformed: " + in_quotes(text));
    return n;
  }

  void root(const char** list) {
    root_ = true;
    const std::string type = attribute(list, "type"), order = attribute(list, "byte_order"),
                      header = attribute(list, "header_type"), compressor = attribute(list, "compressor");
    if (type != wanted_.type) return stop("is of type " + in_quotes(type) + ", not " + wanted_.type);
    if (!order.empty() && order != "LittleEndian" && order != "BigEndian")
      return stop("its byte_order " + in_quotes(order) + " is unknown");
    if (!order.empty()) format_.swap = (order == "LittleEndian") != machine_is_little_endian;
    if (!header.empty() && header != "UInt32" && header != "UInt64")
      return stop("its header_type " + in_quotes(header) + " is unknown");
    format_.header64 = header == "UInt64";
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
      return stop("its compressor " + in_quotes(compressor) + " is not read; use vtkZLibDataCompressor or none");
    format_.zlib = !compressor.empty();
  }
  void piece(const char** list) {
    VtkXmlFile::Piece& p = pieces_.emplace_back();
    p.points = count(list, "NumberOfPoints", true);
    for (const VtkXmlWanted::Section& s : wanted_.sections) p.sections[s.name].count = count(list, s.count, s.needed);
  }
  void data_array(const char** list) {
    VtuArray array{attribute(list, "Name"), attribute(list, "type"), attribute(list, "format"), 0, {}};
    VtkXmlFile::Piece& p = pieces_.back();
    const bool positions = path_.back() == "Points";
    if (positions) {
      if (array.name.empty()) array.name = "Points";
      if (attribute(list, "NumberOfComponents") != "3") return stop("its points do not have three components");
    } else {
      const auto section = std::find_if(wanted_.sections.begin(), wanted_.sections.end(),
                                        [&](const auto& s) { return s.name == path_.back(); });
      if (section == wanted_.sections.end() ||
          std::find(section->arrays.begin(), section->arrays.end(), array.name) == section->arrays.end())
        return;
    }
    if (positions ? p.positions.has_value() : p.sections[path_.back()].arrays.contains(array.name))
      return stop("has the array " + in_quotes(array.name) + " twice");
    if (array.format.empty()) array.format = "ascii";
    if (array.format == "appended") {
      std::int64_t offset = 0;
      if (!parse_integer(attribute(list, "offset"), offset) || offset < 0)
        return stop("the array " + in_quotes(array.name) + " has a malformed offset");
      array.offset = std::size_t(offset);
    }
    const std::string name = array.name;
    current_ = positions ? &p.positions.emplace(std::move(array))
                         : &(p.sections[path_.back()].arrays[name] = std::move(array));
  }
  void start(std::string_view name, const char** list) {
    current_ = nullptr;  // an element inside of an array ends its text: a piece there would move the array
    if (path_.size() > 16) return stop("is nested too deeply");
    if (path_.empty()) {
      if (name != "VTKFile") return stop("is no VTK XML file: its root is " + in_quotes(name));
      root(list);
    } else if (name == "Piece") {
      piece(list);
    } else if (name == "AppendedData") {
      format_.appended_raw = attribute(list, "encoding") != "base64";
    } else if (name == "DataArray" && !pieces_.empty()) {
      data_array(list);
    }
    path_.emplace_back(name);
  }

  static void on_start(void* me, const char* name, const char** list) { static_cast<Parser*>(me)->start(name, list); }
  static void on_end(void* me, const char*) {
    auto& p = *static_cast<Parser*>(me);
    if (!p.path_.empty()) p.path_.pop_back();
    p.current_ = nullptr;
  }
  static void on_text(void* me, const char* text, int n) {
    auto& p = *static_cast<Parser*>(me);
    if (p.current_ && p.current_->format != "appended") p.current_->text.append(text, std::size_t(n));
  }
  static void on_doctype(void* me, const char*, const char*, const char*, int) {
    static_cast<Parser*>(me)->stop("has a document type, which is not allowed");
  }

  const VtkXmlWanted& wanted_;
  VtuFormat& format_;
  std::vector<VtkXmlFile::Piece>& pieces_;
  std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser_;
  std::vector<std::string> path_;
  VtuArray* current_ = nullptr;  ///< the array whose text is being read
  std::string error_;
  bool root_ = false;
};

}  // namespace

VtkXmlFile::VtkXmlFile(const std::filesystem::path& file, std::string_view bytes, const VtkXmlWanted& wanted)
    : file_(file) {
  // Raw appended data are not XML, so they are removed from their underscore on.
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
    format_.appended = bytes.substr(underscore + 1, end - underscore - 1);
    head = std::string(bytes.substr(0, close + 1)) + std::string(bytes.substr(end));
    xml = head;
  }
  Parser(file, xml, wanted, format_, pieces_);
}

std::vector<double> VtkXmlFile::positions(const Piece& piece) const {
  if (!piece.positions) fail(file_, "ends early: it has no points");
  return vtu_numbers(file_, format_, *piece.positions, 3 * piece.points);
}

std::vector<std::int64_t> VtkXmlFile::whole(const Section& section, const std::string& array,
                                            std::int64_t expected) const {
  const auto at = section.arrays.find(array);
  if (at == section.arrays.end()) fail(file_, "ends early: the array \"" + array + "\" is missing");
  std::vector<std::int64_t> out;
  for (const double v : vtu_numbers(file_, format_, at->second, expected)) {
    if (!(std::abs(v) < 9e15) || v != std::floor(v))
      fail(file_, "the array \"" + array + "\" holds a number that is not whole");
    out.push_back(std::int64_t(v));
  }
  return out;
}

}  // namespace insula
