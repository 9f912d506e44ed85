// SPDX-License-Identifier: GPL-3.0-or-later
// Reads scene files with expat. Positions of attributes are found by a scan of the raw start tag.
#include "core/xml/document.h"

#include <expat.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/base/text.h"
#include "core/xml/line_index.h"

namespace insula {
namespace {

class Reader {
 public:
  Reader(std::string_view text, const std::string& file, Diagnostics& diagnostics, const DocumentLimits& limits)
      : text_(text), file_(file), diagnostics_(diagnostics), limits_(limits), lines_(text) {}

  std::unique_ptr<Element> run() {
    std::unique_ptr<XML_ParserStruct, void (*)(XML_Parser)> parser(XML_ParserCreate("UTF-8"), XML_ParserFree);
    if (!parser) {
      diagnostics_.error({file_, 0, 0}, "there is no memory to read it");
      return nullptr;
    }
    parser_ = parser.get();
    XML_SetUserData(parser_, this);
    XML_SetElementHandler(parser_, &Reader::start, &Reader::end);
    XML_SetCharacterDataHandler(parser_, &Reader::characters);
    XML_SetStartDoctypeDeclHandler(parser_, &Reader::doctype);
    XML_SetXmlDeclHandler(parser_, &Reader::declaration);
    // The text is one piece, so expat reads in place and scans no token twice.
    if (XML_Parse(parser_, text_.data(), static_cast<int>(text_.size()), XML_TRUE) != XML_STATUS_OK) {
      if (!stopped_) report_syntax_error();
      return nullptr;
    }
    return stopped_ ? nullptr : std::move(root_);
  }

 private:
  static Reader& self(void* data) { return *static_cast<Reader*>(data); }

  SourcePos place(std::size_t offset) {
    lines_.seek(offset);
    return {file_, lines_.line(), lines_.column()};
  }
  std::size_t offset() const {
#if XML_MAJOR_VERSION > 2 || XML_MINOR_VERSION >= 9  // the older function is deprecated there
    const auto at = XML_GetCurrentByteIndex64(parser_);
#else
    const auto at = XML_GetCurrentByteIndex(parser_);
#endif
    return at < 0 ? text_.size() : static_cast<std::size_t>(at);
  }
  void stop(std::size_t at, std::string text) {
    if (stopped_) return;
    stopped_ = true;
    diagnostics_.error(place(at), std::move(text));
    XML_StopParser(parser_, XML_FALSE);
  }

  static void start(void* data, const char* name, const char** attributes) { self(data).on_start(name, attributes); }
  static void end(void* data, const char*) {
    auto& r = self(data);
    if (!r.stopped_ && !r.open_.empty()) r.open_.pop_back();
  }
  static void characters(void* data, const char* text, int length) {
    self(data).on_text({text, static_cast<std::size_t>(length)});
  }
  static void doctype(void* data, const char*, const char*, const char*, int) {
    auto& r = self(data);
    // The handler is called at some point after "<!DOCTYPE", so the position of its beginning is found.
    const std::size_t at = r.text_.rfind("<!DOCTYPE", r.offset());
    r.stop(at == std::string_view::npos ? r.offset() : at, "document types are not allowed in scene files");
  }
  static void declaration(void* data, const char* version, const char* encoding, int) {
    auto& r = self(data);
    if (version && std::strcmp(version, "1.0") != 0) r.stop(r.offset(), "only XML 1.0 is supported");
    if (!encoding) return;
    std::string upper(encoding);
    for (char& c : upper)
      if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    if (upper != "UTF-8" && upper != "US-ASCII" && upper != "ASCII")
      r.stop(r.offset(), "encoding " + in_quotes(encoding) + " is not supported; save the file as UTF-8");
  }

  void on_text(std::string_view text) {
    if (stopped_) return;
    const auto first = std::find_if_not(text.begin(), text.end(), is_blank);
    if (first == text.end()) return;
    Element* parent = open_.empty() ? nullptr : open_.back();
    if (parent == complained_about_) return;  // one message for each element
    complained_about_ = parent;
    // Plain text comes as it is in the file; entities come as single characters.
    const std::size_t at = offset() + static_cast<std::size_t>(first - text.begin());
    const std::string_view word = split_blanks(text.substr(static_cast<std::size_t>(first - text.begin()))).front();
    diagnostics_.error(place(at), "text " + in_quotes(word) + " may not stand here; values are written as attributes");
  }

  void on_start(const char* name, const char** attributes) {
    if (stopped_) return;
    const std::size_t at = offset();
    if (open_.size() >= limits_.depth)
      return stop(at, "elements are nested more than " + std::to_string(limits_.depth) + " deep");
    if (++count_ > limits_.elements) return stop(at, "more than " + std::to_string(limits_.elements) + " elements");
    if (std::strlen(name) > limits_.name_bytes) return stop(at, "element name " + in_quotes(name) + " is too long");
    auto element = std::make_unique<Element>();
    element->name = name;
    element->pos = place(at);
    scan_attributes(*element, at, attributes);
    if (stopped_) return;
    Element* added = element.get();
    if (open_.empty()) root_ = std::move(element);
    else open_.back()->children.push_back(std::move(element));
    open_.push_back(added);
  }

  /// Finds the position of each attribute of a tag that expat has accepted. Both read them in the written order.
  void scan_attributes(Element& element, std::size_t at, const char** attributes) {
    std::size_t i = at + 1 + element.name.size();
    const auto skip_blanks = [&] {
      while (i < text_.size() && is_blank(text_[i])) ++i;
    };
    for (; attributes[0]; attributes += 2) {
      skip_blanks();
      const std::size_t name_at = i;
      while (i < text_.size() && text_[i] != '=' && !is_blank(text_[i])) ++i;
      skip_blanks();
      ++i;  // '='
      skip_blanks();
      const char quote = i < text_.size() ? text_[i] : '"';
      const std::size_t value_at = i + 1;
      i = text_.find(quote, value_at);
      i = i == std::string_view::npos ? text_.size() : i + 1;
      if (++attribute_count_ > limits_.all_attributes)
        return stop(name_at, "more than " + std::to_string(limits_.all_attributes) + " attributes in all");
      if (element.attributes.size() == limits_.attributes)
        return stop(name_at, "<" + shown(element.name) + "> has more than " + std::to_string(limits_.attributes) +
                                 " attributes");
      if (std::strlen(attributes[0]) > limits_.name_bytes)
        return stop(name_at, "attribute name " + in_quotes(attributes[0]) + " is too long");
      if (std::strlen(attributes[1]) > limits_.value_bytes)
        return stop(value_at, "the value is longer than " + std::to_string(limits_.value_bytes >> 10) + " KiB");
      element.attributes.push_back({attributes[0], attributes[1], place(name_at), place(value_at)});
    }
  }

  /// Position of the first entity after `at` that is not predefined in XML.
  std::size_t unknown_entity(std::size_t at) const {
    for (std::size_t i = text_.find('&', at); i != std::string_view::npos; i = text_.find('&', i + 1)) {
      const std::string_view rest = text_.substr(i + 1);
      bool known = rest.starts_with("#");
      for (const char* name : {"lt;", "gt;", "amp;", "quot;", "apos;"}) known = known || rest.starts_with(name);
      if (!known) return i;
    }
    return at;
  }

  /// The usual cause of an invalid character.
  std::string hint(std::size_t at) const {
    const char here = at < text_.size() ? text_[at] : ' ', before = at > 0 && at <= text_.size() ? text_[at - 1] : ' ';
    if (before == '&' || here == '&') return "write \"&amp;\" for an ampersand";
    if (before == '=') return "a value must stand in quotes";
    if (here == '<') return "\"<\" may not stand here; is a quote or a \">\" missing before it?";
    std::size_t end = std::min(at + 1, text_.size());  // a whole character, not its first byte
    while (end < text_.size() && (static_cast<unsigned char>(text_[end]) & 0xC0) == 0x80) ++end;
    return in_quotes(text_.substr(std::min(at, end), end - std::min(at, end))) + " may not stand here";
  }

  void report_syntax_error() {
    const auto code = XML_GetErrorCode(parser_);
    const std::size_t at = offset();
    const auto word_at = [&](std::size_t from) {
      std::size_t end = from;
      while (end < text_.size() && !is_blank(text_[end]) && !std::strchr("<>=\"'/", text_[end])) ++end;
      from = std::min(from, text_.size());
      return shown(text_.substr(from, std::max(end, from) - from));
    };
    switch (code) {
      case XML_ERROR_DUPLICATE_ATTRIBUTE:
        return diagnostics_.error(place(at), "attribute \"" + word_at(at) + "\" is written twice");
      case XML_ERROR_TAG_MISMATCH:
        if (!open_.empty()) {
          const auto& open = *open_.back();
          const std::size_t tag = at >= 2 && text_.substr(at - 2, 2) == "</" ? at - 2 : at;  // expat points behind "</"
          return diagnostics_.error(place(tag), "</" + word_at(at) + "> closes <" + shown(open.name) + "> of line " +
                                                    std::to_string(open.pos.line));
        }
        break;
      case XML_ERROR_NO_ELEMENTS:
        if (!root_)
          return diagnostics_.error(
              place(at), trim(text_).empty() ? "the file is empty" : "the file ends before its first element");
        [[fallthrough]];
      case XML_ERROR_UNCLOSED_TOKEN:
      case XML_ERROR_UNCLOSED_CDATA_SECTION:
        if (!open_.empty())
          return diagnostics_.error(place(text_.size()), "the file ends before <" + shown(open_.back()->name) +
                                                             "> of line " + std::to_string(open_.back()->pos.line) +
                                                             " is closed");
        break;
      case XML_ERROR_UNDEFINED_ENTITY:
        return diagnostics_.error(place(unknown_entity(at)),
                                  "unknown entity; only &lt; &gt; &amp; &quot; &apos; and &#...; exist");
      case XML_ERROR_JUNK_AFTER_DOC_ELEMENT:
        return diagnostics_.error(place(at), "nothing may follow the root element");
      case XML_ERROR_SYNTAX:
        if (!root_) return diagnostics_.error(place(at), "this is no XML: an element such as <scene> is expected");
        break;
      case XML_ERROR_INVALID_TOKEN: return diagnostics_.error(place(at), "not well-formed XML: " + hint(at));
      default: break;
    }
    const char* why = XML_ErrorString(code);
    diagnostics_.error(place(at), std::string("not well-formed XML: ") + (why ? why : "unknown error"));
  }

  std::string_view text_;
  const std::string& file_;
  Diagnostics& diagnostics_;
  const DocumentLimits& limits_;
  LineIndex lines_;
  XML_Parser parser_ = nullptr;
  std::unique_ptr<Element> root_;
  std::vector<Element*> open_;
  Element* complained_about_ = nullptr;
  std::size_t count_ = 0, attribute_count_ = 0;
  bool stopped_ = false;
};

/// Names the encoding of a text that cannot be UTF-8, by its byte order mark or by the positions of its zero bytes.
std::string foreign_encoding(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 1u; };
  if ((byte(0) == 0xFF && byte(1) == 0xFE && byte(2) == 0 && byte(3) == 0) ||
      (byte(0) == 0 && byte(1) == 0 && byte(2) == 0xFE && byte(3) == 0xFF))
    return "UTF-32";
  if ((byte(0) == 0xFF && byte(1) == 0xFE) || (byte(0) == 0xFE && byte(1) == 0xFF)) return "UTF-16";
  if ((byte(0) == '<' && byte(1) == 0) || (byte(0) == 0 && byte(1) == '<')) return "UTF-16";
  return {};
}

}  // namespace

const Attribute* Element::find(std::string_view attribute) const {
  for (const auto& a : attributes)
    if (a.name == attribute) return &a;
  return nullptr;
}

Document parse_document(std::string_view text, const std::string& file, Diagnostics& diagnostics,
                        const DocumentLimits& limits) {
  if (text.size() > limits.file_bytes) {
    diagnostics.error({file, 0, 0}, "the file is larger than " + std::to_string(limits.file_bytes >> 20) + " MiB");
    return {};
  }
  if (const auto encoding = foreign_encoding(text); !encoding.empty()) {
    diagnostics.error({file, 1, 1}, "the file is written in " + encoding + "; save it as UTF-8");
    return {};
  }
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  LineIndex lines(text);
  const auto place = [&](std::size_t at) {
    lines.seek(at);
    return SourcePos{file, lines.line(), lines.column()};
  };
  if (const auto at = text.find('\0'); at != std::string_view::npos) {
    diagnostics.error(place(at), "the file contains a zero byte; it is no text file");
    return {};
  }
  if (const auto at = find_invalid_utf8(text); at != std::string_view::npos) {
    diagnostics.error(place(at), "invalid UTF-8; save the file as UTF-8");
    return {};
  }
  return {Reader(text, file, diagnostics, limits).run()};
}

std::string read_text_file(const std::string& path, std::size_t limit, std::string& text) {
  std::error_code ec;
  const auto status = std::filesystem::status(path, ec);
  if (!std::filesystem::exists(status)) return "no such file";
  if (!std::filesystem::is_regular_file(status)) return "is not a file";
  std::ifstream in(path, std::ios::binary);
  if (!in) return "cannot be opened";
  in.seekg(0, std::ios::end);
  const auto size = in.tellg();
  if (size < 0) return "cannot be read";
  if (static_cast<std::size_t>(size) > limit) return "the file is larger than " + std::to_string(limit >> 20) + " MiB";
  text.resize(static_cast<std::size_t>(size));
  in.seekg(0);
  if (!in.read(text.data(), size)) return "cannot be read";
  return {};
}

}  // namespace insula
