// SPDX-License-Identifier: GPL-3.0-or-later
// Y = L^-1 P H^T on the reach of the rows, W = Y^T Y. Rows are sorted by their first column, so that the rows which
// reach a front are nearly one range of the columns of Y, as in block_compliance.cpp.
#include <algorithm>
#include <tuple>

#include "core/linalg/opencl/opencl_cholesky.h"

namespace insula::opencl {

void OpenclCholesky::begin_compliance(const BodyRows& rows, const std::vector<int>& node_of_block) {
  const int m = rows.count();
  const bool kept = rows_.rows_factor == factor_number_ && rows_.columns == m;
  rows_.columns = m;
  rows_.rows_factor = m > 0 && e_.nodes > 0 ? factor_number_ : -1;
  rows_.unchanged = false;
  if (m == 0 || e_.nodes == 0) return;
  std::swap(rows_.entries, rows_.before);
  rows_.entries.take(rows, node_of_block, e_.permuted);
  bool same = kept;
  for (int r = 0; same && r < m; ++r) same = rows_.before.find(rows_.entries, r) == r;
  rows_.unchanged = same;
  if (same) return;
  arrange();
  find_reach();
  list_tasks();
  reserve_rows();
}

/// Gives every row its column of Y, and lists the entries by front.
void OpenclCholesky::arrange() {
  const RowEntries& h = rows_.entries;
  rows_.begin.assign(std::size_t(rows_.columns), e_.nodes);
  rows_.order.resize(std::size_t(rows_.columns));
  for (int r = 0; r < rows_.columns; ++r) {
    for (int e = h.start[std::size_t(r)]; e < h.start[std::size_t(r) + 1]; ++e)
      rows_.begin[std::size_t(r)] = std::min(rows_.begin[std::size_t(r)], h.node[std::size_t(e)]);
    rows_.order[std::size_t(r)] = r;
  }
  std::sort(rows_.order.begin(), rows_.order.end(), [this](int a, int b) {
    const int first_a = rows_.begin[std::size_t(a)], first_b = rows_.begin[std::size_t(b)];
    return first_a != first_b ? first_a < first_b : a < b;
  });
  rows_.ldy = (rows_.columns + tile - 1) / tile * tile;
  rows_.entry_records.clear();
  for (int c = 0; c < rows_.columns; ++c) {
    const std::size_t r = std::size_t(rows_.order[std::size_t(c)]);
    for (int e = h.start[r]; e < h.start[r + 1]; ++e) {
      const Vec3& v = h.coeff[std::size_t(e)];
      rows_.entry_records.push_back({v.x(), v.y(), v.z(), c, 3 * h.node[std::size_t(e)]});
    }
  }
  // Entries of one column at one node keep their order: the sort looks at fronts only.
  const auto front = [this](const EntryRecord& e) { return e_.front_of[std::size_t(e.scalar / 3)]; };
  std::sort(rows_.entry_records.begin(), rows_.entry_records.end(), [&](const EntryRecord& a, const EntryRecord& b) {
    if (front(a) != front(b)) return front(a) < front(b);
    if (a.column != b.column) return a.column < b.column;
    if (a.scalar != b.scalar) return a.scalar < b.scalar;
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  });
}

/// The columns of Y that are not zero on each front: those of its entries and of its children.
void OpenclCholesky::find_reach() {
  rows_.reach.assign(e_.front.size(), {0, 0, 0, 0});
  const auto widen = [](ReachRecord& r, int begin, int end) {
    r.begin = r.begin == r.end ? begin : std::min(r.begin, begin);
    r.end = std::max(r.end, end);
  };
  for (std::size_t i = 0; i < rows_.entry_records.size(); ++i) {
    const EntryRecord& e = rows_.entry_records[i];
    ReachRecord& r = rows_.reach[std::size_t(e_.front_of[std::size_t(e.scalar / 3)])];
    if (r.entries_begin == r.entries_end) r.entries_begin = int(i);
    r.entries_end = int(i) + 1;
    widen(r, e.column, e.column + 1);
  }
  rows_.reached.clear();
  for (std::size_t s = 0; s < e_.front.size(); ++s) {
    const ReachRecord& r = rows_.reach[s];
    if (r.begin == r.end) continue;
    rows_.reached.push_back(int(s));
    if (e_.front[s].parent >= 0) widen(rows_.reach[std::size_t(e_.front[s].parent)], r.begin, r.end);
  }
}

void OpenclCholesky::list_tasks() {
  rows_.tasks.clear();
  rows_.levels.resize(plan_.levels.size());
  const auto begin = [this](TaskRange& out) { out.first = int(rows_.tasks.size()); };
  const auto end = [this](TaskRange& out) { out.count = int(rows_.tasks.size()) - out.first; };
  const auto columns_of = [this](int s, auto&& add) {
    const ReachRecord& r = rows_.reach[std::size_t(s)];
    for (int a = 0; a < r.end - r.begin; a += tile) add(a);
  };
  for (std::size_t i = 0; i < plan_.levels.size(); ++i) {
    auto& [own, below] = rows_.levels[i];
    begin(own);
    for (int s : plan_.levels[i].fronts) columns_of(s, [&](int a) { rows_.tasks.push_back({s, a}); });
    end(own);
    begin(below);
    for (int s : plan_.levels[i].fronts)
      columns_of(s, [&](int a) {
        const FrontRecord& f = plan_.fronts[std::size_t(s)];
        for (int b = 0; b < f.rows - f.own; b += tile) rows_.tasks.push_back({s, a, b});
      });
    end(below);
  }
  begin(rows_.tiles);
  for (int a = 0; a < rows_.ldy; a += tile)
    for (int b = 0; b <= a; b += tile) rows_.tasks.push_back({0, a, b});
  end(rows_.tiles);
  // Parts of about equal numbers of columns of L. Their number depends on the rows alone, so the sums do too.
  double all = 0, done = 0;
  for (int s : rows_.reached) all += plan_.fronts[std::size_t(s)].own;
  begin(rows_.parts);
  int from = 0;
  for (int k = 0; k < int(rows_.reached.size()); ++k) {
    done += plan_.fronts[std::size_t(rows_.reached[std::size_t(k)])].own;
    const int parts = int(rows_.tasks.size()) - rows_.parts.first;
    if (done < all * (parts + 1) / most_parts && k + 1 < int(rows_.reached.size())) continue;
    rows_.tasks.push_back({0, from, k + 1});
    from = k + 1;
  }
  end(rows_.parts);
}

void OpenclCholesky::reserve_rows() {
  const std::size_t ldy = std::size_t(rows_.ldy);
  device_.reserve<double>(rows_.y, 3 * std::size_t(e_.nodes) * ldy);
  device_.reserve<double>(rows_.w_part, most_parts * ldy * ldy);
  device_.reserve<double>(rows_.w_sum, ldy * ldy);
  device_.reserve<double>(rows_.load_part, most_parts * ldy);
  device_.reserve<double>(rows_.load_sum, ldy);
  device_.reserve<double>(rows_.lambda_there, ldy);
  for (Buffer& b : carried_many_) device_.reserve<double>(b, std::size_t(plan_.carried_rows) * ldy);
  rows_.w.resize(std::max(rows_.w.size(), ldy * ldy));
  rows_.of_load.resize(std::max(rows_.of_load.size(), ldy));
}

int OpenclCholesky::compliance_parts(ComplianceAct act) const {
  if (rows_.columns == 0 || e_.nodes == 0) return 0;
  return act == ComplianceAct::product || !rows_.unchanged ? 1 : 0;
}

void OpenclCholesky::compliance_part(ComplianceAct act, int) {
  if (act == ComplianceAct::forward) queue_compliance();
  else read_compliance();
}

void OpenclCholesky::queue_compliance() {
  device_.upload_all(rows_.reach_there, rows_.reach);
  device_.upload_all(rows_.entries_there, rows_.entry_records);
  device_.upload_all(rows_.reached_there, rows_.reached);
  device_.upload_all(rows_.tasks_there, rows_.tasks);
  for (std::size_t i = 0; i < rows_.levels.size(); ++i) {
    const auto& [own, below] = rows_.levels[i];
    const Buffer &mine = carried_many_[i % 2], &of_children = carried_many_[(i + 1) % 2];
    device_.run(Kernel::forward_own, std::size_t(own.count), group, fronts_, children_, map_, rows_.tasks_there,
                own.first, rows_.reach_there, rows_.entries_there, panels_, inverses_, rows_.y, rows_.ldy, of_children);
    device_.run(Kernel::forward_below, std::size_t(below.count), group, fronts_, children_, map_, rows_.tasks_there,
                below.first, rows_.reach_there, panels_, rows_.y, rows_.ldy, mine, of_children);
  }
  const int parts = rows_.parts.count, size = rows_.ldy * rows_.ldy;
  device_.run(Kernel::multiply_rows, std::size_t(rows_.tiles.count) * std::size_t(parts), group, fronts_,
              rows_.reached_there, rows_.tasks_there, rows_.tiles.first, rows_.reach_there, rows_.y, rows_.ldy, parts,
              rows_.w_part);
  device_.run(Kernel::add_parts, std::size_t((size + group - 1) / group), group, rows_.w_part, parts, size,
              rows_.w_sum);
  device_.flush();
}

void OpenclCholesky::read_compliance() {
  const std::size_t ldy = std::size_t(rows_.ldy);
  const int parts = rows_.parts.count;
  if (loaded_) {
    device_.run(Kernel::multiply_load, std::size_t(parts), group, fronts_, rows_.reached_there, rows_.tasks_there,
                rows_.parts.first, rows_.reach_there, rows_.y, rows_.ldy, load_, rows_.load_part);
    device_.run(Kernel::add_parts, std::size_t((rows_.ldy + group - 1) / group), group, rows_.load_part, parts,
                rows_.ldy, rows_.load_sum);
    device_.download(rows_.load_sum, rows_.of_load.data(), ldy);
  }
  if (!rows_.unchanged) device_.download(rows_.w_sum, rows_.w.data(), ldy * ldy);
}

void OpenclCholesky::add_free_motion(const BodyRows& rows, double* delta) const {
  if (rows_.columns == 0 || e_.nodes == 0 || !loaded_) return;
  for (std::size_t c = 0; c < rows_.order.size(); ++c) delta[rows.row[std::size_t(rows_.order[c])]] += rows_.of_load[c];
}

void OpenclCholesky::add_compliance(const BodyRows& rows, double* w, int stride) {
  if (rows_.columns == 0 || e_.nodes == 0) return;
  const std::size_t ld = std::size_t(rows_.ldy), step = std::size_t(stride);
  for (std::size_t c = 0; c < rows_.order.size(); ++c)
    for (std::size_t r = c; r < rows_.order.size(); ++r) {
      const std::size_t i = std::size_t(rows.row[std::size_t(rows_.order[r])]),
                        j = std::size_t(rows.row[std::size_t(rows_.order[c])]);
      w[i * step + j] += rows_.w[r * ld + c];
      if (i != j) w[j * step + i] += rows_.w[r * ld + c];
    }
}

SolverCost OpenclCholesky::cost() const {
  SolverCost c;
  c.factor_entries = e_.entries;
  c.factor_flops = e_.flops;
  c.factor_bytes = 2.0 * sizeof(double) * double(e_.entries);
  c.rows_reused = rows_.unchanged ? rows_.columns : 0;
  if (rows_.columns == 0 || rows_.unchanged) return c;
  for (int s : rows_.reached) {
    const ReachRecord& r = rows_.reach[std::size_t(s)];
    const double columns = r.end - r.begin, own = 3 * e_.front[std::size_t(s)].own,
                 below = 3 * e_.front[std::size_t(s)].rows - own;
    c.compliance_flops += columns * own * (own + 2 * below + columns);
  }
  return c;
}

}  // namespace insula::opencl
