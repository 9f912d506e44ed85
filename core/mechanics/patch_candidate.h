// SPDX-License-Identifier: GPL-3.0-or-later
// What a contact constraint offers to the haptic problem: the triangles of a surface near a tool in a hand, and the law
// of their contacts. core/haptics/surface_patch_builder.h makes patches of them.
#pragma once
#include <vector>

#include "core/constraint/surface_patch.h"

namespace insula {

class RigidBody;
class Surface;

struct PatchCandidate {
  struct Triangle {
    int triangle;  ///< of the surface
    double
        clear_m;  ///< smallest distance to the tool at the step's end and on its way ahead; at most 0 if it is touched
  };
  struct Contact {
    int row;  ///< first of the three rows of a friction contact in the last step's problem
    int piece;
    int triangle;
    Vec3 bary;
  };
  const Surface* surface = nullptr;
  const RigidBody* tool = nullptr;
  SurfacePatch law;                ///< without tool and ranges
  std::vector<PatchPiece> pieces;  ///< near the surface, with ranges of `core`
  std::vector<Vec3> core;          ///< tool frame, m
  std::vector<Triangle> triangles;
  std::vector<Contact> contacts;
};

}  // namespace insula
