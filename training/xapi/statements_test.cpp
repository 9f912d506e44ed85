// SPDX-License-Identifier: GPL-3.0-or-later
// Statements against the rules of xAPI 1.0.3. tests/xapi/statement_check.py reads the same rules in another language.
#include "training/xapi/statements.h"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <set>
#include <string>

#include "core/base/input_error.h"
#include "training/xapi/identifiers.h"

namespace insula::xapi {
namespace {

using Record = training::Run;  // a test has a member of that name

const Origin origin{"https://training.example.org/insula", [](const std::string& scene) {
                      return scene == "scenes/training/3_clipping.xml" ? "Place the clip." : "";
                    }};

Record record() {
  Record r;
  r.uuid = "0d5dc6a4-7e0b-4c2f-9a54-0f7a4b7f1a11", r.person = "P07", r.scene = "scenes/training/3_clipping.xml";
  r.title = "Clipping", r.mode = "test", r.began_ms = 1'700'000'000'123, r.duration_s = 30.257, r.state = "done";
  r.goals = 4, r.goals_done = 4, r.faults = 2, r.step_rate_hz = 60, r.seed = 11, r.guided = false, r.version = "0.9";
  r.metrics = {{"path length", "left", 70.5, "Path", "mm", "low", 1}, {"bad", "left", NAN, "", "", "none", 0}};
  r.fault_counts = {{"stenosis", "The clip narrows a branch", 2}};
  r.report = "/home/somebody/report.html", r.recording = "/home/somebody/x.insula";
  return r;
}

std::string verb(const Json& s) {
  const std::string id = s["verb"]["id"];
  return id.substr(id.rfind('/') + 1);
}

TEST(XapiStatements, SayWhoDidWhatWithWhichResult) {
  const auto list = statements_of(record(), origin);
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0]["verb"]["id"], "http://adlnet.gov/expapi/verbs/attempted");
  EXPECT_EQ(list[0]["timestamp"], "2023-11-14T22:13:20.123Z");
  EXPECT_FALSE(list[0].contains("result"));
  const Json& s = list[1];
  EXPECT_EQ(s["actor"]["account"], (Json{{"homePage", "https://training.example.org/insula"}, {"name", "P07"}}));
  EXPECT_EQ(s["verb"]["id"], "http://adlnet.gov/expapi/verbs/passed");
  EXPECT_EQ(s["timestamp"], "2023-11-14T22:13:50.380Z");
  EXPECT_EQ(s["object"]["id"], "https://insula.invalid/xapi/activities/scenes/training/3_clipping.xml");
  EXPECT_EQ(s["object"]["definition"]["type"], "http://adlnet.gov/expapi/activities/simulation");
  EXPECT_EQ(s["object"]["definition"]["name"]["en"], "Clipping");
  EXPECT_EQ(s["object"]["definition"]["description"]["en"], "Place the clip.");
  EXPECT_EQ(s["result"]["score"], (Json{{"scaled", 1.0}, {"raw", 4}, {"min", 0}, {"max", 4}}));
  EXPECT_EQ(s["result"]["success"], true);
  EXPECT_EQ(s["result"]["completion"], true);
  EXPECT_EQ(s["result"]["duration"], "PT30.26S");
  const Json& found = s["result"]["extensions"];
  EXPECT_EQ(found["https://insula.invalid/xapi/extensions/metrics/path%20length/left"],
            (Json{{"value", 70.5}, {"unit", "mm"}}));
  EXPECT_EQ(found["https://insula.invalid/xapi/extensions/faults/stenosis"], 2);
  EXPECT_EQ(found.size(), 3u) << "a value that is not known is no value";
  EXPECT_EQ(s["context"]["registration"], record().uuid);
  EXPECT_EQ(s["context"]["extensions"]["https://insula.invalid/xapi/extensions/seed"], 11);
  EXPECT_EQ(s["context"]["extensions"]["https://insula.invalid/xapi/extensions/version"], "0.9");
}

TEST(XapiStatements, EndAsTheRunEnded) {
  Record r = record();
  r.mode = "practice";
  EXPECT_EQ(verb(statements_of(r, origin)[1]), "completed");
  r.state = "failed", r.goals_done = 1;
  const auto failed = statements_of(r, origin);
  EXPECT_EQ(verb(failed[1]), "failed");
  EXPECT_EQ(failed[1]["result"]["success"], false);
  EXPECT_EQ(failed[1]["result"]["completion"], false);
  EXPECT_EQ(failed[1]["result"]["score"]["scaled"], 0.25);
  r.state = "running";
  const auto left = statements_of(r, origin);
  ASSERT_EQ(left.size(), 1u) << "who leaves has neither passed nor failed";
  EXPECT_EQ(verb(left[0]), "attempted");
  EXPECT_FALSE(left[0]["result"].contains("success"));
  r.goals = 0;
  EXPECT_FALSE(statements_of(r, origin)[0]["result"].contains("score")) << "no goals, no score";
}

TEST(XapiStatements, TellNothingOfGuestsDemonstrationsFilesAndFolders) {
  Record r = record();
  r.person = "";
  EXPECT_TRUE(statements_of(r, origin).empty());
  r = record(), r.mode = "demonstration";
  EXPECT_TRUE(statements_of(r, origin).empty());
  r = record(), r.scene = "/home/maria/cases/left m1.xml";
  for (const Json& s : statements_of(r, origin)) {
    EXPECT_EQ(s.dump().find("maria"), std::string::npos) << s;
    EXPECT_EQ(s.dump().find("somebody"), std::string::npos) << s;
    EXPECT_NE(s["object"]["id"].get<std::string>().find("/left%20m1-"), std::string::npos) << s;
  }
  EXPECT_NE(activity_of("/a/x.xml", origin.home_page), activity_of("/b/x.xml", origin.home_page));
  EXPECT_NE(activity_of("/a/x.xml", origin.home_page), activity_of("/a/x.xml", "https://other.example.org"));
}

TEST(XapiStatements, HaveTheSameIdsWheneverTheyAreMade) {
  const auto once = statements_of(record(), origin), again = statements_of(record(), origin);
  EXPECT_EQ(once, again);
  EXPECT_NE(once[0]["id"], once[1]["id"]);
  Record other = record();
  other.uuid[0] = '1';
  EXPECT_NE(statements_of(other, origin)[0]["id"], once[0]["id"]);
}

TEST(XapiStatements, RefuseARunWithoutUuidAndAHomePageThatIsNone) {
  Record r = record();
  r.uuid = "seven";
  EXPECT_THROW(statements_of(r, origin), InputError);
  for (const char* bad : {"", "training.example.org", "http://a b", ":x", "http:"})
    EXPECT_THROW(statements_of(record(), {bad}), InputError) << bad;
}

/// The rules that hold for each statement, whatever the run: properties, forms of UUID, IRI, time and duration, and the
/// range of a score.
TEST(XapiStatements, KeepTheRulesOfTheSpecification) {
  const std::regex when(R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z)"), lasting(R"(PT\d+\.\d\dS)");
  const std::set<std::string> known{"id", "actor", "verb", "object", "result", "context", "timestamp"};
  Record r = record();
  for (const char* mode : {"test", "practice"})
    for (const char* state : {"done", "failed", "running"})
      for (const int reached : {0, 3, 9})
        for (const double seconds : {0.0, 0.004, 7200.5}) {
          r.mode = mode, r.state = state, r.goals_done = reached, r.duration_s = seconds;
          r.began_ms = reached == 0 ? -1 : 1'700'000'000'000;
          for (const Json& s : statements_of(r, origin)) {
            for (const auto& [name, value] : s.items()) EXPECT_TRUE(known.count(name)) << name;
            EXPECT_TRUE(is_uuid(s["id"].get<std::string>()));
            EXPECT_EQ(s["id"].get<std::string>()[14], '5');
            EXPECT_TRUE(is_iri(s["object"]["id"].get<std::string>()));
            EXPECT_TRUE(std::regex_match(s["timestamp"].get<std::string>(), when)) << s["timestamp"];
            for (const auto& [key, value] : s["context"]["extensions"].items()) EXPECT_TRUE(is_iri(key));
            if (!s.contains("result")) continue;
            EXPECT_TRUE(std::regex_match(s["result"]["duration"].get<std::string>(), lasting));
            EXPECT_LE(s["result"]["score"]["raw"], s["result"]["score"]["max"]);
            for (const auto& [key, value] : s["result"]["extensions"].items()) EXPECT_TRUE(is_iri(key)) << key;
          }
        }
}

/// The value that RFC 9562 gives in its appendix A.4, and one of Python's uuid.uuid5.
TEST(XapiIdentifiers, UuidOfVersionFiveIsThatOfTheStandard) {
  constexpr const char* dns = "6ba7b810-9dad-11d1-80b4-00c04fd430c8";
  EXPECT_EQ(uuid_v5(dns, "www.example.com"), "2ed6657d-e927-568b-95e1-2665a8aea6a2");
  EXPECT_EQ(uuid_v5("6BA7B810-9DAD-11D1-80B4-00C04FD430C8", "python.org"), "886313e1-3b8a-5372-9b90-0c9aee199e5d");
  EXPECT_THROW(uuid_v5("6ba7b810", "x"), InputError);
  EXPECT_FALSE(is_uuid("6ba7b810-9dad-11d1-80b4-00c04fd430cg"));
  EXPECT_FALSE(is_uuid("6ba7b810x9dad-11d1-80b4-00c04fd430c8"));
}

}  // namespace
}  // namespace insula::xapi
