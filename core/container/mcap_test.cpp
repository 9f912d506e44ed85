// SPDX-License-Identifier: GPL-3.0-or-later
// An MCAP file comes back as it was written; damaged ones give what is whole.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <random>

#include "core/base/input_error.h"
#include "core/container/mcap_reader.h"
#include "core/container/mcap_writer.h"
#include "core/testing/temp_folder.h"

namespace insula {
namespace {

using mcap::Buffer;
using mcap::Bytes;
using test_files::TempFolder;

constexpr std::uint64_t step_ns = 1'000'000;

Buffer text(const std::string& s) { return {s.begin(), s.end()}; }
std::string said(Bytes b) { return {b.begin(), b.end()}; }

/// Two channels, `n` messages each in turn, an attachment and a description.
void write_example(McapWriter& file, int n) {
  const auto schema = file.add_schema("number_t", "lcm", "struct number_t { int32_t n; }");
  const auto even = file.add_channel("EVEN", schema, "lcm", {{"unit", "m"}});
  const auto odd = file.add_channel("ODD", 0, "json");
  file.describe("session", {{"scene", "a.xml"}, {"seed", "7"}});
  file.attach("scene/a.xml", "application/xml", 0, text("<scene/>"));
  for (int k = 0; k < n; ++k)
    file.write(k % 2 ? odd : even, std::uint64_t(k) * step_ns, text("message " + std::to_string(k)));
}

std::vector<std::string> all_messages(McapReader& file, std::uint64_t first = 0, std::uint64_t last = UINT64_MAX) {
  std::set<std::uint16_t> channels;
  for (const auto& [id, c] : file.channels()) channels.insert(id);
  std::vector<std::string> out;
  file.read(channels, first, last, [&](const McapReader::Message& m) {
    out.push_back(said(m.data));
    return true;
  });
  return out;
}

Buffer bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
void put_bytes(const std::filesystem::path& file, const Buffer& bytes) {
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

/// A file of some chunks, each of a few hundred bytes; as it is before its end if `end` is false.
Buffer small_chunks(const TempFolder& folder, int n, bool end = true) {
  const auto file = folder.path() / "small.mcap";
  McapWriter w(file, "insula", "test", {.chunk_bytes = 500});
  write_example(w, n);
  if (end) w.close();
  else w.flush();
  return bytes_of(file);
}

TEST(Mcap, ComesBackAsWritten) {
  const TempFolder folder;
  const auto file = folder.path() / "a.mcap";
  McapWriter w(file, "insula", "insula 1", {.chunk_bytes = 500});
  write_example(w, 100);
  w.close();
  EXPECT_EQ(w.bytes(), std::filesystem::file_size(file));
  McapReader r(file);
  EXPECT_TRUE(r.ended());
  EXPECT_TRUE(r.damage().empty());
  EXPECT_EQ(r.profile(), "insula");
  EXPECT_EQ(r.library(), "insula 1");
  ASSERT_EQ(r.schemas().size(), 1u);
  EXPECT_EQ(r.schemas().at(1).data, "struct number_t { int32_t n; }");
  ASSERT_EQ(r.channels().size(), 2u);
  EXPECT_EQ(r.channels().at(1).metadata.at("unit"), "m");
  EXPECT_EQ(r.channel("ODD"), 2);
  EXPECT_FALSE(r.channel("NONE"));
  EXPECT_EQ(r.descriptions().at("session").at("seed"), "7");
  ASSERT_EQ(r.attachments().size(), 1u);
  EXPECT_EQ(r.attachments()[0].name, "scene/a.xml");
  EXPECT_EQ(said(*r.data(r.attachments()[0])), "<scene/>");
  EXPECT_GT(r.chunks().size(), 4u);
  const auto messages = all_messages(r);
  ASSERT_EQ(messages.size(), 100u);
  for (int k = 0; k < 100; ++k) EXPECT_EQ(messages[std::size_t(k)], "message " + std::to_string(k));
}

TEST(Mcap, GivesAStretchOfTimeAndOneChannel) {
  const TempFolder folder;
  small_chunks(folder, 100);
  McapReader r(folder.path() / "small.mcap");
  EXPECT_EQ(all_messages(r, 40 * step_ns, 44 * step_ns),
            (std::vector<std::string>{"message 40", "message 41", "message 42", "message 43", "message 44"}));
  int seen = 0;
  std::uint32_t next = 0;
  r.read({*r.channel("EVEN")}, 0, UINT64_MAX, [&](const McapReader::Message& m) {
    EXPECT_EQ(m.sequence, next++);
    return ++seen < 3;
  });
  EXPECT_EQ(seen, 3);
}

TEST(Mcap, AFileThatWasNotEndedGivesItsChunks) {
  const TempFolder folder;
  const auto cut = folder.path() / "cut.mcap";
  put_bytes(cut, small_chunks(folder, 100, false));
  McapReader r(cut);
  EXPECT_FALSE(r.ended());
  EXPECT_EQ(all_messages(r).size(), 100u);
  EXPECT_EQ(r.descriptions().at("session").at("scene"), "a.xml");
  EXPECT_EQ(said(*r.data(r.attachments().at(0))), "<scene/>");
}

TEST(Mcap, EveryTruncationGivesTheMessagesBeforeIt) {
  const TempFolder folder;
  const Buffer whole = small_chunks(folder, 60);
  const auto cut = folder.path() / "cut.mcap";
  std::size_t before = 0;
  for (std::size_t n = 8; n <= whole.size(); ++n) {
    put_bytes(cut, Buffer(whole.begin(), whole.begin() + std::ptrdiff_t(n)));
    McapReader r(cut);
    EXPECT_EQ(r.ended(), n == whole.size());
    const auto messages = all_messages(r);
    EXPECT_GE(messages.size(), before) << n;
    before = messages.size();
    for (std::size_t k = 0; k < messages.size(); ++k) ASSERT_EQ(messages[k], "message " + std::to_string(k)) << n;
  }
  EXPECT_EQ(before, 60u);
}

TEST(Mcap, TenThousandDamagedFilesGiveWhatIsWhole) {
  const TempFolder folder;
  const Buffer whole = small_chunks(folder, 100);
  const auto hurt = folder.path() / "hurt.mcap";
  std::mt19937 random(11);
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  std::size_t refused = 0, incomplete = 0, unnoticed = 0;
  for (int k = 0; k < 10'000; ++k) {
    Buffer b = whole;
    for (std::size_t n = 1 + below(3); n > 0; --n) {
      switch (below(3)) {
        case 0: b[below(b.size())] ^= std::uint8_t(1u << below(8)); break;
        case 1: b[below(b.size())] = std::uint8_t(below(256)); break;
        default:
          for (std::size_t at = below(b.size()), end = std::min(b.size(), at + 8); at < end; ++at) b[at] = 0xff;
      }
    }
    if (below(4) == 0) b.resize(1 + below(b.size()));
    put_bytes(hurt, b);
    try {
      McapReader r(hurt);
      const auto messages = all_messages(r);
      for (const std::string& m : messages) ASSERT_EQ(m.rfind("message ", 0), 0u) << "number " << k;
      for (const auto& a : r.attachments()) {
        const auto data = r.data(a);
        ASSERT_TRUE(!data || said(*data) == "<scene/>");
      }
      if (messages.size() < 100) {
        ++incomplete;
        unnoticed += r.ended() && r.damage().empty();
        ASSERT_LE(messages.size(), 100u);
      }
    } catch (const InputError& e) {
      ++refused;
      EXPECT_NE(std::string(e.what()).find("is not an MCAP file"), std::string::npos);
    }
  }
  EXPECT_GT(incomplete, 1000u);
  EXPECT_LT(refused, 200u);
  EXPECT_EQ(unnoticed, 0u) << "messages were lost without a word";
}

TEST(Mcap, OtherFilesAreRefused) {
  const TempFolder folder;
  EXPECT_THROW(McapReader(folder.path() / "none.mcap"), InputError);
  EXPECT_THROW(McapReader(folder.write("a.mcap", "")), InputError);
  EXPECT_THROW(McapReader(folder.write("b.mcap", "SQLite format 3")), InputError);
  EXPECT_THROW(McapWriter(folder.path() / "no/such/folder.mcap", "", ""), InputError);
}

TEST(Mcap, AFullDiskIsSaid) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  try {
    McapWriter w("/dev/full", "", "");
    FAIL() << "wrote to a full disk";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("No space left"), std::string::npos) << e.what();
  }
}

// A reader that wants one lane unpacks no chunk of another.
TEST(Mcap, LanesHaveChunksOfTheirOwn) {
  const TempFolder folder;
  const auto file = folder.path() / "lanes.mcap";
  McapWriter w(file, "insula", "test", {.chunk_bytes = 400});
  const auto fast = w.add_channel("FAST", 0, "json");
  const auto slow = w.add_channel("SLOW", 0, "json", {}, 1);
  for (int k = 0; k < 100; ++k) {
    w.write(fast, std::uint64_t(k) * step_ns, text("fast " + std::to_string(k)));
    if (k % 10 == 0) w.write(slow, std::uint64_t(k) * step_ns, text("slow " + std::to_string(k)));
    if (k == 50) w.flush(1);
  }
  w.close();
  McapReader r(file);
  EXPECT_TRUE(r.ended());
  std::vector<std::string> of_slow, of_fast;
  r.read({slow}, 0, UINT64_MAX, [&](const McapReader::Message& m) {
    of_slow.push_back(said(m.data));
    return true;
  });
  r.read({fast}, 0, UINT64_MAX, [&](const McapReader::Message& m) {
    of_fast.push_back(said(m.data));
    return true;
  });
  EXPECT_EQ(of_fast.size(), 100U);
  ASSERT_EQ(of_slow.size(), 10U);
  EXPECT_EQ(of_slow.front(), "slow 0");
  EXPECT_EQ(of_slow.back(), "slow 90");
  // The slow lane has one chunk until it was flushed, and one after it.
  const auto whole = [](const auto& c) { return c.last_ns - c.first_ns >= 30 * step_ns; };
  EXPECT_EQ(std::count_if(r.chunks().begin(), r.chunks().end(), whole), 2);
}

}  // namespace
}  // namespace insula
