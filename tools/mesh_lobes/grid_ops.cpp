// SPDX-License-Identifier: GPL-3.0-or-later
// Image operations on a regular grid.
#include "grid_ops.h"

#include <algorithm>
#include <cstdint>
#include <queue>
#include <utility>

namespace insula::mesh_tool {
namespace {

constexpr double far_away = 1e12;

// One line of the squared distance transform, in units of nodes.
void envelope(std::vector<double>& f, std::vector<double>& d, std::vector<int>& v, std::vector<double>& z) {
  const int n = static_cast<int>(f.size());
  int k = -1;
  for (int q = 0; q < n; ++q) {
    if (f[static_cast<std::size_t>(q)] >= far_away) continue;
    double s = -far_away;
    while (k >= 0) {
      const int p = v[static_cast<std::size_t>(k)];
      s = ((f[static_cast<std::size_t>(q)] + double(q) * q) - (f[static_cast<std::size_t>(p)] + double(p) * p)) /
          (2.0 * (q - p));
      if (s > z[static_cast<std::size_t>(k)]) break;
      --k;
    }
    if (k < 0) s = -far_away;
    ++k;
    v[static_cast<std::size_t>(k)] = q;
    z[static_cast<std::size_t>(k)] = s;
  }
  if (k < 0) {
    std::fill(d.begin(), d.end(), far_away);
    return;
  }
  int at = 0;
  for (int q = 0; q < n; ++q) {
    while (at < k && z[static_cast<std::size_t>(at) + 1] < q) ++at;
    const int p = v[static_cast<std::size_t>(at)];
    d[static_cast<std::size_t>(q)] = double(q - p) * (q - p) + f[static_cast<std::size_t>(p)];
  }
}

// Calls f(first index, stride, length) for every grid line along an axis.
template <class F>
void for_lines(const Grid& g, int axis, F&& f) {
  const std::size_t stride[3] = {1, static_cast<std::size_t>(g.size[0]),
                                 static_cast<std::size_t>(g.size[0]) * static_cast<std::size_t>(g.size[1])};
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  for (int i = 0; i < g.size[static_cast<std::size_t>(a)]; ++i)
    for (int j = 0; j < g.size[static_cast<std::size_t>(b)]; ++j)
      f(static_cast<std::size_t>(i) * stride[a] + static_cast<std::size_t>(j) * stride[b], stride[axis],
        g.size[static_cast<std::size_t>(axis)]);
}

template <class F>
void for_six_neighbours(const Grid& g, std::size_t at, F&& f) {
  const std::size_t sx = static_cast<std::size_t>(g.size[0]), sxy = sx * static_cast<std::size_t>(g.size[1]);
  const std::size_t i = at % sx, j = (at / sx) % static_cast<std::size_t>(g.size[1]), k = at / sxy;
  if (i > 0) f(at - 1);
  if (i + 1 < sx) f(at + 1);
  if (j > 0) f(at - sx);
  if (j + 1 < static_cast<std::size_t>(g.size[1])) f(at + sx);
  if (k > 0) f(at - sxy);
  if (k + 1 < static_cast<std::size_t>(g.size[2])) f(at + sxy);
}

}  // namespace

Field distance_to(const Grid& grid, const Mask& set) {
  std::vector<double> squared(grid.count());
  for (std::size_t i = 0; i < squared.size(); ++i) squared[i] = set[i] ? 0.0 : far_away;
  for (int axis = 0; axis < 3; ++axis) {
    const auto n = static_cast<std::size_t>(grid.size[static_cast<std::size_t>(axis)]);
    std::vector<double> f(n), d(n), z(n + 1);
    std::vector<int> v(n);
    for_lines(grid, axis, [&](std::size_t first, std::size_t stride, int length) {
      for (int i = 0; i < length; ++i)
        f[static_cast<std::size_t>(i)] = squared[first + static_cast<std::size_t>(i) * stride];
      envelope(f, d, v, z);
      for (int i = 0; i < length; ++i)
        squared[first + static_cast<std::size_t>(i) * stride] = d[static_cast<std::size_t>(i)];
    });
  }
  Field out(grid.count());
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = squared[i] >= far_away ? 1e6f : static_cast<float>(grid.spacing * std::sqrt(squared[i]));
  return out;
}

Field signed_distance(const Grid& grid, const Mask& mask) {
  Mask outside(mask.size());
  for (std::size_t i = 0; i < mask.size(); ++i) outside[i] = !mask[i];
  Field inner = distance_to(grid, outside);
  const Field outer = distance_to(grid, mask);
  const float half = static_cast<float>(grid.spacing / 2);
  for (std::size_t i = 0; i < inner.size(); ++i) inner[i] = mask[i] ? inner[i] - half : half - outer[i];
  return inner;
}

void smooth(const Grid& grid, Field& field, double sigma) {
  if (sigma <= 0) return;
  const double s = sigma / grid.spacing;
  const int radius = std::max(1, static_cast<int>(std::ceil(3 * s)));
  std::vector<double> kernel(static_cast<std::size_t>(radius) + 1);
  double sum = 0;
  for (int i = 0; i <= radius; ++i) {
    kernel[static_cast<std::size_t>(i)] = std::exp(-0.5 * (i / s) * (i / s));
    sum += (i ? 2 : 1) * kernel[static_cast<std::size_t>(i)];
  }
  for (double& w : kernel) w /= sum;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> line(static_cast<std::size_t>(grid.size[static_cast<std::size_t>(axis)]));
    for_lines(grid, axis, [&](std::size_t first, std::size_t stride, int length) {
      for (int i = 0; i < length; ++i)
        line[static_cast<std::size_t>(i)] = static_cast<double>(field[first + static_cast<std::size_t>(i) * stride]);
      for (int i = 0; i < length; ++i) {
        double value = kernel[0] * line[static_cast<std::size_t>(i)];
        for (int r = 1; r <= radius; ++r)
          value += kernel[static_cast<std::size_t>(r)] * (line[static_cast<std::size_t>(std::max(0, i - r))] +
                                                          line[static_cast<std::size_t>(std::min(length - 1, i + r))]);
        field[first + static_cast<std::size_t>(i) * stride] = static_cast<float>(value);
      }
    });
  }
}

Mask component(const Grid& grid, const Mask& mask, std::size_t of) {
  Mask out(mask.size(), 0);
  std::vector<std::size_t> stack;
  const auto push = [&](std::size_t at) {
    if (mask[at] && !out[at]) {
      out[at] = 1;
      stack.push_back(at);
    }
  };
  push(of);
  while (!stack.empty()) {
    const std::size_t at = stack.back();
    stack.pop_back();
    for_six_neighbours(grid, at, push);
  }
  return out;
}

Mask largest_component(const Grid& grid, const Mask& mask) {
  std::vector<std::uint32_t> label(mask.size(), 0);
  std::vector<std::size_t> stack;
  std::uint32_t next = 0, best = 0;
  std::size_t best_size = 0;
  for (std::size_t start = 0; start < mask.size(); ++start) {
    if (!mask[start] || label[start]) continue;
    label[start] = ++next;
    stack.assign(1, start);
    std::size_t size = 0;
    while (!stack.empty()) {
      const std::size_t at = stack.back();
      stack.pop_back();
      ++size;
      for_six_neighbours(grid, at, [&](std::size_t to) {
        if (mask[to] && !label[to]) {
          label[to] = next;
          stack.push_back(to);
        }
      });
    }
    if (size > best_size) best_size = size, best = next;
  }
  Mask out(mask.size());
  for (std::size_t i = 0; i < mask.size(); ++i) out[i] = best && label[i] == best;
  return out;
}

Mask fill_holes(const Grid& grid, const Mask& mask) {
  Mask outside(mask.size(), 0);
  std::vector<std::size_t> stack;
  const auto push = [&](std::size_t at) {
    if (!mask[at] && !outside[at]) {
      outside[at] = 1;
      stack.push_back(at);
    }
  };
  for (int k = 0; k < grid.size[2]; ++k)
    for (int j = 0; j < grid.size[1]; ++j)
      for (int i = 0; i < grid.size[0]; ++i)
        if (i == 0 || j == 0 || k == 0 || i == grid.size[0] - 1 || j == grid.size[1] - 1 || k == grid.size[2] - 1)
          push(grid.index(i, j, k));
  while (!stack.empty()) {
    const std::size_t at = stack.back();
    stack.pop_back();
    for_six_neighbours(grid, at, push);
  }
  Mask out(mask.size());
  for (std::size_t i = 0; i < mask.size(); ++i) out[i] = !outside[i];
  return out;
}

Field closing_level(const Grid& grid, const Mask& mask, double radius) {
  Field level = signed_distance(grid, mask);
  if (radius <= 0) return level;
  Mask outside(mask.size());
  for (std::size_t i = 0; i < mask.size(); ++i) outside[i] = static_cast<double>(level[i]) < -radius;
  const Field eroded = distance_to(grid, outside);
  for (std::size_t i = 0; i < level.size(); ++i)
    level[i] = outside[i] ? std::min(level[i], static_cast<float>(-radius))
                          : std::max(level[i], static_cast<float>(std::min(1e3, static_cast<double>(eroded[i])) -
                                                                  radius - grid.spacing / 2));
  return level;
}

std::vector<unsigned char> grow(const Grid& grid, const std::vector<unsigned char>& seeds, const Field& cost) {
  using Item = std::pair<float, std::uint32_t>;  // distance, node: equal distances pop in node order
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
  Field distance(grid.count(), 1e30f);
  std::vector<unsigned char> owner = seeds;
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    if (!seeds[i]) continue;
    distance[i] = 0;
    queue.emplace(0.0f, static_cast<std::uint32_t>(i));
  }
  const int sx = grid.size[0], sy = grid.size[1];
  while (!queue.empty()) {
    const auto [d, node] = queue.top();
    queue.pop();
    if (d > distance[node]) continue;
    const int i = static_cast<int>(node) % sx, j = (static_cast<int>(node) / sx) % sy,
              k = static_cast<int>(node) / (sx * sy);
    for (int dk = -1; dk <= 1; ++dk)
      for (int dj = -1; dj <= 1; ++dj)
        for (int di = -1; di <= 1; ++di) {
          const int length = di * di + dj * dj + dk * dk;
          const int a = i + di, b = j + dj, c = k + dk;
          if (!length || a < 0 || b < 0 || c < 0 || a >= sx || b >= sy || c >= grid.size[2]) continue;
          const std::size_t to = grid.index(a, b, c);
          const float step =
              static_cast<float>(grid.spacing * std::sqrt(double(length))) * 0.5f * (cost[node] + cost[to]);
          if (d + step < distance[to]) {
            distance[to] = d + step;
            owner[to] = owner[node];
            queue.emplace(distance[to], static_cast<std::uint32_t>(to));
          }
        }
  }
  return owner;
}

}  // namespace insula::mesh_tool
