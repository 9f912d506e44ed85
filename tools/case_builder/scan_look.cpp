// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/scan_look.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>

#include "tools/case_builder/otsu.h"

namespace insula::case_builder {
namespace {

constexpr std::size_t bins = 256;
constexpr std::size_t most_labels = 64;
constexpr double most_vessel = 0.15;  // share of a scan's voxels that may be vessel and bone

struct Values {
  double least = 1e300, most = -1e300;
  bool whole = true;
  std::map<float, std::uint64_t> labels;  ///< more than most_labels: no labels
};

Values values_of(const mesh_tool::NiftiVolume& v) {
  Values out;
  float last = NAN;
  std::uint64_t* count = nullptr;
  for (const float x : v.value) {
    if (!std::isfinite(x)) throw std::invalid_argument("a value is not finite");
    out.least = std::min(out.least, double(x)), out.most = std::max(out.most, double(x));
    out.whole = out.whole && x == std::floor(x);
    if (!out.whole || out.labels.size() > most_labels) continue;
    if (x != last) count = &out.labels[x], last = x;
    ++*count;
  }
  return out;
}

bool are_labels(const Values& values) {
  return values.whole && values.labels.size() <= most_labels && values.least >= 0 && values.labels.count(0);
}

std::vector<std::uint64_t> histogram_of(const mesh_tool::NiftiVolume& v, const Values& values) {
  std::vector<std::uint64_t> out(bins, 0);
  const double per_bin = std::max(values.most - values.least, 1e-30) / double(bins);
  for (const float x : v.value) ++out[std::min(bins - 1, std::size_t((double(x) - values.least) / per_bin))];
  return out;
}

/// Otsu's threshold parts a head from the air around it. The brighter part is parted again until it is as small as
/// vessels and bone are.
double proposed_threshold(const std::vector<std::uint64_t>& counts, const Values& values) {
  std::uint64_t all = 0, above = 0;
  for (const std::uint64_t n : counts) all += n;
  std::size_t from = 0;
  do {
    from += otsu_bin(std::span(counts).subspan(from));
    above = 0;
    for (std::size_t b = from; b < bins; ++b) above += counts[b];
  } while (double(above) > most_vessel * double(all) && from + 2 <= bins);
  std::size_t next = from;
  while (next < bins && counts[next] == 0) ++next;
  const double middle = double(from + next) / 2;  // of the gap between dark and bright, where there is one
  return values.least + (values.most - values.least) * middle / double(bins);
}

/// For each axis to the right, forward and up: the axis of the volume nearest to it, and whether it runs the other way.
struct Turned {
  std::array<int, 3> axis{};
  std::array<bool, 3> back{};
};

double towards(const mesh_tool::NiftiVolume& v, int world, int axis) {
  const auto at = [&](int r) { return v.to_world[std::size_t(4 * r + axis)]; };
  return at(world) / std::hypot(at(0), at(1), at(2));
}

Turned turned(const mesh_tool::NiftiVolume& v) {
  Turned best;
  double most = -1;
  std::array<int, 3> order{0, 1, 2};
  do {
    double sum = 0;
    for (int w = 0; w < 3; ++w) sum += std::abs(towards(v, w, order[std::size_t(w)]));
    if (sum > most + 1e-9) most = sum, best.axis = order;
  } while (std::next_permutation(order.begin(), order.end()));
  for (int w = 0; w < 3; ++w) best.back[std::size_t(w)] = towards(v, w, best.axis[std::size_t(w)]) < 0;
  return best;
}

std::string axes_of(const Turned& t) {
  std::string out = "   ";
  for (std::size_t w = 0; w < 3; ++w) out[std::size_t(t.axis[w])] = (t.back[w] ? "LPI" : "RAS")[w];
  return out;
}

class Block {
 public:
  Block(const mesh_tool::NiftiVolume& v, const Turned& t, const Values& values)
      : v_(v),
        t_(t),
        labels_(are_labels(values)),
        bytes_(values.whole && values.least >= 0 && values.most < 256 ? 1 : 2) {
    if (!values.whole || values.least < INT16_MIN || values.most > INT16_MAX) {
      scale_ = std::max(values.most - values.least, 1e-30) / 65000;
      offset_ = values.least + 32500 * scale_;
    }
    for (std::size_t w = 0; w < 3; ++w) {
      const int n = v.size[std::size_t(t.axis[w])];
      step_[w] = (n + most_block_voxels - 1) / most_block_voxels, size_[w] = n / step_[w];
    }
  }

  Json facts() const {
    // Of the middle of the first voxel, and steps.
    std::array<double, 3> first{};
    Json to_world = Json::array();
    for (std::size_t w = 0; w < 3; ++w)
      first[std::size_t(t_.axis[w])] = index(w, 0) + (t_.back[w] ? -1 : 1) * 0.5 * (step_[w] - 1);
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t w = 0; w < 3; ++w)
        to_world.push_back((t_.back[w] ? -1 : 1) * step_[w] * v_.to_world[4 * r + std::size_t(t_.axis[w])]);
      double origin = v_.to_world[4 * r + 3];
      for (std::size_t a = 0; a < 3; ++a) origin += v_.to_world[4 * r + a] * first[a];
      to_world.push_back(origin);
    }
    return {{"size", size_}, {"to_world", to_world}, {"bytes", bytes_}, {"scale", scale_}, {"offset", offset_}};
  }

  std::string voxels() const {
    const std::size_t count = std::size_t(size_[0]) * std::size_t(size_[1]) * std::size_t(size_[2]);
    std::string out(count * std::size_t(bytes_), '\0');
    char* to = out.data();
    for (int k = 0; k < size_[2]; ++k)
      for (int j = 0; j < size_[1]; ++j)
        for (int i = 0; i < size_[0]; ++i, to += bytes_) {
          const auto stored = std::int16_t(std::lround((value({i, j, k}) - offset_) / scale_));
          std::memcpy(to, &stored, std::size_t(bytes_));  // the first byte of two is the lower one
        }
    return out;
  }

 private:
  /// Of the volume's voxel with which one of the block begins.
  int index(std::size_t w, int at) const {
    const int n = v_.size[std::size_t(t_.axis[w])];
    return t_.back[w] ? n - 1 - at * step_[w] : at * step_[w];
  }
  /// The mean; of labels, the middle one.
  double value(const std::array<int, 3>& at) const {
    std::array<int, 3> from{}, one{};
    double sum = 0;
    if (labels_) {
      for (std::size_t w = 0; w < 3; ++w)
        one[std::size_t(t_.axis[w])] = index(w, at[w]) + (t_.back[w] ? -1 : 1) * (step_[w] / 2);
      return v_.at(one[0], one[1], one[2]);
    }
    for (std::size_t w = 0; w < 3; ++w) from[w] = index(w, at[w]) - (t_.back[w] ? step_[w] - 1 : 0);
    for (int k = 0; k < step_[2]; ++k)
      for (int j = 0; j < step_[1]; ++j)
        for (int i = 0; i < step_[0]; ++i) {
          one[std::size_t(t_.axis[0])] = from[0] + i, one[std::size_t(t_.axis[1])] = from[1] + j,
          one[std::size_t(t_.axis[2])] = from[2] + k;
          sum += double(v_.at(one[0], one[1], one[2]));
        }
    return sum / (step_[0] * step_[1] * step_[2]);
  }

  const mesh_tool::NiftiVolume& v_;
  const Turned& t_;
  bool labels_;
  int bytes_;
  double scale_ = 1, offset_ = 0;
  std::array<int, 3> step_{}, size_{};
};

}  // namespace

ScanLook look_at(const mesh_tool::NiftiVolume& v) {
  const Values values = values_of(v);
  const Turned t = turned(v);
  const std::vector<std::uint64_t> counts = histogram_of(v, values);
  const Block block(v, t, values);
  Json spacing = Json::array(), labels = Json::array();
  for (std::size_t a = 0; a < 3; ++a)
    spacing.push_back(std::hypot(v.to_world[a], v.to_world[4 + a], v.to_world[8 + a]));
  if (are_labels(values))
    for (const auto& [label, n] : values.labels)
      if (label != 0) labels.push_back({{"label", int(label)}, {"voxels", n}});
  return {{{"size", v.size},
           {"spacing_mm", spacing},
           {"axes", axes_of(t)},
           {"values", {{"least", values.least}, {"most", values.most}}},
           {"histogram", {{"from", values.least}, {"to", values.most}, {"counts", counts}}},
           {"threshold", proposed_threshold(counts, values)},
           {"labels", labels},
           {"block", block.facts()}},
          block.voxels()};
}

}  // namespace insula::case_builder
