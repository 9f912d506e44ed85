// SPDX-License-Identifier: GPL-3.0-or-later
// The constraint problem of the last step as a value: delta = W lambda + delta_free and the laws of its rows.
#include <fmt/format.h>

#include "core/constraint/solve.h"
#include "python/src/bind.h"

namespace insula::python {
namespace {

struct ProblemValue {
  ConstraintProblem problem;
  std::vector<std::string> owners;  ///< id of the component of each block
};

struct BlockValue {
  Block block;
  std::string owner;
};

const char* name_of(LawKind law) {
  switch (law) {
    case LawKind::box: return "box";
    case LawKind::friction: return "friction";
    case LawKind::patch: return "patch";
  }
  return "";
}

const char* name_of(BlockRole role) {
  switch (role) {
    case BlockRole::other: return "other";
    case BlockRole::contact: return "contact";
    case BlockRole::friction: return "friction";
    case BlockRole::fibre: return "fibre";
    case BlockRole::weld: return "weld";
    case BlockRole::grip: return "grip";
    case BlockRole::stop: return "stop";
    case BlockRole::pressure: return "pressure";
    case BlockRole::surface: return "surface";
  }
  return "";
}

ProblemValue problem_of(Run& run) {
  const Run::Turn turn(run);
  ProblemValue out{run.simulation().problem(), {}};
  for (const Block& b : out.problem.blocks) {
    std::string owner;
    for (const Component* c : run.simulation().scene().components())
      if (c->order == b.owner) owner = c->id;
    out.owners.push_back(std::move(owner));
  }
  return out;
}

std::vector<BlockValue> blocks_of(const ProblemValue& p) {
  std::vector<BlockValue> out;
  for (std::size_t i = 0; i < p.problem.blocks.size(); ++i) out.push_back({p.problem.blocks[i], p.owners[i]});
  return out;
}

using Numbers = nb::ndarray<const double, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

std::pair<Array<double>, Array<double>> solve_again(const ProblemValue& p, std::optional<Numbers> delta_free,
                                                    int max_sweeps, double tolerance, int max_newton) {
  std::vector<double> free = p.problem.delta_free;
  if (delta_free) {
    if (delta_free->size() != free.size())
      throw std::invalid_argument("delta_free needs " + std::to_string(free.size()) + " numbers");
    free.assign(delta_free->data(), delta_free->data() + delta_free->size());
  }
  SolveSettings settings;
  settings.max_sweeps = max_sweeps;
  settings.tolerance_m = tolerance;
  settings.max_newton = max_newton;
  SolveWorkspace workspace;
  workspace.reserve(p.problem.rows, max_newton > 0);
  workspace.lambda.assign(p.problem.lambda.begin(), p.problem.lambda.end());
  solve(p.problem, free, settings, workspace);
  workspace.delta.resize(std::size_t(p.problem.rows));
  return {numbers_of(workspace.lambda), numbers_of(workspace.delta)};
}

Array<const double> values_of(nb::handle owner, const std::vector<double>& v) {
  return view(v.data(), {v.size()}, owner);
}

Array<double> square_of(const Mat6& m) {
  Array<double> out = array<double>({6, 6});
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(out.data()) = m;
  return out;
}

void bind_block(nb::module_& m) {
  nb::class_<BlockValue>(m, "Block", "One row, three rows of a contact with friction, or two rows of a patch.")
      .def_prop_ro(
          "id", [](const BlockValue& b) { return b.block.id; }, "The same from step to step.")
      .def_ro("owner", &BlockValue::owner, "Id of the component that added it.")
      .def_prop_ro(
          "role", [](const BlockValue& b) { return name_of(b.block.role); }, "What it stands for.")
      .def_prop_ro(
          "law", [](const BlockValue& b) { return name_of(b.block.law); }, "\"box\", \"friction\", \"patch\".")
      .def_prop_ro(
          "row", [](const BlockValue& b) { return b.block.row; }, "Its first row.")
      .def_prop_ro(
          "rows", [](const BlockValue& b) { return b.block.rows(); }, "Number of its rows.")
      .def_prop_ro(
          "compliance", [](const BlockValue& b) { return b.block.compliance; }, "m/N.")
      .def_prop_ro(
          "lower", [](const BlockValue& b) { return b.block.lower; }, "Least lambda of a box, N.")
      .def_prop_ro(
          "upper", [](const BlockValue& b) { return b.block.upper; }, "Largest lambda of a box, N.")
      .def_prop_ro(
          "friction", [](const BlockValue& b) { return b.block.friction; }, "Coulomb's coefficient.")
      .def("__repr__",
           [](const BlockValue& b) { return std::string("<Block ") + name_of(b.block.role) + " of " + b.owner + ">"; });
}

void bind_tool_terms(nb::module_& m) {
  nb::class_<ToolTerms>(m, "ToolTerms", "A tool in a hand, with its part in the rows of a problem.")
      .def_prop_ro(
          "hand", [](const ToolTerms& t) { return std::string(hand_name(t.hand)); }, "The hand.")
      .def_prop_ro(
          "jacobian",
          [](const ToolTerms& t) {
            Array<double> out = array<double>({std::size_t(t.jacobian.rows()), 6});
            std::copy_n(t.jacobian.data(), t.jacobian.size(), out.data());
            return out;
          },
          as_array, "Derivative of the rows by the tool's position (m) and rotation vector (rad).")
      .def_prop_ro(
          "compliance", [](const ToolTerms& t) { return square_of(t.compliance); }, as_array, "Inverse of its matrix.")
      .def_prop_ro(
          "stiffness", [](const ToolTerms& t) { return square_of(t.stiffness); }, as_array, "Of the coupling spring.")
      .def_prop_ro(
          "device", [](const ToolTerms& t) { return tuple_of(t.device); }, "Pose of the device.")
      .def_prop_ro(
          "free", [](const ToolTerms& t) { return tuple_of(t.free); }, "Pose after the free motion.")
      .def("__repr__", [](const ToolTerms& t) { return fmt::format("<ToolTerms of the {} hand>", hand_name(t.hand)); });
}

}  // namespace

void bind_problem(nb::module_& m, RunClass& run) {
  bind_block(m);
  bind_tool_terms(m);
  nb::class_<ProblemValue>(m, "ConstraintProblem",
                           "The constraint problem of a step as a value. Later steps do not change it.")
      .def_prop_ro(
          "rows", [](const ProblemValue& p) { return p.problem.rows; }, "Number of rows.")
      .def_prop_ro(
          "W",
          [](nb::handle self) {
            const ConstraintProblem& p = nb::cast<const ProblemValue&>(self).problem;
            const std::array<std::size_t, 2> shape{std::size_t(p.rows), std::size_t(p.rows)};
            const std::array<std::int64_t, 2> strides{p.stride, 1};
            return Array<const double>(p.w.data(), 2, shape.data(), self, strides.data());
          },
          as_array, "View of the compliance of the rows, symmetric, m/N.")
      .def_prop_ro(
          "delta_free",
          [](nb::handle self) { return values_of(self, nb::cast<const ProblemValue&>(self).problem.delta_free); },
          as_array, "View of the violations without forces, m.")
      .def_prop_ro(
          "lambda_",
          [](nb::handle self) { return values_of(self, nb::cast<const ProblemValue&>(self).problem.lambda); }, as_array,
          "View of the forces that solve it, N.")
      .def_prop_ro("blocks", &blocks_of, "Blocks of rows, in the order of the rows.")
      .def_prop_ro(
          "tools", [](const ProblemValue& p) { return p.problem.tools; }, "The tools in the hands.")
      .def("solve", &solve_again, "delta_free"_a.none() = nb::none(), "max_sweeps"_a = 200, "tolerance"_a = 1e-9,
           "max_newton"_a = 0,
           "Solves the problem, with other free violations if they are given: lambda (N) and delta (m).")
      .def("__repr__", [](const ProblemValue& p) {
        return fmt::format("<ConstraintProblem of {} rows in {} blocks>", p.problem.rows, p.problem.blocks.size());
      });
  run.def_prop_ro("problem", &problem_of, "The constraint problem of the last step, with its solution.");
}

}  // namespace insula::python
