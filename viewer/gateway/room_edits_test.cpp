// SPDX-License-Identifier: GPL-3.0-or-later
// Stations that are added to a room and taken off it, and the file that keeps them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/base/input_error.h"
#include "core/testing/temp_folder.h"
#include "viewer/gateway/room.h"

namespace insula::gateway {
namespace {

using nlohmann::json;

class RoomEdits : public ::testing::Test {
 protected:
  /// As after a restart of the gateway.
  Room& start(std::vector<StationAddress> given = {}) {
    room_.emplace(io_, Room::Lists{std::move(given), file_}, "", nullptr);
    return *room_;
  }
  std::vector<std::string> names() {
    std::vector<std::string> out;
    const json all = json::parse(room_->json());
    for (const json& each : all["stations"]) out.push_back(each["name"]);
    return out;
  }
  static std::string station(const std::string& name, const std::string& url, const std::string& print = {}) {
    return json{{"name", name}, {"url", url}, {"fingerprint", print}}.dump();
  }

  test_files::TempFolder folder_;
  std::filesystem::path file_ = folder_.path() / "stations.json";
  boost::asio::io_context io_;
  std::optional<Room> room_;
};

using Names = std::vector<std::string>;

TEST_F(RoomEdits, AreKept) {
  Room& first = start();
  EXPECT_EQ(first.add(station("table 1", "http://192.0.2.1:8080")), "");
  EXPECT_EQ(first.add(station("table 2", "http://192.0.2.2:8080/")), "");
  EXPECT_EQ(first.add(station("table 3", "http://192.0.2.3:8080/")), "");
  EXPECT_EQ(first.remove(1), "");
  EXPECT_EQ(first.remove(1), "there is no such station") << "numbers are given once";
  EXPECT_FALSE(first.has(1));
  EXPECT_TRUE(first.has(2));
  start({station_of("given", "http://192.0.2.9:8080/", "")});
  EXPECT_EQ(names(), (Names{"given", "table 1", "table 3"}));
  EXPECT_EQ(room_->remove(0), "this station is in the list that the gateway was started with");
  EXPECT_EQ(room_->remove(1), "");
  start();
  EXPECT_EQ(names(), Names{"table 3"});
}

TEST_F(RoomEdits, WrongOnesAreNotListed) {
  Room& room = start({station_of("given", "http://192.0.2.9:8080/", "")});
  const std::string address = "this is no address of a station";
  EXPECT_EQ(room.add(station("", "http://192.0.2.1/")), "a name has 1 to 63 bytes");
  EXPECT_EQ(room.add(station(std::string(64, 'x'), "http://192.0.2.1/")), "a name has 1 to 63 bytes");
  EXPECT_EQ(room.add(station("a\nb", "http://192.0.2.1/")), "a name has 1 to 63 bytes");
  EXPECT_EQ(room.add(station("a", "192.0.2.1")), "an address begins with http:// or https://");
  EXPECT_EQ(room.add(station("a", "http://192.0.2.1:99999/")), address);
  EXPECT_EQ(room.add(station("a", "http://")), address);
  EXPECT_EQ(room.add(station("a", "http://b/page")), address);
  EXPECT_EQ(room.add(station("a", "http://192.0.2.9:8080")), "a station with this address is listed already");
  EXPECT_EQ(room.add(station("given", "http://192.0.2.1/")), "a station with this name is listed already");
  EXPECT_EQ(room.add(station("a", "https://192.0.2.1/", "AB:CD")),
            "a SHA-256 has 32 pairs of digits such as AB, with colons between them");
  for (const char* bad : {"", "{", "[]", "7", R"({"name":7,"url":8})"}) EXPECT_NE(room.add(bad), "") << bad;
  EXPECT_EQ(names(), Names{"given"});
  EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST_F(RoomEdits, ARoomHasBounds) {
  Room& room = start();
  for (std::size_t i = 0; i < most_stations; ++i)
    ASSERT_EQ(room.add(station("s" + std::to_string(i), "http://192.0.2.1:" + std::to_string(1000 + i))), "");
  EXPECT_EQ(room.add(station("one more", "http://192.0.2.2/")), "the room is full");
}

TEST_F(RoomEdits, AFileThatCannotBeUsedIsTold) {
  folder_.write("stations.json", "{}");
  EXPECT_THROW(start(), InputError);
  folder_.write("stations.json", R"([{"name":"a","url":"ftp://b/"}])");
  EXPECT_THROW(start(), InputError);
  file_ = "/proc/nowhere/stations.json";
  EXPECT_EQ(start().add(station("a", "http://192.0.2.1/")), "the list cannot be written");
  EXPECT_EQ(names(), Names{});
  file_.clear();
  EXPECT_EQ(start().add(station("a", "http://192.0.2.1/")),
            "this gateway has no folder of its own to keep the list in");
}

}  // namespace
}  // namespace insula::gateway
