// SPDX-License-Identifier: GPL-3.0-or-later
// Texts in files of comma-separated values (RFC 4180).
#pragma once
#include <string>

namespace insula {

/// In quotes if it needs them.
inline std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

}  // namespace insula
