// SPDX-License-Identifier: GPL-3.0-or-later
// What every plugin of a kind must hold, checked on its example scene. Failures are GoogleTest failures.
// A new plugin is covered without a line of test code: tests/physics/contracts_test.cpp goes through the registry.
#pragma once
#include <filesystem>
#include <string>

namespace insula::test {

/// The scene loads without a message, runs its script and 40 steps more, stays finite, and once the hands are still its
/// energy (weight included) never exceeds what it then was by more than 1 % of the most it had.
void check_example(const std::filesystem::path& scene);
/// Same bits: twice, with one and two threads, and after reset.
void check_deterministic(const std::filesystem::path& scene);
/// Rows: ids unique and stable at rest, lambda within its law, H = derivative of the violation and of the points'
/// motion, forces and moments on moving bodies add up to nothing. Rows whose violation is zero by definition (friction,
/// plastic holds) are held to the last point only. Applies to what constraints and instruments of that element add.
void check_rows(const std::filesystem::path& scene, const std::string& element, bool rows_expected);

/// Force = -dE/dx to 1e-7, exact tangent = -df/dx to 1e-6, both with the promised damping factor; the step's tangent is
/// symmetric and has no negative eigenvalue. Of models that say internal(): rigid motion gives no force (1e-10), forces
/// and moments add up to nothing.
void check_force_model(const std::filesystem::path& scene, const std::string& element);
/// A rigid body that is no instrument (jaws on a hinge): H of a point of any link is the derivative of its position, and its rows hold
/// the contract of rows.
void check_rigid_body(const std::filesystem::path& scene, const std::string& element);
/// Holds at least one node, holds it to the bit, and leaves others free.
void check_support(const std::filesystem::path& scene, const std::string& element);
/// The free tool follows the hand; coupling force = stiffness times displacement; its terms for the haptic loop are
/// symmetric, positive and predict where the free tool goes for another device pose.
void check_instrument(const std::filesystem::path& scene, const std::string& element);
/// Points of every surface follow their body: rest shape, rigid motion, and H = derivative of the position.
void check_surfaces(const std::filesystem::path& scene);
/// The state's hash is the same with and without the exercise; goals and faults have unique ids; reset clears them.
void check_exercise_rule(const std::filesystem::path& scene, const std::string& element);


/// Those of the above that the element's kind asks for, on its plugin's example.
void check_element(const std::filesystem::path& scene, const std::string& element);

}  // namespace insula::test
