// SPDX-License-Identifier: GPL-3.0-or-later
// A block of rows and its law. It does not include Eigen, since the sweep's kernels are compiled once per instruction
// set.
#pragma once
#include <array>
#include <cstdint>
#include <limits>

namespace insula {

inline constexpr double infinite = std::numeric_limits<double>::infinity();

/// Law that relates delta and lambda on a block of rows.
enum class LawKind : std::uint8_t {
  box,       ///< one row: lambda in [lower, upper]; inside the bounds delta + compliance * lambda = 0.
             ///< bilateral: c = 0, no bounds; compliant: c > 0; contact without friction: c = 0, [0, inf);
             ///< a fibre that carries tension only: c = 1/k, (-inf, 0]
  friction,  ///< three rows (normal, tangent, tangent): Signorini on the normal, Coulomb on the tangents
  patch,  ///< two rows (tangent, tangent) that the `normals` one-row blocks before it share: |lambda_t| <= friction *
          ///< the sum of their lambda, opposing slip (many contacts close together, one friction force)
};

/// What a block of rows stands for. The solver does not use it. Readers of a problem may.
enum class BlockRole : std::uint8_t {
  other,     ///< none of the roles below
  contact,   ///< two surfaces that may not overlap
  friction,  ///< friction force that several contacts share
  fibre,     ///< a spring or fibre between two points
  weld,      ///< one of six bilateral rows that make a tool and a rigid body without other support one body
  grip,      ///< a bounded hold of tissue: suction, forceps
  stop,      ///< the end of the range of a joint or of a motion
  pressure,  ///< fluid in a closed wall
  surface,   ///< displacement of a surface's vertex, without a force of its own (core/constraint/surface_patch.h)
  last = surface,
};

struct Block {
  std::uint64_t id = 0;     ///< stable from step to step, unique in a problem: the warm start's key
  std::int32_t owner = -1;  ///< document order of the component that added it; ConstraintBuilder fills it in; -1: none
  BlockRole role = BlockRole::other;
  int row = 0;  ///< first row
  LawKind law = LawKind::box;
  double compliance = 0;     ///< m/N, >= 0; for friction blocks on the normal row
  double lower = -infinite;  ///< N, box only
  double upper = infinite;   ///< N, box only
  double friction = 0;       ///< Coulomb coefficient, friction and patch blocks only
  int normals = 0;           ///< number of one-row blocks before this one that share the patch, patch only
  /// For use between steps: rotation vector, rad, of a friction block's directions about its contact point while the
  /// tool moves on by its displacement in the step.
  std::array<float, 3> frame_rotation{};
  // For use between steps: failure of a box row, which then bears nothing. The engine's components fail by themselves.
  /// Blocks of the same group fail together, such as a fibre and the blade in it; 0: the block fails alone.
  std::int32_t failure_group = 0;
  /// Displacement since the step began at which the row fails, m; 0: at none. Such a row is rigid-plastic: it resists
  /// every further displacement instead of that since the step began. The share that is left of this displacement is
  /// the integrity of its group, which divides the others' compliance and multiplies their failure_force.
  float failure_travel = 0;
  float failure_force = 0;  ///< |lambda| above which the row fails, N; 0: it bears any
  bool operator==(const Block&) const = default;
  int rows() const { return law == LawKind::friction ? 3 : law == LawKind::patch ? 2 : 1; }
};

}  // namespace insula
