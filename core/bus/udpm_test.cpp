// SPDX-License-Identifier: GPL-3.0-or-later
// LCM's datagrams: addresses, cutting and assembling, and datagrams that lie about themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "core/base/random.h"
#include "core/bus/byte_io.h"
#include "core/bus/udpm_packet.h"
#include "core/bus/udpm_url.h"

namespace insula {
namespace {

using Buffer = std::vector<std::uint8_t>;

TEST(UdpmUrl, PartsAndDefaults) {
  const auto whole = parse_udpm_url("udpm://239.1.2.3:7700?ttl=1&recv_buf_size=9");
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->group, (std::array<std::uint8_t, 4>{239, 1, 2, 3}));
  EXPECT_EQ(whole->port, 7700);
  EXPECT_EQ(whole->ttl, 1);
  EXPECT_EQ(whole->receive_buffer_bytes, 9);
  const auto bare = parse_udpm_url("udpm://");
  ASSERT_TRUE(bare);
  EXPECT_EQ(bare->group, (std::array<std::uint8_t, 4>{239, 255, 76, 67}));
  EXPECT_EQ(bare->port, 7667);
  EXPECT_EQ(bare->ttl, 0);
  EXPECT_EQ(bare->receive_buffer_bytes, 2'097'152);
}

TEST(UdpmUrl, MalformedOnesAreRefused) {
  for (const char* url :
       {"", "udp://239.255.76.67:7667", "udpm://10.0.0.1:7667", "udpm://240.0.0.1:7667", "udpm://239.255.76:7667",
        "udpm://239.255.76.256:7667", "udpm://239.255.76.67.1:7667", "udpm://239.255.76.67:0",
        "udpm://239.255.76.67:70000", "udpm://239.255.76.67:", "udpm://239.255.76.67:7667?ttl=256",
        "udpm://239.255.76.67:7667?ttl=-1", "udpm://239.255.76.67:7667?tttl=0", "udpm://a:1"})
    EXPECT_FALSE(parse_udpm_url(url)) << url;
}

/// The datagrams of a message as they go over the wire.
std::vector<Buffer> datagrams(std::string_view channel, const Buffer& message, std::uint32_t sequence) {
  std::vector<Buffer> out;
  EXPECT_TRUE(udpm::cut(channel, message, sequence, [&](const udpm::Datagram& d) {
    Buffer bytes(d.head.begin(), d.head.begin() + std::ptrdiff_t(d.head_bytes));
    bytes.insert(bytes.end(), d.payload.begin(), d.payload.end());
    out.push_back(std::move(bytes));
    return true;
  }));
  return out;
}

Buffer counted(std::size_t size) {
  Buffer out(size);
  std::iota(out.begin(), out.end(), std::uint8_t(size));
  return out;
}

TEST(Udpm, EverySizeComesThroughWhole) {
  // Around one datagram (8 bytes of header, 3 of name) and around two fragments.
  for (const std::size_t size :
       {0u, 1u, 65'495u, 65'496u, 65'497u, 115'000u, 130'969u, 130'970u, 130'971u, 130'972u, 524'288u}) {
    const Buffer sent = counted(size);
    const auto pieces = datagrams("AB", sent, 7);
    EXPECT_EQ(pieces.size(), size <= 65'496 ? 1 : (size + 3 + 65'486) / 65'487) << size;
    udpm::Assembler assembler;
    udpm::Received got;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      EXPECT_LE(pieces[i].size(), udpm::max_datagram_bytes);
      EXPECT_EQ(assembler.add(1, pieces[i], got), i + 1 == pieces.size()) << size;
    }
    EXPECT_EQ(got.channel, "AB");
    EXPECT_EQ(Buffer(got.message.begin(), got.message.end()), sent) << size;
    EXPECT_EQ(assembler.refused(), 0u);
  }
}

TEST(Udpm, FragmentsOfSeveralSendersDoNotMix) {
  const Buffer a = counted(100'000), b = counted(150'001);
  const auto of_a = datagrams("A", a, 5), of_b = datagrams("B", b, 5);
  udpm::Assembler assembler;
  udpm::Received got;
  EXPECT_FALSE(assembler.add(1, of_a[0], got));
  EXPECT_FALSE(assembler.add(2, of_b[0], got));
  EXPECT_FALSE(assembler.add(2, of_b[1], got));
  ASSERT_TRUE(assembler.add(1, of_a[1], got));
  EXPECT_EQ(Buffer(got.message.begin(), got.message.end()), a);
  ASSERT_TRUE(assembler.add(2, of_b[2], got));
  EXPECT_EQ(Buffer(got.message.begin(), got.message.end()), b);
}

TEST(Udpm, AGapDropsTheMessageAndTheNextOneArrives) {
  const Buffer message = counted(200'000);
  udpm::Assembler assembler;
  udpm::Received got;
  const auto first = datagrams("A", message, 1), second = datagrams("A", message, 2);
  EXPECT_FALSE(assembler.add(1, first[0], got));
  for (std::size_t i = 2; i < first.size(); ++i) EXPECT_FALSE(assembler.add(1, first[i], got));
  EXPECT_EQ(assembler.refused(), first.size() - 2);
  for (std::size_t i = 0; i + 1 < second.size(); ++i) EXPECT_FALSE(assembler.add(1, second[i], got));
  EXPECT_TRUE(assembler.add(1, second.back(), got));
}

void set32(Buffer& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = std::uint8_t(value >> (24 - 8 * i));
}

TEST(Udpm, OffsetPlusSizeThatOverflowsIsRefused) {
  const auto pieces = datagrams("A", counted(100'000), 1);
  for (const std::uint32_t offset : {0xFFFFFFFFu, 0xFFFF0000u, 0x80000000u, 100'001u, 65'484u, 0u}) {
    udpm::Assembler assembler;
    udpm::Received got;
    EXPECT_FALSE(assembler.add(1, pieces[0], got));
    Buffer bad = pieces[1];
    set32(bad, 12, offset);
    EXPECT_FALSE(assembler.add(1, bad, got)) << offset;
    EXPECT_EQ(assembler.refused(), 1u);
  }
}

TEST(Udpm, SizesThatLieAreRefused) {
  const auto pieces = datagrams("A", counted(100'000), 1);
  udpm::Received got;
  for (const std::uint32_t size : {0u, 1u, 65'484u, 524'289u, 0xFFFFFFFFu}) {
    udpm::Assembler assembler;
    Buffer bad = pieces[0];
    set32(bad, 8, size);
    EXPECT_FALSE(assembler.add(1, bad, got)) << size;
    EXPECT_EQ(assembler.refused(), 1u) << size;
  }
  for (std::size_t cut = 0; cut < 22; ++cut) {  // the first fragment's header has 20 bytes, its name 2
    udpm::Assembler assembler;
    EXPECT_FALSE(assembler.add(1, Bytes(pieces[0]).first(cut), got)) << cut;
    EXPECT_EQ(assembler.refused(), 1u) << cut;
  }
}

TEST(Udpm, ManySendersNeedBoundedMemoryAndTheLastOnesGetThrough) {
  udpm::Assembler assembler;
  udpm::Received got;
  const auto pieces = datagrams("A", counted(500'000), 1);
  for (std::uint64_t sender = 0; sender < 1000; ++sender) EXPECT_FALSE(assembler.add(sender, pieces[0], got));
  int whole = 0;
  for (std::uint64_t sender = 0; sender < 1000; ++sender)
    for (std::size_t i = 1; i < pieces.size(); ++i) whole += assembler.add(sender, pieces[i], got);
  EXPECT_EQ(whole, int(udpm::Assembler::max_senders));
}

TEST(Udpm, AHundredThousandDamagedDatagramsGiveOnlyWholeMessages) {
  Random random(2026);
  udpm::Assembler assembler;
  const Buffer small = counted(500), large = counted(140'000);
  std::uint64_t given = 0, whole = 0;
  udpm::Received got;
  for (std::uint32_t sequence = 0; given < 100'000; ++sequence)
    for (Buffer& piece : datagrams("CHANNEL", sequence % 50 == 0 ? large : small, sequence)) {
      const std::uint32_t damages = random.below(4);
      for (std::uint32_t k = 0; k < damages; ++k)
        piece[random.below(std::uint32_t(std::min<std::size_t>(piece.size(), 40)))] = std::uint8_t(random.below(256));
      const bool cut_short = random.below(10) == 0;
      if (cut_short) piece.resize(random.below(std::uint32_t(piece.size() + 1)));
      ++given;
      if (!assembler.add(random.below(40), piece, got)) continue;
      ++whole;
      ASSERT_GE(got.channel.size(), 1u);
      ASSERT_LE(got.channel.size(), udpm::max_name_bytes);
      ASSERT_LE(got.message.size(), max_message_bytes);
      const Buffer copy(got.message.begin(), got.message.end());  // reads every byte: the address sanitizer watches
      if (damages == 0 && !cut_short && sequence % 50 != 0) {
        ASSERT_EQ(copy, small);
      }
    }
  EXPECT_GT(whole, given / 4);
  EXPECT_GT(assembler.refused(), given / 20);
}

}  // namespace
}  // namespace insula
