// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/xapi/login.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cstdlib>
#include <fstream>

#include "core/base/input_error.h"
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

void check_mode(const std::filesystem::path& file) {
  struct stat found {};
  if (::stat(file.c_str(), &found) != 0) throw InputError(fmt::format("{}: it cannot be read", file.string()));
  if (!S_ISREG(found.st_mode)) throw InputError(fmt::format("{}: this is no file", file.string()));
  if ((found.st_mode & (S_IRWXG | S_IRWXO)) != 0)
    throw InputError(fmt::format("{}: others may read this password; chmod 600 {}", file.string(), file.string()));
}

}  // namespace

Login read_login(const std::filesystem::path& file) {
  if (file.empty()) return from_environment();
  check_mode(file);
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
