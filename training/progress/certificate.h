// SPDX-License-Identifier: GPL-3.0-or-later
// The certificate of a curriculum that was passed: what was asked, when it was met, and by which runs. It is a record
// of training on one machine, and no licence to operate.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "training/curriculum/evaluate.h"
#include "training/store/store.h"

namespace insula::training {

struct CertifiedTask {
  std::string module, title;  ///< titles
  std::vector<Gate> gates;
  int attempts_to_level = 0;   ///< until it was passed for the first time
  std::int64_t passed_ms = 0;  ///< when it was passed last; UTC, since 1970-01-01
  std::vector<Run> runs;       ///< those that counted, in order of time
};

struct Certificate {
  std::string person, curriculum;            ///< pseudonym and title
  std::string content;                       ///< hash of the curriculum's text, hexadecimal
  std::int64_t began_ms = 0, passed_ms = 0;  ///< first run that counted, and when the last task was passed
  std::vector<CertifiedTask> tasks;
  std::string digest;  ///< certificate_digest() of all of its runs
};

/// None unless all tasks stand as passed or due.
std::optional<Certificate> certificate(const Store& store, const std::string& person, const Curriculum& curriculum,
                                       const Progress& progress);

/// The first 64 bits of the SHA-256 of pseudonym, curriculum's hash and ids of the runs, a line each, in groups of four
/// hexadecimal digits. The ids are sorted, and each counts once. Whoever has the store computes it again.
std::string certificate_digest(const std::string& person, const std::string& content, std::vector<std::string> runs);

/// version: of the program that issues it.
nlohmann::ordered_json certificate_json(const Certificate& certificate, std::string_view version);

}  // namespace insula::training
