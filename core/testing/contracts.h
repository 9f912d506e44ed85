// SPDX-License-Identifier: GPL-3.0-or-later
// What every plugin of a kind must hold, checked on its example scene. A new plugin is covered without a line of test
// code: tests/physics/contracts_test.cpp goes through the registry. Each broken law is one GoogleTest failure of one
// line (findings.h); INSULA_CONTRACT_DETAIL=1 shows every place. tests/contracts/ shows that wrong plugins are caught.
#pragma once
#include <filesystem>
#include <string>

namespace insula::test {

/// The scene loads without a message, runs its script and 40 steps more, stays finite, and once the hands are still its
/// energy (weight included) never exceeds what it then was by more than 1 % of the most it had.
void check_example(const std::filesystem::path& scene);
/// Same bits of states and of problems: twice, from a heap that is upside down, with one and two threads, and after
/// reset.
void check_deterministic(const std::filesystem::path& scene);
/// A step that has seen its largest problem allocates nothing, except for the events and messages that it emits.
void check_allocations(const std::filesystem::path& scene);
/// Rows of a component of that element:
///   - ids are its own, unique, and stable at rest; numbers are finite, bounds in order, lambda within its law;
///   - H = derivative of the violation. Contacts are compared at small gaps, and open gaps are closed for it;
///   - forces and moments on moving bodies add up to nothing;
///   - the rows' force is that of the law that the component states (core/constraint/stated_law.h), on both sides of
///     the point where it begins to act; what only pushes does nothing between bodies that are far apart;
///   - a row that moves by itself declares its rate; what the rows remember is in append_state() and undone by reset().
/// Rows whose violation is zero by definition (friction, plastic holds) are held to the points on ids, numbers and
/// balance.
void check_rows(const std::filesystem::path& scene, const std::string& element, bool rows_expected);

/// Force = -dE/dx to 1e-7, exact tangent = -df/dx to 1e-6, both with the promised damping factor; the step's tangent is
/// symmetric and has no negative eigenvalue. Of models that say internal(): rigid motion gives no force (1e-10), forces
/// and moments add up to nothing. What finish() changes is in append_state() and undone by reset().
/// Of models with a damping of their own: damping = minus force gradient by velocity to 1e-6, symmetric, without
/// negative eigenvalues, and the force takes energy out.
void check_force_model(const std::filesystem::path& scene, const std::string& element);
/// A rigid body that is no instrument: H of a point of any link is the derivative of its position, and its
/// rows hold the contract of rows.
void check_rigid_body(const std::filesystem::path& scene, const std::string& element);
/// Holds at least one node, holds it to the bit, leaves others free, and lets no node go that another support holds.
void check_support(const std::filesystem::path& scene, const std::string& element);
/// The free tool follows the hand; coupling force = stiffness times displacement; its terms for the haptic loop are
/// symmetric, positive and predict where the free tool goes for another device pose.
void check_instrument(const std::filesystem::path& scene, const std::string& element);
/// Points of every surface follow their body: rest shape, rigid motion, and H = derivative of the position.
void check_surfaces(const std::filesystem::path& scene);
/// The state's hash is the same with and without the exercise; goals and faults have unique ids; after reset the same
/// run gives the same goals, faults, timers and measures.
void check_exercise_rule(const std::filesystem::path& scene, const std::string& element);

/// Those of the above that the element's kind asks for, on its plugin's example.
void check_element(const std::filesystem::path& scene, const std::string& element);

}  // namespace insula::test
