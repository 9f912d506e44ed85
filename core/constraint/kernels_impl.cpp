// SPDX-License-Identifier: GPL-3.0-or-later
// The sweep, compiled once per instruction set: KERNEL_NAME, KERNEL_BYTES a vector. Nothing inline from elsewhere is used
// here: it would be compiled for this instruction set and might be linked into the rest.
#include "core/constraint/sweep_kernels.h"

namespace insula::KERNEL_NAME {
namespace {

constexpr int W = KERNEL_BYTES / 8;  // doubles a vector
typedef double V __attribute__((vector_size(W * 8), aligned(8)));

inline V load(const double* p) { return *reinterpret_cast<const V*>(p); }
inline void store(double* p, V v) { *reinterpret_cast<V*>(p) = v; }
inline V first(int n) {  // n ones, then zeros; n <= W
  static const double ones[16] = {1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0};
  return load(ones + 8 - n);
}
inline double sum(V v) {
  double s = 0;
#if KERNEL_BYTES == 64
  typedef double V4 __attribute__((vector_size(32)));
  typedef double V2 __attribute__((vector_size(16)));
  const V4 a = __builtin_shufflevector(v, v, 0, 1, 2, 3) + __builtin_shufflevector(v, v, 4, 5, 6, 7);
  const V2 b = __builtin_shufflevector(a, a, 0, 1) + __builtin_shufflevector(a, a, 2, 3);
  s = b[0] + b[1];
#else
  for (int i = 0; i < W; ++i) s += v[i];
#endif
  return s;
}
inline double above(double least, double x) { return x < least ? least : x; }  // lets NaN through, as below
inline double below(double most, double x) { return x > most ? most : x; }
inline double size(double x) { return __builtin_fabs(x); }
inline double larger(double a, double b) { return a > b ? a : b; }

// --- local solutions -------------------------------------------------------------------------------------------------

struct Move {
  double d[3];
  int rows;
};

inline Move move_box(const LocalBlock& b, double* lambda, double delta) {
  const double l = *lambda, low = b.lower - l, high = b.upper - l;
  const double d = below(high, above(low, -b.compliance * l * b.inverse[0] - delta * b.inverse[0]));
  *lambda = d == low ? b.lower : d == high ? b.upper : l + d;  // the bounds to the last bit
  return {{d, 0, 0}, 1};
}

struct Three {
  double n, t1, t2;
};

// What the fast ways below do not cover. Leaves a start for the next slip, from (S + s) lambda_t = g.
__attribute__((noinline)) Three exact(const SweepData& data, int k, LocalBlock& b, const double* lambda, const double* delta, double g1, double g2) {
  double out[3] = {0, 0, 0};
  data.exact(*data.problem, k, lambda, delta, out);
  const double* t = b.law == LawKind::friction ? out + 1 : out;
  const double t1 = b.vx * t[0] + b.vy * t[1], t2 = -b.vy * t[0] + b.vx * t[1];
  const double s = (t1 * (g1 - b.high * t1) + t2 * (g2 - b.low * t2)) / (t1 * t1 + t2 * t2);
  b.slip = s > 0 ? s : -1;
  return {out[0], out[1], out[2]};
}

// Slip: |lambda_t| = mu lambda_n with (S + s) lambda_t = g and lambda_n = a0 + (a1 d2 + a2 d1) / (d1 d2), d = e + s. Times d1 d2, squared,
// this is a polynomial in s. Newton from the last sweep's s, most often one step: its error is the square of what s moves by, which
// vanishes with the sweeps, and the result is put on the cone.
constexpr double slip_step = 0.03;  // relative to d2: further than that and one more step is made

inline Three next_friction(const SweepData& data, int k, LocalBlock& b, const double* lambda, const double* delta) {
  const long s = data.stride;
  const int r = b.row;
  const double* w = data.w + r * s + r;
  const double l0 = lambda[r], l1 = lambda[r + 1], l2 = lambda[r + 2];
  // W lambda of the block itself: known before delta is.
  const double w0 = w[0] * l0 + w[1] * l1 + w[2] * l2, w1 = w[1] * l0 + w[s + 1] * l1 + w[s + 2] * l2, w2 = w[2] * l0 + w[s + 2] * l1 + w[2 * s + 2] * l2;
  const double i = b.inverse_normal, c1 = b.m1 * i, c2 = b.m2 * i;
  const double own1 = b.vx * w1 + b.vy * w2 - c1 * w0, own2 = b.vx * w2 - b.vy * w1 - c2 * w0;
  const double dn = delta[r], d1 = delta[r + 1], d2 = delta[r + 2];
  const double qn = dn - w0;
  if (qn >= 0) return {0, 0, 0};
  if (!b.regular) return exact(data, k, b, lambda, delta, 0, 0);
  const double mu2 = b.friction * b.friction;
  const double* v = b.inverse;
  const double c = dn + b.compliance * l0;
  const double n = l0 - (v[0] * c + v[1] * d1 + v[2] * d2);
  const double t1 = l1 - (v[1] * c + v[3] * d1 + v[4] * d2), t2 = l2 - (v[2] * c + v[4] * d1 + v[5] * d2);
  if (n > 0 && t1 * t1 + t2 * t2 <= mu2 * n * n) return {n, t1, t2};
  const double g1 = own1 - (b.vx * d1 + b.vy * d2 - c1 * dn), g2 = own2 - (b.vx * d2 - b.vy * d1 - c2 * dn);
  double slip = b.slip, e1 = b.high + slip, e2 = b.low + slip;
  if (!(slip >= 0)) return exact(data, k, b, lambda, delta, g1, g2);
  for (int step_count = 0;; ++step_count) {
    const double p1 = g1 * e2, p2 = g2 * e1, m = -i * (qn * (e1 * e2) + b.m1 * p1 + b.m2 * p2), dm = -i * (qn * (e1 + e2) + b.m1 * g1 + b.m2 * g2);
    const double f = p1 * p1 + p2 * p2 - mu2 * m * m, df = 2 * (g1 * p1 + g2 * p2 - mu2 * m * dm);
    const double step = f / df;
    slip -= step;
    e1 -= step;
    e2 -= step;
    if (!(slip >= 0) || step_count == 4) return exact(data, k, b, lambda, delta, g1, g2);
    if (size(step) <= slip_step * e2) break;
  }
  const double p1 = g1 * e2, p2 = g2 * e1, area = e1 * e2, length2 = p1 * p1 + p2 * p2;
  const double normal = -i * (qn * area + b.m1 * p1 + b.m2 * p2) / area, scale = b.friction * normal / __builtin_sqrt(length2);
  // A slow fall of f may end elsewhere: the right place has lambda_n > 0 and is nearly on the cone already.
  if (!(normal > 0 && size(scale * area - 1) < 1e-2)) return exact(data, k, b, lambda, delta, g1, g2);
  b.slip = slip;
  return {normal, (b.vx * p1 - b.vy * p2) * scale, (b.vy * p1 + b.vx * p2) * scale};
}

// The same for friction of given strength: |(S + s)^-1 g| = bound.
inline Three next_patch(const SweepData& data, int k, LocalBlock& b, const double* lambda, const double* delta) {
  const long s = data.stride;
  const int r = b.row;
  double pressed = 0;
  for (int i = r - b.normals; i < r; ++i) pressed += lambda[i] > 0 ? lambda[i] : 0;
  const double bound = b.friction * pressed, bound2 = bound * bound;
  if (!(bound > 0)) return {0, 0, 0};
  if (!b.regular) return exact(data, k, b, lambda, delta, 0, 0);
  const double* v = b.inverse;
  const double l0 = lambda[r], l1 = lambda[r + 1], d0 = delta[r], d1 = delta[r + 1];
  const double t1 = l0 - (v[0] * d0 + v[1] * d1), t2 = l1 - (v[1] * d0 + v[2] * d1);
  if (t1 * t1 + t2 * t2 <= bound2) return {t1, t2, 0};
  const double* w = data.w + r * s + r;
  const double q1 = d0 - (w[0] * l0 + w[1] * l1), q2 = d1 - (w[1] * l0 + w[s + 1] * l1);
  const double g1 = -(b.vx * q1 + b.vy * q2), g2 = b.vy * q1 - b.vx * q2;
  double slip = b.slip, e1 = b.high + slip, e2 = b.low + slip;
  if (!(slip >= 0)) return exact(data, k, b, lambda, delta, g1, g2);
  for (int step_count = 0;; ++step_count) {
    const double p1 = g1 * e2, p2 = g2 * e1, m = e1 * e2;
    const double f = p1 * p1 + p2 * p2 - bound2 * m * m, df = 2 * (g1 * p1 + g2 * p2 - bound2 * m * (e1 + e2));
    const double step = f / df;
    slip -= step;
    e1 -= step;
    e2 -= step;
    if (!(slip >= 0) || step_count == 4) return exact(data, k, b, lambda, delta, g1, g2);
    if (size(step) <= slip_step * e2) break;
  }
  const double p1 = g1 * e2, p2 = g2 * e1, scale = bound / __builtin_sqrt(p1 * p1 + p2 * p2);
  if (!(size(scale * e1 * e2 - 1) < 1e-2)) return exact(data, k, b, lambda, delta, g1, g2);
  b.slip = slip;
  return {(b.vx * p1 - b.vy * p2) * scale, (b.vy * p1 + b.vx * p2) * scale, 0};
}

// --- products with W -------------------------------------------------------------------------------------------------

constexpr int group = W < 4 ? 4 : W;  // rows taken together: as many as registers allow

struct Changes {  // of one panel: the rows that moved, padded to whole groups with changes of 0
  int count = 0;
  const double* w[panel_rows + group];
  double d[panel_rows + group];
};

inline void near(double* delta, const double* w, double d, int from, int full, int end) {
  for (int j = from; j < full; j += W) store(delta + j, load(delta + j) + load(w + j) * d);
  if (full < end) store(delta + full, load(delta + full) + load(w + full) * (first(end - full) * d));
}

inline void near3(double* delta, const double* w, long s, long s2, const double* d, int from, int full, int end) {
  const double d0 = d[0], d1 = d[1], d2 = d[2];
  for (int j = from; j < full; j += W) store(delta + j, load(delta + j) + load(w + j) * d0 + load(w + s + j) * d1 + load(w + s2 + j) * d2);
  if (full < end) {
    const V x = load(w + full) * d0 + load(w + s + full) * d1 + load(w + s2 + full) * d2;
    store(delta + full, load(delta + full) + x * first(end - full));
  }
}

// A group of rows of a panel onto all columns before it.
inline void behind(double* delta, const Changes& c, int at, int end) {
  const double* w[group];
  V d[group];
#pragma GCC unroll 8
  for (int i = 0; i < group; ++i) {
    w[i] = c.w[at + i];
    d[i] = V{} + c.d[at + i];
  }
  for (int j = 0; j < end; j += W) {
    V x = load(delta + j);
#pragma GCC unroll 8
    for (int i = 0; i < group; ++i) x += load(w[i] + j) * d[i];
    store(delta + j, x);
  }
}

// A group of rows (or fewer) times the changes in the listed columns.
inline void ahead(double* out, const double* w, long s, int rows, const double* moved, const int* columns, int count) {
  const double* row[group];
  V a[group];
#pragma GCC unroll 8
  for (int i = 0; i < group; ++i) {
    row[i] = i < rows ? w + i * s : w;
    a[i] = V{};
  }
  for (int k = 0; k < count; ++k) {
    const int j = columns[k];
    const V m = load(moved + j);
#pragma GCC unroll 8
    for (int i = 0; i < group; ++i) a[i] += load(row[i] + j) * m;
  }
#pragma GCC unroll 8
  for (int i = 0; i < group; ++i) {
    const double x = sum(a[i]);
    if (i < rows) out[i] = x;
  }
}

double sweep(const SweepData& data, double* lambda, double* delta) {
  const long s = data.stride;
  const double* w = data.w;
  double most = 0;
  double* moved = data.moved;
  for (int i = 0; i < s; ++i) moved[i] = 0;
  int column_count = 0;
  Changes changes[2];
  int last_from = 0;  // first column of the panel before this one
  for (int q = 0; q < data.panel_count; ++q) {
    Changes& now = changes[q & 1];
    const Changes& before = changes[(q & 1) ^ 1];
    now.count = 0;
    const auto row_of = [&](int panel) { return panel < data.panel_count ? data.blocks[data.panels[panel]].row : data.rows; };
    const int from = row_of(q) / W * W, begin_next = row_of(q + 1), end = row_of(q + 2), full = end / W * W, next_from = begin_next / W * W;
    // Work that waits for nothing: changes of the panel before onto the columns left of it, and what the panel after gathers.
    alignas(64) double gathered[panel_rows + 2 * W] = {};
    const int behind_tasks = (before.count + group - 1) / group, ahead_tasks = column_count ? (end - begin_next + group - 1) / group : 0, tasks = behind_tasks + ahead_tasks;
    int done = 0;
    const int first_block = data.panels[q], blocks = data.panels[q + 1] - first_block;
    for (int k = first_block; k < first_block + blocks; ++k) {
      LocalBlock& b = data.blocks[k];
      const int r = b.row;
      const double* wr = w + r * s;
      if (b.law == LawKind::box) {
        const double d = move_box(b, lambda + r, delta[r]).d[0];
        if (d != 0) {
          near(delta, wr, d, from, full, end);
          most = larger(most, size(d) * (wr[r] + b.compliance));
          now.w[now.count] = wr;
          now.d[now.count++] = d;
        }
      } else {
        const bool friction = b.law == LawKind::friction;
        const int rows = friction ? 3 : 2;
        const Three next = friction ? next_friction(data, k, b, lambda, delta) : next_patch(data, k, b, lambda, delta);
        const double d[3] = {next.n - lambda[r], next.t1 - lambda[r + 1], friction ? next.t2 - lambda[r + 2] : 0};
        if (d[0] != 0 || d[1] != 0 || d[2] != 0) {
          near3(delta, wr, s, friction ? 2 * s : s, d, from, full, end);
          lambda[r] = next.n;
          lambda[r + 1] = next.t1;
          if (friction) lambda[r + 2] = next.t2;
          for (int i = 0; i < rows; ++i) {
            most = larger(most, size(d[i]) * wr[i * s + r + i]);
            now.w[now.count] = wr + i * s;
            now.d[now.count++] = d[i];
          }
        }
      }
      for (const int due = (k - first_block + 1) * tasks / blocks; done < due; ++done) {
        if (done < behind_tasks) {
          behind(delta, before, group * done, last_from);
        } else {
          const int at = begin_next + group * (done - behind_tasks), rows = end - at < group ? end - at : group;
          ahead(gathered + (at - next_from), w + at * s, s, rows, moved, data.columns, column_count);
        }
      }
    }
    for (int i = 0; i < now.count; ++i) {
      const int row = int((now.w[i] - w) / s), column = row / W * W;
      moved[row] = now.d[i];
      if (column_count == 0 || data.columns[column_count - 1] != column) data.columns[column_count++] = column;
    }
    for (int i = now.count; i % group; ++i) {
      now.w[i] = now.w[0];
      now.d[i] = 0;
    }
    if (ahead_tasks)
      for (int j = 0; next_from + j < end; j += W) store(delta + next_from + j, load(delta + next_from + j) + load(gathered + j));
    last_from = from;
  }
  const Changes& last = changes[(data.panel_count & 1) ^ 1];
  for (int i = 0; i < last.count; i += group) behind(delta, last, i, last_from);
  return most;
}

void combine(double* y, const double* a, long stride, const double* c, int rows, int n) {
  Changes some;
  const auto add = [&] {
    for (; some.count % group; ++some.count) {
      some.w[some.count] = some.w[0];
      some.d[some.count] = 0;
    }
    for (int i = 0; i < some.count; i += group) behind(y, some, i, n);
    some.count = 0;
  };
  for (int k = 0; k < rows; ++k) {
    if (c[k] == 0) continue;
    some.w[some.count] = a + k * stride;
    some.d[some.count++] = c[k];
    if (some.count == panel_rows) add();
  }
  add();
}

}  // namespace

extern const SweepKernels sweep_table;
const SweepKernels sweep_table = {sweep, combine};

}  // namespace insula::KERNEL_NAME
