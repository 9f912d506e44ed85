// SPDX-License-Identifier: GPL-3.0-or-later
// PINs and the key of a room that are made or given on a page.
#include "viewer/gateway/room_access.h"

#include <gtest/gtest.h>

#include "core/base/pin.h"
#include "core/testing/temp_folder.h"

namespace insula::gateway {
namespace {

using nlohmann::json;

class MadeOnAPage : public ::testing::Test {
 protected:
  RoomAccess start(Secrets secrets, bool kept = true) {
    return {std::move(secrets), kept ? file_ : std::filesystem::path(), [this](const Secrets& s) { used_ = s; }};
  }
  test_files::TempFolder folder_;
  std::filesystem::path file_ = folder_.path() / "room_key";
  Secrets used_;
};

TEST_F(MadeOnAPage, PinsAreTwoAndUsedAtOnce) {
  RoomAccess access = start({});
  EXPECT_EQ(json::parse(access.state().json),
            (json{{"pin", ""}, {"observer_pin", ""}, {"key", ""}, {"key_kept", true}, {"reachable", false}}));
  const ApiAnswer made = access.change(R"({"make": "pins"})");
  ASSERT_EQ(made.status, 200);
  const json state = json::parse(made.json);
  EXPECT_TRUE(is_pin(used_.pin) && is_pin(used_.observer_pin));
  EXPECT_NE(used_.pin, used_.observer_pin);
  EXPECT_EQ(state["pin"], used_.pin);
  EXPECT_EQ(state["observer_pin"], used_.observer_pin);
  EXPECT_EQ(access.change(R"({"make": "pins"})").status, 409) << "persons know the first ones";
}

TEST_F(MadeOnAPage, AKeyIsKeptForTheNextStart) {
  RoomAccess access = start({"123456", "654321", ""});
  ASSERT_EQ(access.change(R"({"make": "key"})").status, 200);
  EXPECT_TRUE(is_key(used_.key));
  EXPECT_EQ(used_.pin, "123456");
  Secrets again;
  read_key(file_, again);  // throws if others may read it
  EXPECT_EQ(again.key, used_.key);
  EXPECT_EQ(access.change(R"({"make": "key"})").status, 409);
  const std::string other(40, 'k');
  ASSERT_EQ(access.change(json{{"key", other}}.dump()).status, 200) << "that of another station";
  read_key(file_, again);
  EXPECT_EQ(again.key, other);
  EXPECT_EQ(json::parse(access.state().json)["key"], other);
}

TEST_F(MadeOnAPage, NothingElseIsTaken) {
  RoomAccess access = start({});
  for (const char* bad : {"", "[]", "7", "{}", R"({"make": 1})", R"({"make": "coffee"})", R"({"key": "short"})",
                          R"({"key": "0123456789012345678901234567890\n1"})"})
    EXPECT_EQ(access.change(bad).status, 400) << bad;
  EXPECT_FALSE(std::filesystem::exists(file_));
  RoomAccess given = start({"", "", std::string(32, 'a')}, false);
  EXPECT_EQ(given.change(json{{"key", std::string(32, 'b')}}.dump()).status, 409);
  EXPECT_EQ(json::parse(given.state().json)["key_kept"], false);
  EXPECT_EQ(used_.key, "");
}

}  // namespace
}  // namespace insula::gateway
