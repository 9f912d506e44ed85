// SPDX-License-Identifier: GPL-3.0-or-later
// Many right-hand sides: Y = L^-1 P H^T on the fronts that rows reach, then W = Y^T Y. Y is row-major with leading
// dimension ldy. A front's columns outside of its reach are neither read nor written.

// Own rows of a front, TILE columns from its reach's begin + a on: entries of H^T, what the children carry, L11^-1.
__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void forward_own(
    __global const FrontRecord* fronts, __global const int* children, __global const int* map,
    __global const Task* tasks, int first_task, __global const ReachRecord* reach, __global const EntryRecord* entries,
    __global const double* panels, __global const double* inverses, __global double* y, int ldy,
    __global const double* below) {
  __local double as[TILE * CHUNK], bs[TILE * CHUNK];
  const Task task = tasks[first_task + get_group_id(0)];
  const FrontRecord f = fronts[task.front];
  const ReachRecord own = reach[task.front];
  const int me = get_local_id(0), begin = own.begin + task.a, end = min(begin + TILE, own.end);
  const int column = begin + me % TILE, start = me / TILE;
  __global double* yf = y + (long)f.first * ldy;
  if (column < end)
    for (int r = start; r < f.own; r += GROUP / TILE) yf[(long)r * ldy + column] = 0.0;
  barrier(CLK_GLOBAL_MEM_FENCE);
  if (start == 0 && column < end)
    for (int e = own.entries_begin; e < own.entries_end; ++e) {
      const EntryRecord h = entries[e];
      if (h.column != column) continue;
      __global double* to = y + (long)h.scalar * ldy + column;
      to[0] += h.x;
      to[ldy] += h.y;
      to[2L * ldy] += h.z;
    }
  barrier(CLK_GLOBAL_MEM_FENCE);
  for (int k = f.children_begin; k < f.children_end; ++k) {
    const FrontRecord child = fronts[children[k]];
    const ReachRecord there = reach[children[k]];
    const int n = 3 * first_from(map + child.map, (child.rows - child.own) / 3, f.own / 3);
    if (column < end && column >= there.begin && column < there.end)
      for (int i = start; i < n; i += GROUP / TILE)
        yf[(long)(3 * map[child.map + i / 3] + i % 3) * ldy + column] += below[(long)(child.carried + i) * ldy + column];
    barrier(CLK_GLOBAL_MEM_FENCE);
  }
  const int x = me % 8, z = me / 8;
  double sum[4][4];
  for (int row = 0; row < f.own; row += TILE) {
    const int n = min(TILE, f.own - row);
    if (row > 0) {
      clear(sum);
      multiply(sum, panels + f.panel + row, f.lda, 0, n, yf + begin, ldy, 0, end - begin, row, as, bs);
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
          if (x + 8 * i < n && begin + z + 8 * j < end) yf[(long)(row + x + 8 * i) * ldy + begin + z + 8 * j] -= sum[i][j];
      barrier(CLK_GLOBAL_MEM_FENCE);
    }
    clear(sum);
    multiply(sum, inverses + f.inverse + (long)(row / TILE) * TILE * TILE, TILE, 0, n, yf + (long)row * ldy + begin, ldy,
             0, end - begin, n, as, bs);
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        if (x + 8 * i < n && begin + z + 8 * j < end) yf[(long)(row + x + 8 * i) * ldy + begin + z + 8 * j] = sum[i][j];
    barrier(CLK_GLOBAL_MEM_FENCE);
  }
}

// TILE rows below a front's own from b on: what it and its children carry to its parent.
__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void forward_below(
    __global const FrontRecord* fronts, __global const int* children, __global const int* map,
    __global const Task* tasks, int first_task, __global const ReachRecord* reach, __global const double* panels,
    __global const double* y, int ldy, __global double* carried, __global const double* below) {
  __local double as[TILE * CHUNK], bs[TILE * CHUNK];
  const Task task = tasks[first_task + get_group_id(0)];
  const FrontRecord f = fronts[task.front];
  const ReachRecord own = reach[task.front];
  const int me = get_local_id(0), begin = own.begin + task.a, end = min(begin + TILE, own.end);
  const int column = begin + me % TILE, start = me / TILE;
  const int rows = min(TILE, f.rows - f.own - task.b), first = f.own + task.b;
  __global double* out = carried + (long)(f.carried + task.b) * ldy;
  if (column < end)
    for (int r = start; r < rows; r += GROUP / TILE) out[(long)r * ldy + column] = 0.0;
  barrier(CLK_GLOBAL_MEM_FENCE);
  for (int k = f.children_begin; k < f.children_end; ++k) {
    const FrontRecord child = fronts[children[k]];
    const ReachRecord there = reach[children[k]];
    const int nodes = (child.rows - child.own) / 3;
    const int from = 3 * first_from(map + child.map, nodes, first / 3),
              to = 3 * first_from(map + child.map, nodes, (first + rows + 2) / 3);
    if (column < end && column >= there.begin && column < there.end)
      for (int i = from + start; i < to; i += GROUP / TILE) {
        const int r = 3 * map[child.map + i / 3] + i % 3 - first;
        if (r >= 0 && r < rows) out[(long)r * ldy + column] += below[(long)(child.carried + i) * ldy + column];
      }
    barrier(CLK_GLOBAL_MEM_FENCE);
  }
  const int x = me % 8, z = me / 8;
  double sum[4][4];
  clear(sum);
  multiply(sum, panels + f.panel + first, f.lda, 0, rows, y + (long)f.first * ldy + begin, ldy, 0, end - begin, f.own, as,
           bs);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      if (x + 8 * i < rows && begin + z + 8 * j < end) out[(long)(x + 8 * i) * ldy + begin + z + 8 * j] -= sum[i][j];
}

// Part of W, the tile of rows from a on and columns from b on: the sum over the fronts [front, c) of the list `reached`.
__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void multiply_rows(
    __global const FrontRecord* fronts, __global const int* reached, __global const Task* tasks, int first_task,
    __global const ReachRecord* reach, __global const double* y, int ldy, int parts, __global double* w) {
  __local double as[TILE * CHUNK], bs[TILE * CHUNK];
  const int group = get_group_id(0), tile = group / parts, part = group % parts;
  const Task where = tasks[first_task + tile], range = tasks[first_task + get_num_groups(0) / parts + part];
  const int x = get_local_id(0) % 8, z = get_local_id(0) / 8;
  double sum[4][4];
  clear(sum);
  for (int k = range.a; k < range.b; ++k) {
    const FrontRecord f = fronts[reached[k]];
    const ReachRecord own = reach[reached[k]];
    if (own.begin >= where.a + TILE || own.end <= where.a || own.begin >= where.b + TILE || own.end <= where.b) continue;
    __global const double* yf = y + (long)f.first * ldy;
    multiply(sum, yf + where.a, ldy, own.begin - where.a, own.end - where.a, yf + where.b, ldy, own.begin - where.b,
             own.end - where.b, f.own, as, bs);
  }
  __global double* out = w + (long)part * ldy * ldy;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) out[(long)(where.a + x + 8 * i) * ldy + where.b + z + 8 * j] = sum[i][j];
}

// Part of Y^T load, one group a range of the list `reached`.
__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void multiply_load(
    __global const FrontRecord* fronts, __global const int* reached, __global const Task* ranges, int first_range,
    __global const ReachRecord* reach, __global const double* y, int ldy, __global const double* load,
    __global double* out) {
  const Task range = ranges[first_range + get_group_id(0)];
  for (int c = get_local_id(0); c < ldy; c += GROUP) {
    double sum = 0.0;
    for (int k = range.a; k < range.b; ++k) {
      const FrontRecord f = fronts[reached[k]];
      const ReachRecord own = reach[reached[k]];
      if (c < own.begin || c >= own.end) continue;
      for (int r = f.first; r < f.first + f.own; ++r) sum += y[(long)r * ldy + c] * load[r];
    }
    out[(long)get_group_id(0) * ldy + c] = sum;
  }
}

// sum[i] = sum over the parts, in their order, of part[i].
__kernel void add_parts(__global const double* part, int parts, int size, __global double* sum) {
  const int i = get_global_id(0);
  if (i >= size) return;
  double s = 0.0;
  for (int p = 0; p < parts; ++p) s += part[(long)p * size + i];
  sum[i] = s;
}

// x += Y lambda on one front a group.
__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void combine(__global const FrontRecord* fronts,
                                                                        __global const int* reached,
                                                                        __global const ReachRecord* reach,
                                                                        __global const double* y, int ldy,
                                                                        __global const double* lambda,
                                                                        __global double* x) {
  const int front = reached[get_group_id(0)];
  const FrontRecord f = fronts[front];
  const ReachRecord own = reach[front];
  for (int r = f.first + get_local_id(0); r < f.first + f.own; r += GROUP) {
    double sum = 0.0;
    for (int c = own.begin; c < own.end; ++c) sum += y[(long)r * ldy + c] * lambda[c];
    x[r] += sum;
  }
}
