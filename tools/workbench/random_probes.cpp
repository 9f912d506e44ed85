// SPDX-License-Identifier: GPL-3.0-or-later
// Draws places, tests whether tools reach them, and writes the motions.
#include "tools/workbench/random_probes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/base/input_error.h"
#include "core/base/random.h"
#include "core/collision/colliders/tool_collider.h"
#include "core/mechanics/surface.h"

namespace insula {
namespace {

constexpr double key_interval_s = 5e-3;
constexpr double above_m = 25e-3;  ///< along the shaft, where a tool comes down from
constexpr double start_m = 5e-3;   ///< over the touch, along the normal, where a probe begins and ends
constexpr double margin_m = 0.3e-3;
constexpr double path_sample_m = 1e-3;               ///< of a path that is tested
constexpr double sample_m = 0.5e-3;                  ///< of the last part of it, and of a tool
constexpr double fine_sample_m = 0.05e-3;            ///< where it touches
constexpr double farthest_touch_m = 2.5e-3;          ///< from the place that was drawn
constexpr double least_cosine = 0.4;                 ///< between normal and shaft
constexpr int max_draws = 20000, max_reaches = 500;  ///< of triangles, and of tests whether a tool reaches one

double minimum_jerk(double s) { return s * s * s * (10 - 15 * s + 6 * s * s); }

/// What a tool occupies, as balls in its frame.
struct Balls {
  std::vector<std::pair<Vec3, double>> at;
  explicit Balls(const Instrument& tool) {
    for (const ConvexPiece& piece : tool.link_pieces(0)) {
      const RoundedPiece r = rounded(piece);
      const Vec3 along = r.axis1 - r.axis0;
      const double radius = r.bound + r.radius;
      const int n = 1 + int(along.norm() / std::max(sample_m, radius));
      for (int i = 0; i <= n; ++i) at.emplace_back(r.axis0 + double(i) / n * along, radius);
    }
  }
};

struct Place {
  const Surface* surface = nullptr;
  Vec3 touch, normal;  ///< tip where the tool first touches; outward normal of the surface
  bool wall() const { return surface->thickness() > 0; }
};

/// One hand's tool and where it can go.
class Reach {
 public:
  Reach(const Simulation& simulation, int hand)
      : simulation_(simulation),
        tool_(*simulation.instrument_of(hand)),
        balls_(tool_),
        home_(tool_.home_pose()),
        shaft_(home_.q * Vec3::UnitZ()) {}

  const Pose& home() const { return home_; }
  Vec3 above(const Place& place) const { return start(place) + above_m * shaft_; }
  static Vec3 start(const Place& place) { return place.touch + start_m * place.normal; }

  bool faces(const Vec3& normal) const { return normal.dot(shaft_) >= least_cosine; }
  /// Where the tool touches when it comes to `point` against `normal`; none if it cannot.
  std::optional<Place> to(const Surface& surface, const Vec3& point, const Vec3& normal) const {
    const Vec3 from = point + start_m * normal;
    if (touched(from, margin_m) || touched(from + above_m * shaft_, margin_m)) return std::nullopt;
    const double down = touch_distance(from, -normal, start_m + 1e-3);
    const Place place{&surface, from - down * normal, normal};
    if (touched(place.touch, 0) != &surface || (place.touch - point).norm() > farthest_touch_m) return std::nullopt;
    if (!clear(above(place), start(place)) || !clear(home_.p, above(place))) return std::nullopt;
    return place;
  }
  /// Whether the shafts of two tools at their places keep a distance.
  bool apart(const Place& place, const Reach& other, const Place& others) const {
    constexpr double least_m = 4e-3, length_m = 60e-3;
    for (double s = 0; s < length_m; s += 2e-3)
      for (double t = 0; t < length_m; t += 2e-3)
        if ((start(place) + s * shaft_ - start(others) - t * other.shaft_).norm() < least_m) return false;
    return true;
  }

 private:
  /// The surface that is nearer than `gap` to the tool with its tip there.
  const Surface* touched(const Vec3& tip, double gap) const {
    for (const Surface* s : simulation_.surfaces()) {
      if (!s->contact()) continue;
      for (const auto& [local, radius] : balls_.at)
        if (s->collision().nearest(tip + home_.q * local, 0, radius + 0.5 * s->thickness() + gap).triangle >= 0)
          return s;
    }
    return nullptr;
  }
  /// How far the tip goes along a unit direction until the tool touches, at most `most`.
  double touch_distance(const Vec3& from, const Vec3& direction, double most) const {
    double s = 0;
    while (s < most && !touched(from + s * direction, 0)) s += sample_m;
    for (s = std::max(0.0, s - sample_m); s < most && !touched(from + s * direction, 0);) s += fine_sample_m;
    return s;
  }
  bool clear(const Vec3& a, const Vec3& b) const {
    const int n = 1 + int((b - a).norm() / path_sample_m);
    for (int i = 0; i <= n; ++i)
      if (touched(a + double(i) / n * (b - a), margin_m)) return false;
    return true;
  }

  const Simulation& simulation_;
  const Instrument& tool_;
  Balls balls_;
  Pose home_;
  Vec3 shaft_;
};

/// Draws triangles by area.
class Places {
 public:
  Places(const Simulation& simulation, bool walls) {
    for (const Surface* s : simulation.surfaces()) {
      if (!s->contact() || s->body().blocks() == 0 || (s->thickness() > 0) != walls) continue;
      for (int k = 0; k < int(s->triangles().size()); ++k) {
        const auto& t = s->triangles()[std::size_t(k)];
        const Vec3 &a = s->positions()[std::size_t(t[0])], &b = s->positions()[std::size_t(t[1])],
                   &c = s->positions()[std::size_t(t[2])];
        area_ += 0.5 * (b - a).cross(c - a).norm();
        triangles_.push_back({s, k, area_});
      }
    }
  }
  bool empty() const { return triangles_.empty(); }
  /// A place that the tool reaches. `near`: within so far of that point, and on that surface.
  std::optional<Place> draw(Random& random, const Reach& reach, const Place* near = nullptr) const {
    constexpr double near_m = 25e-3, not_nearer_m = 7e-3;
    int reaches = 0;
    for (int draw = 0; draw < max_draws && reaches < max_reaches; ++draw) {
      const double at = random.uniform(0, area_);
      double u = random.uniform(), v = random.uniform();
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      const auto it = std::upper_bound(triangles_.begin(), triangles_.end(), at,
                                       [](double x, const Triangle& t) { return x < t.area_up_to; });
      const Triangle& t = it == triangles_.end() ? triangles_.back() : *it;
      const auto& corner = t.surface->triangles()[std::size_t(t.index)];
      const auto& x = t.surface->positions();
      const Vec3 &a = x[std::size_t(corner[0])], &b = x[std::size_t(corner[1])], &c = x[std::size_t(corner[2])];
      const Vec3 point = a + u * (b - a) + v * (c - a);
      if (near) {
        const double distance = (point - near->touch).norm();
        if (t.surface != near->surface || distance > near_m || distance < not_nearer_m) continue;
      }
      const Vec3 normal = (b - a).cross(c - a).normalized();
      if (!reach.faces(normal)) continue;
      ++reaches;
      if (auto place = reach.to(*t.surface, point, normal)) return place;
    }
    return std::nullopt;
  }

 private:
  struct Triangle {
    const Surface* surface;
    int index;
    double area_up_to;
  };
  std::vector<Triangle> triangles_;
  double area_ = 0;
};

/// Moves of one hand, from rest to rest.
class Path {
 public:
  Path(Motion& motion, int hand, const Reach& reach) : motion_(motion), hand_(hand), home_(reach.home()), at_(home_.p) {
    key();
  }
  void to(const Vec3& target, double seconds) {
    const Vec3 from = at_;
    const int n = std::max(1, int(std::lround(seconds / key_interval_s)));
    const double begin = time_;
    for (int i = 1; i <= n; ++i) {
      time_ = begin + seconds * i / n;
      at_ = from + minimum_jerk(double(i) / n) * (target - from);
      key();
    }
  }
  void rest(double seconds) { to(at_, seconds); }
  void rest_until(double time) {
    if (time > time_) rest(time - time_);
  }
  double time() const { return time_; }

 private:
  void key() {
    HandSample s;
    s.pose = {at_, home_.q};
    motion_.add(hand_, {time_, s});
  }
  Motion& motion_;
  int hand_;
  Pose home_;
  Vec3 at_;
  double time_ = 0;
};

/// Time for a way through free space at 0.15 m/s in the mean.
double free_time(const Vec3& a, const Vec3& b) { return std::max(0.15, (b - a).norm() / 0.15); }

void approach(Path& path, const Reach& reach, const Place& place) {
  path.to(reach.above(place), free_time(reach.home().p, reach.above(place)));
  path.to(Reach::start(place), free_time(reach.above(place), Reach::start(place)));
}

/// Depths below the first touch; walls are thin and stiff.
double depth(Random& random, const Place& place) {
  return place.wall() ? random.uniform(0.15e-3, 0.45e-3) : random.uniform(0.8e-3, 2.2e-3);
}

class Writer {
 public:
  Writer(Random& random, double pace) : random_(random), pace_(pace) {}

  void tap(Path& path, const Place& p) {
    for (const double faster : {1.0, 1.25, 1.5}) {
      const Vec3 pressed = p.touch - depth(random_, p) * p.normal;
      path.to(pressed, 0.25 * pace_ / faster);
      path.rest(0.08 * pace_);
      path.to(p.touch + 2e-3 * p.normal, 0.2 * pace_ / faster);
    }
    path.to(Reach::start(p), 0.1 * pace_);
  }
  void press(Path& path, const Place& p) {
    const double most = depth(random_, p);
    path.to(p.touch - 0.5 * most * p.normal, 0.4 * pace_);
    path.to(p.touch - most * p.normal, 0.3 * pace_);
    path.rest(0.3 * pace_);
    path.to(p.touch - 0.6 * most * p.normal, 0.2 * pace_);
    path.to(Reach::start(p), 0.3 * pace_);
  }
  /// There and back along the surface.
  void drag(Path& path, const Place& p) {
    const double angle = random_.uniform(0, 2 * std::numbers::pi);
    const Vec3 x = p.normal.unitOrthogonal(), y = p.normal.cross(x);
    slide(path, p, 2e-3 * (std::cos(angle) * x + std::sin(angle) * y));
  }
  /// One of two hands: pressed in, and on towards the other.
  void squeeze(Path& path, const Place& p, const Place& other) {
    Vec3 way = other.touch - p.touch;
    way -= way.dot(p.normal) * p.normal;
    slide(path, p, (p.wall() ? 0.4e-3 : 1.5e-3) * way.normalized());
  }

 private:
  void slide(Path& path, const Place& p, const Vec3& way) {
    const Vec3 pressed = p.touch - 0.8 * depth(random_, p) * p.normal;
    path.to(pressed, 0.3 * pace_);
    path.rest(0.1 * pace_);
    path.to(pressed + way, 0.3 * pace_);
    path.rest(0.1 * pace_);
    path.to(pressed, 0.25 * pace_);
    path.to(Reach::start(p), 0.3 * pace_);
  }
  Random& random_;
  double pace_;
};

constexpr std::array<const char*, 4> kinds{"tap", "drag", "press", "squeeze"};
constexpr std::array<double, 3> paces{1.6, 1.0, 0.6};  ///< slow, as in docs/haptic-truth.md, fast
constexpr std::size_t drag = 1, press = 2, squeeze = 3;
constexpr int max_failures = 8;

class Draw {
 public:
  Draw(const Simulation& simulation, std::uint64_t seed)
      : random_(seed), lobes_(simulation, false), walls_(simulation, true) {
    for (int h = 0; h < 2; ++h)
      if (simulation.instrument_of(h)) reach_[std::size_t(h)].emplace(simulation, h);
  }
  bool any() const { return (reach_[0] || reach_[1]) && !(lobes_.empty() && walls_.empty()); }

  /// `failed`: how often this number's probe found no place; after a failure it looks on the other surfaces.
  /// Where two hands do not reach, a squeeze becomes a press.
  std::optional<Probe> make(int number, int failed) {
    const bool turn = (number / int(kinds.size()) % 2 == 1) != (failed % 2 == 1);
    const bool wall = !walls_.empty() && (lobes_.empty() || turn);
    std::size_t kind = std::size_t(number) % kinds.size();
    if (kind == squeeze && failed >= max_failures / 2) kind = press;
    const Places& places = wall ? walls_ : lobes_;
    const std::size_t hand = reach_[1] ? 1 : 0;
    const auto place = places.draw(random_, *reach_[hand]);
    if (!place) return std::nullopt;
    Writer writer(random_, paces[std::size_t(number / int(2 * kinds.size()) + number) % paces.size()]);
    Probe probe{fmt::format("{} {} {}", kinds[kind], place->surface->body().id, number + 1), {}};
    if (kind == squeeze) return both_hands(std::move(probe), writer, places, *place);
    Path path(probe.motion, int(hand), *reach_[hand]);
    approach(path, *reach_[hand], *place);
    if (kind == press) writer.press(path, *place);
    else if (kind == drag) writer.drag(path, *place);
    else writer.tap(path, *place);
    return probe;
  }

 private:
  std::optional<Probe> both_hands(Probe probe, Writer& writer, const Places& places, const Place& right) {
    if (!reach_[0] || !reach_[1]) return std::nullopt;
    const auto left = places.draw(random_, *reach_[0], &right);
    if (!left || !reach_[1]->apart(right, *reach_[0], *left)) return std::nullopt;
    Path a(probe.motion, 0, *reach_[0]), b(probe.motion, 1, *reach_[1]);
    approach(a, *reach_[0], *left);
    approach(b, *reach_[1], right);
    b.rest_until(a.time());
    a.rest_until(b.time());
    writer.squeeze(a, *left, right);
    writer.squeeze(b, right, *left);
    return probe;
  }

  Random random_;
  Places lobes_, walls_;
  std::array<std::optional<Reach>, 2> reach_;
};

}  // namespace

std::vector<Probe> random_probes(Simulation& simulation, int count, std::uint64_t seed) {
  simulation.step();  // surfaces know where they are
  std::vector<Probe> out;
  Draw draw(simulation, seed);
  int failures = 0;
  while (draw.any() && int(out.size()) < count && failures < max_failures) {
    if (auto probe = draw.make(int(out.size()), failures)) {
      out.push_back(std::move(*probe));
      failures = 0;
    } else {
      ++failures;
    }
  }
  simulation.reset();
  if (int(out.size()) < count)
    throw InputError(fmt::format(
        "only {} of {} random probes found a place that the tools reach from their homes; are the homes outside of the "
        "tissue, and is there a hand's tool?",
        out.size(), count));
  return out;
}

}  // namespace insula
