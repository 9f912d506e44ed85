// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/session/session_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/base/input_error.h"
#include "core/base/text.h"
#include "core/linalg/instruction_set.h"
#include "engine/authoring/embedded.h"

namespace insula {

std::string session::library() { return "insula " INSULA_VERSION; }

std::string session::schema_of(std::string_view type) {
  const std::string wanted = fmt::format("struct {} ", type);
  for (const EmbeddedFile& file : message_declarations())
    if (file.text.find(wanted) != std::string_view::npos) return std::string(file.text);
  throw std::out_of_range("no message type " + std::string(type));
}

std::string session::instruction_set() {
  switch (chosen_instruction_set()) {
    case InstructionSet::sse2: return "sse2";
    case InstructionSet::avx2: return "avx2";
    case InstructionSet::avx512: return "avx512";
  }
  return {};
}

std::pair<std::string, std::string> session::parse_field(const std::string& text) {
  const std::size_t at = text.find('=');
  const std::string name = text.substr(0, at), value = at == std::string::npos ? "" : text.substr(at + 1);
  const auto plain = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  const bool named = !name.empty() && name.size() <= 40 && std::all_of(name.begin(), name.end(), plain);
  const bool clean = std::none_of(value.begin(), value.end(), [](unsigned char c) { return c < 32 || c == 127; });
  if (!named || value.empty() || value.size() > 100 || !clean || find_invalid_utf8(value) != std::string::npos)
    throw InputError("\"" + shown(text) +
                     "\" is no field: write NAME=VALUE, a name of small letters, digits and _, and a value of at most "
                     "100 bytes, such as level=expert");
  return {name, value};
}

std::map<std::string, std::string> session::parse_fields(const std::vector<std::string>& texts) {
  std::map<std::string, std::string> out;
  for (const std::string& text : texts) {
    const auto [name, value] = parse_field(text);
    out[name] = value;
  }
  return out;
}

std::string session::hex(std::uint64_t value) { return fmt::format("{:016x}", value); }

std::string session::exact(double value) { return fmt::format("{}", value); }

}  // namespace insula
