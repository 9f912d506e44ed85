// SPDX-License-Identifier: GPL-3.0-or-later
// Who may ring whom, what is passed on of a talk by voice, and what pages of a station are told.
#include "viewer/gateway/voice_message.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/bus/mem_bus.h"
#include "viewer/gateway/hub.h"

namespace insula::gateway {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

const std::string sdp = "v=0\r\no=- 1 2 IN IP4 127.0.0.1\r\ns=-\r\nt=0 0\r\nm=audio 9 UDP/TLS/RTP/SAVPF 111\r\n";

/// A page that keeps what it hears of the room.
class ListeningPage : public Client {
 public:
  ListeningPage(Role role, Access access) : visitor_{"192.0.2.1", access, role, ++last_number} {}
  void send(Topic topic, const Message& message) override {
    if (topic != Topic::room) return;
    const auto parts = unframe(*message);
    heard_.push_back(json::parse(parts->payload.begin(), parts->payload.end()));
  }
  std::uint64_t dropped() const override { return 0; }
  const Visitor& visitor() const override { return visitor_; }
  /// Since the last question.
  std::vector<json> heard() { return std::exchange(heard_, {}); }

 private:
  static inline std::uint64_t last_number = 0;
  Visitor visitor_;
  std::vector<json> heard_;
};

class VoiceOfAStation : public ::testing::Test {
 protected:
  std::shared_ptr<ListeningPage> join(Role role, Access access) {
    auto page = std::make_shared<ListeningPage>(role, access);
    hub_.join(page);
    return page;
  }
  Hub::Taken say(const std::shared_ptr<ListeningPage>& page, const json& what) {
    const std::string text = what.dump();
    const Message framed = frame(room_channel, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    return hub_.from_page(*framed, page->visitor(), page.get());
  }
  static json voice(const char* step) { return {{"kind", "voice"}, {"step", step}}; }
  static json voice(const char* step, const std::shared_ptr<ListeningPage>& to, const std::string& described = {}) {
    json out{{"kind", "voice"}, {"step", step}, {"to", to->visitor().page}};
    if (!described.empty()) out["sdp"] = described;
    return out;
  }

  std::shared_ptr<MemHub> mem_ = std::make_shared<MemHub>();
  MemBus bus_{mem_};
  Hub hub_{bus_, [](std::function<void()> f) { f(); }};
  std::shared_ptr<ListeningPage> trainee_ = join(Role::trainee, Access::here),
                                 instructor_ = join(Role::instructor, Access::instructor),
                                 other_ = join(Role::instructor, Access::here),
                                 observer_ = join(Role::observer, Access::observer);
  void SetUp() override {
    for (const auto& page : {trainee_, instructor_, other_, observer_}) page->heard();
  }
};

TEST_F(VoiceOfAStation, GoesToTheOtherSideAlone) {
  EXPECT_TRUE(say(instructor_, voice("ring")).accepted);
  const json ring = trainee_->heard().at(0);
  EXPECT_EQ(ring,
            (json{{"kind", "voice"}, {"step", "ring"}, {"from", "instructor"}, {"page", instructor_->visitor().page}}));
  EXPECT_TRUE(say(trainee_, voice("accept", instructor_)).accepted);
  EXPECT_EQ(instructor_->heard().at(0)["page"], trainee_->visitor().page);
  EXPECT_TRUE(say(instructor_, voice("offer", trainee_, sdp)).accepted);
  EXPECT_EQ(trainee_->heard().at(0)["sdp"], sdp);
  EXPECT_TRUE(say(trainee_, voice("answer", instructor_, sdp)).accepted);
  EXPECT_EQ(instructor_->heard().at(0)["step"], "answer");
  EXPECT_EQ(other_->heard().size(), 0U) << "another instructor learns nothing of it";
  EXPECT_EQ(observer_->heard().size(), 0U);
  EXPECT_TRUE(say(trainee_, voice("ring")).accepted);
  EXPECT_EQ(instructor_->heard().size() + other_->heard().size(), 2U) << "a trainee rings all instructors";
}

TEST_F(VoiceOfAStation, RefusesWhatItMust) {
  EXPECT_EQ(say(observer_, voice("ring")).why, "not allowed");
  const auto claimed = join(Role::instructor, Access::observer);
  EXPECT_EQ(say(claimed, voice("ring")).why, "not allowed") << "the role in an address gives no right";
  EXPECT_EQ(say(instructor_, voice("offer", other_, sdp)).why, "there is no such page") << "not of the same side";
  EXPECT_EQ(say(instructor_, voice("offer", observer_, sdp)).why, "there is no such page");
  EXPECT_EQ(say(instructor_, voice("accept")).why, "malformed") << "to whom?";
  for (const char* step : {"", "offer", "answer", "shout"})
    EXPECT_EQ(say(instructor_, voice(step, trainee_)).why, "malformed") << step;
  for (const json& to : {json(-1), json(0.5), json("1"), json(true), json::array()}) {
    json said = voice("end");
    said["to"] = to;
    EXPECT_EQ(say(instructor_, said).why, "malformed") << to;
  }
  trainee_->heard();
  say(instructor_, {{"kind", "voice"}, {"step", "ring"}, {"from", "trainee"}, {"page", 99}, {"more", "x"}});
  const json heard = trainee_->heard().at(0);
  EXPECT_EQ(heard["page"], instructor_->visitor().page) << "who sent it is not for the sender to say";
  EXPECT_EQ(heard["from"], "instructor");
  EXPECT_FALSE(heard.contains("more"));
}

TEST_F(VoiceOfAStation, NobodyIsRungAtWithoutEnd) {
  int accepted = 0;
  for (int i = 0; i < 100; ++i) accepted += say(instructor_, voice("ring")).accepted;
  EXPECT_GE(accepted, 20);
  EXPECT_LT(accepted, 30);
  EXPECT_TRUE(say(trainee_, voice("ring")).accepted) << "each page has a limit of its own";
}

TEST_F(VoiceOfAStation, EndsWhenAPageLeaves) {
  say(instructor_, voice("ring"));
  trainee_->heard();
  hub_.leave(instructor_.get());
  const std::vector<json> heard = trainee_->heard();
  ASSERT_EQ(heard.size(), 2U);
  EXPECT_EQ(heard[0]["step"], "end");
  EXPECT_EQ(heard[0]["page"], instructor_->visitor().page);
  EXPECT_EQ(heard[1], (json{{"kind", "pages"}, {"instructors", 1}, {"trainees", 1}}));
  hub_.leave(other_.get());
  EXPECT_EQ(trainee_->heard().size(), 1U) << "one that never talked has nothing to end";
}

TEST_F(VoiceOfAStation, OnlyTheTraineesPageHereIsAskedForAPicture) {
  const auto now = std::chrono::steady_clock::now();
  hub_.want_picture(now);
  hub_.want_picture(now + Hub::picture_period / 2);
  EXPECT_EQ(trainee_->heard(), (std::vector<json>{json{{"kind", "picture"}}}));
  for (const auto& page : {instructor_, other_, observer_}) EXPECT_EQ(page->heard().size(), 0U);
  hub_.want_picture(now + Hub::picture_period);
  EXPECT_EQ(trainee_->heard().size(), 1U);
}

TEST(SoundDescription, HasOneStreamOfSoundAndNothingElse) {
  EXPECT_TRUE(is_sound_description(sdp));
  EXPECT_FALSE(is_sound_description(sdp + "m=video 9 UDP/TLS/RTP/SAVPF 96\r\n"));
  EXPECT_FALSE(is_sound_description(sdp + "m=audio 9 UDP/TLS/RTP/SAVPF 96\r\n"));
  EXPECT_FALSE(is_sound_description(sdp + "m=application 9 UDP/DTLS/SCTP webrtc-datachannel\r\n"));
  EXPECT_FALSE(is_sound_description("v=0\r\n"));
  EXPECT_FALSE(is_sound_description(sdp.substr(1)));
  EXPECT_FALSE(is_sound_description(sdp + "a=\xC3\xA4\r\n"));
  EXPECT_TRUE(is_sound_description(sdp + std::string(8 * 1024 - sdp.size(), 'a')));
  EXPECT_FALSE(is_sound_description(sdp + std::string(8 * 1024 + 1 - sdp.size(), 'a')));
}

}  // namespace
}  // namespace insula::gateway
