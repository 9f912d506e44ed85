// SPDX-License-Identifier: GPL-3.0-or-later
// Substitution with one right-hand side, one group of LINE_GROUP items a front. What a front subtracts from its
// ancestors is carried upwards from child to parent, so that no two fronts write to one place.

// x := L^-1 x on the fronts of a level. `carried` gets what the parents add, `below` has that of the children.
__kernel __attribute__((reqd_work_group_size(LINE_GROUP, 1, 1))) void forward_one(
    __global const FrontRecord* fronts, __global const int* children, __global const int* map,
    __global const Task* tasks, int first_task, __global const double* panels, __global const double* inverses,
    __global double* x, __global double* carried, __global const double* below) {
  __local double t[TILE];
  const FrontRecord f = fronts[tasks[first_task + get_group_id(0)].front];
  const int me = get_local_id(0);
  __global double* own = x + f.first;
  __global double* mine = carried + f.carried - f.own;
  for (int r = f.own + me; r < f.rows; r += LINE_GROUP) mine[r] = 0.0;
  barrier(CLK_GLOBAL_MEM_FENCE);
  for (int k = f.children_begin; k < f.children_end; ++k) {
    const FrontRecord child = fronts[children[k]];
    for (int i = me; i < child.rows - child.own; i += LINE_GROUP) {
      const int r = 3 * map[child.map + i / 3] + i % 3;
      if (r < f.own) own[r] += below[child.carried + i];
      else mine[r] += below[child.carried + i];
    }
    barrier(CLK_GLOBAL_MEM_FENCE);
  }
  for (int begin = 0; begin < f.own; begin += TILE) {
    const int n = min(TILE, f.own - begin);
    __global const double* inverse = inverses + f.inverse + (long)(begin / TILE) * TILE * TILE;
    if (me < n) {
      double s = 0.0;
      for (int k = 0; k <= me; ++k) s += inverse[me + TILE * k] * own[begin + k];
      t[me] = s;
    }
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    if (me < n) own[begin + me] = t[me];
    __global const double* l = panels + f.panel + (long)begin * f.lda;
    for (int r = begin + n + me; r < f.rows; r += LINE_GROUP) {
      double s = 0.0;
      for (int k = 0; k < n; ++k) s += l[r + (long)k * f.lda] * t[k];
      if (r < f.own) own[r] -= s;
      else mine[r] -= s;
    }
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
  }
}

// x := L^-T x on the fronts of a level, after those above it. Teams of 32 items sum one column each.
__kernel __attribute__((reqd_work_group_size(LINE_GROUP, 1, 1))) void backward_one(
    __global const FrontRecord* fronts, __global const int* index, __global const Task* tasks, int first_task,
    __global const double* panels, __global const double* inverses, __global double* x) {
  __local double part[LINE_GROUP], t[TILE];
  const FrontRecord f = fronts[tasks[first_task + get_group_id(0)].front];
  const int me = get_local_id(0), lane = me % 32, team = me / 32;
  __global double* own = x + f.first;
  __global const int* node = index + f.index;
  for (int begin = (f.own - 1) / TILE * TILE; begin >= 0; begin -= TILE) {
    const int n = min(TILE, f.own - begin);
    for (int c = team; c < TILE; c += LINE_GROUP / 32) {
      double s = 0.0;
      if (c < n) {
        __global const double* l = panels + f.panel + (long)(begin + c) * f.lda;
        for (int r = begin + n + lane; r < f.rows; r += 32)
          s += l[r] * (r < f.own ? own[r] : x[3 * node[r / 3] + r % 3]);
      }
      part[me] = s;
      barrier(CLK_LOCAL_MEM_FENCE);
      if (lane == 0 && c < n) {
        double whole = 0.0;
        for (int k = 0; k < 32; ++k) whole += part[me + k];
        t[c] = own[begin + c] - whole;
      }
      barrier(CLK_LOCAL_MEM_FENCE);
    }
    __global const double* inverse = inverses + f.inverse + (long)(begin / TILE) * TILE * TILE;
    if (me < n) {
      double s = 0.0;
      for (int k = me; k < n; ++k) s += inverse[k + TILE * me] * t[k];
      own[begin + me] = s;
    }
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
  }
}
