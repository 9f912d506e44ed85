// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/json_input.h"

#include <fstream>
#include <iterator>

namespace insula::gateway {

nlohmann::json read_json(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return nlohmann::json::parse(std::string(std::istreambuf_iterator<char>(in), {}), nullptr, false);
}

std::string text_of(const nlohmann::json& body, const char* name) {
  const auto found = body.find(name);
  return found != body.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace insula::gateway
