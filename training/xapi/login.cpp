// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/xapi/login.h"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>

#include "core/base/input_error.h"
#include "core/base/private_file.h"
#include "core/base/text.h"

namespace insula::xapi {
namespace {

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

Login from_environment() {
  const Login out{variable("INSULA_LRS_USER"), variable("INSULA_LRS_PASSWORD")};
  if (out.user.empty() != out.password.empty())
    throw InputError("INSULA_LRS_USER and INSULA_LRS_PASSWORD belong together: one of them is missing");
  return out;
}

}  // namespace

Login read_login(const std::filesystem::path& file) {
  if (file.empty()) return from_environment();
  check_private(file);
  std::ifstream in(file);
  std::string line;
  if (!std::getline(in, line)) throw InputError(fmt::format("{}: it has no line NAME:PASSWORD", file.string()));
  const std::string_view text = trim(line);
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos || colon == 0 || colon + 1 == text.size())
    throw InputError(fmt::format("{}: its first line is not NAME:PASSWORD", file.string()));
  return {std::string(text.substr(0, colon)), std::string(text.substr(colon + 1))};
}

}  // namespace insula::xapi
