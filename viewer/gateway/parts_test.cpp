// SPDX-License-Identifier: GPL-3.0-or-later
// The gateway's parts that need no network: URL paths, the outbox, framing, the bundle's list of files.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/testing/temp_folder.h"
#include "viewer/gateway/bundle.h"
#include "viewer/gateway/byte_range.h"
#include "viewer/gateway/outbox.h"
#include "viewer/gateway/static_files.h"

namespace fs = std::filesystem;

namespace insula::gateway {
namespace {

using Parts = std::vector<std::string>;

TEST(SplitTarget, GoodPaths) {
  EXPECT_EQ(split_target("/"), Parts{""});
  EXPECT_EQ(split_target("/index.html"), Parts{"index.html"});
  EXPECT_EQ(split_target("/assets/a.js?v=1#x"), (Parts{"assets", "a.js"}));
  EXPECT_EQ(split_target("/a%20b/c%2Ed"), (Parts{"a b", "c.d"}));
  EXPECT_EQ(split_target("/?quality=low"), Parts{""});
  EXPECT_EQ(split_target("/sub/"), (Parts{"sub", ""}));
}

TEST(SplitTarget, EverythingElse) {
  for (const char* bad : {"",
                          "x",
                          "*",
                          "http://a/b",
                          "/..",
                          "/../etc/passwd",
                          "/a/../b",
                          "/./a",
                          "/%2e%2e/etc/passwd",
                          "/%2E%2e",
                          "/.%2e/x",
                          "/a%2fb",
                          "/..%2f..%2fetc",
                          "/a\\b",
                          "/%5c..%5c",
                          "/a%00b",
                          "/%",
                          "/%4",
                          "/%zz",
                          "//etc/passwd",
                          "/a//b",
                          "/a%0ab"})
    EXPECT_FALSE(split_target(bad).has_value()) << bad;
  EXPECT_FALSE(split_target("/" + std::string(3000, 'a')).has_value());
}

TEST(ByteRange, PartsOfAFile) {
  const auto part = [](std::string_view header) {
    const auto r = byte_range(header, 100);
    return r ? std::pair(r->first, r->length) : std::pair<std::uint64_t, std::uint64_t>(7777, 0);
  };
  using P = std::pair<std::uint64_t, std::uint64_t>;
  EXPECT_EQ(part("bytes=0-0"), P(0, 1));
  EXPECT_EQ(part("bytes=10-19"), P(10, 10));
  EXPECT_EQ(part("bytes=90-1000"), P(90, 10));
  EXPECT_EQ(part("bytes=90-"), P(90, 10));
  EXPECT_EQ(part("bytes=-30"), P(70, 30));
  EXPECT_EQ(part("bytes=-300"), P(0, 100));
  EXPECT_EQ(part("bytes=100-").second, 0U) << "there are no such bytes";
  EXPECT_EQ(byte_range("bytes=0-", 0)->length, 0U);
  for (const char* other : {"", "bytes", "bytes=", "bytes=-", "bytes=3", "bytes=5-4", "bytes=a-5", "bytes=1-5x",
                            "bytes= 1-2", "bytes=+1-2", "bytes=1-2,4-5", "lines=1-2", "bytes=99999999999999999999-"})
    EXPECT_FALSE(byte_range(other, 100)) << other;
}

class Folder : public ::testing::Test {
 protected:
  Folder() {
    fs::create_directories(root_ / "page/assets");
    fs::create_directories(root_ / "outside");
    write("outside/secret.bin", "secret");
    write("page/index.html", "<p>page");
    write("page/assets/a.js", "let a");
  }
  void write(const fs::path& file, std::string_view text) { std::ofstream(root_ / file) << text; }
  test_files::TempFolder temporary_;
  fs::path root_ = temporary_.path();
};

TEST_F(Folder, FilesBelow) {
  EXPECT_TRUE(file_below(root_ / "page", {"index.html"}));
  EXPECT_TRUE(file_below(root_ / "page", {"assets", "a.js"}));
  EXPECT_FALSE(file_below(root_ / "page", {"assets"}));
  EXPECT_FALSE(file_below(root_ / "page", {"none"}));
  EXPECT_FALSE(file_below(root_ / "page", {"..", "outside", "secret.bin"}));
  EXPECT_FALSE(file_below(root_ / "page", {"/etc/passwd"}));
  EXPECT_FALSE(file_below(root_ / "missing", {"index.html"}));
}

TEST_F(Folder, LinksOutOfTheFolderAreNotFollowed) {
  fs::create_symlink(root_ / "outside/secret.bin", root_ / "page/link.bin");
  fs::create_symlink(root_ / "outside", root_ / "page/dir");
  fs::create_symlink("assets/a.js", root_ / "page/inside.js");
  EXPECT_FALSE(file_below(root_ / "page", {"link.bin"}));
  EXPECT_FALSE(file_below(root_ / "page", {"dir", "secret.bin"}));
  EXPECT_TRUE(file_below(root_ / "page", {"inside.js"}));
}

TEST_F(Folder, BundleServesWhatItListsAndNothingElse) {
  Bundle bundle;
  EXPECT_FALSE(bundle.find("0", {"scene.json"}));
  fs::create_directories(root_ / "bundle/deep");
  bundle.set(42, (root_ / "bundle").string());
  EXPECT_FALSE(bundle.find("42", {"scene.json"}));  // not written yet
  write("bundle/scene.json", "{\"bodies\": [");
  EXPECT_FALSE(bundle.find("42", {"scene.json"}));  // half written
  write("bundle/a.bin", "a");
  write("bundle/deep/b.bin", "b");
  write("bundle/unlisted.bin", "u");
  fs::create_symlink(root_ / "outside/secret.bin", root_ / "bundle/link.bin");
  write("bundle/scene.json", R"({"bodies":[{"rest":"a.bin"}],"x":["deep/b.bin","link.bin","../outside/secret.bin"]})");
  fs::last_write_time(root_ / "bundle/scene.json", fs::file_time_type::clock::now() + std::chrono::seconds(5));
  EXPECT_TRUE(bundle.find("42", {"scene.json"}));
  EXPECT_TRUE(bundle.find("42", {"a.bin"}));
  EXPECT_TRUE(bundle.find("42", {"deep", "b.bin"}));
  EXPECT_FALSE(bundle.find("42", {"unlisted.bin"}));
  EXPECT_FALSE(bundle.find("42", {"link.bin"}));
  EXPECT_FALSE(bundle.find("42", {"..", "outside", "secret.bin"}));
  EXPECT_FALSE(bundle.find("41", {"a.bin"}));
  bundle.set(43, "/etc");
  EXPECT_FALSE(bundle.find("43", {"passwd"}));
}

TEST(Mime, KnownTypes) {
  EXPECT_EQ(mime_type("a/index.html"), "text/html; charset=utf-8");
  EXPECT_EQ(mime_type("a.js"), "text/javascript; charset=utf-8");
  EXPECT_EQ(mime_type("scene.json"), "application/json");
  EXPECT_EQ(mime_type("x.bin"), "application/octet-stream");
}

TEST(Framing, RoundTripAndGarbage) {
  const std::vector<std::uint8_t> payload{1, 2, 3};
  const Message m = frame("RENDER_FRAME", payload);
  const auto back = unframe(*m);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->channel, "RENDER_FRAME");
  EXPECT_TRUE(std::equal(payload.begin(), payload.end(), back->payload.begin(), back->payload.end()));
  EXPECT_FALSE(unframe({}));
  const std::vector<std::uint8_t> zero{0, 1}, shorter{5, 'A', 'B'};
  EXPECT_FALSE(unframe(zero));
  EXPECT_FALSE(unframe(shorter));
}

Message message(std::size_t size, std::uint8_t mark) {
  return std::make_shared<const std::vector<std::uint8_t>>(size, mark);
}

TEST(Outbox, KeepsTheNewestStateAndABoundedNumberOfEvents) {
  Outbox box;
  for (int i = 0; i < 10'000; ++i) {
    box.put(Topic::render_frame, message(40'000, std::uint8_t(i)));
    box.put(Topic::sim_event, message(100, std::uint8_t(i)));
  }
  EXPECT_LE(box.bytes(), 40'000 + 100 * Outbox::max_events);
  EXPECT_EQ(box.dropped(), 9'999 + (10'000 - Outbox::max_events));
  std::size_t events = 0, frames = 0;
  std::uint8_t last_event = 0;
  while (const Message m = box.take()) {
    if (m->size() == 100) {
      ++events;
      last_event = (*m)[0];
    } else {
      ++frames;
      EXPECT_EQ((*m)[0], std::uint8_t(9'999));
    }
  }
  EXPECT_EQ(events, Outbox::max_events);
  EXPECT_EQ(last_event, std::uint8_t(9'999));
  EXPECT_EQ(frames, 1u);
  EXPECT_EQ(box.bytes(), 0u);
}

TEST(Outbox, SceneInfoFirstAndNoStateStarves) {
  Outbox box;
  box.put(Topic::render_frame, message(1, 1));
  box.put(Topic::device_state, message(1, 2));
  box.put(Topic::haptic_status, message(1, 3));
  box.put(Topic::scene_info, message(1, 0));
  EXPECT_EQ((*box.take())[0], 0);
  EXPECT_EQ((*box.take())[0], 1);
  for (int i = 0; i < 2; ++i) box.put(Topic::render_frame, message(1, 1));  // a fast sender
  std::vector<int> order;
  while (const Message m = box.take()) order.push_back((*m)[0]);
  EXPECT_EQ(order, (std::vector<int>{2, 3, 1}));
}

}  // namespace
}  // namespace insula::gateway
