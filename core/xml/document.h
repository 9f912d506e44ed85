// SPDX-License-Identifier: GPL-3.0-or-later
// A scene file as a tree of elements. Everything keeps its line and column for messages. The file is read with expat:
// only UTF-8, and no document types (hence no entities of its own). Nesting and sizes are limited, so a hostile file
// costs only milliseconds and no recursion.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/diagnostic.h"

namespace insula {

/// The limits of a scene file. A file beyond them is an error with a clear message.
struct DocumentLimits {
  std::size_t file_bytes = 16u << 20;
  std::size_t depth = 64;
  std::size_t elements = 100'000;
  std::size_t attributes = 64;  ///< of one element
  std::size_t all_attributes = 400'000;
  std::size_t value_bytes = 64u << 10;
  std::size_t name_bytes = 128;
};

struct Attribute {
  std::string name;
  std::string value;    ///< entities resolved
  SourcePos name_pos;   ///< of the first character of the name
  SourcePos value_pos;  ///< of the first character inside the quotes
};

struct ScenePart;

struct Element {
  std::string name;
  SourcePos pos;                    ///< of '<'
  const ScenePart* part = nullptr;  ///< the file it came from; set by expand_scene
  std::vector<Attribute> attributes;
  std::vector<std::unique_ptr<Element>> children;
  std::vector<std::string> broken_attributes;  ///< dropped by expand_scene after an error was reported

  const Attribute* find(std::string_view attribute) const;
};

struct Document {
  std::unique_ptr<Element> root;  ///< null if the text is not a well-formed document
};

/// Reads `text`. Messages use `file` as its name. Columns count characters, not bytes; a byte order mark is skipped.
Document parse_document(std::string_view text, const std::string& file, Diagnostics& diagnostics,
                        const DocumentLimits& limits = {});

/// Reads a whole file of at most `limit` bytes. Returns the error text; empty when it was read.
std::string read_text_file(const std::string& path, std::size_t limit, std::string& text);

}  // namespace insula
