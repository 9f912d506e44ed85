// SPDX-License-Identifier: GPL-3.0-or-later
// The gateway as browsers meet it: HTTP and WebSocket clients on one side, an in-process bus on the other.
#include "viewer/gateway/gateway.h"

#include <gtest/gtest.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/bus/codec.h"
#include "core/bus/mem_bus.h"
#include "core/testing/temp_folder.h"
#include "viewer/gateway/framing.h"
#include "viewer/gateway/hub.h"

namespace fs = std::filesystem;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = boost::asio::ip::tcp;

namespace insula::gateway {
namespace {

using Buffer = std::vector<std::uint8_t>;
using Response = http::response<http::string_body>;

class WsPage {
 public:
  explicit WsPage(std::uint16_t port, int receive_buffer = 0) {
    auto& socket = ws_.next_layer();
    socket.open(tcp::v4());
    if (receive_buffer > 0) socket.set_option(boost::asio::socket_base::receive_buffer_size(receive_buffer));
    socket.connect({boost::asio::ip::make_address("127.0.0.1"), port});
    timeval limit{20, 0};  // a lost message fails the test instead of hanging it
    ::setsockopt(socket.native_handle(), SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    ws_.handshake("127.0.0.1:" + std::to_string(port), "/ws");
    ws_.binary(true);
  }
  void send(const Buffer& bytes, bool binary = true) {
    ws_.binary(binary);
    ws_.write(boost::asio::buffer(bytes));
  }
  template <class T>
  void send(std::string_view channel, const T& message) {
    Buffer payload;
    ASSERT_TRUE(encode(message, payload));
    send(*frame(channel, payload));
  }
  Buffer receive() {
    beast::flat_buffer in;
    ws_.read(in);
    const auto* p = static_cast<const std::uint8_t*>(in.cdata().data());
    return {p, p + in.size()};
  }
  /// The payload of the next message of a channel.
  Buffer receive(std::string_view channel) {
    for (;;) {
      const Buffer bytes = receive();
      const auto parts = unframe(bytes);
      if (parts && parts->channel == channel) return {parts->payload.begin(), parts->payload.end()};
    }
  }

 private:
  boost::asio::io_context io_;
  websocket::stream<tcp::socket> ws_{io_};
};

insula_lcm::scene_info_t scene_info(std::int64_t session, const std::string& bundle) {
  insula_lcm::scene_info_t m{};
  m.session = session;
  m.state = "running";
  m.bundle = bundle;
  return m;
}

insula_lcm::render_frame_t render_frame(std::int64_t sequence, int nodes = 10) {
  insula_lcm::render_frame_t m{};
  m.sequence = sequence;
  m.bodies = 1;
  m.body.resize(1);
  m.body[0].nodes = nodes;
  m.body[0].x_m.assign(std::size_t(nodes), {0.f, 0.f, 0.f});
  m.body_force_N = {0};
  return m;
}

class GatewayTest : public ::testing::Test {
 protected:
  GatewayTest() {
    fs::create_directories(root_ / "page/assets");
    fs::create_directories(root_ / "bundle");
    write("page/index.html", "<p>page");
    write("page/assets/app-1a2b.js", "let a");
    write("bundle/scene.json", R"({"bodies":[{"rest":"body0_rest.bin"}],"tools":[{"picture":"clip_picture.svg"}]})");
    write("bundle/clip_picture.svg", "<svg xmlns=\"http://www.w3.org/2000/svg\"/>");
    write("bundle/body0_rest.bin", "0123");
    write("bundle/other.bin", "x");
    write("secret", "secret");
    fs::create_directories(root_ / "sessions");
    write("sessions/monday 1.insula", "recorded");
    write("sessions/other.txt", "x");
    write("given.insula", "given");
    Options options;
    options.sessions = root_ / "sessions";
    options.session_files = {root_ / "given.insula"};
    options.port = 0;
    options.page = root_ / "page";
    gateway_ = std::make_unique<Gateway>(gateway_bus_, options);
    const std::string error = gateway_->start();
    EXPECT_EQ(error, "");
  }
  ~GatewayTest() override { gateway_.reset(); }
  void write(const fs::path& file, std::string_view text) { std::ofstream(root_ / file) << text; }

  Response get(const std::string& target, http::verb verb = http::verb::get,
               const std::vector<std::pair<std::string, std::string>>& fields = {}, const std::string& content = "") {
    boost::asio::io_context io;
    tcp::socket socket(io);
    socket.connect({boost::asio::ip::make_address("127.0.0.1"), gateway_->port()});
    http::request<http::string_body> request{verb, target, 11, content};
    request.set(http::field::host, "127.0.0.1");
    for (const auto& [field, value] : fields) request.set(field, value);
    request.prepare_payload();
    http::write(socket, request);
    beast::flat_buffer buffer;
    http::response_parser<http::string_body> parser;
    parser.skip(verb == http::verb::head);
    http::read(socket, buffer, parser);
    return parser.release();
  }
  nlohmann::json health() { return nlohmann::json::parse(get("/healthz").body()); }
  template <class T>
  void put(std::string_view channel, const T& message) {
    Buffer scratch;
    ASSERT_TRUE(publish(bus_, channel, message, scratch));
  }
  /// Waits (without a limit of its own on how fast) until the health report satisfies a condition.
  template <class Condition>
  bool eventually(Condition condition) {
    for (int i = 0; i < 2000; ++i) {
      if (condition(health())) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }
  bool clients_are(int n) {
    return eventually([n](const auto& h) { return h["clients"] == n; });
  }

  std::shared_ptr<MemHub> hub_ = std::make_shared<MemHub>();
  MemBus bus_{hub_}, gateway_bus_{hub_};
  test_files::TempFolder temporary_;
  fs::path root_ = temporary_.path();
  std::unique_ptr<Gateway> gateway_;
};

TEST_F(GatewayTest, ServesThePage) {
  for (const char* target : {"/", "/index.html", "/?quality=low"}) {
    const Response r = get(target);
    EXPECT_EQ(r.result_int(), 200u) << target;
    EXPECT_EQ(r.body(), "<p>page");
    EXPECT_EQ(r[http::field::content_type], "text/html; charset=utf-8");
    EXPECT_EQ(r[http::field::cache_control], "no-cache");
  }
  const Response asset = get("/assets/app-1a2b.js");
  EXPECT_EQ(asset.body(), "let a");
  EXPECT_EQ(asset[http::field::content_type], "text/javascript; charset=utf-8");
  EXPECT_NE(asset[http::field::cache_control].find("immutable"), beast::string_view::npos);
  // A compressed copy goes to browsers that unpack it, under the name and type of what it is a copy of.
  write("page/assets/app-1a2b.js.gz", "packed");
  const Response packed = get("/assets/app-1a2b.js", http::verb::get, {{"Accept-Encoding", "br, gzip;q=0.8"}});
  EXPECT_EQ(packed.body(), "packed");
  EXPECT_EQ(packed[http::field::content_encoding], "gzip");
  EXPECT_EQ(packed[http::field::content_type], "text/javascript; charset=utf-8");
  EXPECT_EQ(get("/assets/app-1a2b.js", http::verb::get, {{"Accept-Encoding", "gzip;q=0"}}).body(), "let a");
  EXPECT_EQ(get("/assets/app-1a2b.js").body(), "let a");
  EXPECT_EQ(get("/none.html").result_int(), 404u);
  EXPECT_EQ(get("/assets/").result_int(), 404u);
  const Response head = get("/index.html", http::verb::head);
  EXPECT_EQ(head.result_int(), 200u);
  EXPECT_EQ(head[http::field::content_length], "7");
  EXPECT_EQ(get("/index.html", http::verb::delete_).result_int(), 405u);
}

TEST_F(GatewayTest, NothingOutsideIsServed) {
  put(channel::scene_info, scene_info(7, (root_ / "bundle").string()));
  ASSERT_TRUE(eventually([](const auto& h) { return h["session"] == 7; }));
  for (const char* target : {"/../secret",
                             "/%2e%2e/secret",
                             "/..%2fsecret",
                             "/assets/../../secret",
                             "/assets/%2e%2e/%2e%2e/secret",
                             "//etc/passwd",
                             "/etc/passwd",
                             "/bundle/../../etc/passwd",
                             "/bundle/7/../secret",
                             "/bundle/7/%2e%2e/secret",
                             "/bundle/7/..%2fsecret",
                             "/bundle/7//etc/passwd",
                             "/bundle/7/other.bin",
                             "/bundle/8/scene.json",
                             "/bundle/7",
                             "/bundle/7/",
                             "/bundle/",
                             "/bundle/%2e%2e/%2e%2e/etc/passwd",
                             "/bundle/-7/scene.json",
                             "/bundle/07/scene.json"})
    EXPECT_EQ(get(target).result_int(), 404u) << target;
}

TEST_F(GatewayTest, ServesTheBundleOfTheSession) {
  EXPECT_EQ(get("/bundle/7/scene.json").result_int(), 404u);
  put(channel::scene_info, scene_info(7, (root_ / "bundle").string()));
  ASSERT_TRUE(eventually([](const auto& h) { return h["session"] == 7; }));
  const Response json = get("/bundle/7/scene.json");
  EXPECT_EQ(json.result_int(), 200u);
  EXPECT_EQ(json[http::field::content_type], "application/json");
  EXPECT_EQ(json[http::field::cache_control], "no-store");
  EXPECT_EQ(get("/bundle/7/body0_rest.bin").body(), "0123");
  const auto picture = get("/bundle/7/clip_picture.svg");
  EXPECT_EQ(picture.result(), http::status::ok);
  EXPECT_EQ(picture[http::field::content_type], "image/svg+xml");
  put(channel::scene_info, scene_info(8, (root_ / "bundle").string()));
  ASSERT_TRUE(eventually([](const auto& h) { return h["session"] == 8; }));
  EXPECT_EQ(get("/bundle/7/scene.json").result_int(), 404u);
  EXPECT_EQ(get("/bundle/8/scene.json").result_int(), 200u);
}

TEST_F(GatewayTest, OffersRecordedSessions) {
  fs::last_write_time(root_ / "given.insula", fs::file_time_type::clock::now() - std::chrono::hours(1));
  const auto listed = nlohmann::json::parse(get("/sessions").body());
  ASSERT_EQ(listed.size(), 2U);
  EXPECT_EQ(listed[0]["name"], "monday 1") << "the newest first";
  EXPECT_EQ(listed[0]["bytes"], 8);
  EXPECT_EQ(listed[1]["name"], "given");
  EXPECT_EQ(get("/sessions/monday%201").body(), "recorded");
  EXPECT_EQ(get("/sessions/given").body(), "given");
  for (const char* none : {"/sessions/other", "/sessions/..", "/sessions/given/other", "/sessions/given/notes/x"})
    EXPECT_EQ(get(none).result_int(), 404U) << none;
  EXPECT_EQ(gateway_->sessions_query(), "session=given");
}

TEST_F(GatewayTest, AnswersTheStartPageButNoForeignSite) {
  EXPECT_EQ(nlohmann::json::parse(get("/api/exercises").body()), nlohmann::json::array());
  EXPECT_EQ(get("/api").result_int(), 404U);
  EXPECT_EQ(get("/api/people/x").result_int(), 404U);
  EXPECT_EQ(get("/api/picture?scene=x").result_int(), 404U);
  const std::pair<std::string, std::string> foreign{"Origin", "http://elsewhere.example"};
  EXPECT_EQ(get("/api/choose", http::verb::post, {foreign}, R"({"scene":"x","person":""})").result_int(), 403U);
  EXPECT_EQ(get("/api/choose", http::verb::post, {}, R"({"scene":"x","person":""})").result_int(), 404U);
  EXPECT_EQ(get("/api/choose", http::verb::put, {}, "{}").result_int(), 405U);
}

TEST_F(GatewayTest, GivesPartsOfARecording) {
  const auto part = [&](const char* range) { return get("/sessions/given", http::verb::get, {{"Range", range}}); };
  const Response middle = part("bytes=1-3");
  EXPECT_EQ(middle.result_int(), 206U);
  EXPECT_EQ(middle.body(), "ive");
  EXPECT_EQ(middle[http::field::content_range], "bytes 1-3/5");
  EXPECT_EQ(part("bytes=3-").body(), "en");
  EXPECT_EQ(part("bytes=-2").body(), "en");
  const Response none = part("bytes=5-6");
  EXPECT_EQ(none.result_int(), 416U);
  EXPECT_EQ(none[http::field::content_range], "bytes */5");
  EXPECT_EQ(part("bytes=0-1,3-4").result_int(), 200U) << "several parts are not known; all is given";
  EXPECT_EQ(get("/sessions/given", http::verb::head)[http::field::content_length], "5");
  write("given.insula", std::string(5 << 20, 'x'));
  const Response large = part("bytes=0-5242879");
  EXPECT_EQ(large.body().size(), 4U << 20) << "a page asks again for the rest";
  EXPECT_EQ(large[http::field::content_range], "bytes 0-4194303/5242880");
}

TEST_F(GatewayTest, KeepsNotesBesideARecording) {
  EXPECT_EQ(nlohmann::json::parse(get("/sessions/given/notes").body()), nlohmann::json::array());
  const std::string notes = R"([{"time_s":1.5,"text":"too deep"}])";
  EXPECT_EQ(get("/sessions/given/notes", http::verb::put, {}, notes).result_int(), 200U);
  EXPECT_EQ(get("/sessions/given/notes").body(), notes);
  EXPECT_TRUE(fs::exists(root_ / "given.insula.notes.json"));
  const std::pair<std::string, std::string> foreign{"Origin", "http://elsewhere.example"};
  EXPECT_EQ(get("/sessions/given/notes", http::verb::put, {foreign}, "[]").result_int(), 403U);
  for (const char* bad : {"", "{", "{}", R"([{"text":"when?"}])", R"([{"time_s":"1","text":""}])"})
    EXPECT_EQ(get("/sessions/given/notes", http::verb::put, {}, bad).result_int(), 400U) << bad;
  for (const char* fixed : {"/sessions/given", "/sessions", "/index.html"})
    EXPECT_EQ(get(fixed, http::verb::put, {}, "[]").result_int(), 405U) << fixed;
  EXPECT_EQ(get("/sessions/given/notes").body(), notes) << "nothing of that was stored";
  EXPECT_EQ(get("/sessions/given").body(), "given");
}

TEST_F(GatewayTest, LateJoinersGetTheSceneAtOnceAndEverybodyTheFrames) {
  put(channel::scene_info, scene_info(7, "/tmp"));
  ASSERT_TRUE(eventually([](const auto& h) { return h["session"] == 7; }));
  WsPage a(gateway_->port()), b(gateway_->port());
  for (WsPage* page : {&a, &b}) {
    const Buffer first = page->receive();
    const auto parts = unframe(first);
    ASSERT_TRUE(parts);
    ASSERT_EQ(parts->channel, channel::scene_info);
    EXPECT_EQ(decode<insula_lcm::scene_info_t>(parts->payload)->session, 7);
  }
  for (int i = 1; i <= 50; ++i) {
    put(channel::render_frame, render_frame(i));
    for (WsPage* page : {&a, &b}) {
      const auto got = decode<insula_lcm::render_frame_t>(page->receive(channel::render_frame));
      ASSERT_TRUE(got);
      EXPECT_EQ(got->sequence, i);
    }
  }
  insula_lcm::sim_event_t event{};
  event.kind = "goal";
  put(channel::sim_event, event);
  EXPECT_EQ(decode<insula_lcm::sim_event_t>(a.receive(channel::sim_event))->kind, "goal");
  insula_lcm::haptic_status_t status{};
  status.ticks_per_s = 1000;
  put(channel::haptic_status, status);
  EXPECT_EQ(decode<insula_lcm::haptic_status_t>(b.receive(channel::haptic_status))->ticks_per_s, 1000);
}

TEST_F(GatewayTest, PagesReachTheBus) {
  std::vector<insula_lcm::user_command_t> commands;
  std::vector<insula_lcm::hand_input_t> inputs;
  bus_.subscribe(channel::user_command, [&](Bytes b) { commands.push_back(*decode<insula_lcm::user_command_t>(b)); });
  bus_.subscribe(channel::hand_input, [&](Bytes b) { inputs.push_back(*decode<insula_lcm::hand_input_t>(b)); });
  WsPage page(gateway_->port());
  insula_lcm::user_command_t command{};
  command.sender = "trainee";
  command.command = "pause";
  page.send(channel::user_command, command);
  insula_lcm::hand_input_t input{};
  input.hand = 1;
  input.p_m[2] = 0.03;
  input.q[0] = 1;
  page.send(channel::hand_input, input);
  for (int i = 0; i < 1000 && (commands.empty() || inputs.empty()); ++i) bus_.poll(20);
  ASSERT_EQ(commands.size(), 1u);
  EXPECT_EQ(commands[0].command, "pause");
  EXPECT_EQ(commands[0].sender, "trainee");
  EXPECT_GT(commands[0].time_us, 0);  // stamped here
  ASSERT_EQ(inputs.size(), 1u);
  EXPECT_EQ(inputs[0].p_m[2], 0.03);
}

TEST_F(GatewayTest, ABusyPagesHandIsRepeatedUntilItIsReleasedOrThePageIsGone) {
  int inputs = 0;
  bus_.subscribe(channel::hand_input, [&](Bytes) { ++inputs; });
  const auto heard_within = [&](std::chrono::milliseconds time) {
    const int before = inputs;
    const auto end = std::chrono::steady_clock::now() + time;
    while (std::chrono::steady_clock::now() < end) bus_.poll(10);
    return inputs - before;
  };
  const auto quiet_soon = [&] {
    for (int k = 0; k < 50; ++k)
      if (heard_within(4 * Hub::repeat_period) == 0) return true;
    return false;
  };
  insula_lcm::hand_input_t input{};
  input.hand = 1;
  input.q[0] = 1;
  insula_lcm::user_command_t release{};
  release.command = "release";
  {
    WsPage page(gateway_->port());
    page.send(channel::hand_input, input);
    for (int k = 0; k < 200 && inputs < 4; ++k) heard_within(Hub::repeat_period);
    EXPECT_GE(inputs, 4) << "one pose was sent; the others are repeated";
    release.argument = "left";
    page.send(channel::user_command, release);
    release.argument = "right";
    page.send(channel::user_command, release);
    EXPECT_TRUE(quiet_soon());
    const int before = inputs;
    page.send(channel::hand_input, input);
    for (int k = 0; k < 200 && inputs < before + 2; ++k) heard_within(Hub::repeat_period);
    EXPECT_GE(inputs, before + 2);
  }
  EXPECT_TRUE(quiet_soon()) << "the page is gone";
}

TEST_F(GatewayTest, GarbageFromAPageChangesNothing) {
  int seen = 0;
  for (const auto channel :
       {channel::user_command, channel::hand_input, channel::haptic_problem, channel::render_frame})
    bus_.subscribe(channel, [&](Bytes) { ++seen; });
  WsPage page(gateway_->port());
  insula_lcm::hand_input_t input{};
  input.q[0] = 1;
  Buffer payload;
  ASSERT_TRUE(encode(input, payload));
  const Buffer good = *frame(channel::hand_input, payload);
  int bad = 0;
  const auto send_bad = [&](const Buffer& bytes, bool binary = true) {
    page.send(bytes, binary);
    ++bad;
  };
  send_bad({});
  send_bad({0});
  send_bad({200, 'A'});
  send_bad({'h', 'e', 'y'}, false);
  send_bad(*frame("HAPTIC_PROBLEM", payload));
  send_bad(*frame("NO_SUCH_CHANNEL", payload));
  send_bad(*frame("USER_COMMAND", payload));
  for (std::size_t n = 0; n < good.size(); n += 7) send_bad({good.begin(), good.begin() + std::ptrdiff_t(n)});
  input.p_m[0] = std::nan("");
  ASSERT_TRUE(encode(input, payload));
  send_bad(*frame(channel::hand_input, payload));
  page.send(good);
  for (int i = 0; i < 1000 && seen == 0; ++i) bus_.poll(20);
  EXPECT_EQ(seen, 1);
  const auto h = health();
  EXPECT_EQ(h["from_pages"]["accepted"], 1);
  EXPECT_EQ(h["from_pages"]["refused"], bad);
}

TEST_F(GatewayTest, TooLargeAMessageEndsThatClientAlone) {
  WsPage bad(gateway_->port()), good(gateway_->port());
  ASSERT_TRUE(clients_are(2));
  try {
    bad.send(Buffer(1'000'000, 1));
  } catch (const std::exception&) {  // cut off while sending
  }
  EXPECT_TRUE(clients_are(1));
  put(channel::render_frame, render_frame(3));
  EXPECT_EQ(decode<insula_lcm::render_frame_t>(good.receive(channel::render_frame))->sequence, 3);
}

TEST_F(GatewayTest, GarbageOnTheBusIsNotPassedOn) {
  WsPage page(gateway_->port());
  ASSERT_TRUE(clients_are(1));
  Buffer bytes;
  ASSERT_TRUE(encode(render_frame(1), bytes));
  for (std::size_t n = 0; n < bytes.size(); n += 5) bus_.publish(channel::render_frame, Bytes(bytes).first(n));
  auto broken = render_frame(2);
  broken.body[0].x_m[3][1] = NAN;
  put(channel::render_frame, broken);
  bus_.publish(channel::scene_info, bytes);
  put(channel::render_frame, render_frame(9));
  const auto got = decode<insula_lcm::render_frame_t>(page.receive(channel::render_frame));
  ASSERT_TRUE(got);
  EXPECT_EQ(got->sequence, 9);
  const auto h = health();
  EXPECT_GT(h["channels"]["RENDER_FRAME"]["refused"], 10);
  EXPECT_EQ(h["channels"]["SCENE_INFO"]["refused"], 1);
}

long resident_kb() {
  std::ifstream in("/proc/self/statm");
  long total = 0, resident = 0;
  in >> total >> resident;
  return resident * 4;
}

TEST_F(GatewayTest, AClientThatDoesNotReadCostsNoMemory) {
  WsPage slow(gateway_->port(), 4096), fast(gateway_->port());
  ASSERT_TRUE(clients_are(2));
  constexpr int frames = 1000, nodes = 3000;  // 36 KB each, 36 MB in all
  Buffer bytes;
  long start = 0;
  for (int i = 1; i <= frames; ++i) {
    ASSERT_TRUE(encode(render_frame(i, nodes), bytes));
    bus_.publish(channel::render_frame, bytes);
    const auto got = decode<insula_lcm::render_frame_t>(fast.receive(channel::render_frame));
    ASSERT_TRUE(got);
    ASSERT_EQ(got->sequence, i);  // the fast client misses none of them
    if (i == 200) start = resident_kb();
  }
  EXPECT_LT(resident_kb() - start, 12'000);
  EXPECT_GT(health()["dropped"], frames / 2);
  // When it wakes up it gets what the sockets still held, then the newest.
  std::int64_t last = 0;
  int received = 0;
  while (last < frames) {
    const auto got = decode<insula_lcm::render_frame_t>(slow.receive(channel::render_frame));
    ASSERT_TRUE(got);
    ASSERT_GT(got->sequence, last);
    last = got->sequence;
    ++received;
  }
  EXPECT_LT(received, frames / 4);
}

TEST_F(GatewayTest, DeviceStateIsThinnedOut) {
  WsPage page(gateway_->port());
  ASSERT_TRUE(clients_are(1));
  insula_lcm::device_state_t state{};
  const auto before = std::chrono::steady_clock::now();
  for (int i = 0; i < 200; ++i) {
    state.sequence = i;
    put(channel::device_state, state);
  }
  ASSERT_TRUE(eventually([](const auto& h) { return h["channels"]["DEVICE_STATE"]["received"] == 200; }));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  const double sent = health()["sent"];
  EXPECT_GE(sent, 1);
  EXPECT_LE(sent, 2 + 30 * seconds);
}

TEST_F(GatewayTest, ForeignPagesMayNotConnect) {
  const std::vector<std::pair<std::string, std::string>> upgrade{{"Connection", "Upgrade"},
                                                                 {"Upgrade", "websocket"},
                                                                 {"Sec-WebSocket-Version", "13"},
                                                                 {"Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ=="}};
  auto with = [&](const std::string& origin) {
    auto fields = upgrade;
    fields.emplace_back("Origin", origin);
    return get("/ws", http::verb::get, fields).result_int();
  };
  EXPECT_EQ(with("http://evil.example"), 403u);
  EXPECT_EQ(with("null"), 403u);
  EXPECT_EQ(with("http://127.0.0.1.evil.example"), 403u);
  EXPECT_EQ(with("http://127.0.0.1:5173"), 101u);
  EXPECT_EQ(get("/other", http::verb::get, upgrade).result_int(), 404u);
}

TEST_F(GatewayTest, TakesTheNextPortWhenBusy) {
  MemBus other_bus;
  Options options;
  options.port = gateway_->port();
  Gateway next(other_bus, options);
  EXPECT_EQ(next.start(), "");
  EXPECT_GT(next.port(), gateway_->port());
  EXPECT_NE(next.url().find(std::to_string(next.port())), std::string::npos);
  options.more_ports = 0;
  MemBus third_bus;
  Gateway none(third_bus, options);
  EXPECT_NE(none.start().find("cannot listen"), std::string::npos);
}

TEST_F(GatewayTest, WithoutAPageItSaysHowToBuildOne) {
  MemBus other_bus;
  Options options;
  options.port = 0;
  gateway_ = std::make_unique<Gateway>(other_bus, options);
  ASSERT_EQ(gateway_->start(), "");
  const Response r = get("/");
  EXPECT_EQ(r.result_int(), 503u);
  EXPECT_NE(r.body().find("npm run build"), std::string::npos);
  gateway_.reset();  // before its bus
}

}  // namespace
}  // namespace insula::gateway
