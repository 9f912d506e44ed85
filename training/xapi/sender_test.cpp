// SPDX-License-Identifier: GPL-3.0-or-later
// The sender against a store in memory that answers as it is told. tests/xapi/ does the same over the network.
#include "training/xapi/sender.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <map>
#include <set>

#include "training/store/records_for_test.h"
#include "training/xapi/backoff.h"
#include "training/xapi/http_record_store.h"
#include "training/xapi/sender_lock.h"

namespace insula::xapi {
namespace {

using training::Outbox;
using training::run_for_test;
using training::Store;

/// Keeps statements as the specification asks for: all of a request or none.
class MemoryStore : public RecordStore {
 public:
  Answer post(const std::string& text) override {
    const Json list = Json::parse(text);
    sizes.push_back(list.size());
    if (!answers.empty()) {
      const Answer a = answers.front();
      answers.pop_front();
      return a;
    }
    Json ids = Json::array();
    for (const Json& s : list) {
      const std::string id = s["id"];
      if (bad.count(s["context"]["registration"].get<std::string>())) return {400, "not this one", 0};
      if (kept.count(id) && kept[id] != s) return {409, "it is there", 0};
      ids.push_back(id);
    }
    for (const Json& s : list)
      if (kept.emplace(s["id"].get<std::string>(), s).second) order.push_back(s["timestamp"]);
    return {200, ids.dump(), 0};
  }
  Answer get(const std::string& id) override {
    const auto found = kept.find(id);
    return found == kept.end() ? Answer{404, "", 0} : Answer{200, found->second.dump(), 0};
  }

  std::deque<Answer> answers;  // of the next posts, which are not kept
  std::set<std::string> bad;   // registrations
  std::map<std::string, Json> kept;
  std::vector<std::string> order;  // times of what was kept, as it came
  std::vector<std::size_t> sizes;  // of the posts
};

class XapiSender : public testing::Test {
 protected:
  XapiSender() : store_(folder_.path() / "training.sqlite") {}
  std::string add(std::int64_t second) {
    const auto run = run_for_test("P07", "scenes/a.xml", 1000 * second);
    store_.add(run);
    return run.uuid;
  }
  Round round(bool patient = true, std::size_t most = 4) {
    Sender sender(store_, records_, {home_page_}, {most, patient, [this] { return now_; }}, random_);
    return sender.round();
  }
  Outbox outbox() const { return Outbox(store_); }

  test_files::TempFolder folder_;
  Store store_;
  MemoryStore records_;
  std::string home_page_ = "https://example.org";
  std::int64_t now_ = 1'000'000;
  std::mt19937_64 random_{7};
};

TEST_F(XapiSender, SendsBatchesInOrderOfTime) {
  for (const int second : {900, 100, 500, 700, 300, 800, 200, 600, 400}) add(second);
  const Round r = round();
  EXPECT_EQ(r.end, Round::End::empty);
  EXPECT_EQ(r.sent, 9);
  EXPECT_EQ(records_.kept.size(), 18u);
  EXPECT_TRUE(std::is_sorted(records_.order.begin(), records_.order.end()));
  EXPECT_EQ(records_.sizes, (std::vector<std::size_t>{8, 8, 2}));
  EXPECT_EQ(outbox().counts().sent, 9);
  round();
  EXPECT_EQ(records_.sizes.size(), 3u) << "nothing is sent twice";
}

TEST_F(XapiSender, OneBadStatementDoesNotBlockTheOthers) {
  std::vector<std::string> runs;
  for (int k = 0; k < 8; ++k) runs.push_back(add(k));
  records_.bad = {runs[2]};
  const Round r = round(true, 8);
  EXPECT_EQ(r.end, Round::End::empty);
  EXPECT_EQ(r.sent, 7);
  EXPECT_EQ(r.refused, 1);
  ASSERT_EQ(outbox().refused().size(), 1u);
  EXPECT_EQ(outbox().refused()[0].run, runs[2]);
  EXPECT_EQ(outbox().refused()[0].error, "status 400: not this one");
}

TEST_F(XapiSender, WaitsLongerAfterEachFailureAndKeepsTheOrder) {
  std::int64_t second = 100;
  add(second);
  std::int64_t waited = 0;
  for (const Answer& failure : {Answer{0, "no route", 0}, Answer{503, "", 0}, Answer{500, "", 0}}) {
    records_.answers = {failure};
    const Round r = round();
    EXPECT_EQ(r.end, Round::End::later);
    EXPECT_GT(r.next_try_ms - now_, waited) << "each wait is longer than the one before";
    waited = r.next_try_ms - now_;
    const std::size_t posts = records_.sizes.size();
    add(second += 100);
    EXPECT_EQ(round().end, Round::End::later);
    EXPECT_EQ(records_.sizes.size(), posts) << "before its time nothing is tried, also not what is newer";
    now_ = r.next_try_ms;
  }
  EXPECT_EQ(round().sent, 4);
  EXPECT_TRUE(std::is_sorted(records_.order.begin(), records_.order.end()));
}

TEST_F(XapiSender, HeedsWhatTheStoreAsksFor) {
  add(1);
  records_.answers = {{429, "", 120}};
  EXPECT_EQ(round().next_try_ms, now_ + 120'000);
  EXPECT_EQ(round(false).sent, 1) << "who sends by hand does not wait";
}

TEST_F(XapiSender, StopsWhereAPersonMustLook) {
  add(1);
  for (const Answer& a : {Answer{401, "", 0}, Answer{403, "", 0}, Answer{404, "", 0}, Answer{302, "", 0},
                          Answer{200, "<html>", 0}, Answer{200, R"(["2ed6657d-e927-568b-95e1-2665a8aea6a2"])", 0}}) {
    records_.answers = {a};
    const Round r = round();
    EXPECT_EQ(r.end, Round::End::stop) << a.status;
    EXPECT_FALSE(r.why.empty());
    EXPECT_EQ(outbox().pending(9).size(), 1u) << "it stays in the outbox";
  }
  EXPECT_EQ(round().sent, 1);
}

TEST_F(XapiSender, WhatIsThereAlreadyCountsAsSentOnlyIfItIsOurs) {
  add(1), add(2);
  round();
  // As if a sender had died before it could note what it sent, and another version said more.
  training::Database(folder_.path() / "training.sqlite").run("UPDATE outbox SET state = 'pending'");
  for (auto& [id, statement] : records_.kept) statement["result"]["response"] = "other";
  const Round again = round();
  EXPECT_EQ(again.sent, 2);
  EXPECT_EQ(again.refused, 0);

  training::Database(folder_.path() / "training.sqlite").run("UPDATE outbox SET state = 'pending'");
  for (auto& [id, statement] : records_.kept) statement["actor"]["account"]["name"] = "somebody else";
  const Round foreign = round();
  EXPECT_EQ(foreign.refused, 2);
  EXPECT_NE(outbox().refused()[0].error.find("same id"), std::string::npos);
}

TEST_F(XapiSender, SendsTheRestOfARunOfWhichAPartIsThere) {
  add(1);
  round();
  training::Database(folder_.path() / "training.sqlite").run("UPDATE outbox SET state = 'pending'");
  auto first = records_.kept.begin();
  first->second["result"]["response"] = "other";
  records_.kept.erase(std::next(first));
  EXPECT_EQ(round().sent, 1);
  EXPECT_EQ(records_.kept.size(), 2u);
}

TEST_F(XapiSender, PassesOverWhatCannotBeSaid) {
  auto run = run_for_test("P07", "a.xml", 1);
  run.uuid = "seven";
  store_.add(run);
  add(2);
  const Round r = round();
  EXPECT_EQ(r.sent, 1);
  EXPECT_EQ(r.refused, 1);
  EXPECT_NE(outbox().refused()[0].error.find("UUID"), std::string::npos);
}

TEST(XapiBackoff, DoublesUpToItsLimitAndIsDrawnFromTheGivenGenerator) {
  std::mt19937_64 one(3), same(3);
  for (int n = 1; n < 80; ++n) {
    const std::int64_t full = n < 10 ? std::min(first_wait_ms << (n - 1), longest_wait_ms) : longest_wait_ms;
    const std::int64_t wait = backoff_ms(n, one);
    EXPECT_GE(wait, full / 2);
    EXPECT_LE(wait, full);
    EXPECT_EQ(wait, backoff_ms(n, same));
  }
}

TEST(XapiSenderLock, IsHeldByOneAndGivenBack) {
  const test_files::TempFolder folder;
  const SenderLock second(folder.path() / "s");
  {
    const SenderLock first(folder.path() / "s");
    EXPECT_TRUE(first.take());
    EXPECT_FALSE(second.take());
  }
  EXPECT_TRUE(second.take());
  EXPECT_THROW(SenderLock("/proc/nowhere/s"), InputError);
}

TEST(XapiLogin, IsReadFromAFileThatNobodyElseMayRead) {
  const test_files::TempFolder folder;
  const auto file = folder.write("login", "P:a:b \n");
  chmod(file.c_str(), 0640);
  EXPECT_NE(training::message_of([&] { read_login(file); }).find("chmod 600"), std::string::npos);
  chmod(file.c_str(), 0600);
  EXPECT_EQ(read_login(file).user, "P");
  EXPECT_EQ(read_login(file).password, "a:b");
  for (const char* bad : {"", "name\n", ":p\n", "name:\n"}) {
    const auto other = folder.write("bad", bad);
    chmod(other.c_str(), 0600);
    EXPECT_THROW(read_login(other), InputError) << bad;
  }
  EXPECT_THROW(read_login(folder.path()), InputError);
  EXPECT_THROW(read_login(folder.path() / "none"), InputError);
  setenv("INSULA_LRS_USER", "P", 1), unsetenv("INSULA_LRS_PASSWORD");
  EXPECT_THROW(read_login({}), InputError);
  setenv("INSULA_LRS_PASSWORD", "b", 1);
  EXPECT_EQ(read_login({}).password, "b");
  unsetenv("INSULA_LRS_USER"), unsetenv("INSULA_LRS_PASSWORD");
  EXPECT_TRUE(read_login({}).user.empty());
}

TEST(XapiHttp, RefusesAddressesThatWouldTellThePassword) {
  for (const char* bad : {"", "lrs", "http://lrs.example.org/xapi", "https://a:b@lrs.example.org", "ftp://localhost/",
                          "https://lrs.example.org/?a=b", "https://lrs.example.org/#a", "http://localhost.example.org"})
    EXPECT_THROW(HttpRecordStore(bad, {}), InputError) << bad;
  for (const char* good : {"https://lrs.example.org/xapi/", "http://localhost:7/xapi", "http://[::1]:7"})
    EXPECT_NO_THROW(HttpRecordStore(good, {})) << good;
  HttpRecordStore nobody("http://127.0.0.1:1/xapi", {});
  const Answer a = nobody.post("[]");
  EXPECT_EQ(a.status, 0);
  EXPECT_FALSE(a.text.empty());
}

}  // namespace
}  // namespace insula::xapi
