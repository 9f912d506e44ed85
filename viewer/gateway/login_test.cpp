// SPDX-License-Identifier: GPL-3.0-or-later
// Who gets in, and what he may do: PINs, tokens, tickets, keys, and the gateway that asks for them.
#include "viewer/gateway/logins.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/base/input_error.h"
#include "core/bus/mem_bus.h"
#include "core/testing/temp_folder.h"
#include "viewer/gateway/audit.h"
#include "viewer/gateway/client_for_test.h"
#include "viewer/gateway/gateway.h"

namespace insula::gateway {
namespace {

namespace fs = std::filesystem;
namespace http = boost::beast::http;
using namespace std::chrono_literals;
using nlohmann::json;
using pages::Fields;
using pages::Response;
using test_files::TempFolder;

const Secrets room{"123456", "654321", std::string(40, 'k')};

class LoginsTest : public ::testing::Test {
 protected:
  Logins::Clock::time_point now_ = Logins::Clock::now();
  Logins logins_{room, [this] { return now_; }};
};

TEST_F(LoginsTest, APinDecidesTheAccess) {
  const auto instructor = logins_.log_in("123456", "a"), observer = logins_.log_in("654321", "a");
  EXPECT_EQ(instructor.access, Access::instructor);
  EXPECT_EQ(observer.access, Access::observer);
  EXPECT_EQ(instructor.token.size(), 64U);
  EXPECT_EQ(logins_.access_of(instructor.token), Access::instructor);
  EXPECT_EQ(logins_.access_of(observer.token), Access::observer);
  EXPECT_EQ(logins_.access_of(""), Access::none);
  EXPECT_EQ(logins_.access_of(instructor.token.substr(1)), Access::none);
  logins_.log_out(instructor.token);
  EXPECT_EQ(logins_.access_of(instructor.token), Access::none);
}

TEST_F(LoginsTest, ATokenEnds) {
  const std::string token = logins_.log_in("123456", "a").token;
  now_ += Logins::lasts - 1s;
  EXPECT_EQ(logins_.access_of(token), Access::instructor);
  now_ += 2s;
  EXPECT_EQ(logins_.access_of(token), Access::none);
}

TEST_F(LoginsTest, WrongTriesAreLimitedByAddressAndInAll) {
  for (int i = 0; i < Logins::wrong_a_minute; ++i) {
    const auto refused = logins_.log_in("000000", "a");
    EXPECT_EQ(refused.access, Access::none);
    EXPECT_FALSE(refused.too_many);
  }
  EXPECT_TRUE(logins_.log_in("123456", "a").too_many) << "not even the right one is looked at";
  EXPECT_EQ(logins_.log_in("123456", "b").access, Access::instructor) << "another machine is not disturbed";
  now_ += 61s;
  EXPECT_EQ(logins_.log_in("123456", "a").access, Access::instructor);
  for (int i = 0; i < Logins::wrong_a_minute_of_all; ++i) logins_.log_in("000000", "m" + std::to_string(i));
  EXPECT_TRUE(logins_.log_in("123456", "c").too_many);
  now_ += 61s;
  EXPECT_EQ(logins_.log_in("123456", "c").access, Access::instructor);
}

TEST_F(LoginsTest, GuessingForDaysIsEnded) {
  int tries = 0;
  for (int i = 0; i < 3 * Logins::wrong_ever; ++i, now_ += 20s)
    tries += logins_.log_in("000000", "m" + std::to_string(i % 9)).too_many ? 0 : 1;
  EXPECT_EQ(tries, Logins::wrong_ever);
  now_ += 24h;
  EXPECT_TRUE(logins_.log_in("123456", "b").too_many);
}

TEST_F(LoginsTest, ATicketAdmitsOnceAndSoon) {
  const std::string ticket = logins_.ticket(), late = logins_.ticket();
  EXPECT_EQ(logins_.access_of(ticket), Access::none) << "it is no token";
  EXPECT_EQ(logins_.redeem(ticket, "a").access, Access::instructor);
  EXPECT_EQ(logins_.redeem(ticket, "a").access, Access::none);
  now_ += Logins::ticket_lasts + 1s;
  EXPECT_EQ(logins_.redeem(late, "a").access, Access::none);
}

TEST_F(LoginsTest, AnEmptySecretAdmitsNobody) {
  Logins open{Secrets{}};
  EXPECT_FALSE(open.needed());
  EXPECT_EQ(open.log_in("", "a").access, Access::none);
  EXPECT_EQ(open.access_of_key("", "a").access, Access::none);
  EXPECT_EQ(logins_.access_of_key(room.key, "a").access, Access::instructor);
  EXPECT_EQ(logins_.access_of_key(room.key + "k", "a").access, Access::none);
}

TEST_F(LoginsTest, TokensAreBoundedAndDiffer) {
  const std::string first = logins_.log_in("654321", "a").token;
  now_ += 1s;
  std::set<std::string> tokens;
  for (std::size_t i = 0; i < Logins::most_tokens; ++i, now_ += 1s) tokens.insert(logins_.log_in("654321", "a").token);
  EXPECT_EQ(tokens.size(), Logins::most_tokens);
  EXPECT_EQ(logins_.access_of(first), Access::none) << "the oldest made room";
  EXPECT_EQ(logins_.access_of(*tokens.begin()), Access::observer);
}

TEST(Rights, GrowWithAccessAndRoleTogether) {
  EXPECT_TRUE(rights_of(Role::trainee, Access::here).hands);
  EXPECT_FALSE(rights_of(Role::trainee, Access::instructor).hands) << "no hands from other machines";
  EXPECT_FALSE(rights_of(Role::instructor, Access::here).hands);
  EXPECT_TRUE(rights_of(Role::instructor, Access::instructor).commands);
  EXPECT_FALSE(rights_of(Role::instructor, Access::observer).commands) << "a role alone gives nothing";
  EXPECT_FALSE(rights_of(Role::trainee, Access::observer).speaks);
  EXPECT_FALSE(rights_of(Role::observer, Access::instructor).commands);
  EXPECT_TRUE(rights_of(Role::instructor, Access::instructor).draws);
  EXPECT_FALSE(rights_of(Role::trainee, Access::here).draws);
}

fs::path secret_file(const TempFolder& folder, const std::string& name, const std::string& text,
                     fs::perms perms = fs::perms::owner_read) {
  const fs::path file = folder.write(name, text);
  fs::permissions(file, perms);
  return file;
}

TEST(SecretFiles, AreCheckedBeforeUse) {
  const TempFolder folder;
  Secrets secrets;
  read_pins(secret_file(folder, "good", R"({"pin":"123456","observer_pin":"222222"})"), secrets);
  EXPECT_EQ(secrets.observer_pin, "222222");
  read_key(secret_file(folder, "key", std::string(32, 'a') + "\n"), secrets);
  EXPECT_EQ(secrets.key, std::string(32, 'a'));
  const fs::perms all = fs::perms::owner_read | fs::perms::others_read;
  EXPECT_THROW(read_pins(secret_file(folder, "open", R"({"pin":"123456"})", all), secrets), InputError);
  for (const char* bad : {"", "{}", "[]", R"({"pin":123456})", R"({"pin":"12345"})", R"({"pin":"12345a"})",
                          R"({"pin":"123456","observer_pin":"123456"})"}) {
    const fs::path file = secret_file(folder, "bad" + std::to_string(std::string(bad).size()), bad);
    Secrets read;
    EXPECT_THROW(read_pins(file, read), InputError) << bad;
  }
  EXPECT_THROW(read_key(secret_file(folder, "short", "abc"), secrets), InputError);
  EXPECT_THROW(read_key(folder.path() / "none", secrets), InputError);
}

/// 127.0.0.1 is this machine; other addresses of the loopback network stand for other machines.
class GatewayOfARoom : public ::testing::Test {
 protected:
  void start(Secrets secrets, bool tls = false) {
    Options options;
    options.port = 0;
    options.page = folder_.path() / "page";
    options.secrets = std::move(secrets);
    options.audit = folder_.path() / "commands.log";
    options.kept_stations = folder_.path() / "stations.json";
    options.kept_key = folder_.path() / "room_key";
    if (tls) options.tls = self_made_certificate(folder_.path() / "own", {});
    options.is_here = [](const auto& remote, const auto&) { return remote.to_string() == "127.0.0.1"; };
    fs::create_directories(options.page);
    for (const char* page : {"index.html", "login.html"}) std::ofstream(options.page / page) << page;
    gateway_ = std::make_unique<Gateway>(gateway_bus_, options);
    ASSERT_EQ(gateway_->start(), "");
    bus_.subscribe(channel::user_command,
                   [this](Bytes b) { commands_.push_back(decode<insula_lcm::user_command_t>(b)->command); });
    bus_.subscribe(channel::hand_input, [this](Bytes) { commands_.emplace_back("hand"); });
  }
  void TearDown() override { gateway_.reset(); }

  std::uint16_t port() const { return gateway_->port(); }
  Response ask(const std::string& from, pages::Request request) { return pages::ask(from, port(), request); }
  Response log_in(const std::string& from, const std::string& pin, const Fields& fields = {}) {
    return ask(from, {http::verb::post, "/api/login", fields, json{{"pin", pin}}.dump()});
  }
  /// As a Cookie field.
  std::string cookie(const Response& response) {
    const std::string set(response[http::field::set_cookie]);
    return set.substr(0, set.find(';'));
  }
  /// What reaches the bus of a command and a pose that a page sends.
  std::vector<std::string> reaches_the_bus(const std::string& from, const std::string& query,
                                           const std::string& login = {}) {
    commands_.clear();
    pages::Socket page(from, port(), query, login);
    insula_lcm::user_command_t command{};
    command.command = "pause";
    page.send(channel::user_command, command);
    insula_lcm::hand_input_t hand{};
    hand.q[0] = 1;
    page.send(channel::hand_input, hand);
    // A page of this machine is served after them, so that what did not come then never comes.
    const auto handled = [this] {
      const json h = json::parse(ask("127.0.0.1", {http::verb::get, "/healthz"}).body());
      return h["from_pages"]["accepted"].get<int>() + h["from_pages"]["refused"].get<int>();
    };
    handled_ += 2;
    for (int i = 0; i < 2000 && handled() < handled_; ++i) std::this_thread::sleep_for(2ms);
    bus_.poll(20);
    return commands_;
  }
  std::vector<json> record() {
    std::vector<json> out;
    std::ifstream in(folder_.path() / "commands.log");
    for (std::string line; std::getline(in, line);) out.push_back(json::parse(line));
    return out;
  }

  TempFolder folder_;
  std::shared_ptr<MemHub> hub_ = std::make_shared<MemHub>();
  MemBus bus_{hub_}, gateway_bus_{hub_};
  std::unique_ptr<Gateway> gateway_;
  std::vector<std::string> commands_;
  int handled_ = 0;
};

using Heard = std::vector<std::string>;

TEST_F(GatewayOfARoom, WithoutAPinOtherMachinesObserveWhateverRoleTheyName) {
  start({});
  EXPECT_EQ(ask("127.0.0.2", {}).result_int(), 200U);
  for (const char* role : {"", "?role=instructor", "?role=trainee", "?role=observer"})
    EXPECT_EQ(reaches_the_bus("127.0.0.2", role), Heard{}) << role;
  EXPECT_EQ(reaches_the_bus("127.0.0.1", "?role=instructor"), Heard{"pause"});
  EXPECT_EQ(reaches_the_bus("127.0.0.1", "").front(), "pause");
  EXPECT_EQ(commands_.at(1), "hand");
}

TEST_F(GatewayOfARoom, WithAPinStrangersGetTheLoginPageAlone) {
  start(room);
  EXPECT_EQ(ask("127.0.0.1", {}).result_int(), 200U) << "this machine stays free";
  const Response page = ask("127.0.0.2", {http::verb::get, "/?role=instructor"});
  EXPECT_EQ(page.result_int(), 303U);
  EXPECT_EQ(page[http::field::location], "/login.html?next=%2F%3Frole%3Dinstructor");
  EXPECT_EQ(ask("127.0.0.2", {http::verb::get, "/login.html"}).result_int(), 200U);
  for (const char* closed : {"/healthz", "/bundle/1/scene.json", "/sessions", "/api/people", "/api/state"})
    EXPECT_EQ(ask("127.0.0.2", {http::verb::get, closed}).result_int(), 401U) << closed;
  EXPECT_THROW(pages::Socket("127.0.0.2", port(), "?role=observer"), std::exception);
  EXPECT_THROW(pages::Socket("127.0.0.2", port(), "", "insula_1=" + std::string(64, '0')), std::exception);
}

TEST_F(GatewayOfARoom, ALoginAdmitsItsRoleAndNoMore) {
  start(room);
  const Response wrong = log_in("127.0.0.2", "111111");
  EXPECT_EQ(wrong.result_int(), 401U);
  EXPECT_EQ(cookie(wrong), "");
  const Response right = log_in("127.0.0.2", "123456");
  EXPECT_EQ(right.result_int(), 200U);
  const std::string set(right[http::field::set_cookie]);
  EXPECT_NE(set.find("HttpOnly; SameSite=Strict"), std::string::npos);
  EXPECT_EQ(set.find("Secure"), std::string::npos);
  const std::string instructor = cookie(right), observer = cookie(log_in("127.0.0.2", "654321"));
  EXPECT_EQ(reaches_the_bus("127.0.0.2", "?role=instructor", instructor), Heard{"pause"});
  EXPECT_EQ(reaches_the_bus("127.0.0.2", "?role=trainee", instructor), Heard{"pause"}) << "no hands";
  EXPECT_EQ(reaches_the_bus("127.0.0.2", "?role=instructor", observer), Heard{}) << "the role is not escalated";
  const auto get = [&](const char* target, const std::string& login) {
    return ask("127.0.0.2", {http::verb::get, target, {{"Cookie", "x=1; " + login}}}).result_int();
  };
  EXPECT_EQ(get("/healthz", observer), 200U);
  EXPECT_EQ(get("/api/people", instructor), 403U) << "persons' runs stay on this machine";
  ask("127.0.0.2", {http::verb::post, "/api/logout", {{"Cookie", observer}}});
  EXPECT_EQ(get("/healthz", observer), 401U);
  const std::string key = "Bearer " + room.key;
  EXPECT_EQ(ask("127.0.0.2", {http::verb::get, "/healthz", {{"Authorization", key}}}).result_int(), 200U);
  EXPECT_EQ(ask("127.0.0.2", {http::verb::get, "/healthz", {{"Authorization", key + "x"}}}).result_int(), 401U);
}

TEST_F(GatewayOfARoom, ForeignSitesAndGuessersAreRefused) {
  start(room);
  EXPECT_EQ(log_in("127.0.0.2", "123456", {{"Origin", "http://elsewhere.example"}}).result_int(), 403U);
  for (const char* bad : {"", "{", "[]", "{}", R"({"pin":123456})", R"({"pin":"1","ticket":"2"})"})
    EXPECT_EQ(ask("127.0.0.2", {http::verb::post, "/api/login", {}, bad}).result_int(), 400U) << bad;
  for (int i = 0; i < Logins::wrong_a_minute; ++i) EXPECT_EQ(log_in("127.0.0.3", "1").result_int(), 401U);
  EXPECT_EQ(log_in("127.0.0.3", "123456").result_int(), 429U);
  EXPECT_EQ(log_in("127.0.0.2", "123456").result_int(), 200U);
}

TEST_F(GatewayOfARoom, EveryCommandAndLoginIsRecorded) {
  start(room);
  const std::string observer = cookie(log_in("127.0.0.2", "654321"));
  log_in("127.0.0.3", "999999");
  reaches_the_bus("127.0.0.2", "?role=instructor", observer);
  reaches_the_bus("127.0.0.1", "");
  const std::vector<json> lines = record();
  ASSERT_EQ(lines.size(), 6U);
  EXPECT_EQ(lines[0]["command"], "log in");
  EXPECT_EQ(lines[0]["role"], "observer");
  EXPECT_EQ(lines[0]["who"], "login 1");
  EXPECT_EQ(lines[1]["who"], "no login");
  EXPECT_EQ(lines[2]["who"], "login 1");
  EXPECT_EQ(lines[4]["who"], "guest") << "nobody is known at this machine";
  EXPECT_EQ(lines[1]["accepted"], false);
  EXPECT_EQ(lines[1]["address"], "127.0.0.3");
  EXPECT_EQ(lines[1]["why"], "this is not the PIN");
  EXPECT_EQ(lines[2]["why"], "not allowed");
  EXPECT_EQ(lines[2]["role"], "instructor");
  EXPECT_EQ(lines[4]["command"], "pause");
  EXPECT_EQ(lines[4]["accepted"], true);
  EXPECT_EQ(lines[5]["command"], "hand");
  EXPECT_NE(lines[2]["page"], lines[4]["page"]);
  EXPECT_EQ(lines[0]["time"].get<std::string>().size(), 24U);
  EXPECT_EQ(fs::status(folder_.path() / "commands.log").permissions() & (fs::perms::group_all | fs::perms::others_all),
            fs::perms::none);
  for (const json& line : lines) EXPECT_EQ(line.dump().find("654321"), std::string::npos) << "no PIN is kept";
}

TEST_F(GatewayOfARoom, TheRecordNamesWhoLoggedInAndNeverAPin) {
  start(room);
  const auto name = [&](const std::string& called) {
    const json body{{"pin", "123456"}, {"name", called}};
    const std::string login = cookie(ask("127.0.0.2", {http::verb::post, "/api/login", {}, body.dump()}));
    reaches_the_bus("127.0.0.2", "?role=instructor", login);
    const std::vector<json> lines = record();
    return lines.at(lines.size() - 2)["who"].get<std::string>();  // the last one tells of the refused hand
  };
  EXPECT_EQ(name("Dr. \xC3\x84rztin"), "Dr. \xC3\x84rztin (login 1)");
  EXPECT_EQ(name("123456"), "login 2") << "a PIN in the wrong field";
  EXPECT_EQ(name("a\nb"), "login 3");
  EXPECT_EQ(name(std::string(61, 'x')), "login 4");
  for (const json& line : record()) {
    EXPECT_EQ(line.dump().find("123456"), std::string::npos);
    EXPECT_EQ(line.dump().find("token"), std::string::npos);
  }
}

TEST_F(GatewayOfARoom, OnlyThisMachineChangesTheListOfStations) {
  start(room);
  const std::string instructor = cookie(log_in("127.0.0.2", "123456"));
  const std::string body = R"({"name":"a","url":"http://192.0.2.9:8080/"})";
  const auto add = [&](const std::string& from, const Fields& fields) {
    return ask(from, {http::verb::post, "/api/room/stations", fields, body}).result_int();
  };
  EXPECT_EQ(add("127.0.0.2", {{"Cookie", instructor}}), 403U) << "the key would go where an instructor says";
  EXPECT_EQ(add("127.0.0.2", {}), 401U);
  EXPECT_EQ(add("127.0.0.1", {{"Origin", "http://elsewhere.example"}}), 403U);
  EXPECT_EQ(add("127.0.0.1", {}), 200U);
  const Response again = ask("127.0.0.1", {http::verb::post, "/api/room/stations", {}, body});
  EXPECT_EQ(again.result_int(), 400U);
  EXPECT_EQ(json::parse(again.body())["error"], "a station with this address is listed already");
  const auto remove = [&](const std::string& from, const std::string& login, const char* target) {
    return ask(from, {http::verb::delete_, target, {{"Cookie", login}}}).result_int();
  };
  EXPECT_EQ(remove("127.0.0.2", instructor, "/api/room/stations?station=0"), 403U);
  EXPECT_EQ(remove("127.0.0.1", "", "/api/room/stations?station=7"), 404U);
  EXPECT_EQ(remove("127.0.0.1", "", "/api/room/stations?station=0"), 200U);
  EXPECT_EQ(remove("127.0.0.1", "", "/api/room/stations?station=0"), 404U);
}

TEST_F(GatewayOfARoom, WordsAndStrokesGoFromPageToPagesAndNeverToTheBus) {
  start(room);
  const std::string login = cookie(log_in("127.0.0.2", "123456")), watching = cookie(log_in("127.0.0.2", "654321"));
  pages::Socket trainee("127.0.0.1", port(), ""), instructor("127.0.0.2", port(), "?role=instructor", login),
      observer("127.0.0.2", port(), "?role=instructor", watching);
  for (int i = 0; i < 2000 && json::parse(ask("127.0.0.1", {http::verb::get, "/healthz"}).body())["clients"] != 3; ++i)
    std::this_thread::sleep_for(2ms);
  int heard = 0;
  bus_.subscribe("ROOM", [&](Bytes) { ++heard; });
  for (const char* bad :
       {"", "{", "[]", R"({"kind":"hand"})", R"({"kind":"say","text":""})", R"({"kind":"say","text":7})",
        R"({"kind":"stroke","id":1,"points":[]})", R"({"kind":"stroke","id":1,"points":[[0,0]]})",
        R"({"kind":"stroke","id":1,"points":[[0,0,1e9]]})", R"({"kind":"stroke","id":1,"points":[[0,0,null]]})",
        R"({"kind":"stroke","id":-1,"points":[[0,0,0]]})", R"({"kind":"point"})", R"({"kind":"point","at":"x"})"})
    instructor.send_text("ROOM", bad);
  instructor.send_text("ROOM", R"({"kind":"say","text":")" + std::string(381, 'x') + "\"}");
  instructor.send_text("ROOM", R"({"kind":"stroke","id":1,"points":[)" + std::string(17000, ' ') + "[0,0,0]]}");
  instructor.send_text("ROOM", "{\"kind\":\"say\",\"text\":\"\xff\"}");
  observer.send_text("ROOM", R"({"kind":"clear"})");
  observer.send_text("ROOM", R"({"kind":"say","text":"let me"})");
  trainee.send_text("ROOM", R"({"kind":"clear"})");
  const auto sent = std::chrono::steady_clock::now();
  instructor.send_text("ROOM", R"({"kind":"stroke","id":5,"points":[[0.01,0,0.002]],"from":"trainee","x":1})");
  const auto next = [](pages::Socket& page) {
    for (;;)
      if (json said = json::parse(page.receive("ROOM")); said["kind"] != "pages") return said;
  };
  const json stroke = next(trainee);
  EXPECT_LT(std::chrono::steady_clock::now() - sent, 150ms);
  EXPECT_EQ(stroke, (json{{"kind", "stroke"}, {"id", 5}, {"points", {{0.01, 0, 0.002}}}, {"from", "instructor"}}));
  trainee.send_text("ROOM", R"({"kind":"say","text":"which branch?"})");
  EXPECT_EQ(next(instructor), (json{{"kind", "say"}, {"text", "which branch?"}, {"from", "trainee"}}))
      << "nobody gets what he sent";
  EXPECT_EQ(next(observer)["kind"], "stroke") << "observers see all of it";
  bus_.poll(20);
  EXPECT_EQ(heard, 0);
}

TEST_F(GatewayOfARoom, ServesByTls) {
  start(room, true);
  EXPECT_EQ(gateway_->url(), "https://127.0.0.1:" + std::to_string(port()) + "/");
  const Response in =
      pages::ask_by_tls("127.0.0.2", port(), {http::verb::post, "/api/login", {}, R"({"pin":"123456"})"});
  EXPECT_EQ(in.result_int(), 200U);
  EXPECT_NE(std::string(in[http::field::set_cookie]).find("; Secure"), std::string::npos);
  EXPECT_EQ(
      pages::ask_by_tls("127.0.0.2", port(), {http::verb::get, "/healthz", {{"Cookie", cookie(in)}}}).result_int(),
      200U);
  EXPECT_THROW(pages::ask("127.0.0.1", port(), {}), std::exception) << "plain HTTP is not answered";
}

TEST(Certificates, AreKeptUntilTheyLackAName) {
  const TempFolder folder;
  const CertificateFiles files = self_made_certificate(folder.path(), {});
  const std::string print = fingerprint(files.certificate);
  EXPECT_EQ(print.size(), 95U);
  EXPECT_EQ(fingerprint(self_made_certificate(folder.path(), {"127.0.0.1"}).certificate), print);
  const std::string other =
      fingerprint(self_made_certificate(folder.path(), {"trainer.local", "192.0.2.77"}).certificate);
  EXPECT_NE(other, print);
  EXPECT_EQ(fingerprint(self_made_certificate(folder.path(), {"trainer.local"}).certificate), other);
  EXPECT_EQ(fs::status(files.key).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  std::ofstream(folder.path() / "none.pem") << "x";
  EXPECT_THROW(server_context({folder.path() / "none.pem", files.key}), InputError);
  EXPECT_THROW(fingerprint(folder.path() / "none.pem"), InputError);
  EXPECT_THROW(self_made_certificate("/proc/nowhere", {}), InputError);
}

TEST(AuditRecord, IsBounded) {
  const TempFolder folder;
  Audit audit(folder.path() / "commands.log", 4096);
  for (int i = 0; i < 1000; ++i) audit.write({"127.0.0.2", "instructor", 1, std::string(3000, 'x'), false, "no\nno"});
  std::uintmax_t bytes = 0;
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder.path())) bytes += entry.file_size(), ++files;
  EXPECT_EQ(files, 3);
  EXPECT_LT(bytes, 3 * 4096U);
  std::ifstream in(folder.path() / "commands.log");
  for (std::string line; std::getline(in, line);)
    EXPECT_EQ(json::parse(line)["command"].get<std::string>().size(), 400U);
  EXPECT_THROW(Audit("/proc/nowhere/commands.log"), InputError);
}

TEST_F(GatewayOfARoom, SecretsAreMadeAndSeenOnlyHere) {
  start({});
  const pages::Request look{http::verb::get, "/api/room/access"};
  const pages::Request make{http::verb::post, "/api/room/access", {}, R"({"make": "pins"})"};
  EXPECT_EQ(ask("127.0.0.2", make).result_int(), 403u);
  EXPECT_EQ(ask("127.0.0.1", {make.verb, make.target, {{"Origin", "http://evil.example"}}, make.body}).result_int(),
            403u);
  EXPECT_EQ(json::parse(ask("127.0.0.1", look).body())["pin"], "");
  const json made = json::parse(ask("127.0.0.1", make).body());
  const std::string pin = made["pin"], observer_pin = made["observer_pin"];
  EXPECT_EQ(ask("127.0.0.2", look).result_int(), 401u) << "from now on others log in";
  const std::string login = cookie(log_in("127.0.0.2", pin));
  EXPECT_EQ(reaches_the_bus("127.0.0.2", "?role=instructor", login), std::vector<std::string>{"pause"});
  EXPECT_EQ(ask("127.0.0.2", {http::verb::get, "/api/room/access", {{"Cookie", login}}}).result_int(), 403u);
  ASSERT_EQ(ask("127.0.0.1", {http::verb::post, "/api/room/access", {}, R"({"make": "key"})"}).result_int(), 200u);
  const std::string key = json::parse(ask("127.0.0.1", look).body())["key"];
  EXPECT_EQ(ask("127.0.0.2", {http::verb::get, "/api/station", {{"Authorization", "Bearer " + key}}}).result_int(),
            200u);
  std::ifstream in(folder_.path() / "commands.log");
  const std::string record(std::istreambuf_iterator<char>(in), {});
  EXPECT_NE(record.find("secrets of the room"), record.npos);
  for (const std::string& secret : {pin, observer_pin, key}) EXPECT_EQ(record.find(secret), record.npos);
}

}  // namespace
}  // namespace insula::gateway
