// SPDX-License-Identifier: GPL-3.0-or-later
// Answers to the pages' requests below /api/.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace insula::gateway {

struct ApiAnswer {
  int status = 200;  ///< of HTTP
  std::string json;  ///< an error is {"error": text}
};

template <class Json>
ApiAnswer answer_with(const Json& json, int status = 200) {
  return {status, json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"};
}

inline ApiAnswer refusal(int status, const std::string& text) {
  return answer_with(nlohmann::json{{"error", text}}, status);
}

}  // namespace insula::gateway
