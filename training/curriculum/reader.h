// SPDX-License-Identifier: GPL-3.0-or-later
// From the expanded text of a curriculum to its elements: names, places, parameters, ids, references and files.
#pragma once
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "core/scene/expand.h"
#include "training/curriculum/elements.h"

namespace insula {

class CurriculumReader {
 public:
  /// shipped: CurriculumSources::shipped_folder().
  CurriculumReader(ExpandedScene& tree, std::filesystem::path shipped, Diagnostics& diagnostics)
      : tree_(tree), shipped_(std::move(shipped)), diagnostics_(diagnostics) {}

  /// Null if the root is no curriculum. Everything that is wrong is reported.
  std::unique_ptr<CurriculumRoot> read();
  /// Whether something is wrong with an element. What depends on it would only report consequences.
  bool failed(const CurriculumElement& element) const { return failed_.contains(&element); }
  void report(const CurriculumElement& element, const SourcePos& pos, std::string text);

 private:
  void fill(const Element& from, const CurriculumElementInfo& info, CurriculumElement& into);
  void read_id(const Element& from, const CurriculumElementInfo& info, CurriculumElement& into);
  void add_child(const Element& from, CurriculumElement& parent);
  void unknown(const Element& from, const CurriculumElement& parent);
  void lose_ids(const Element& from);
  void resolve_all(CurriculumElement& element);
  void resolve(CurriculumElement& element, RefParamBase& reference);
  void find_file(CurriculumElement& element, Param<File>& file);
  std::string missing(const RefParamBase& reference, const std::string& id);

  ExpandedScene& tree_;
  std::filesystem::path shipped_;
  Diagnostics& diagnostics_;
  std::map<std::string, CurriculumElement*, std::less<>> by_id_;
  std::set<std::string, std::less<>> lost_ids_;  ///< of elements that could not be read
  std::set<const CurriculumElement*> failed_;
};

}  // namespace insula
