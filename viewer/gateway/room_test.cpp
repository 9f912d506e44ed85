// SPDX-License-Identifier: GPL-3.0-or-later
// The overview of a room: what a station says of itself, and twenty gateways that one more gateway asks.
#include "viewer/gateway/room.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/base/input_error.h"
#include "core/bus/mem_bus.h"
#include "core/testing/temp_folder.h"
#include "viewer/gateway/client_for_test.h"
#include "viewer/gateway/gateway.h"
#include "viewer/gateway/station.h"

namespace insula::gateway {
namespace {

namespace fs = std::filesystem;
namespace http = boost::beast::http;
using namespace std::chrono_literals;
using nlohmann::json;
using test_files::TempFolder;

/// Markers of a JPEG of that size, without a picture.
std::string jpeg(int wide, int high, std::size_t more = 0) {
  const auto word = [](int n) { return std::string{char(n >> 8), char(n & 255)}; };
  return "\xff\xd8\xff\xe0" + word(4) + "ab" + "\xff\xc0" + word(11) + "\x08" + word(high) + word(wide) +
         std::string(4, '\1') + "\xff\xda" + std::string(16 + more, 'x') + "\xff\xd9";
}

const std::string room_key(40, 'k');
constexpr const char* here = "127.0.0.9";  // stands for pages on the station itself; others for other machines

/// A station with its bus.
class LiveStation {
 public:
  explicit LiveStation(const std::string& name, Options options = {}, std::string key = room_key) {
    options.port = 0;
    options.station = name;
    options.secrets = {"123456", "654321", std::move(key)};
    options.is_here = [](const auto& remote, const auto&) { return remote.to_string() == here; };
    gateway_ = std::make_unique<Gateway>(gateway_bus_, options);
    error = gateway_->start();
  }
  template <class T>
  void put(std::string_view channel, const T& message) {
    std::vector<std::uint8_t> scratch;
    publish(bus_, channel, message, scratch);
  }
  void run(const std::string& title, double time_s) {
    insula_lcm::scene_info_t info{};
    info.session = 1;
    info.title = title;
    info.state = "running";
    put(channel::scene_info, info);
    insula_lcm::sim_event_t fault{};
    fault.kind = "fault";
    fault.text = "torn " + title;
    put(channel::sim_event, fault);
    insula_lcm::render_frame_t frame{};
    frame.sim_time_s = time_s;
    put(channel::render_frame, frame);
  }
  pages::Response ask(const std::string& from, const pages::Request& request) {
    return pages::ask(from, gateway_->port(), request);
  }
  pages::Response put_picture(const std::string& from, const std::string& picture, const char* type = "image/jpeg") {
    return ask(from, {http::verb::put, "/api/station/picture", {{"Content-Type", type}}, picture});
  }
  std::string url() const { return gateway_->url(); }
  std::string error;

 private:
  std::shared_ptr<MemHub> hub_ = std::make_shared<MemHub>();
  MemBus bus_{hub_}, gateway_bus_{hub_};
  std::unique_ptr<Gateway> gateway_;
};

std::string station_lines(const std::vector<std::unique_ptr<LiveStation>>& stations) {
  std::string out = "# the room\n\n";
  for (std::size_t i = 0; i < stations.size(); ++i) out += "S" + std::to_string(i) + " " + stations[i]->url() + "\n";
  return out;
}

/// What an overview says of its listed stations when it satisfies a condition; what it says last if it never does.
template <class Condition>
json overview(LiveStation& instructor, Condition condition) {
  json out;
  for (int i = 0; i < 400; ++i) {
    out = json::parse(instructor.ask(here, {http::verb::get, "/api/room"}).body())["stations"];
    if (condition(out)) return out;
    std::this_thread::sleep_for(50ms);
  }
  ADD_FAILURE() << out.dump(1);
  return out;
}

Options with_stations(std::vector<StationAddress> stations) {
  Options options;
  options.stations = std::move(stations);
  return options;
}

bool all_answer(const json& list) {
  return std::all_of(list.begin(), list.end(), [](const json& s) { return s["error"] == "" && s["picture"] == 1; });
}

TEST(Room, ShowsTwentyStationsWithPicturesAndOpensOne) {
  constexpr std::size_t count = 20;
  std::vector<std::unique_ptr<LiveStation>> stations;
  for (std::size_t i = 0; i < count; ++i) {
    stations.push_back(std::make_unique<LiveStation>("table " + std::to_string(i)));
    ASSERT_EQ(stations[i]->error, "");
    stations[i]->run("exercise " + std::to_string(i), double(i));
    ASSERT_EQ(stations[i]->put_picture(here, jpeg(320, 180)).result_int(), 200U);
  }
  const TempFolder folder;
  LiveStation instructor("desk", with_stations(read_stations(folder.write("stations", station_lines(stations)))));
  const json list = overview(instructor, all_answer);
  ASSERT_EQ(list.size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    const json& said = list[i]["station"];
    EXPECT_EQ(list[i]["name"], "S" + std::to_string(i));
    EXPECT_EQ(said["name"], "table " + std::to_string(i));
    EXPECT_EQ(said["title"], "exercise " + std::to_string(i));
    EXPECT_EQ(said["time_s"], double(i));
    EXPECT_EQ(said["state"], "running");
    EXPECT_EQ(said["alarms"][0]["text"], "torn exercise " + std::to_string(i));
    EXPECT_GE(said["frame_age_ms"].get<int>(), 0);
  }
  const auto picture = instructor.ask(here, {http::verb::get, "/api/room/picture?station=19"});
  EXPECT_EQ(picture.body(), jpeg(320, 180));
  EXPECT_EQ(picture[http::field::content_type], "image/jpeg");
  EXPECT_EQ(instructor.ask(here, {http::verb::get, "/api/room/picture?station=20"}).result_int(), 404U);
  // A browser on the instructor's machine goes to the station with a ticket, which admits it once.
  const std::string url =
      json::parse(instructor.ask(here, {http::verb::post, "/api/room/open?station=7"}).body())["url"];
  EXPECT_TRUE(url.starts_with(stations[7]->url() + "login.html?next=")) << url;
  const std::string body = json{{"ticket", url.substr(url.find('=', url.find('#')) + 1)}}.dump();
  EXPECT_EQ(stations[7]->ask("127.0.0.2", {http::verb::post, "/api/login", {}, body}).result_int(), 200U);
  EXPECT_EQ(stations[7]->ask("127.0.0.2", {http::verb::post, "/api/login", {}, body}).result_int(), 401U);
  // One that goes away is told of, and the others stay.
  stations[3].reset();
  const json later = overview(instructor, [](const json& all) { return all[3]["error"] != ""; });
  EXPECT_EQ(later[4]["error"], "");
  EXPECT_EQ(later[3]["station"]["title"], "exercise 3") << "what it said last is still shown";
}

TEST(Room, SaysWhyAStationIsNotShown) {
  std::vector<std::unique_ptr<LiveStation>> stations;
  stations.push_back(std::make_unique<LiveStation>("other key", Options{}, std::string(40, 'x')));
  const TempFolder folder;
  LiveStation instructor("desk", with_stations(read_stations(folder.write("stations", station_lines(stations)))));
  const json list = overview(instructor, [](const json& all) { return all[0]["error"] != "it was not asked yet"; });
  EXPECT_EQ(list[0]["error"], "it does not admit this room's key");
  EXPECT_TRUE(list[0]["station"].is_null());
}

TEST(Room, AsksByTlsOnlyTheListedCertificate) {
  const TempFolder folder;
  Options tls;
  tls.tls = self_made_certificate(folder.path(), {});
  std::vector<std::unique_ptr<LiveStation>> stations;
  for (const char* name : {"right", "wrong", "unlisted"}) stations.push_back(std::make_unique<LiveStation>(name, tls));
  const std::string right = fingerprint(tls.tls.certificate);
  std::string wrong = right;
  wrong[0] = wrong[0] == '0' ? '1' : '0';
  const std::string text = "a " + stations[0]->url() + " " + right + "\nb " + stations[1]->url() + " " + wrong +
                           "\nc " + stations[2]->url() + "\n";
  LiveStation instructor("desk", with_stations(read_stations(folder.write("stations", text))));
  const json list = overview(instructor, [](const json& all) {
    return all[0]["error"] == "" && all[1]["error"] != "it was not asked yet" &&
           all[2]["error"] != "it was not asked yet";
  });
  EXPECT_EQ(list[0]["station"]["name"], "right");
  EXPECT_NE(list[1]["error"], "");
  EXPECT_NE(list[2]["error"], "") << "nobody vouches for it";
  EXPECT_TRUE(list[1]["station"].is_null());
}

TEST(StationOfARoom, IsShownToInstructorsAndTakesPicturesOfItsOwnPagesOnly) {
  LiveStation station("table");
  const auto log_in = [&](const char* pin) {
    const std::string set(station.ask(
        "127.0.0.2", {http::verb::post, "/api/login", {}, json{{"pin", pin}}.dump()})[http::field::set_cookie]);
    return set.substr(0, set.find(';'));
  };
  const std::string instructor = log_in("123456"), observer = log_in("654321");
  const auto status = [&](http::verb verb, const char* target, const std::string& cookie) {
    return station.ask("127.0.0.2", {verb, target, {{"Cookie", cookie}}}).result_int();
  };
  EXPECT_EQ(status(http::verb::get, "/api/station", instructor), 200U);
  for (const char* closed : {"/api/station", "/api/station/picture", "/api/room", "/api/room/picture?station=0"})
    EXPECT_EQ(status(http::verb::get, closed, observer), 403U) << closed;
  EXPECT_EQ(status(http::verb::post, "/api/ticket", observer), 403U);
  EXPECT_EQ(status(http::verb::get, "/api/ticket", instructor), 404U) << "only by POST";
  EXPECT_EQ(status(http::verb::get, "/api/station/picture", instructor), 404U) << "there is none yet";
  EXPECT_EQ(status(http::verb::put, "/api/station/picture", instructor), 403U);
  EXPECT_EQ(station.put_picture(here, jpeg(320, 180), "text/html").result_int(), 400U);
  EXPECT_EQ(station.put_picture(here, "<script>").result_int(), 400U);
  EXPECT_EQ(station.put_picture(here, jpeg(320, 180, 70'000)).result_int(), 400U) << "too many bytes";
  EXPECT_EQ(station.put_picture(here, jpeg(320, 180)).result_int(), 200U);
  EXPECT_EQ(status(http::verb::get, "/api/station/picture", instructor), 200U);
  const pages::Request foreign{http::verb::post, "/api/ticket", {{"Origin", "http://elsewhere.example"}}};
  EXPECT_EQ(station.ask(here, foreign).result_int(), 403U);
}

TEST(StationOfARoom, CountsAlarmsUntilAReset) {
  Station station("a", {});
  insula_lcm::sim_event_t event{};
  for (int i = 0; i < 9; ++i) {
    event.kind = i % 2 == 0 ? "fault" : "complication";
    event.text = std::to_string(i);
    station.event(event);
  }
  event.kind = "goal";
  station.event(event);
  json said = json::parse(station.json(Station::Clock::now()));
  ASSERT_EQ(said["alarms"].size(), Station::most_alarms);
  EXPECT_EQ(said["alarms"][4]["text"], "8");
  EXPECT_EQ(said["frame_age_ms"], -1);
  event.kind = "reset";
  station.event(event);
  EXPECT_EQ(json::parse(station.json(Station::Clock::now()))["alarms"].size(), 0U);
}

TEST(Jpeg, IsKnownByItsMarkers) {
  EXPECT_TRUE(is_jpeg(jpeg(320, 180), 1024));
  EXPECT_TRUE(is_jpeg(jpeg(1024, 1024), 1024));
  EXPECT_FALSE(is_jpeg(jpeg(1025, 1), 1024));
  EXPECT_FALSE(is_jpeg(jpeg(0, 1), 1024));
  const std::string good = jpeg(320, 180);
  for (std::size_t n = 0; n < good.size(); ++n) EXPECT_FALSE(is_jpeg(good.substr(0, n), 1024)) << n;
  EXPECT_FALSE(is_jpeg("GIF89a" + good, 1024));
  EXPECT_FALSE(is_jpeg(std::string("\xff\xd8\xff\xe0\x00\x00", 6) + good, 1024)) << "a segment of no length";
}

TEST(StationList, IsCheckedLineByLine) {
  const TempFolder folder;
  const std::string print = std::string("AB") + [] {
    std::string out;
    for (int i = 0; i < 31; ++i) out += ":CD";
    return out;
  }();
  const auto read = read_stations(
      folder.write("good", "# x\n a  http://Trainer.Local:8081  # first\nb https://[fd00::1]/ " + print + "\n"));
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].url(), "http://trainer.local:8081/");
  EXPECT_EQ(read[1].url(), "https://[fd00::1]:443/");
  EXPECT_EQ(read[1].fingerprint, print);
  int number = 0;
  for (const char* bad : {"", "a", "a trainer.local", "a ftp://b/", "a http://b:0/", "a http://b:99999/",
                          "a http://b/c d e", "a https://b/ AB:CD", "a http://b:8080/path", "a http:///"}) {
    const fs::path file = folder.write("bad" + std::to_string(++number), "# line\n" + std::string(bad) + "\n");
    try {
      read_stations(file);
      ADD_FAILURE() << bad;
    } catch (const InputError& e) {
      const bool located = std::string(e.what()).find(":2: error: ") != std::string::npos;
      EXPECT_TRUE(located || *bad == '\0') << e.what();
    }
  }
  EXPECT_THROW(read_stations(folder.path() / "none"), InputError);
}

}  // namespace
}  // namespace insula::gateway
