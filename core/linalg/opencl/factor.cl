// SPDX-License-Identifier: GPL-3.0-or-later
// The numeric factor, one level of the elimination tree after the other. A front's own columns are factorised in blocks
// of TILE columns. No two groups write to one place and all sums have a fixed order, so the bits are the same each time.

// Puts the blocks of A into the panels, which are zero. target: scatter offset; place: slot, leading dimension,
// whether transposed.
__kernel void scatter(__global const double* values, __global const long* target, __global const int4* place, int count,
                      __global double* panels) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const int4 p = place[i];
  __global const double* block = values + 9L * p.x;
  __global double* to = panels + target[i];
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) to[(long)c * p.y + r] = p.z ? block[3 * r + c] : block[3 * c + r];
}

// Adds the children's updates to the nodes [a, b) of the columns of a front. Its own update is cleared before.
__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void assemble(
    __global const FrontRecord* fronts, __global const int* children, __global const int* map,
    __global const Task* tasks, int first_task, __global double* panels, __global double* updates,
    __global const double* below) {
  const Task task = tasks[first_task + get_group_id(0)];
  const FrontRecord f = fronts[task.front];
  const int me = get_local_id(0);
  for (int c = max(3 * task.a, f.own); c < 3 * task.b; ++c)
    for (int r = c - f.own + me; r < f.rows - f.own; r += GROUP) updates[f.update + (long)(c - f.own) * f.ldu + r] = 0.0;
  barrier(CLK_GLOBAL_MEM_FENCE);
  for (int k = f.children_begin; k < f.children_end; ++k) {
    const FrontRecord child = fronts[children[k]];
    const int n = (child.rows - child.own) / 3;
    __global const int* to = map + child.map;
    for (int j = first_from(to, n, task.a); j < n && to[j] < task.b; ++j)
      for (int i = 0; i < 3; ++i) {
        const int c = 3 * to[j] + i;
        __global const double* from = below + child.update + (long)(3 * j + i) * child.ldu;
        __global double* column = c < f.own ? panels + f.panel + (long)c * f.lda
                                            : updates + f.update + (long)(c - f.own) * f.ldu - f.own;
        for (int r = 3 * j + i + me; r < 3 * n; r += GROUP) column[3 * to[r / 3] + r % 3] += from[r];
      }
    barrier(CLK_GLOBAL_MEM_FENCE);
  }
}

// Rows from b on of the block of columns from a on: subtracts what the columns before give.
__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void update_block(__global const FrontRecord* fronts,
                                                                             __global const Task* tasks, int first_task,
                                                                             __global double* panels) {
  __local double as[TILE * CHUNK], bs[TILE * CHUNK];
  const Task task = tasks[first_task + get_group_id(0)];
  const FrontRecord f = fronts[task.front];
  const int x = get_local_id(0) % 8, y = get_local_id(0) / 8;
  const int rows = min(TILE, f.rows - task.b), columns = min(TILE, f.own - task.a);
  double sum[4][4];
  clear(sum);
  __global double* panel = panels + f.panel;
  multiply(sum, panel + task.b, f.lda, 0, rows, panel + task.a, f.lda, 0, columns, task.a, as, bs);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      if (x + 8 * i < rows && y + 8 * j < columns)
        panel[task.b + x + 8 * i + (long)(task.a + y + 8 * j) * f.lda] -= sum[i][j];
}

// Cholesky of the diagonal block from column a on, and the inverse of its triangle. A pivot is judged by its diagonal
// entry of A; bad[0] says that one was lost.
__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void factor_diagonal(
    __global const FrontRecord* fronts, __global const Task* tasks, int first_task, __global double* panels,
    __global double* inverses, __global const double* values, __global const int* diagonal, double least,
    double largest, __global int* bad) {
  __local double l[TILE][TILE + 1], inverse[TILE][TILE + 1];
  const Task task = tasks[first_task + get_group_id(0)];
  const FrontRecord f = fronts[task.front];
  const int me = get_local_id(0), n = min(TILE, f.own - task.a);
  __global double* block = panels + f.panel + task.a + (long)task.a * f.lda;
  for (int e = me; e < n * n; e += GROUP) l[e % n][e / n] = block[e % n + (long)(e / n) * f.lda];
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int c = 0; c < n; ++c) {
    if (me == 0) {
      const int scalar = f.first + task.a + c;
      const double pivot = l[c][c], entry = values[9L * diagonal[scalar / 3] + 4 * (scalar % 3)];
      const double root = sqrt(pivot);
      if (!(pivot > 0.0 && pivot > least * entry && root <= largest)) bad[0] = 1;
      l[c][c] = root;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (int r = c + 1 + me; r < n; r += GROUP) l[r][c] /= l[c][c];
    barrier(CLK_LOCAL_MEM_FENCE);
    const int left = n - c - 1;
    for (int e = me; e < left * left; e += GROUP) {
      const int r = c + 1 + e % left, k = c + 1 + e / left;
      if (k <= r) l[r][k] -= l[r][c] * l[k][c];
    }
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  for (int e = me; e < TILE * TILE; e += GROUP) inverse[e % TILE][e / TILE] = 0.0;
  barrier(CLK_LOCAL_MEM_FENCE);
  if (me < n)
    for (int r = me; r < n; ++r) {
      double s = r == me ? 1.0 : 0.0;
      for (int k = me; k < r; ++k) s -= l[r][k] * inverse[k][me];
      inverse[r][me] = s / l[r][r];
    }
  barrier(CLK_LOCAL_MEM_FENCE);
  __global double* out = inverses + f.inverse + (long)(task.a / TILE) * TILE * TILE;
  for (int e = me; e < TILE * TILE; e += GROUP) out[e] = inverse[e % TILE][e / TILE];
  for (int e = me; e < n * n; e += GROUP)
    if (e % n >= e / n) block[e % n + (long)(e / n) * f.lda] = l[e % n][e / n];
}

// Rows from b on, below the diagonal block from column a on: L21 = A21 L11^-T.
__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void solve_block(__global const FrontRecord* fronts,
                                                                            __global const Task* tasks, int first_task,
                                                                            __global double* panels,
                                                                            __global const double* inverses) {
  __local double as[TILE * CHUNK], bs[TILE * CHUNK];
  const Task task = tasks[first_task + get_group_id(0)];
  const FrontRecord f = fronts[task.front];
  const int x = get_local_id(0) % 8, y = get_local_id(0) / 8;
  const int rows = min(TILE, f.rows - task.b), columns = min(TILE, f.own - task.a);
  double sum[4][4];
  clear(sum);
  __global double* block = panels + f.panel + task.b + (long)task.a * f.lda;
  multiply(sum, block, f.lda, 0, rows, inverses + f.inverse + (long)(task.a / TILE) * TILE * TILE, TILE, 0, TILE,
           columns, as, bs);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      if (x + 8 * i < rows && y + 8 * j < columns) block[x + 8 * i + (long)(y + 8 * j) * f.lda] = sum[i][j];
}

// The tile of rows from a on and columns from b on of a front's update: subtracts L21 L21^T from its lower triangle.
__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void subtract_update(__global const FrontRecord* fronts,
                                                                                __global const Task* tasks,
                                                                                int first_task,
                                                                                __global const double* panels,
                                                                                __global double* updates) {
  __local double as[TILE * CHUNK], bs[TILE * CHUNK];
  const Task task = tasks[first_task + get_group_id(0)];
  const FrontRecord f = fronts[task.front];
  const int x = get_local_id(0) % 8, y = get_local_id(0) / 8, n = f.rows - f.own;
  double sum[4][4];
  clear(sum);
  __global const double* l21 = panels + f.panel + f.own;
  multiply(sum, l21 + task.a, f.lda, 0, min(TILE, n - task.a), l21 + task.b, f.lda, 0, min(TILE, n - task.b), f.own, as,
           bs);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) {
      const int r = task.a + x + 8 * i, c = task.b + y + 8 * j;
      if (r < n && c <= r) updates[f.update + r + (long)c * f.ldu] -= sum[i][j];
    }
}
