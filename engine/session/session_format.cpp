// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/session/session_format.h"

#include <fmt/format.h>

#include <stdexcept>

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

std::string session::hex(std::uint64_t value) { return fmt::format("{:016x}", value); }

std::string session::exact(double value) { return fmt::format("{}", value); }

}  // namespace insula
