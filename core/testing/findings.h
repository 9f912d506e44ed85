// SPDX-License-Identifier: GPL-3.0-or-later
// What a contract finds wrong. Each broken law is one test failure of one line: what is wrong, what was expected, where
// it was first seen. INSULA_CONTRACT_DETAIL=1 shows every place.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace insula::test {

class Findings {
 public:
  /// `subject`: what is checked, "<tether> in plugins/tether/example.xml".
  explicit Findings(std::string subject);
  ~Findings();
  Findings(const Findings&) = delete;
  Findings& operator=(const Findings&) = delete;

  /// Where the checks that follow are: "after step 15".
  void at(std::string place) { place_ = std::move(place); }
  /// Whether `good`. If not: `law` is the sentence that says what is wrong and what was expected, `found` the numbers
  /// of this place.
  bool expect(bool good, std::string_view law, std::string_view found = {});
  /// Whether error <= tolerance * size; the greatest error / size is kept as a property of the test (held.h) under the
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
