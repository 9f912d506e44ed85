// SPDX-License-Identifier: GPL-3.0-or-later
// Patches in the haptic problem's wire format: contacts of one row each, then the friction force that they share.
#include <functional>

#include "core/bus/mutate_for_test.h"
#include "core/haptics/haptic_update_for_test.h"

namespace insula {
namespace {

using testing::Buffer;
using testing::encoded;
using testing::make_update;

/// Rows: a spring, three contacts, their patch (two rows), a contact with friction (three rows), one contact, its
/// patch.
enum : std::size_t { spring, contact, patch = 4, friction, last_contact, last_patch };

HapticUpdate patch_update(unsigned seed) {
  HapticUpdate u = make_update(seed, 12, 0, 2);
  ConstraintProblem& p = u.problem;
  p.blocks.clear();
  int row = 0;
  const auto add = [&](LawKind law, int normals) {
    Block b;
    b.id = 0xabcd000000000000u + std::uint64_t(row);
    b.row = row;
    b.law = law;
    b.normals = normals;
    if (law == LawKind::box) b.lower = 0;
    else b.friction = double(0.4f);
    row += b.rows();
    p.blocks.push_back(b);
  };
  add(LawKind::box, 0);
  p.blocks[spring].lower = -infinite;
  p.blocks[spring].compliance = double(0.02f);
  for (int i = 0; i < 3; ++i) add(LawKind::box, 0);
  add(LawKind::patch, 3);
  add(LawKind::friction, 0);
  add(LawKind::box, 0);
  add(LawKind::patch, 1);
  EXPECT_EQ(row, p.rows);
  p.lambda = {-0.2, 0.1, 0.0, 0.2, 0.08, -0.08, 0.5, 0.1, 0.1, 0.3, -0.1, 0.05};
  return u;
}

TEST(HapticPatch, RoundTripIsExact) {
  const HapticUpdate sent = patch_update(3);
  const Buffer bytes = encoded(sent);
  HapticUpdate got = make_update(9);
  std::string why;
  ASSERT_TRUE(decode_problem(bytes, got, why)) << why;
  testing::expect_equal(sent, got);
  EXPECT_EQ(got.problem.blocks[patch].law, LawKind::patch);
  EXPECT_EQ(got.problem.blocks[patch].normals, 3);
  EXPECT_EQ(got.problem.blocks[last_patch].normals, 1);
  const auto message = testing::expect_generated_form(bytes);
  EXPECT_EQ(message.block_law[patch], 2);
  EXPECT_EQ(message.block_normals[patch], 3);
  EXPECT_EQ(message.block_normals[contact], 0);
}

// With a rule broken, the message is refused for that reason and what was there before stays.
TEST(HapticPatch, WhatIsNoPatchIsRefused) {
  struct Fault {
    const char* name;
    std::function<void(HapticUpdate&)> make;
    const char* reason;
  };
  const auto normals = [](std::size_t block, int value) {
    return [=](HapticUpdate& u) { u.problem.blocks[block].normals = value; };
  };
  const char* none = "a patch without the contacts it is of";
  const std::vector<Fault> faults = {
      {"negative", normals(patch, -1), none},
      {"most negative", normals(patch, -32768), none},
      {"no contacts", normals(patch, 0), none},
      {"a contact with normals", normals(contact, 1), none},
      {"a friction block with normals", normals(friction, 1), none},
      {"a box with negative normals", normals(spring, -1), none},
      {"more than are before it", normals(patch, 5), none},
      {"far more", normals(patch, 32767), none},
      {"of a friction block too", normals(last_patch, 2), none},
      {"of another patch too", normals(last_patch, 4), none},
      {"a first block that is a patch",
       [](HapticUpdate& u) {
         u.problem.blocks.erase(u.problem.blocks.begin());
         std::swap(u.problem.blocks[0], u.problem.blocks[3]);
       },
       none},
      {"of a row of a surface", [](HapticUpdate& u) { u.problem.blocks[contact].role = BlockRole::surface; }, none},
      {"law 3", [](HapticUpdate& u) { u.problem.blocks[patch].law = LawKind(3); }, "unknown law"},
      {"law -1", [](HapticUpdate& u) { u.problem.blocks[contact].law = LawKind(255); }, "unknown law"},
      {"negative friction", [](HapticUpdate& u) { u.problem.blocks[patch].friction = -0.1; }, "friction out of range"},
      {"outside the disc", [](HapticUpdate& u) { u.problem.lambda[5] = 0.1; }, "lambda outside its law"},
      {"friction of nothing", [](HapticUpdate& u) { u.problem.lambda[9] = 0; }, "lambda outside its law"},
      {"one row of two", [](HapticUpdate& u) { u.problem.blocks[friction].row -= 1; }, "cover the rows"},
  };
  const HapticUpdate before = make_update(9);
  for (const Fault& fault : faults) {
    HapticUpdate u = patch_update(4), into = before;
    std::string why;
    ASSERT_TRUE(decode_problem(encoded(u), into, why)) << why;
    into = before;
    fault.make(u);
    EXPECT_FALSE(decode_problem(encoded(u), into, why)) << fault.name;
    EXPECT_NE(why.find(fault.reason), std::string::npos) << fault.name << ": " << why;
    testing::expect_equal(before, into);
  }
}

TEST(HapticPatch, EveryTruncationIsRefused) {
  const Buffer whole = encoded(patch_update(1));
  HapticUpdate into = make_update(2);
  for (std::size_t n = 0; n < whole.size(); ++n) {
    std::string why;
    const Buffer cut(whole.begin(), whole.begin() + std::ptrdiff_t(n));
    ASSERT_FALSE(decode_problem(cut, into, why)) << n;
  }
}

TEST(HapticPatch, RandomDamageNeverGetsThroughUnseen) {
  const Buffer whole = encoded(patch_update(1));
  HapticUpdate into = make_update(2, 2, 1, 2);
  Buffer before = encoded(into), now;
  testing::Mutator mutate(77);
  int accepted = 0;
  std::string why;
  for (int i = 0; i < 50'000; ++i) {
    Buffer damaged = mutate(whole);
    seal_problem(damaged);
    const bool ok = decode_problem(damaged, into, why);
    ASSERT_TRUE(encode_problem(into, now));
    ASSERT_EQ(now, ok ? damaged : before);
    if (!ok) continue;
    ++accepted;
    ASSERT_NO_FATAL_FAILURE(testing::expect_sane(into));
    before = now;
  }
  EXPECT_GT(accepted, 0);
  EXPECT_LT(accepted, 40'000);
}

}  // namespace
}  // namespace insula
