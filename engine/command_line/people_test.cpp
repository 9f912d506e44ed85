// SPDX-License-Identifier: GPL-3.0-or-later
// Persons on the command line: what is printed, written and removed.
#include "engine/command_line/people.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/registry/registry.h"
#include "core/testing/block_mesh.h"
#include "training/store/data_folder.h"
#include "training/store/store.h"

namespace insula {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class People : public testing::Test {
 protected:
  People() { options_.data = folder_.path(); }
  int run(int (*command)(const CommandContext&, const PeopleOptions&)) {
    out_.str(""), err_.str("");
    return command({registry_, out_, err_}, options_);
  }
  training::Store store() const { return training::Store(training::data_folder(options_.data).store()); }
  static std::string content(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  test::SceneFolder folder_;
  Registry registry_;
  std::ostringstream out_, err_;
  PeopleOptions options_;
};

TEST_F(People, AreAddedAndListed) {
  EXPECT_EQ(run(cmd_people_list), 0);
  EXPECT_NE(out_.str().find("nobody yet"), std::string::npos);
  options_.person.pseudonym = "P07", options_.person.role = "resident", options_.person.year = 3;
  EXPECT_EQ(run(cmd_people_add), 0);
  EXPECT_EQ(run(cmd_people_add), 2);
  EXPECT_EQ(err_.str(), "error: the pseudonym \"P07\" is in use\n");
  options_.json = true;
  EXPECT_EQ(run(cmd_people_list), 0);
  const json list = json::parse(out_.str());
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0]["year"], 3);
  EXPECT_EQ(list[0]["runs"], 0);
}

TEST_F(People, AreExportedOneOrAll) {
  training::Run run_of_one;
  run_of_one.uuid = training::new_uuid(), run_of_one.person = "P07", run_of_one.scene = "a.xml";
  run_of_one.title = "A, \"quoted\"", run_of_one.mode = "test", run_of_one.state = "done";
  run_of_one.began_ms = 1'700'000'000'000;
  run_of_one.metrics = {{"path", "left", 7.25, "Path", "mm", "low", 1}};
  run_of_one.fault_counts = {{"torn", "A strand tore", 2}};
  store().add(run_of_one);
  training::Run of_guest = run_of_one;
  of_guest.uuid = training::new_uuid(), of_guest.person = "";
  store().add(of_guest);
  options_.output = options_.data / "all";
  EXPECT_EQ(run(cmd_people_export), 0);
  const std::string runs = content(options_.output / "runs.csv");
  EXPECT_NE(runs.find(run_of_one.uuid + ",P07,a.xml,\"A, \"\"quoted\"\"\",test,2023-11-14T22:13:20Z"),
            std::string::npos)
      << runs;
  EXPECT_NE(runs.find(of_guest.uuid + ",,a.xml"), std::string::npos);
  EXPECT_NE(content(options_.output / "metrics.csv").find(run_of_one.uuid + ",path,left,7.25,mm,low,Path"),
            std::string::npos);
  options_.pseudonym = "P07", options_.format = "json", options_.output = options_.data / "one";
  EXPECT_EQ(run(cmd_people_export), 0);
  EXPECT_EQ(json::parse(content(options_.output / "runs.json")).size(), 1u);
  EXPECT_EQ(json::parse(content(options_.output / "faults.json"))[0]["count"], 2);
  options_.pseudonym = "P08";
  EXPECT_EQ(run(cmd_people_export), 2);
}

TEST_F(People, ComeForwardInACurriculum) {
  register_builtin(registry_);
  options_.pseudonym = "P07", options_.json = true;
  options_.curriculum = fs::path(INSULA_SOURCE_DIR) / "curricula/first_day.xml";
  EXPECT_EQ(run(cmd_people_progress), 2) << "not known yet";
  options_.person.pseudonym = "P07";
  run(cmd_people_add);
  const auto standing = [&] {
    EXPECT_EQ(run(cmd_people_progress), 0) << err_.str();
    const json hands = json::parse(out_.str())["modules"][0];
    return std::vector<std::string>{hands["standing"], hands["tasks"][0]["standing"], hands["tasks"][1]["standing"]};
  };
  using Standings = std::vector<std::string>;
  EXPECT_EQ(standing(), (Standings{"open", "open", "locked"}));
  training::Run tried;
  tried.person = "P07", tried.scene = "scenes/skills/1_touch_targets.xml", tried.title = "Touch", tried.state = "done";
  const auto add = [&](const char* mode, bool guided, std::int64_t at) {
    tried.uuid = training::new_uuid(), tried.mode = mode, tried.guided = guided, tried.began_ms = at;
    store().add(tried);
  };
  add("demonstration", false, 1);
  EXPECT_EQ(standing(), (Standings{"open", "open", "locked"}));
  add("practice", true, 2);
  add("practice", true, 3);
  EXPECT_EQ(standing(), (Standings{"open", "passed", "open"})) << "the guide does not count for the second task";
  add("test", false, 4);
  EXPECT_EQ(standing(), (Standings{"passed", "passed", "passed"}));
  options_.json = false;
  EXPECT_EQ(run(cmd_people_progress), 0);
  EXPECT_NE(out_.str().find("open     Gentle force"), std::string::npos) << out_.str();
  EXPECT_NE(out_.str().find("insula play scenes/skills/1_touch_targets.xml"), std::string::npos)
      << "the day begins with the warm-up: " << out_.str();
  options_.curriculum = options_.data / "none.xml";
  EXPECT_EQ(run(cmd_people_progress), 2);
}

TEST_F(People, AreForgottenWithTheirReports) {
  options_.person.pseudonym = "P07";
  run(cmd_people_add);
  const fs::path report = options_.data / "reports/one";
  fs::create_directories(report);
  std::ofstream(report / "report.json") << R"({"fields":{"person":"P07"}})";
  const fs::path other = options_.data / "reports/other";
  fs::create_directories(other);
  std::ofstream(other / "report.json") << R"({"fields":{"person":"P08"}})";
  options_.pseudonym = "P07";
  EXPECT_EQ(run(cmd_people_forget), 0);
  EXPECT_TRUE(store().persons().empty());
  EXPECT_FALSE(fs::exists(report));
  EXPECT_TRUE(fs::exists(other));
  options_.output = options_.data / "copy.sqlite";
  EXPECT_EQ(run(cmd_people_backup), 0);
  EXPECT_TRUE(fs::is_regular_file(options_.output));
}

}  // namespace
}  // namespace insula
