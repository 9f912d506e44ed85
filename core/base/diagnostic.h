// SPDX-License-Identifier: GPL-3.0-or-later
// Errors as data. All errors of a scene are collected and shown together, with its position in the file.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace insula {

/// A position in a text file. Line and column count from 1; 0 means "the whole file".
struct SourcePos {
  std::string file;
  int line = 0;
  int column = 0;
};

enum class Severity { error, warning };

struct Diagnostic {
  Severity severity = Severity::error;
  SourcePos pos;
  std::string text;
};

class Diagnostics {
 public:
  void error(const SourcePos& pos, std::string text);
  void warning(const SourcePos& pos, std::string text);
  bool ok() const { return errors_ == 0; }
  int errors() const { return errors_; }
  const std::vector<Diagnostic>& all() const { return all_; }
  /// Lines "file:line:column: error: text", in order of position, without duplicates.
  std::string format() const;
  /// Orders by file (in the order in which files first occurred), line, column. Equal positions keep their order.
  void sort_by_position();

 private:
  std::vector<Diagnostic> all_;
  int errors_ = 0;
};

/// The candidate nearest to `word` by edit distance, or empty if none is near enough.
std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates);
/// The end of a message: "; did you mean "near"?", or nothing if `near` is empty.
std::string did_you_mean(std::string_view near);
/// The same of an element: "; did you mean <near>?".
std::string did_you_mean_element(std::string_view near);
/// The name that a message proposes in one of these two forms; empty: none.
std::string proposed_name(std::string_view message);

}  // namespace insula
