// SPDX-License-Identifier: GPL-3.0-or-later
// Logs of lcm-logger: liblcm's own writer against our reader, and damage.
#include "core/bus/event_log.h"

#include <gtest/gtest.h>
#include <lcm/lcm.h>

#include "core/base/input_error.h"
#include "core/base/this_process.h"

namespace insula {
namespace {

namespace fs = std::filesystem;

class EventLogFile : public ::testing::Test {
 protected:
  fs::path file = fs::temp_directory_path() / ("insula_log_" + std::to_string(process_id()));
  void SetUp() override {
    lcm_eventlog_t* log = lcm_eventlog_create(file.c_str(), "w");
    for (int k = 0; k < 3; ++k) {
      std::string name = "CHANNEL_" + std::to_string(k);
      std::vector<std::uint8_t> data(std::size_t(1 + 100 * k), std::uint8_t(k));
      lcm_eventlog_event_t e{};
      e.timestamp = 1000 + k;
      e.channellen = int(name.size());
      e.datalen = int(data.size());
      e.channel = name.data();
      e.data = data.data();
      ASSERT_EQ(lcm_eventlog_write_event(log, &e), 0);
    }
    lcm_eventlog_destroy(log);
  }
  void TearDown() override { fs::remove(file); }

  /// Events until the end or the error, which goes to `why`.
  int read(std::string& why) const {
    int n = 0;
    why.clear();
    try {
      EventLog log(file);
      for (LogEvent e; log.next(e); ++n) {
        EXPECT_EQ(e.channel, "CHANNEL_" + std::to_string(n));
        EXPECT_EQ(e.time_us, 1000 + n);
        EXPECT_EQ(e.message, std::vector<std::uint8_t>(std::size_t(1 + 100 * n), std::uint8_t(n)));
      }
    } catch (const InputError& e) {
      why = e.what();
    }
    return n;
  }
  void overwrite(std::streamoff at, char byte) const {
    std::fstream f(file, std::ios::in | std::ios::out | std::ios::binary);
    f.seekp(at);
    f.put(byte);
  }
};

TEST_F(EventLogFile, ReadsWhatLcmWrites) {
  std::string why;
  EXPECT_EQ(read(why), 3);
  EXPECT_EQ(why, "");
}

TEST_F(EventLogFile, EveryTruncationIsSaid) {
  std::string why;
  const auto whole = fs::file_size(file);
  const std::size_t first = 28 + 9 + 1, second = first + 28 + 9 + 101;
  for (auto n = whole - 1; n > 0; --n) {
    fs::resize_file(file, n);
    EXPECT_EQ(read(why), n < first ? 0 : n < second ? 1 : 2) << n;
    const bool between = n == first || n == second;
    EXPECT_EQ(why.find("the log ends within an event") != std::string::npos, !between) << n << ": " << why;
  }
  fs::resize_file(file, 0);
  EXPECT_EQ(read(why), 0);
  EXPECT_NE(why.find("the log is empty"), std::string::npos) << why;
}

TEST_F(EventLogFile, DamageIsSaidWithItsPlace) {
  std::string why;
  overwrite(38, 'x');  // the second event's mark
  EXPECT_EQ(read(why), 1);
  EXPECT_NE(why.find(": byte 38: no event begins here"), std::string::npos) << why;
  overwrite(24, '\x7f');  // the first event's length
  EXPECT_EQ(read(why), 0);
  EXPECT_NE(why.find("the log is damaged"), std::string::npos) << why;
  overwrite(0, 'P');
  EXPECT_EQ(read(why), 0);
  EXPECT_NE(why.find("this is no log of lcm-logger"), std::string::npos) << why;
  fs::remove(file);
  EXPECT_EQ(read(why), 0);
  EXPECT_NE(why.find("cannot be read"), std::string::npos) << why;
}

}  // namespace
}  // namespace insula
