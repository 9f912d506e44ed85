// SPDX-License-Identifier: GPL-3.0-or-later
// Collection and output of errors; search for the name that was meant.
#include "core/base/diagnostic.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "core/base/text.h"

namespace insula {

void Diagnostics::error(const SourcePos& pos, std::string text) {
  all_.push_back({Severity::error, pos, std::move(text)});
  ++errors_;
}

void Diagnostics::warning(const SourcePos& pos, std::string text) {
  all_.push_back({Severity::warning, pos, std::move(text)});
}

std::string Diagnostics::format() const {
  std::string out;
  std::set<std::string> seen;
  for (const auto& d : all_) {
    std::string line;
    if (!d.pos.file.empty()) {
      line += d.pos.file;
      if (d.pos.line > 0) line += ':' + std::to_string(d.pos.line);
      if (d.pos.line > 0 && d.pos.column > 0) line += ':' + std::to_string(d.pos.column);
      line += ": ";
    }
    line += d.severity == Severity::error ? "error: " : "warning: ";
    line += d.text;
    line += '\n';
    if (seen.insert(line).second) out += line;
  }
  return out;
}

void Diagnostics::sort_by_position() {
  std::vector<std::string> files;
  const auto rank = [&](const std::string& file) {
    const auto it = std::find(files.begin(), files.end(), file);
    if (it != files.end()) return static_cast<std::size_t>(it - files.begin());
    files.push_back(file);
    return files.size() - 1;
  };
  std::vector<std::pair<std::size_t, std::size_t>> order;
  for (std::size_t i = 0; i < all_.size(); ++i) order.emplace_back(rank(all_[i].pos.file), i);
  std::stable_sort(order.begin(), order.end(), [&](const auto& a, const auto& b) {
    if (a.first != b.first) return a.first < b.first;
    const auto &p = all_[a.second].pos, &q = all_[b.second].pos;
    return p.line != q.line ? p.line < q.line : p.column < q.column;
  });
  std::vector<Diagnostic> sorted;
  for (const auto& o : order) sorted.push_back(std::move(all_[o.second]));
  all_ = std::move(sorted);
}

namespace {
/// Optimal string alignment distance (insert, delete, replace, swap of neighbours), capitals ignored.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  std::vector<std::size_t> before(b.size() + 1), previous(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) previous[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t differ = lower(a[i - 1]) != lower(b[j - 1]);
      row[j] = std::min({previous[j] + 1, row[j - 1] + 1, previous[j - 1] + differ});
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]))
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, previous);
    std::swap(previous, row);
  }
  return previous[b.size()];
}
}  // namespace

std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates) {
  if (word.empty() || word.size() > 64) return {};
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const auto& c : candidates) {
    if (c.empty() || c.size() > 64) continue;
    if (std::max(c.size(), word.size()) - std::min(c.size(), word.size()) >= best_distance)
      continue;  // so far apart at least
    const std::size_t d = edit_distance(word, c);
    // A suggestion that shares nothing with the written name is useless.
    if (d < best_distance && d < std::max(word.size(), c.size())) {
      best = c;
      best_distance = d;
    }
  }
  return best;
}

namespace {

constexpr std::string_view asks = "; did you mean ";

}  // namespace

std::string did_you_mean(std::string_view near) {
  return near.empty() ? std::string() : std::string(asks) + in_quotes(near) + "?";
}

std::string did_you_mean_element(std::string_view near) {
  return near.empty() ? std::string() : std::string(asks) + "<" + std::string(near) + ">?";
}

std::string proposed_name(std::string_view message) {
  const std::size_t at = message.rfind(asks);
  if (at == std::string_view::npos) return {};
  const std::size_t begin = at + asks.size() + 1, end = message.find_first_of("\">", begin);
  return end == std::string_view::npos ? std::string() : std::string(message.substr(begin, end - begin));
}

}  // namespace insula
