// SPDX-License-Identifier: GPL-3.0-or-later
// Contracts of supports and of their conditions.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/testing/contracts.h"
#include "core/testing/example.h"
#include "core/testing/findings.h"

namespace insula::test {
namespace {

void check_hold(Findings& findings, const Simulation& s, Support& support, const DeformableBody& body) {
  Diagnostics diagnostics;
  PrepareContext context{diagnostics, s.h()};
  std::vector<char> held(std::size_t(body.nodes()), 0), all(held.size(), 1);
  support.hold(context, body.rest_nodes(), held);
  support.hold(context, body.rest_nodes(), all);
  findings.expect(diagnostics.ok(), "hold() reports an error for its own example", diagnostics.format());
  const auto own = std::count_if(held.begin(), held.end(), [](char h) { return h != 0; });
  findings.expect(own > 0, "it holds nothing, expected one node at least");
  findings.expect(std::find(all.begin(), all.end(), 0) == all.end(), "it lets go what another support holds");
  for (std::size_t i = 0; i < held.size(); ++i)
    if (held[i])
      findings.expect(body.fixed()[i], "a node that it holds is free in its body", fmt::format("node {}", i));
}

void check_held(Findings& findings, const DeformableBody& body) {
  int moved = 0;
  for (int i = 0; i < body.nodes(); ++i) {
    const bool same = body.q().segment<3>(3 * i) == body.rest_nodes()[std::size_t(i)];
    if (body.fixed()[std::size_t(i)])
      findings.expect(same && body.v().segment<3>(3 * i).isZero(0), "a fixed node moves", fmt::format("node {}", i));
    else moved += !same;
  }
  findings.expect(moved > 0, "nothing moves in its example, so it shows nothing");
}

}  // namespace

void check_support(const std::filesystem::path& scene, const std::string& element) {
  auto s = load(scene);
  ASSERT_TRUE(s);
  Findings findings("<" + element + ">");
  int found = 0;
  for (Support* support : s->scene().all<Support>()) {
    if (support->element != element) continue;
    ++found;
    auto* body = dynamic_cast<DeformableBody*>(support->parent);
    ASSERT_TRUE(body);
    findings.at(support->id);
    check_hold(findings, *s, *support, *body);
  }
  findings.expect(found > 0, "its example holds none of it");
  run_script(*s, 40);
  for (const Body* b : s->bodies())
    if (auto* body = dynamic_cast<const DeformableBody*>(b)) {
      findings.at(body->id);
      check_held(findings, *body);
    }
}

void check_condition(const std::filesystem::path& scene, const std::string& element) {
  auto s = load(scene);
  ASSERT_TRUE(s);
  Findings findings("<" + element + ">");
  int found = 0;
  for (Condition* condition : s->scene().all<Condition>()) {
    if (condition->element != element) continue;
    ++found;
    auto* support = dynamic_cast<Support*>(condition->parent);
    ASSERT_TRUE(support);
    const auto* body = dynamic_cast<const DeformableBody*>(support->parent);
    ASSERT_TRUE(body);
    findings.at(condition->id);
    Diagnostics diagnostics;
    PrepareContext context{diagnostics, s->h()};
    std::vector<char> own(std::size_t(body->nodes()), 0), none(own.size(), 0);
    support->fix(context, body->rest_nodes(), own);
    const auto before = std::count(own.begin(), own.end(), 1);
    condition->restrict(context, body->rest_nodes(), own);
    condition->restrict(context, body->rest_nodes(), none);
    const auto after = std::count(own.begin(), own.end(), 1);
    findings.expect(diagnostics.ok(), "restrict() reports an error for its own example", diagnostics.format());
    findings.expect(after < before, "it excludes no node of its support, so its example shows nothing");
    findings.expect(std::count(none.begin(), none.end(), 1) == 0, "it adds a node that its support does not select");
  }
  findings.expect(found > 0, "its example holds none of it");
}

}  // namespace insula::test
