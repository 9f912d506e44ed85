// SPDX-License-Identifier: GPL-3.0-or-later
// Contracts of whole scenes: bounded, deterministic, without allocations.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/registry/surgeon_requests.h"
#include "core/testing/contracts.h"
#include "core/testing/count_allocations.h"
#include "core/testing/example.h"
#include "core/testing/findings.h"

namespace insula::test {
namespace {

std::string name_of(const std::filesystem::path& scene) {
  return (scene.parent_path().filename() / scene.filename()).string();
}

/// What the surgeon asks for is a command of the component, and its usual number lies in the command's range.
void check_requests(Findings& findings, const Component& component) {
  const auto* takes = dynamic_cast<const TakesSurgeonRequests*>(&component);
  if (!takes) return;
  const std::vector<CommandInfo> commands = component.commands();
  for (const SurgeonRequest& r : takes->surgeon_requests()) {
    const auto named =
        std::find_if(commands.begin(), commands.end(), [&](const CommandInfo& c) { return c.name == r.command; });
    findings.expect(named != commands.end(), "a request that is no command", r.command);
    if (named != commands.end())
      findings.expect(named->min <= r.usual && r.usual <= named->max, "a usual number out of the command's range",
                      fmt::format("{} {}", r.command, r.usual));
  }
}

/// Kinetic, elastic, coupling energy and weight.
double total_energy(const Simulation& s) {
  double e = s.energy();
  for (const Body* b : s.bodies())
    if (auto* soft = dynamic_cast<const DeformableBody*>(b))
      for (int i = 0; i < soft->nodes(); ++i)
        e -= soft->node_mass()[std::size_t(i)] *
             s.scene().gravity().dot(soft->q().segment<3>(3 * i) - soft->rest_nodes()[std::size_t(i)]);
  return e;
}

bool check_finite(Findings& findings, const Simulation& s) {
  bool good = findings.expect(s.report().finite, "the step's result is not finite");
  for (const Body* b : s.bodies())
    if (auto* soft = dynamic_cast<const DeformableBody*>(b)) {
      good =
          findings.expect(soft->q().allFinite() && soft->v().allFinite(), "a body's state is not finite", soft->id) &&
          good;
      findings.expect(soft->indefinite_steps() == 0, "a body's matrix is indefinite", soft->id);
    }
  return good;
}

/// The parts of a step's problem that do not depend on W: ids, laws and their order, violations, solution.
struct ProblemBits {
  std::vector<Block> blocks;
  std::vector<double> numbers;
  explicit ProblemBits(const Simulation& s) : blocks(s.problem().blocks), numbers(s.problem().delta_free) {
    numbers.insert(numbers.end(), s.problem().lambda.begin(), s.problem().lambda.end());
  }
  bool same_numbers(const ProblemBits& o) const {
    return numbers.size() == o.numbers.size() &&
           (numbers.empty() || std::memcmp(numbers.data(), o.numbers.data(), numbers.size() * sizeof(double)) == 0);
  }
};

struct Bits {
  std::uint64_t state;
  ProblemBits problem;
  explicit Bits(const Simulation& s) : state(s.state_hash()), problem(s) {}
};

/// One line for the first difference. False if there is one.
bool compare(Findings& findings, const Bits& a, const Bits& b, const std::string& what, const std::string& step) {
  if (!findings.expect(a.problem.blocks == b.problem.blocks, what + " has other rows: other ids, laws or order", step))
    return false;
  return findings.expect(a.state == b.state && a.problem.same_numbers(b.problem), what + " differs in its bits", step);
}

}  // namespace

void check_example(const std::filesystem::path& scene) {
  auto s = load(scene);
  ASSERT_TRUE(s);
  Findings findings(name_of(scene));
  for (const Component* c : s->scene().components()) check_requests(findings, *c);
  const int n = int(std::lround(script_length / s->h()));
  double most = 0, still = 0;
  for (int i = 0; i < n + 40; ++i) {
    run_script(*s, 1);
    findings.at(fmt::format("step {}", i));
    if (!check_finite(findings, *s)) return;
    const double e = total_energy(*s);
    most = std::max(most, std::abs(e));
    if (i == n) still = e;  // the first step with hands at rest, after which no energy is added
    if (i > n)
      findings.expect(e <= still + 0.01 * most + 1e-15, "energy grows while the hands are still",
                      fmt::format("{:.4g} J, at first {:.4g} J", e, still));
  }
}

void check_deterministic(const std::filesystem::path& scene) {
  const auto load_in = [&](OrderedHeap::Order order) {  // results that depend on the order of pointers differ
    const OrderedHeap heap(order);
    return load(scene, 1);
  };
  auto one = load_in(OrderedHeap::ascending), again = load_in(OrderedHeap::descending);
  auto two = load(scene, 2);
  ASSERT_TRUE(one && again && two);
  Findings findings(name_of(scene));
  const std::uint64_t start = one->state_hash();
  findings.expect(again->state_hash() == start, "a second load differs in its bits");
  std::vector<Bits> bits;
  for (int i = 0; i < 75; ++i) {
    for (Simulation* s : {one.get(), again.get(), two.get()}) run_script(*s, 1);
    bits.emplace_back(*one);
    const std::string step = fmt::format("step {}", i);
    if (!compare(findings, Bits(*again), bits.back(),
                 "a second run (loaded after the first, its memory in another order)", step))
      return;
    if (!compare(findings, Bits(*two), bits.back(), "a run with two threads", step)) return;
  }
  one->reset();
  findings.expect(one->state_hash() == start, "reset() does not lead back to the start: the state's bits differ");
  for (std::size_t i = 0; i < bits.size(); ++i) {
    run_script(*one, 1);
    if (!compare(findings, Bits(*one), bits[i], "the run after reset()", fmt::format("step {}", i))) return;
  }
}

void check_allocations(const std::filesystem::path& scene) {
  auto s = load(scene, 2);
  ASSERT_TRUE(s);
  Findings findings(name_of(scene));
  run_script(*s, 80);  // reaches the largest problem; alternating buffers reach it twice
  s->reset();
  for (int i = 0; i < 70; ++i) {
    drive(*s);
    const long before = allocations;
    s->step();
    const long count = allocations - before;
    if (s->events().empty())
      findings.expect(count == 0, "a step allocates memory, expected none once it has seen its largest problem",
                      fmt::format("{} times in step {}", count, i));
  }
}

}  // namespace insula::test
