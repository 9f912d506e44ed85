// SPDX-License-Identifier: GPL-3.0-or-later
// Contracts that every plugin of a kind must satisfy, checked on its example scene. A new plugin needs no test code for
// this, since tests/physics/contracts_test.cpp goes through the registry. Each violated law is one GoogleTest failure
// of one line (findings.h). INSULA_CONTRACT_DETAIL=1 shows every occurrence. tests/contracts/ shows that wrong plugins
// are detected.
#pragma once
#include <filesystem>
#include <string>

namespace insula::test {

/// The scene loads without a message, runs its script and 40 more steps, and stays finite. Once the hands are still,
/// its energy (weight included) never exceeds its value at that moment by more than 1 % of its maximum. What the
/// surgeon may ask for are commands of their components, with usual numbers in range.
void check_example(const std::filesystem::path& scene);
/// Equal bits of states and problems in two runs, with opposite orders of the heap, with one and two threads, and after
/// reset.
void check_deterministic(const std::filesystem::path& scene);
/// A step that has seen its largest problem allocates nothing, except for the events and messages that it emits.
void check_allocations(const std::filesystem::path& scene);
/// Checks the rows of a component of that element:
///   - Ids are its own, unique, and stable at rest. Numbers are finite, bounds are in order, lambda is within its law.
///   - H = derivative of the violation. Contacts are compared at small gaps, and open gaps are closed for it.
///   - Forces and moments on moving bodies sum to zero.
///   - The rows' force is that of the law that the component states (core/constraint/stated_law.h), on both sides of
///     the point where it begins to act. A unilateral law has no force between bodies that are far apart.
///   - A row that moves by itself declares its rate. The state of the rows is in append_state() and undone by reset().
/// Rows whose violation is zero by definition (friction, plastic holds) are checked for ids, numbers and balance only.
void check_rows(const std::filesystem::path& scene, const std::string& element, bool rows_expected);

/// Force = -dE/dx to 1e-7 and exact tangent = -df/dx to 1e-6, both with the declared damping factor. The step's tangent
/// is symmetric and has no negative eigenvalue. If the model says internal(), rigid motion gives no force (1e-10), and
/// forces and moments sum to zero. The state that finish() changes is in append_state() and undone by reset(). If the
/// model has a damping of its own, that is minus the derivative of the force by velocity to 1e-6 and symmetric without
/// negative eigenvalues, and the force dissipates energy.
void check_force_model(const std::filesystem::path& scene, const std::string& element);
/// A rigid body that is no instrument: H of a point of any link is the derivative of its position, and its rows satisfy
/// the contract of rows.
void check_rigid_body(const std::filesystem::path& scene, const std::string& element);
/// Fixes at least one node exactly, leaves others free, and keeps nodes that another support fixes.
void check_support(const std::filesystem::path& scene, const std::string& element);
/// Excludes a node of the support that owns it, and adds none.
void check_condition(const std::filesystem::path& scene, const std::string& element);
/// The free tool follows the hand, and the coupling force is stiffness times displacement. Its terms for the haptic
/// loop are symmetric and positive, and predict the free pose for another device pose.
void check_instrument(const std::filesystem::path& scene, const std::string& element);
/// Points of every surface follow their body in rest shape and rigid motion, and H is the derivative of the position.
void check_surfaces(const std::filesystem::path& scene);
/// The state's hash is the same with and without the exercise. Goals and faults have unique ids. After reset the same
/// run gives the same goals, faults, timers and measures.
void check_exercise_rule(const std::filesystem::path& scene, const std::string& element);

/// Metrics have unique ids, a text, a source, and finite values or none. They are a function of the reports: evaluate()
/// neither writes state nor changes later values, and after reset the same run gives the same values.
void check_metric(const std::filesystem::path& scene, const std::string& element);

/// The contracts above that apply to the element's kind, on its plugin's example.
void check_element(const std::filesystem::path& scene, const std::string& element);

}  // namespace insula::test
