// SPDX-License-Identifier: GPL-3.0-or-later
// What insula doctor says of this machine, with an address of the bus that works and one that does not.
#include "engine/command_line/doctor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

namespace insula {
namespace {

class Doctor : public testing::Test {
 protected:
  Doctor() {
    const char* url = std::getenv("LCM_DEFAULT_URL");
    if (url) url_ = url;
    had_url_ = url;
  }
  ~Doctor() override { had_url_ ? setenv("LCM_DEFAULT_URL", url_.c_str(), 1) : unsetenv("LCM_DEFAULT_URL"); }
  static void address(const char* url) { setenv("LCM_DEFAULT_URL", url, 1); }
  int run(bool json) { return cmd_doctor({registry_, out_, err_}, json); }

  Registry registry_;
  std::ostringstream out_, err_;

 private:
  std::string url_;
  bool had_url_ = false;
};

TEST_F(Doctor, EveryLackHasARemedyAndEveryIdOccursOnce) {
  address("memq://");
  std::set<std::string> ids;
  for (const MachineFinding& f : examine_machine()) {
    EXPECT_TRUE(ids.insert(f.id).second) << f.id;
    EXPECT_FALSE(f.text.empty()) << f.id;
    EXPECT_EQ(f.remedy.empty(), f.fitness == Fitness::good) << f.id;
  }
  for (const char* id : {"processor", "memory", "bus", "real_time", "browser", "graphics", "devices"})
    EXPECT_TRUE(ids.contains(id)) << id;
}

TEST_F(Doctor, TellsProgramsTheSameAsPersons) {
  address("memq://");
  EXPECT_EQ(run(true), 0);
  const auto told = nlohmann::json::parse(out_.str());
  EXPECT_EQ(told["fit"], true);
  out_.str("");
  EXPECT_EQ(run(false), 0);
  for (const auto& f : told["findings"])
    EXPECT_NE(out_.str().find(f["text"].get<std::string>()), std::string::npos) << f << out_.str();
}

TEST_F(Doctor, AnAddressWithoutABusMakesTheMachineUnusable) {
  address("nonsense://");
  EXPECT_EQ(run(true), 1);
  const auto told = nlohmann::json::parse(out_.str());
  EXPECT_EQ(told["fit"], false);
  const auto bus =
      std::find_if(told["findings"].begin(), told["findings"].end(), [](const auto& f) { return f["id"] == "bus"; });
  ASSERT_NE(bus, told["findings"].end());
  EXPECT_EQ((*bus)["fitness"], "unusable");
  EXPECT_NE((*bus)["remedy"], "");
}

}  // namespace
}  // namespace insula
