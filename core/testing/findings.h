// SPDX-License-Identifier: GPL-3.0-or-later
// Violations that a contract finds. Each violated law is one test failure of one line: what is wrong, what was
// expected, where it first occurred. INSULA_CONTRACT_DETAIL=1 shows every occurrence.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace insula::test {

class Findings {
 public:
  /// `subject`: the checked component, "<tether> in plugins/tether/example.xml".
  explicit Findings(std::string subject);
  ~Findings();
  Findings(const Findings&) = delete;
  Findings& operator=(const Findings&) = delete;

  /// Sets the position of the following checks: "after step 15".
  void at(std::string place) { place_ = std::move(place); }
  /// Returns `good`. If it is false, records `law`, a sentence that says what is wrong and what was expected, and
  /// `found`, the numbers of this occurrence.
  bool expect(bool good, std::string_view law, std::string_view found = {});
  /// Whether error <= tolerance * size. The largest error / size is kept as a property of the test (held.h) under the
  /// name of the law.
  bool within(const std::string& law, double error, double size, double tolerance, std::string_view found = {});
  bool clean() const { return broken_.empty(); }

 private:
  struct Broken {
    std::string law, first;
    std::vector<std::string> others;
  };
  std::string subject_, place_;
  std::vector<Broken> broken_;
};

}  // namespace insula::test
