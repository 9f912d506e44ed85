// SPDX-License-Identifier: GPL-3.0-or-later
// Violated laws, collected and reported once each.
#include "core/testing/findings.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "core/testing/held.h"

namespace insula::test {

Findings::Findings(std::string subject) : subject_(std::move(subject)) {}

bool Findings::expect(bool good, std::string_view law, std::string_view found) {
  if (good) return true;
  std::string where(found);
  if (!place_.empty()) where += (where.empty() ? "" : ", ") + place_;
  const auto known = std::find_if(broken_.begin(), broken_.end(), [&](const Broken& b) { return b.law == law; });
  if (known == broken_.end()) broken_.push_back({std::string(law), std::move(where), {}});
  else known->others.push_back(std::move(where));
  return false;
}

bool Findings::within(const std::string& law, double error, double size, double tolerance, std::string_view found) {
  if (held(law, error, size, tolerance)) return true;
  const std::string off = fmt::format("off by {:.3g}, allowed {:.3g}", error == 0 ? 0 : error / size, tolerance);
  return expect(false, "broken law: " + law, found.empty() ? off : fmt::format("{}; {}", off, found));
}

Findings::~Findings() {
  const char* detail = std::getenv("INSULA_CONTRACT_DETAIL");
  const bool all = detail && *detail && *detail != '0';
  for (const Broken& b : broken_) {
    std::string line = subject_ + ": " + b.law;
    if (!b.first.empty()) line += " (" + b.first + ")";
    if (!b.others.empty()) line += fmt::format(", and in {} more places", b.others.size());
    if (all)
      for (const std::string& other : b.others) line += "\n  " + other;
    ADD_FAILURE() << line;
  }
}

}  // namespace insula::test
