// SPDX-License-Identifier: GPL-3.0-or-later
// Samples a tool's pieces and edges once, and moves the samples with the tool.
#include "plugins/arachnoid_membrane/tool_outline.h"

#include <algorithm>
#include <cmath>

namespace insula {

ToolOutline::ToolOutline(Instrument& tool, double length, double spacing) : tool_(&tool), length_(length) {
  for (const ConvexPiece& piece : tool.tool().pieces) {
    // Corners first. Between them only where there is no ball yet.
    for (const Vec3& p : piece.points) add(balls_, p, piece.radius, 1e-9);
    for (std::size_t i = 0; i < piece.points.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Vec3 &a = piece.points[j], d = piece.points[i] - a;
        const int parts = std::max(1, int(std::ceil(d.norm() / spacing)));
        for (int k = 1; k < parts; ++k) add(balls_, a + double(k) / parts * d, piece.radius, 0.7 * spacing);
      }
  }
  for (const auto& [a, b] : tool.tool().blade_edges) {
    const int parts = std::max(1, int(std::ceil((b - a).norm() / spacing)));
    for (int k = 0; k <= parts; ++k) add(edge_, a + double(k) / parts * (b - a), 0, 0);
  }
  make_groups();
  place();
}

void ToolOutline::make_groups() {
  constexpr std::size_t size = 8;
  for (std::size_t begin = 0; begin < balls_.size(); begin += size) {
    Group g;
    g.begin = begin;
    g.end = std::min(begin + size, balls_.size());
    for (std::size_t i = g.begin; i < g.end; ++i) g.local += balls_[i].local / double(g.end - g.begin);
    for (std::size_t i = g.begin; i < g.end; ++i) {
      g.radius = std::max(g.radius, balls_[i].radius);
      g.spread = std::max(g.spread, (balls_[i].local - g.local).norm());
    }
    groups_.push_back(g);
  }
}

void ToolOutline::add(std::vector<Ball>& to, const Vec3& local, double radius, double apart) const {
  if (local.norm() > length_) return;
  for (const Ball& other : to)
    if ((other.local - local).norm() < apart) return;
  to.push_back({local, radius, Vec3::Zero()});
}

void ToolOutline::place() {
  middle_.setZero();
  for (std::vector<Ball>* all : {&balls_, &edge_})
    for (Ball& b : *all) b.at = tool_->pose().apply(b.local);
  for (Group& g : groups_) g.at = tool_->pose().apply(g.local);
  for (const Ball& b : balls_) middle_ += b.at / double(balls_.size());
  radius_ = 0;
  for (const std::vector<Ball>* all : {&balls_, &edge_})
    for (const Ball& b : *all) radius_ = std::max(radius_, (b.at - middle_).norm() + b.radius);
}

}  // namespace insula
